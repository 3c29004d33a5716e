// SPDX-License-Identifier: MIT
// The only user of hiredis: a connection to a Redis server, and its answers as plain values.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace penumbra {

struct RedisAddress {
    std::string host = "127.0.0.1";
    int port = 6379;
    std::string socket;  // a path instead of host and port
    std::string user, password;
    int database = 0;
};

// redis://[[USER]:PASSWORD@]HOST[:PORT][/DATABASE] or redis+unix:///PATH. Else a sentence.
std::variant<RedisAddress, std::string> parse_redis_url(std::string_view url);
// For logs: without the password.
std::string to_string(const RedisAddress& address);

// The server is away, or the connection is. Another connection may do.
class RedisLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The server refuses the command.
class RedisError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct RedisReply {
    enum class Kind { nothing, text, number, list };
    Kind kind = Kind::nothing;
    std::string text;
    std::int64_t number = 0;
    std::vector<RedisReply> list;

    // The element at this place; an empty reply where there is none.
    const RedisReply& at(std::size_t index) const;
};

class Redis {
public:
    // Throws RedisLost, or RedisError when the password or the database is refused.
    explicit Redis(const RedisAddress& address);
    ~Redis();
    Redis(const Redis&) = delete;
    Redis& operator=(const Redis&) = delete;

    // For one thread at a time. Throws as above. `patience` is for commands that wait on the server.
    RedisReply command(const std::vector<std::string>& words, std::chrono::milliseconds patience = std::chrono::milliseconds(0));

private:
    struct Context;
    std::unique_ptr<Context> context_;
};

}  // namespace penumbra
