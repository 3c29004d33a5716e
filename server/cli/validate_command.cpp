// SPDX-License-Identifier: MIT
// penumbra validate: every problem of a scene, without rendering it and without a device.
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "server/cli/commands.h"
#include "server/cli/files.h"
#include "server/cli/scene_report.h"
#include "server/service/report.h"

namespace penumbra {
namespace {

int validate_file(const std::string& path, bool json, const Engine& engine) {
    const SceneLimits limits = limits_of(Config{});
    const std::string text = read_text(path, limits.text.max_bytes);
    RenderRequest request;
    request.text = text;
    const CheckedScene checked = check_scene(request, limits, engine.unsupported);
    if (json) {
        write_text("-", validation_json(checked));
    } else {
        complain_about_scene(path, checked.problems, checked.problems_left_out);
        if (checked.failure == RenderFailure::none) {
            write_text("-", (path == "-" ? "<stdin>" : path) + ": valid\n");
        }
    }
    return checked.failure == RenderFailure::none ? kSuccess : kBadInput;
}

}  // namespace

void add_validate_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("validate", "List every problem of a scene");
    auto path = std::make_shared<std::string>();
    auto json = std::make_shared<bool>(false);
    command->add_option("scene", *path, "Scene file, - for the standard input")->required();
    command->add_flag("--json", *json, "Say it as JSON on the standard output");
    command->callback([&context, path, json] {
        context.run = [&context, path, json]() -> int {
            try {
                return validate_file(*path, *json, context.engine);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
