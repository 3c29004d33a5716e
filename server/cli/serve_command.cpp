// SPDX-License-Identifier: MIT
// penumbra serve: the service, until a signal ends it.
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <future>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>

#include "server/cli/commands.h"
#include "server/cli/config_options.h"
#include "server/cli/cpu_quota.h"
#include "server/cli/files.h"
#include "server/http/http_server.h"
#include "server/service/version.h"
#include "server/worker/process_backend.h"

namespace penumbra {
namespace {

sigset_t ending_signals() {
    sigset_t set;
    ::sigemptyset(&set);
    ::sigaddset(&set, SIGTERM);
    ::sigaddset(&set, SIGINT);
    return set;
}

// The signal that ended the wait, 0 after `milliseconds`.
int wait_for_signal(const sigset_t& set, long milliseconds) {
    const timespec time{milliseconds / 1000, (milliseconds % 1000) * 1000000};
    const int signal = ::sigtimedwait(&set, nullptr, &time);
    return signal > 0 ? signal : 0;
}

// From here on a second signal ends the process at once. A handler, not the default action: as process 1
// of a container the default action would be nothing.
void exit_at_next_signal(const sigset_t& set) {
    struct sigaction action {};
    action.sa_handler = [](int) { ::_exit(kWorldFailed); };
    ::sigaction(SIGTERM, &action, nullptr);
    ::sigaction(SIGINT, &action, nullptr);
    ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

// What makes the renderers: processes of this program, or this process.
struct Workers {
    std::size_t count = 1;
    BackendFactory make;
};

Workers workers_of(Config& config, const Engine& engine, std::shared_ptr<const ToneLut> tone_lut) {
    const int processors = usable_processors();
    config.render_threads = processors;
    if (config.workers == 0) {
        return {1, [&, tone_lut] { return engine.make_backend({.device = config.device, .shader_dir = {}, .tone_lut = tone_lut}); }};
    }
    const int count = config.workers > 0 ? config.workers : std::max(processors / 4, 1);
    WorkerProcessOptions options;
    options.program = "/proc/self/exe";  // also when the file has been replaced since
    options.arguments = {"worker-process", "--device", config.device};
    if (!config.tone_lut.empty()) options.arguments.insert(options.arguments.end(), {"--tony-lut", config.tone_lut});
    config.render_threads = (processors + count - 1) / count;
    // They share the processors: llvmpipe's own count knows neither of the others nor of a quota.
    if (std::getenv("LP_NUM_THREADS") == nullptr) {
        options.environment = {{"LP_NUM_THREADS", std::to_string(config.render_threads)}};
    }
    options.silence = std::chrono::seconds(config.worker_silence_s);
    options.most_memory_bytes = config.worker_memory_mb << 20;
    options.most_renders = config.worker_renders;
    return {std::size_t(count), [options] { return make_process_backend(options); }};
}

int serve(Config config, const Engine& engine) {
    config.tokens = read_tokens(config.token_file);
    config.url_key = read_key(config.url_key_file);
    const std::shared_ptr<const ToneLut> tone_lut = read_tone_lut(config.tone_lut);
    // Blocked before any thread exists, so that no thread but this one is interrupted.
    const sigset_t signals = ending_signals();
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);

    const Log log(config.log_format);
    const Workers workers = workers_of(config, engine, tone_lut);
    RenderWorker worker(workers.make, config.queue_capacity, log, warm_up_scenes(config.warm_up), workers.count);
    RenderService service(worker, engine.unsupported_with({.tone_lut = tone_lut != nullptr}), config);
    HttpServer server(service, config, log);
    if (const std::string why = server.start(); !why.empty()) {
        complain(why);
        return kWorldFailed;
    }
    if (!config.port_file.empty()) {
        write_text(config.port_file, std::to_string(server.port()) + "\n" +
                                         (server.admin_port() > 0 ? std::to_string(server.admin_port()) + "\n" : ""));
    }
    log.info("listening on " + server.url(), {{"version", version()}, {"admin_port", std::int64_t(server.admin_port())}});

    bool told_ready = false;
    int signal = 0;
    while (signal == 0) {
        signal = wait_for_signal(signals, 100);
        const RenderWorker::Status status = worker.status();
        if (status.state == RenderWorker::State::ready && !told_ready) {
            told_ready = true;
            log.info("ready", {{"device", status.device.renderer},
                               {"workers", std::int64_t(config.workers == 0 ? 0 : status.workers)}});
        }
        if (status.state == RenderWorker::State::broken) {
            complain(status.reason);
            server.stop();
            return kWorldFailed;
        }
        if (signal == 0 && !server.listening()) {
            complain("the listening socket failed");
            return kWorldFailed;
        }
    }
    log.info("stopping", {{"signal", std::int64_t(signal)}, {"waiting", std::int64_t(worker.status().waiting)}});
    exit_at_next_signal(signals);
    std::promise<void> done;
    std::thread limit([&, end = done.get_future()] {
        if (end.wait_for(std::chrono::seconds(config.shutdown_timeout_s)) == std::future_status::ready) return;
        log.warning("ending renders", {{"running", std::int64_t(worker.status().running)}});
        service.stop_all();
    });
    server.stop();
    done.set_value();
    limit.join();
    log.info("stopped");
    return kSuccess;
}

}  // namespace

void add_serve_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("serve", "Render over HTTP");
    auto config = std::make_shared<Config>();
    add_config_options(*command, *config);
    command->callback([&context, config] {
        context.run = [&context, config]() -> int {
            try {
                return serve(*config, context.engine);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
