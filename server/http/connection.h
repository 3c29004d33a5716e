// SPDX-License-Identifier: MIT
// A connection as the edge keeps it, and what bounds all of them together.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <string>
#include <string_view>

#include "server/http/request_reader.h"

namespace penumbra {

// A connection belongs to the edge's thread, or, while its request is being answered, to one thread of a pool.
struct Connection {
    using Clock = std::chrono::steady_clock;
    enum class State { reading, answering, writing, lingering, closed };

    Connection(int the_socket, const RequestLimits& limits) : socket(the_socket), reader(limits) {}

    const int socket;
    State state = State::reading;
    RequestReader reader;
    std::string rest;     // what came after the request
    std::string unsent;   // of the answer, from `sent` on
    std::size_t sent = 0;
    Clock::time_point start;     // the first byte of the request
    Clock::time_point since;     // of the present state
    Clock::time_point deadline;  // of the same
    bool fresh = true;    // has sent nothing yet
    bool go_on = false;   // after the answer
    bool probe = false, at_once = false;  // as judged
    bool watched = false;
    Fault refusal = Fault::none;  // of the connection itself
    std::size_t held = 0, held_unsent = 0;  // bytes, as they are counted
    std::size_t place = 0;
    std::promise<void>* ended = nullptr;

    std::string_view left() const { return std::string_view(unsent).substr(sent); }
};

// Bytes that all connections hold together.
class Held {
public:
    explicit Held(std::size_t most) : most_(most) {}
    void change(std::size_t& counted, std::size_t now);
    bool over() const { return bytes_ > most_; }
    // For who answers: what the edge's thread is to send when the answer is complete. False: there is no room for it.
    bool send_later(Connection& connection, std::string_view bytes);
    void has_sent(Connection& connection, std::size_t bytes);

private:
    const std::size_t most_;
    std::atomic<std::size_t> bytes_{0};
};

// Raises the process's bound on open files as far as it may and as `wanted` connections need, with `others` beside them; how many
// connections that leaves room for.
std::size_t room_for_connections(std::size_t wanted, std::size_t others);

}  // namespace penumbra
