// SPDX-License-Identifier: MIT
#include "server/redis/connection.h"

#include <charconv>

#include <hiredis/hiredis.h>

namespace penumbra {
namespace {

using std::chrono::milliseconds;

// For a connection, and for an answer beyond what the command itself waits.
constexpr milliseconds kPatience{5000};

timeval to_timeval(milliseconds time) {
    return {static_cast<time_t>(time.count() / 1000), static_cast<suseconds_t>(time.count() % 1000 * 1000)};
}

RedisReply to_reply(const redisReply& raw) {
    RedisReply reply;
    switch (raw.type) {
        case REDIS_REPLY_STRING:
        case REDIS_REPLY_STATUS:
        case REDIS_REPLY_ERROR:  // inside of a list
            reply.kind = RedisReply::Kind::text;
            reply.text.assign(raw.str, static_cast<std::size_t>(raw.len));
            break;
        case REDIS_REPLY_INTEGER:
            reply.kind = RedisReply::Kind::number;
            reply.number = raw.integer;
            break;
        case REDIS_REPLY_ARRAY:
            reply.kind = RedisReply::Kind::list;
            for (std::size_t i = 0; i < raw.elements; ++i) reply.list.push_back(to_reply(*raw.element[i]));
            break;
        default: break;
    }
    return reply;
}

// %41 is A: passwords hold anything.
bool unescape(std::string_view text, std::string& to) {
    to.clear();
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            to += text[i];
            continue;
        }
        unsigned value = 0;
        if (i + 2 >= text.size()) return false;
        const auto [end, error] = std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16);
        if (error != std::errc() || end != text.data() + i + 3) return false;
        to += static_cast<char>(value);
        i += 2;
    }
    return true;
}

bool parse_number(std::string_view text, int least, int most, int& to) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
    return error == std::errc() && end == text.data() + text.size() && to >= least && to <= most;
}

}  // namespace

std::variant<RedisAddress, std::string> parse_redis_url(std::string_view url) {
    constexpr std::string_view kForm = "takes redis://[[USER]:PASSWORD@]HOST[:PORT][/DATABASE] or redis+unix:///PATH";
    RedisAddress address;
    if (constexpr std::string_view kUnix = "redis+unix://"; url.starts_with(kUnix)) {
        address.socket = url.substr(kUnix.size());
        if (!address.socket.starts_with('/')) return std::string(kForm);
        return address;
    }
    if (url.starts_with("rediss://")) return std::string("cannot speak TLS to Redis: put a tunnel (stunnel) between, and say redis://");
    constexpr std::string_view kScheme = "redis://";
    if (!url.starts_with(kScheme)) return std::string(kForm);
    std::string_view rest = url.substr(kScheme.size());
    if (const std::size_t at = rest.rfind('@'); at != std::string_view::npos) {
        const std::string_view login = rest.substr(0, at);
        const std::size_t colon = login.find(':');
        if (colon == std::string_view::npos || !unescape(login.substr(0, colon), address.user) ||
            !unescape(login.substr(colon + 1), address.password)) {
            return std::string(kForm);
        }
        rest.remove_prefix(at + 1);
    }
    if (const std::size_t slash = rest.find('/'); slash != std::string_view::npos) {
        const std::string_view database = rest.substr(slash + 1);
        if (!database.empty() && !parse_number(database, 0, 1 << 20, address.database)) return std::string(kForm);
        rest = rest.substr(0, slash);
    }
    // [::1]:6379
    const std::size_t bracket = rest.starts_with('[') ? rest.find(']') : 0;
    if (bracket == std::string_view::npos) return std::string(kForm);
    const std::size_t colon = rest.find(':', bracket);
    if (colon != std::string_view::npos && !parse_number(rest.substr(colon + 1), 1, 65535, address.port)) return std::string(kForm);
    const std::string_view host = rest.substr(0, colon);
    address.host = bracket > 0 ? host.substr(1, bracket - 1) : host;
    if (address.host.empty()) return std::string(kForm);
    return address;
}

std::string to_string(const RedisAddress& address) {
    if (!address.socket.empty()) return "redis+unix://" + address.socket;
    const bool v6 = address.host.find(':') != std::string::npos;
    return "redis://" + (v6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port) +
           (address.database > 0 ? "/" + std::to_string(address.database) : "");
}

const RedisReply& RedisReply::at(std::size_t index) const {
    static const RedisReply kNothing;
    return index < list.size() ? list[index] : kNothing;
}

struct Redis::Context {
    redisContext* raw = nullptr;
    ~Context() {
        if (raw != nullptr) ::redisFree(raw);
    }
};

Redis::Redis(const RedisAddress& address) : context_(std::make_unique<Context>()) {
    const timeval patience = to_timeval(kPatience);
    context_->raw = address.socket.empty() ? ::redisConnectWithTimeout(address.host.c_str(), address.port, patience)
                                           : ::redisConnectUnixWithTimeout(address.socket.c_str(), patience);
    if (context_->raw == nullptr) throw std::bad_alloc();
    if (context_->raw->err != 0) throw RedisLost(to_string(address) + ": " + context_->raw->errstr);
    ::redisEnableKeepAlive(context_->raw);
    if (!address.password.empty()) {
        command(address.user.empty() ? std::vector<std::string>{"AUTH", address.password}
                                     : std::vector<std::string>{"AUTH", address.user, address.password});
    }
    if (address.database > 0) command({"SELECT", std::to_string(address.database)});
}

Redis::~Redis() = default;

RedisReply Redis::command(const std::vector<std::string>& words, milliseconds patience) {
    std::vector<const char*> texts;
    std::vector<std::size_t> sizes;
    for (const std::string& word : words) {
        texts.push_back(word.data());
        sizes.push_back(word.size());
    }
    ::redisSetTimeout(context_->raw, to_timeval(kPatience + patience));
    const std::unique_ptr<redisReply, void (*)(redisReply*)> raw(
        static_cast<redisReply*>(::redisCommandArgv(context_->raw, static_cast<int>(words.size()), texts.data(), sizes.data())),
        [](redisReply* reply) { ::freeReplyObject(reply); });
    if (raw == nullptr) throw RedisLost(std::string("the connection to Redis failed: ") + context_->raw->errstr);
    if (raw->type == REDIS_REPLY_ERROR) {
        const std::string why(raw->str, static_cast<std::size_t>(raw->len));
        // Of a server that starts, ends or changes its role.
        for (const char* passing : {"LOADING", "MASTERDOWN", "READONLY", "CLUSTERDOWN", "BUSY ", "TRYAGAIN"}) {
            if (why.starts_with(passing)) throw RedisLost(why);
        }
        throw RedisError(why);
    }
    return to_reply(*raw);
}

}  // namespace penumbra
