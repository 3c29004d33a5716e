// SPDX-License-Identifier: MIT
// penumbra worker-process: what `penumbra serve` starts for its renders. Not for people.
#include <memory>

#include <CLI/CLI.hpp>

#include "server/cli/commands.h"
#include "server/cli/config_options.h"
#include "server/worker/worker_process.h"

namespace penumbra {
namespace {

struct WorkerProcess {
    std::string device = "auto";
    std::string tone_lut;
    int socket = -1, memory = -1;
};

}  // namespace

void add_worker_process_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("worker-process", "A renderer for penumbra serve, which starts it");
    command->group("");  // not in the help
    auto options = std::make_shared<WorkerProcess>();
    add_device_option(*command, options->device);
    add_tone_lut_option(*command, options->tone_lut);
    command->add_option("--socket", options->socket)->required();
    command->add_option("--memory", options->memory)->required();
    command->callback([&context, options] {
        context.run = [&context, options] {
            const RendererOptions renderer{.device = options->device, .shader_dir = {}, .tone_lut = read_tone_lut(options->tone_lut)};
            return run_worker_process(context.engine, renderer, options->socket, options->memory);
        };
    });
}

}  // namespace penumbra
