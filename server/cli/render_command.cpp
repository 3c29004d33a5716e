// SPDX-License-Identifier: MIT
// penumbra render: a scene's file to a picture's file.
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "server/cli/commands.h"
#include "server/cli/config_options.h"
#include "server/cli/files.h"
#include "server/cli/scene_input.h"
#include "server/cli/scene_report.h"
#include "server/service/report.h"

namespace penumbra {
namespace {

struct RenderOptions {
    std::string scene, output, stats, format, device = "auto", tone_lut, font;
    std::vector<std::string> sets;
};

// --format, else the file's extension, else the scene's own.
FormatWishes wishes_of(const RenderOptions& options) {
    if (!options.format.empty()) {
        if (!find_format(options.format)) {
            throw InputError("--format takes one of " + format_names() + ", not " + options.format);
        }
        return only_format(options.format);
    }
    if (options.output == "-") return any_format();
    const PictureFormat* format = find_format_of_file(options.output);
    if (!format) {
        throw InputError("cannot tell a picture format from the name " + options.output + "; there are " +
                         format_names() + " (or say --format)");
    }
    return only_format(format->name);
}

int render_file(const RenderOptions& options, const Engine& engine) {
    Config config;
    config.font = options.font;
    const SceneLimits limits = limits_of(config);
    RenderRequest request;
    request.formats = wishes_of(options);
    request.overrides = parse_sets(options.sets);
    if (options.output == "-" && options.stats == "-") {
        throw InputError("-o - and --stats - both want the standard output");
    }
    if (options.output == "-" && stdout_is_terminal()) {
        throw InputError("a picture does not go to a terminal; use -o FILE or a pipe");
    }
    const std::shared_ptr<const ToneLut> tone_lut = read_tone_lut(options.tone_lut);
    const std::string text = read_text(options.scene, limits.text.max_bytes);
    request.text = text;

    // The device is asked for after the scene is known to be right: mistakes cost no start-up.
    const RenderResponse response =
        render_to_bytes(request, limits, engine.unsupported_with({.tone_lut = tone_lut != nullptr}), [&](const Scene& scene) {
            return engine.make_backend({.device = options.device, .shader_dir = {}, .tone_lut = tone_lut})->render(scene, {});
        });
    if (response.failure != RenderFailure::none) {
        complain_about_scene(options.scene, response.problems, response.problems_left_out);
        return kBadInput;
    }
    write_file(options.output, response.answer->picture);
    if (!options.stats.empty()) write_text(options.stats, stats_json(response));
    return kSuccess;
}

}  // namespace

void add_render_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("render", "Render a scene to a picture");
    auto options = std::make_shared<RenderOptions>();
    command->add_option("scene", options->scene, "Scene file, - for the standard input")->required();
    command->add_option("-o,--output", options->output, "Picture file, - for the standard output")->required();
    command->add_option("--format", options->format,
                        "Picture format (" + format_names() + "); else the file's extension, else the scene's");
    command->add_option("--set", options->sets, "Replace a value of the scene: /json/pointer=value")
        ->expected(1)
        ->take_all();
    command->add_option("--stats", options->stats, "Write what ran and how long as JSON, - for the standard output");
    add_device_option(*command, options->device);
    add_font_option(*command, options->font);
    add_tone_lut_option(*command, options->tone_lut);
    command->callback([&context, options] {
        context.run = [&context, options]() -> int {
            try {
                return render_file(*options, context.engine);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
