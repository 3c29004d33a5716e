// SPDX-License-Identifier: MIT
#include "server/cli/cli.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

#include <CLI/CLI.hpp>

#include "core/scene/wording.h"
#include "server/service/version.h"

namespace penumbra {

namespace {

// "render", "" when no command was named.
std::string command_of(const CLI::App& app) {
    const auto commands = app.get_subcommands();
    return commands.empty() ? "" : commands.front()->get_name();
}

int refuse(const CLI::App& app, const std::string& text) {
    const std::string command = command_of(app);
    complain(text);
    complain("try: penumbra " + (command.empty() ? "" : command + " ") + "--help");
    return kBadInput;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
    const std::vector<std::string_view> views(known.begin(), known.end());
    return did_you_mean(nearest_word(word, views));
}

// What nobody takes: a command, an option or an argument.
std::string stranger(const CLI::App& app, const std::string& word) {
    const std::string command = command_of(app);
    const CLI::App& reader = command.empty() ? app : *app.get_subcommands().front();
    if (word.starts_with('-')) {
        std::vector<std::string> options;
        for (const CLI::Option* option : reader.get_options())
            for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
        return in_quotes(word) + " is not an option of penumbra" + (command.empty() ? "" : " " + command) + suggestion(word, options);
    }
    if (!command.empty()) return in_quotes(word) + " is one argument too many for penumbra " + command;
    return in_quotes(word) + " is no command";
}

std::string in_words(const CLI::App& app, const CLI::ParseError& error) {
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands({})) {
        if (!command->get_group().empty()) commands.push_back(command->get_name());
    }
    const std::string list = "; there are " + CLI::detail::join(commands, ", ");
    const bool extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    const bool missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (extra || missing) {
        const std::vector<std::string> rest = app.remaining(true);
        const auto option = std::find_if(rest.begin(), rest.end(), [](const std::string& word) { return word.starts_with('-'); });
        if (!rest.empty()) {
            const std::string& word = option != rest.end() ? *option : rest.front();
            const bool command = command_of(app).empty() && !word.starts_with('-');
            return stranger(app, word) + (command ? suggestion(word, commands) + list : "");
        }
        if (command_of(app).empty()) return "a command is missing" + list;
    }
    const std::string text = error.what();
    const bool no_value = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && text.ends_with(" missing");
    return no_value ? text.substr(0, text.find(':')) + ": needs a value" : text;
}

// What is wrong with a variable that stands for an option, "" when all is well. CLI11 2.1 complains of the option,
// which nobody wrote, and 2.4 passes over it in silence.
std::string refused_variable(const CLI::App& app, const std::vector<std::string>& arguments) {
    for (CLI::App* command : app.get_subcommands()) {
        for (CLI::Option* option : command->get_options({})) {
            const std::string name = option->get_envname();
            const char* value = name.empty() ? nullptr : std::getenv(name.c_str());
            if (value == nullptr || *value == '\0') continue;
            const bool written = std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
                return argument == option->get_name() || argument.starts_with(option->get_name() + "=");
            });
            // All that takes a variable and can refuse it has one check.
            const auto* check = written || option->get_type_name() == "TEXT" ? nullptr : option->get_validator(0);
            const std::string why = check == nullptr ? "" : (*check)(std::string(value));
            if (!why.empty()) return name + ": " + why;
        }
    }
    return "";
}

}  // namespace

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
        const std::string variable = refused_variable(app, {argv, argv + argc});
        return refuse(app, variable.empty() ? in_words(app, error) : variable);
    }
    if (const std::string variable = refused_variable(app, {argv, argv + argc}); !variable.empty()) return refuse(app, variable);
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
