// SPDX-License-Identifier: MIT
#include "server/cli/cli.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

#include <CLI/CLI.hpp>

#include "server/service/version.h"

namespace penumbra {

void complain(std::string_view text) {
    std::fprintf(stderr, "penumbra: %.*s\n", int(text.size()), text.data());
}

int run_cli(int argc, char** argv, const Engine& engine, std::span<const AddCommand> commands) {
    CLI::App app("Light in flatland: a scene goes in as JSON, a lit picture comes out.", "penumbra");
    app.set_version_flag("--version", "penumbra " + version());
    app.require_subcommand(1);
    app.footer("Exit codes: 0 done, 1 the world failed (device, disk, network), 2 bad input.");
    CommandContext context{engine, {}};
    for (const AddCommand add : commands) add(app, context);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error, std::cout, std::cerr);  // --help, --version
        complain(error.what());
        complain("try: penumbra --help");
        return kBadInput;
    }
    // A variable that its option refuses: CLI11 2.1 complains by itself, 2.4 passes over it in silence.
    for (const CLI::App* command : app.get_subcommands()) {
        for (const CLI::Option* option : command->get_options()) {
            const std::string name = option->get_envname();
            const char* value = name.empty() ? nullptr : std::getenv(name.c_str());
            if (value != nullptr && *value != '\0' && option->count() == 0) {
                complain(name + ": " + option->get_name() + " does not take '" + value + "'");
                complain("try: penumbra --help");
                return kBadInput;
            }
        }
    }
    try {
        return context.run();
    } catch (const std::bad_alloc&) {
        complain("out of memory");
    } catch (const std::exception& error) {
        complain(error.what());
    }
    return kWorldFailed;
}

}  // namespace penumbra
