// SPDX-License-Identifier: MIT
// The program with the fake renderer. FAKE_START_ERROR, FAKE_SELF_TEST: sentences with which these fail;
// FAKE_RENDER_MS: how long a render takes.
#include <chrono>
#include <cstdlib>
#include <thread>

#include "fake_engine.h"
#include "server/cli/cli.h"
#include "server/cli/commands.h"

int main(int argc, char** argv) {
    using namespace penumbra;
    const auto text = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value ? value : "");
    };
    auto control = std::make_shared<test::FakeControl>();
    control->set_start_error(text("FAKE_START_ERROR"));
    control->set_self_test(text("FAKE_SELF_TEST"));
    Engine engine = test::fake_engine(control);
    if (const int ms = std::atoi(text("FAKE_RENDER_MS").c_str()); ms > 0) {
        control->close_gate();
        std::thread([control, ms] {
            control->wait_for_begun(1);
            std::this_thread::sleep_for(std::chrono::milliseconds(ms));
            control->open_gate();
        }).detach();
    }
    constexpr AddCommand kCommands[] = {add_render_command, add_serve_command, add_validate_command,
                                        add_info_command, add_health_command, add_reference_command,
                                        add_compare_command, add_bench_command,
                                        add_sign_url_command,
                                        add_worker_command, add_submit_command,
                                        add_worker_process_command};
    return run_cli(argc, argv, engine, kCommands);
}
