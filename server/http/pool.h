// SPDX-License-Identifier: MIT
// The threads that answer.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/http/connection.h"

namespace penumbra {

// Threads, made when needed, that take connections one after another. Few begin at a time: more than there are processors would only
// keep each other, and the edge, from them. Who is at work for longer waits for a render, and another may begin.
class Pool {
public:
    // Answers that take longer wait for a render, or are long work: others may begin.
    static constexpr std::chrono::milliseconds kSoonDone{5};

    Pool(const char* name, std::size_t most_threads, std::function<void(Connection&)> work);  // the name is for `top -H`
    ~Pool() { stop(); }
    void add(Connection& connection, bool first);
    bool nudge();  // false when nobody waits; to be called now and then while somebody does
    void stop();  // when all is done

private:
    using Clock = Connection::Clock;

    void run();
    void begin_another();
    bool may_begin() const;

    const char* const name_;
    const std::size_t most_threads_, most_at_once_;
    const std::function<void(Connection&)> work_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Connection*> waiting_;
    std::vector<std::thread> threads_;
    std::vector<Clock::time_point> begun_;  // of each thread that is at work
    std::size_t idle_ = 0;
    bool stopping_ = false;
};

}  // namespace penumbra
