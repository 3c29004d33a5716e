// SPDX-License-Identifier: MIT
#include "server/cli/config_options.h"

#include <CLI/CLI.hpp>

#include "core/scene/wording.h"
#include "server/cli/checks.h"
#include "server/cli/files.h"

namespace penumbra {

void add_font_option(CLI::App& command, std::string& path) {
    command.add_option("--font", path, "Font file for texts (TrueType, OpenType); else DejaVu Sans")->envname("PENUMBRA_FONT");
}

void add_tone_lut_option(CLI::App& command, std::string& path) {
    command.add_option("--tony-lut", path, "Table of the tone map tony: tony_mc_mapface.dds of its project")
        ->envname("PENUMBRA_TONY_LUT");
}

std::shared_ptr<const ToneLut> read_tone_lut(const std::string& path) {
    if (path.empty()) return nullptr;
    constexpr std::size_t kMostBytes = std::size_t(64) << 20;
    const std::string text = read_text(path, kMostBytes);
    auto decoded = decode_tone_lut({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    if (const auto* why = std::get_if<std::string>(&decoded)) throw InputError(path + ": " + *why);
    return std::make_shared<const ToneLut>(std::move(std::get<ToneLut>(decoded)));
}

Tokens read_tokens(const std::string& path) {
    constexpr std::size_t kMostBytes = std::size_t(1) << 20;
    if (path.empty()) return {};
    const std::string text = read_text(path, kMostBytes);
    try {
        return Tokens::parse(text);
    } catch (const std::runtime_error& error) {
        throw InputError(path + ": " + error.what());
    }
}

std::string read_key(const std::string& path) {
    constexpr std::size_t kShortest = 32, kLongest = 4096;
    if (path.empty()) return "";
    std::string key = read_text(path, kLongest);
    while (!key.empty() && (key.back() == '\n' || key.back() == '\r')) key.pop_back();
    if (key.size() < kShortest) throw InputError(path + ": a key has at least " + std::to_string(kShortest) + " bytes");
    return key;
}

void add_device_option(CLI::App& command, std::string& device) {
    command.add_option("--device", device, "auto, cpu, gpu, or an index as `penumbra info` lists them")
        ->envname("PENUMBRA_DEVICE")
        ->check(device_name())
        ->capture_default_str();
}

void add_config_options(CLI::App& command, Config& config) {
    const auto option = [&](const char* name, auto& value, const char* env, const char* text) {
        return command.add_option(name, value, text)->envname(env)->capture_default_str();
    };
    option("--host", config.host, "PENUMBRA_HOST", "Address to listen on; 0.0.0.0 for every network");
    option("--port", config.port, "PENUMBRA_PORT", "Port; 0 takes a free one")->check(whole_number(0, 65535));
    option("--port-file", config.port_file, "PENUMBRA_PORT_FILE", "Write the port here once it listens");
    add_device_option(command, config.device);
    add_font_option(command, config.font);
    add_tone_lut_option(command, config.tone_lut);
    option("--queue", config.queue_capacity, "PENUMBRA_QUEUE", "Renders that may wait; more get 503")
        ->check(whole_number(1, 10000));
    // In whole MiB on the command line; bytes inside.
    command
        .add_option_function<std::size_t>(
            "--max-body-mb", [&config](std::size_t mb) { config.max_body_bytes = mb << 20; },
            "Longest body, in MiB [" + std::to_string(config.max_body_bytes >> 20) + "]")
        ->envname("PENUMBRA_MAX_BODY_MB")
        ->check(whole_number(1, 1024));
    command
        .add_option_function<std::size_t>(
            "--max-held-mb", [&config](std::size_t mb) { config.held_bytes = mb << 20; },
            "MiB of requests and unread answers, of all connections together; at least two longest bodies [" +
                std::to_string(config.held_bytes >> 20) + "]")
        ->envname("PENUMBRA_MAX_HELD_MB")
        ->check(whole_number(1, 65536));
    option("--max-pixels", config.max_pixels, "PENUMBRA_MAX_PIXELS", "Largest canvas, in pixels")
        ->check(number_between(1, config.max_pixels));
    option("--max-shapes", config.bounds.max_shapes, "PENUMBRA_MAX_SHAPES", "Most shapes of a scene")
        ->check(whole_number(0, long(config.bounds.max_shapes)));
    option("--max-points", config.bounds.max_points, "PENUMBRA_MAX_POINTS", "Most points of all outlines of a scene")
        ->check(whole_number(0, long(config.bounds.max_points)));
    option("--max-lights", config.bounds.max_lights, "PENUMBRA_MAX_LIGHTS", "Most lights of a scene")
        ->check(whole_number(0, long(config.bounds.max_lights)));
    option("--max-texels", config.bounds.max_bitmap_texels, "PENUMBRA_MAX_TEXELS", "Most texels of all bitmaps of a scene")
        ->check(number_between(0, config.bounds.max_bitmap_texels));
    option("--max-bounces", config.bounds.max_bounces, "PENUMBRA_MAX_BOUNCES", "Most bounces, also of \"converged\"")
        ->check(whole_number(0, config.bounds.max_bounces));
    option("--max-json-depth", config.bounds.max_json_depth, "PENUMBRA_MAX_JSON_DEPTH", "Deepest nesting of a body")
        ->check(whole_number(8, config.bounds.max_json_depth));
    option("--max-json-values", config.bounds.max_json_values, "PENUMBRA_MAX_JSON_VALUES", "Most values in a body")
        ->check(whole_number(100, long(config.bounds.max_json_values)));
    option("--max-header-bytes", config.max_header_bytes, "PENUMBRA_MAX_HEADER_BYTES", "Longest header section, bytes")
        ->check(whole_number(1024, 65536));
    option("--max-headers", config.max_header_lines, "PENUMBRA_MAX_HEADERS", "Most headers")->check(whole_number(8, 1000));
    option("--request-timeout", config.request_timeout_s, "PENUMBRA_REQUEST_TIMEOUT",
           "Seconds for a whole request to arrive")
        ->check(whole_number(1, 3600));
    option("--response-timeout", config.response_timeout_s, "PENUMBRA_RESPONSE_TIMEOUT",
           "Seconds for a whole response to be taken")
        ->check(whole_number(1, 3600));
    option("--keep-alive", config.keep_alive_s, "PENUMBRA_KEEP_ALIVE", "Seconds an idle connection is kept")
        ->check(whole_number(1, 3600));
    option("--connections", config.spare_http_threads, "PENUMBRA_CONNECTIONS",
           "Requests answered at a time beside those that wait for a render, a thread each")
        ->check(whole_number(2, 1000));
    option("--waiting-connections", config.max_waiting_connections, "PENUMBRA_WAITING_CONNECTIONS",
           "Connections open beyond these: silent, slow or idle; more get 503")
        ->check(whole_number(1, 10000));
    option("--admin-port", config.admin_port, "PENUMBRA_ADMIN_PORT", "Port for /metrics and probes; 0 takes a free one, -1 none")
        ->check(whole_number(-1, 65535));
    option("--admin-host", config.admin_host, "PENUMBRA_ADMIN_HOST", "Its address; as --host unless it is said");
    option("--client-budget", config.client_budget_s, "PENUMBRA_CLIENT_BUDGET",
           "Seconds of rendering that a client may have in a minute; 0 is no bound")
        ->check(number_between(0, 3600));
    command.add_option("--cors-origin", config.cors_origins, "Origin whose scripts may use the service, or *; any number of times")
        ->envname("PENUMBRA_CORS_ORIGIN");
    command.add_flag("--trust-forwarded-for", config.trust_forwarded_for, "Tell clients apart by X-Forwarded-For's last address")
        ->envname("PENUMBRA_TRUST_FORWARDED_FOR");
    option("--token-file", config.token_file, "PENUMBRA_TOKEN_FILE", "File of bearer tokens, \"NAME TOKEN\" a line: who renders needs one");
    option("--url-key-file", config.url_key_file, "PENUMBRA_URL_KEY_FILE", "File of the key of signed addresses (penumbra sign-url)");
    command
        .add_option_function<std::string>(
            "--workers", [&config](const std::string& word) { config.workers = same_letters(word, "auto") ? -1 : std::stoi(word); },
            "Processes that render: auto is one for four processors; 0 renders in this process [auto]")
        ->envname("PENUMBRA_WORKERS")
        ->check(whole_number(0, 64) | one_of({"auto"}));
    option("--worker-memory-mb", config.worker_memory_mb, "PENUMBRA_WORKER_MEMORY_MB",
           "A worker that uses more MiB is replaced; 0 is no bound")
        ->check(whole_number(0, 1 << 20));
    option("--worker-renders", config.worker_renders, "PENUMBRA_WORKER_RENDERS",
           "A worker is replaced after so many renders; 0 is never")
        ->check(whole_number(0, 1'000'000'000));
    option("--worker-silence", config.worker_silence_s, "PENUMBRA_WORKER_SILENCE",
           "Seconds without a sign of life after which a worker counts as hanging")
        ->check(whole_number(1, 3600));
    option("--max-deadline", config.max_deadline_s, "PENUMBRA_MAX_DEADLINE",
           "Seconds that a request may take at most; clients may ask for less")
        ->check(whole_number(1, 86400));
    option("--max-jobs", config.max_jobs, "PENUMBRA_MAX_JOBS", "Jobs kept, those that have ended included; 0 takes none")
        ->check(whole_number(0, 100'000));
    option("--job-ttl", config.job_ttl_s, "PENUMBRA_JOB_TTL", "Seconds that a job is kept after its end")->check(whole_number(1, 7 * 86400));
    option("--max-job-time", config.max_job_s, "PENUMBRA_MAX_JOB_TIME", "Seconds that a job, or an animation, may take")
        ->check(whole_number(1, 7 * 86400));
    option("--max-frames", config.max_frames, "PENUMBRA_MAX_FRAMES", "Most frames of an animation")->check(whole_number(1, 60'000));
    option("--shutdown-timeout", config.shutdown_timeout_s, "PENUMBRA_SHUTDOWN_TIMEOUT",
           "Seconds after the first signal after which renders are ended")
        ->check(whole_number(0, 86400));
    option("--cache-bytes", config.cache_bytes, "PENUMBRA_CACHE_BYTES", "Bytes of pictures kept to be given again; 0 keeps none")
        ->check(whole_number(0, 1L << 46));
    command
        .add_option_function<std::string>(
            "--warm-up",
            [&config](const std::string& word) {
                config.warm_up = same_letters(word, "none") ? WarmUp::none
                                 : same_letters(word, "all") ? WarmUp::all
                                                             : WarmUp::common;
            },
            "Programs compiled before it is ready: none, common or all [common]")
        ->envname("PENUMBRA_WARM_UP")
        ->check(one_of({"none", "common", "all"}));
    command
        .add_option_function<std::string>(
            "--log",
            [&config](const std::string& word) {
                config.log_format = same_letters(word, "json") ? LogFormat::json : LogFormat::text;
            },
            "Log lines as text or json [text]")
        ->envname("PENUMBRA_LOG")
        ->check(one_of({"text", "json"}));
}

}  // namespace penumbra
