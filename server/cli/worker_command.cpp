// SPDX-License-Identifier: MIT
// penumbra worker: renders that lie in a Redis stream, until a signal ends it.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>

#include "server/cli/checks.h"
#include "server/cli/commands.h"
#include "server/cli/config_options.h"
#include "server/cli/cpu_quota.h"
#include "server/cli/files.h"
#include "server/cli/redis_options.h"
#include "server/redis/batch_worker.h"
#include "server/service/version.h"
#include "server/worker/process_backend.h"

namespace penumbra {
namespace {

struct WorkerOptions {
    RedisOptions redis;
    std::string device = "auto", font, tone_lut;
    std::string folder, put, name;
    int workers = -1;  // -1: by the processors
    double abandoned_s = 30;
    long tries = 3, longest_s = 600, shutdown_s = 60, silence_s = 30;
    LogFormat log = LogFormat::text;
};

// Told apart from those of other hosts, other containers, and of the one before on this host.
std::string own_name() {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
    return std::string(host.data()) + "-" + std::to_string(::getpid()) + "-" + std::to_string(::time(nullptr));
}

BackendFactory backends(const WorkerOptions& options, int count) {
    WorkerProcessOptions process;
    process.program = "/proc/self/exe";
    process.arguments = {"worker-process", "--device", options.device};
    if (!options.tone_lut.empty()) process.arguments.insert(process.arguments.end(), {"--tony-lut", options.tone_lut});
    if (std::getenv("LP_NUM_THREADS") == nullptr) {
        process.environment = {{"LP_NUM_THREADS", std::to_string((usable_processors() + count - 1) / count)}};
    }
    process.silence = std::chrono::seconds(options.silence_s);
    return [process] { return make_process_backend(process); };
}

void check_places(const WorkerOptions& options) {
    if (options.folder.empty() == options.put.empty()) throw InputError("say where results go: --output FOLDER or --put URL");
    if (!options.put.empty() && !options.put.starts_with("http://") && !options.put.starts_with("https://")) {
        throw InputError("--put takes what URLs begin with, http:// or https://, not " + options.put);
    }
    if (options.folder.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(options.folder, error);
    if (error || ::access(options.folder.c_str(), W_OK | X_OK) != 0) {
        throw std::runtime_error("cannot write to the folder " + options.folder + (error ? ": " + error.message() : ""));
    }
}

int run_worker(const WorkerOptions& options, const Engine& engine) {
    BatchSettings settings;
    settings.redis = address_of(options.redis);
    settings.names = options.redis.names;
    settings.folder = options.folder;
    settings.put_prefix = options.put;
    settings.abandoned_after = std::chrono::milliseconds(long(1000 * options.abandoned_s));
    settings.most_deliveries = options.tries;
    settings.longest_render = std::chrono::seconds(options.longest_s);
    check_places(options);
    const std::shared_ptr<const ToneLut> tone_lut = read_tone_lut(options.tone_lut);
    Config config;
    config.font = options.font;

    sigset_t signals;
    ::sigemptyset(&signals);
    ::sigaddset(&signals, SIGTERM);
    ::sigaddset(&signals, SIGINT);
    ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    ::signal(SIGPIPE, SIG_IGN);  // a connection that breaks is an answer, not an end

    const Log log(options.log);
    const int count = options.workers > 0 ? options.workers : std::max(usable_processors() / 4, 1);
    const std::string name = options.name.empty() ? own_name() : options.name;
    std::vector<std::unique_ptr<BatchWorker>> workers;
    for (int i = 0; i < count; ++i) {
        settings.consumer = count == 1 ? name : name + "-" + std::to_string(i + 1);
        workers.push_back(std::make_unique<BatchWorker>(settings, limits_of(config), engine.unsupported_with({.tone_lut = tone_lut != nullptr}),
                                                        backends(options, count), log));
    }
    log.info("worker", {{"version", version()}, {"workers", std::int64_t(count)}, {"results", options.folder.empty() ? options.put : options.folder}});
    for (const auto& worker : workers) worker->start();
    const auto all_ended = [&] { return std::all_of(workers.begin(), workers.end(), [](const auto& worker) { return worker->ended(); }); };
    const auto wait = [&] {  // a tenth of a second, or a signal
        const timespec time{0, 100'000'000};
        return ::sigtimedwait(&signals, nullptr, &time) > 0;
    };
    while (!all_ended() && !wait()) {
    }
    if (!all_ended()) {
        log.info("stopping");
        for (const auto& worker : workers) worker->finish();
        const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(options.shutdown_s);
        while (!all_ended()) {
            if (wait()) {
                log.warning("a second signal: what is under way is left to others");
                ::_exit(kWorldFailed);
            }
            if (std::chrono::steady_clock::now() < limit) continue;
            for (const auto& worker : workers) worker->stop();
        }
        log.info("stopped");
        return kSuccess;
    }
    for (const auto& worker : workers) {
        if (worker->broken().empty()) continue;
        complain(worker->broken());
        return kWorldFailed;
    }
    return kSuccess;
}

}  // namespace

void add_worker_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("worker", "Render what lies in a Redis stream");
    auto options = std::make_shared<WorkerOptions>();
    add_redis_options(*command, options->redis);
    command->add_option("--group", options->redis.names.group, "Consumer group of all workers that share the jobs")->envname("PENUMBRA_GROUP")->capture_default_str();
    command->add_option("-o,--output", options->folder, "Folder for the pictures");
    command->add_option("--put", options->put, "What the URLs begin with that pictures are PUT to; a job's name goes behind it")->envname("PENUMBRA_PUT");
    command->add_option("--name", options->name, "Name of this worker, no other's; else host, process and time");
    add_device_option(*command, options->device);
    add_font_option(*command, options->font);
    add_tone_lut_option(*command, options->tone_lut);
    command->add_option("--workers", options->workers, "Renders at a time; else one for four processors")->envname("PENUMBRA_WORKERS")->check(whole_number(1, 256));
    command->add_option("--abandoned-after", options->abandoned_s, "Seconds without a sign of life after which a job is taken over")
        ->capture_default_str()->check(number_between(0.2, 86400));
    command->add_option("--tries", options->tries, "Times that a job is handed out before it is dead")->capture_default_str()->check(whole_number(1, 1000));
    command->add_option("--longest-render", options->longest_s, "Seconds that one render may take")->capture_default_str()->check(whole_number(1, 86400));
    command->add_option("--worker-silence", options->silence_s, "Seconds without a sign of life after which a renderer counts as hanging")
        ->envname("PENUMBRA_WORKER_SILENCE")->capture_default_str()->check(whole_number(1, 3600));
    command->add_option("--shutdown-timeout", options->shutdown_s, "Seconds after the first signal after which renders are left to others")
        ->envname("PENUMBRA_SHUTDOWN_TIMEOUT")->capture_default_str()->check(whole_number(1, 86400));
    command
        ->add_option_function<std::string>(
            "--log", [options](const std::string& word) { options->log = word == "json" || word == "JSON" ? LogFormat::json : LogFormat::text; },
            "Log lines as text or json [text]")
        ->envname("PENUMBRA_LOG")
        ->check(one_of({"text", "json"}));
    command->callback([&context, options] {
        context.run = [&context, options]() -> int {
            try {
                return run_worker(*options, context.engine);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
