// SPDX-License-Identifier: MIT
// penumbra validate: every problem of a scene, without rendering it and without a device.
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "server/cli/commands.h"
#include "server/cli/config_options.h"
#include "server/cli/files.h"
#include "server/cli/scene_report.h"
#include "server/service/report.h"

namespace penumbra {
namespace {

CheckedScene check_file(const std::string& path, const SceneLimits& limits, const UnsupportedFeatures& unsupported) {
    const std::string text = read_text(path, limits.text.max_bytes);
    RenderRequest request;
    request.text = text;
    return check_scene(request, limits, unsupported);
}

void report(const std::string& path, const CheckedScene& checked) {
    complain_about_scene(path, checked.problems, checked.problems_left_out);
    if (checked.failure == RenderFailure::none)
        write_text("-", (path == "-" ? "<stdin>" : path) + ": valid\n");
}

int validate_file(const std::string& path, bool json, const SceneLimits& limits, const UnsupportedFeatures& unsupported) {
    const CheckedScene checked = check_file(path, limits, unsupported);
    if (json) {
        write_text("-", validation_json(checked));
    } else {
        report(path, checked);
    }
    return checked.failure == RenderFailure::none ? kSuccess : kBadInput;
}

// Each is reported, whatever the ones before it are.
int validate_files(const std::vector<std::string>& paths, bool json, const SceneLimits& limits, const UnsupportedFeatures& unsupported) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    bool good = true;
    for (const std::string& path : paths) {
        CheckedScene checked;
        try {
            checked = check_file(path, limits, unsupported);
            if (!json) report(path, checked);
        } catch (const InputError& error) {
            checked.failure = RenderFailure::not_json;
            checked.problems = {{{"", "unreadable", error.what()}, 0, 0, ""}};
            if (!json) complain(error.what());
        }
        good = good && checked.failure == RenderFailure::none;
        if (!json) continue;
        nlohmann::ordered_json entry = {{"file", path}};
        entry.update(nlohmann::ordered_json::parse(validation_json(checked)));
        list.push_back(std::move(entry));
    }
    if (json)
        write_text(
            "-", list.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
    return good ? kSuccess : kWorldFailed;
}

}  // namespace

void add_validate_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("validate", "List every problem of scenes");
    auto paths = std::make_shared<std::vector<std::string>>();
    auto json = std::make_shared<bool>(false);
    command->add_option("scenes", *paths, "Scene files, - for the standard input")->required();
    command->add_flag("--json", *json,
                      "Say it as JSON on the standard output; a list when there are several files");
    auto tone_lut = std::make_shared<std::string>();
    auto font = std::make_shared<std::string>();
    add_font_option(*command, *font);
    add_tone_lut_option(*command, *tone_lut);
    command->footer("Exit codes: 0 all are valid, 2 the only one is not, 1 one of several is not.");
    command->callback([&context, paths, json, tone_lut, font] {
        context.run = [&context, paths, json, tone_lut, font]() -> int {
            try {
                Config config;
                config.font = *font;
                const SceneLimits limits = limits_of(config);
                const auto unsupported = context.engine.unsupported_with({.tone_lut = read_tone_lut(*tone_lut) != nullptr});
                return paths->size() == 1 ? validate_file(paths->front(), *json, limits, unsupported)
                                          : validate_files(*paths, *json, limits, unsupported);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
