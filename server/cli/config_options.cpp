// SPDX-License-Identifier: MIT
#include "server/cli/config_options.h"

#include <algorithm>
#include <map>

#include <CLI/CLI.hpp>

namespace penumbra {
namespace {

std::string check_device(const std::string& device) {
    const bool index = !device.empty() && device.size() <= 4 &&
                       std::all_of(device.begin(), device.end(), [](char c) { return c >= '0' && c <= '9'; });
#ifdef PENUMBRA_HAS_OSMESA
    if (device == "osmesa") return "";
#endif
    if (index || device == "auto" || device == "cpu" || device == "gpu") return "";
    return "a device is auto, cpu, gpu or an index as `penumbra info` lists them, not " + device;
}

}  // namespace

void add_device_option(CLI::App& command, std::string& device) {
    command.add_option("--device", device, "auto, cpu, gpu, or an index as `penumbra info` lists them")
        ->envname("PENUMBRA_DEVICE")
        ->check(CLI::Validator(check_device, "DEVICE"))
        ->capture_default_str();
}

void add_config_options(CLI::App& command, Config& config) {
    const auto option = [&](const char* name, auto& value, const char* env, const char* text) {
        return command.add_option(name, value, text)->envname(env)->capture_default_str();
    };
    option("--host", config.host, "PENUMBRA_HOST", "Address to listen on; 0.0.0.0 for every network");
    option("--port", config.port, "PENUMBRA_PORT", "Port; 0 takes a free one")->check(CLI::Range(0, 65535));
    option("--port-file", config.port_file, "PENUMBRA_PORT_FILE", "Write the port here once it listens");
    add_device_option(command, config.device);
    option("--queue", config.queue_capacity, "PENUMBRA_QUEUE", "Renders that may wait; more get 503")
        ->check(CLI::Range(1, 10000));
    // In whole MiB on the command line; bytes inside.
    command
        .add_option_function<std::size_t>(
            "--max-body-mb", [&config](std::size_t mb) { config.max_body_bytes = mb << 20; },
            "Longest body, in MiB [" + std::to_string(config.max_body_bytes >> 20) + "]")
        ->envname("PENUMBRA_MAX_BODY_MB")
        ->check(CLI::Range(1, 1024));
    option("--max-pixels", config.max_pixels, "PENUMBRA_MAX_PIXELS", "Largest canvas, in pixels")
        ->check(CLI::Range(1.0, config.max_pixels));
    option("--request-timeout", config.request_timeout_s, "PENUMBRA_REQUEST_TIMEOUT",
           "Seconds for a whole request to arrive")
        ->check(CLI::Range(1, 3600));
    option("--response-timeout", config.response_timeout_s, "PENUMBRA_RESPONSE_TIMEOUT",
           "Seconds for a whole response to be taken")
        ->check(CLI::Range(1, 3600));
    option("--keep-alive", config.keep_alive_s, "PENUMBRA_KEEP_ALIVE", "Seconds an idle connection is kept")
        ->check(CLI::Range(1, 3600));
    option("--connections", config.spare_http_threads, "PENUMBRA_CONNECTIONS",
           "Connections served beside those that wait for a render")
        ->check(CLI::Range(2, 1000));
    const std::map<std::string, LogFormat> formats{{"text", LogFormat::text}, {"json", LogFormat::json}};
    command.add_option("--log", config.log_format, "Log lines as text or json [text]")
        ->envname("PENUMBRA_LOG")
        ->transform(CLI::CheckedTransformer(formats, CLI::ignore_case));
}

}  // namespace penumbra
