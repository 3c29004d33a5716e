// SPDX-License-Identifier: MIT
#include "server/cli/redis_options.h"

#include <CLI/CLI.hpp>

#include "server/cli/files.h"

namespace penumbra {

void add_redis_options(CLI::App& command, RedisOptions& options) {
    command.add_option("--redis", options.url, "Redis server: redis://[[USER]:PASSWORD@]HOST[:PORT][/DATABASE] or redis+unix:///PATH")
        ->envname("PENUMBRA_REDIS")
        ->required();
    command.add_option("--stream", options.names.stream, "Stream that jobs lie in")->envname("PENUMBRA_STREAM")->capture_default_str();
}

RedisAddress address_of(const RedisOptions& options) {
    const auto parsed = parse_redis_url(options.url);
    if (const auto* why = std::get_if<std::string>(&parsed)) throw InputError("--redis " + *why);
    if (options.names.stream.empty() || options.names.group.empty()) throw InputError("--stream and --group take a name");
    return std::get<RedisAddress>(parsed);
}

}  // namespace penumbra
