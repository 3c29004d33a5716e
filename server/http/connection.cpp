// SPDX-License-Identifier: MIT
#include "server/http/connection.h"

#include <algorithm>

#include <sys/resource.h>

namespace penumbra {

void Held::change(std::size_t& counted, std::size_t now) {
    bytes_ += now - counted;  // unsigned: also when it becomes less
    counted = now;
}

bool Held::send_later(Connection& connection, std::string_view bytes) {
    if (bytes_ + bytes.size() > most_) return false;
    connection.unsent.append(bytes);
    change(connection.held_unsent, connection.unsent.size());
    return true;
}

void Held::has_sent(Connection& connection, std::size_t bytes) {
    connection.sent += bytes;
    if (connection.sent < connection.unsent.size()) return;
    connection.unsent = {};
    connection.sent = 0;
    change(connection.held_unsent, 0);
}

std::size_t room_for_connections(std::size_t wanted, std::size_t others) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
    const rlim_t needed = wanted + others;
    if (limit.rlim_cur < needed) {
        limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, needed);
        ::setrlimit(RLIMIT_NOFILE, &limit);
        ::getrlimit(RLIMIT_NOFILE, &limit);
    }
    if (limit.rlim_cur >= needed) return wanted;
    // Few, but some: the system's refusals are met with patience.
    return std::clamp<std::size_t>(limit.rlim_cur > others ? std::size_t(limit.rlim_cur) - others : 0, 16, wanted);
}

}  // namespace penumbra
