// SPDX-License-Identifier: MIT
// penumbra info: the device, the limits, the versions, and which devices there are.
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "server/cli/commands.h"
#include "server/cli/config_options.h"
#include "server/cli/files.h"
#include "server/service/report.h"
#include "server/service/version.h"

namespace penumbra {
namespace {

std::string as_text(const DeviceInfo& device, const std::vector<DeviceListing>& listing,
                    const SceneLimits& limits) {
    std::string text = "penumbra " + version() + "\n";
    const auto line = [&](const char* name, const std::string& value) {
        text += std::string(name) + std::string(18 - std::string_view(name).size(), ' ') + value + "\n";
    };
    const auto number = [](double value) {
        char out[40];
        std::snprintf(out, sizeof out, "%.0f", value);
        return std::string(out);
    };
    line("device", device.renderer + " (" + device.kind + ", " + device.platform + ")");
    line("vendor", device.vendor);
    line("OpenGL", device.gl_version);
    line("GLSL", device.glsl_version);
    line("largest texture", std::to_string(device.max_texture_side) + " px");
    line("loop limit",
         device.max_loop_iterations > 0 ? std::to_string(device.max_loop_iterations) + " iterations" : "none found");
    line("largest canvas", std::to_string(limits.scene.max_canvas_side_px) + " px a side, " +
                               number(limits.scene.max_canvas_pixels) + " px in all");
    line("most shapes", std::to_string(limits.scene.max_shapes));
    line("formats", format_names());
    text += "devices:\n";
    for (const DeviceListing& entry : listing) {
        text += "  " + std::to_string(entry.index) + "  " + entry.name + "\n";
    }
    return text;
}

}  // namespace

void add_info_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("info", "Show the device, the limits and the versions");
    auto json = std::make_shared<bool>(false);
    auto device = std::make_shared<std::string>("auto");
    command->add_flag("--json", *json, "Say it as JSON");
    add_device_option(*command, *device);
    command->callback([&context, json, device] {
        context.run = [&context, json, device]() -> int {
            const Engine& engine = context.engine;
            const auto listing = engine.list_devices();
            const auto backend = engine.make_backend({.device = *device, .shader_dir = {}, .tone_lut = {}});
            const SceneLimits limits = limits_of(Config{});
            write_text("-", *json ? info_json(&backend->device(), &listing, limits, engine.unsupported_with({}))
                                  : as_text(backend->device(), listing, limits));
            return kSuccess;
        };
    });
}

}  // namespace penumbra
