// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "server/redis/job_stream.h"

namespace CLI {
class App;
}

namespace penumbra {

// What the commands that speak to Redis share.
struct RedisOptions {
    std::string url;
    StreamNames names;
};
void add_redis_options(CLI::App& command, RedisOptions& options);

// Throws InputError.
RedisAddress address_of(const RedisOptions& options);

}  // namespace penumbra
