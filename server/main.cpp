// SPDX-License-Identifier: MIT
// The program: the real renderer and the list of commands.
#include "server/cli/cli.h"
#include "server/cli/commands.h"
#include "server/cli/cpu_quota.h"
#include "server/service/renderer_backend.h"

int main(int argc, char** argv) {
    using namespace penumbra;
    // One line each; a command lives in server/cli/NAME_command.cpp.
    constexpr AddCommand kCommands[] = {
        add_render_command,
        add_serve_command,
        add_validate_command,
        add_info_command,
        add_health_command,
        add_reference_command,
        add_compare_command,
        add_bench_command,
        add_sign_url_command,
        add_worker_command,
        add_submit_command,
        add_worker_process_command,
    };
    limit_render_threads_to_cpu_quota();
    return run_cli(argc, argv, real_engine(), kCommands);
}
