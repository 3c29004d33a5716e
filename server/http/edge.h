// SPDX-License-Identifier: MIT
// The edge of the network: one thread that accepts connections, reads whole requests, keeps idle connections, writes what slow
// readers take slowly, and ends what takes too long. Threads of a pool see whole requests alone (docs/decisions/0080).
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "server/http/connection.h"
#include "server/http/pool.h"

namespace penumbra {

struct EdgeLimits {
    RequestLimits request;
    std::chrono::milliseconds request_time{0};
    std::chrono::milliseconds response_time{0};
    std::chrono::milliseconds keep_alive{0};
    std::size_t threads = 0;
    std::size_t waiting_connections = 0;  // beside one for each thread
    std::size_t held_bytes = 0;           // of requests and answers, of all connections
};

class Edge {
public:
    struct Judgement {
        bool wants_body = true;
        bool probe = false;    // answered by a thread of its own
        bool at_once = false;  // needs nothing: answered by the edge's thread
    };
    struct Work {
        // What the head alone says. On the edge's thread: soon done.
        std::function<Judgement(const RequestHead&, const RequestReader&)> judge;
        // Answers a request that is whole or refused; whether the connection goes on. On a thread of a pool.
        std::function<bool(Connection&)> answer;
    };

    Edge(const EdgeLimits& limits, Work work);
    ~Edge();
    Edge(const Edge&) = delete;
    Edge& operator=(const Edge&) = delete;

    void start(int listener);  // which listens; the edge closes it
    bool running() const { return running_; }
    void serve(int socket);  // a connection from elsewhere, until it ends
    void drain();  // connections end after their present request
    void stop();   // takes no more, and returns when all is answered

    Held& held() { return held_; }
    std::size_t most_connections() const { return most_connections_; }

private:
    using Clock = Connection::Clock;
    using State = Connection::State;

    void run();
    int timeout();
    void wake() const;
    void take_messages();
    void accept_all();
    void watch_listener(bool wanted);
    void accept(int socket, std::promise<void>* ended);
    bool make_room();
    void enter(Connection& connection, State state, Clock::time_point deadline);
    void watch(Connection& connection, unsigned events);
    void ignore(Connection& connection);
    void on_event(Connection& connection);
    void receive(Connection& connection);
    void feed(Connection& connection, std::string_view bytes);
    bool ask(Connection& connection, bool more_is_there);
    void hand_over(Connection& connection);
    void take_back(Connection& connection);
    void write(Connection& connection);
    void finish(Connection& connection);
    void linger(Connection& connection, std::chrono::milliseconds time);
    void close(Connection& connection);
    void expire();
    void expire(Connection& connection);
    void begin_drain();
    void bound_held();
    void count(Connection& connection);
    Clock::time_point reading_deadline(const Connection& connection, bool begun) const;

    const EdgeLimits limits_;
    const Work work_;
    std::size_t most_connections_;
    Held held_;
    int listener_ = -1, epoll_ = -1, wake_ = -1;
    std::vector<std::unique_ptr<Connection>> connections_, ended_;
    std::size_t lingering_ = 0;
    std::vector<char> block_;
    Clock::time_point now_, next_deadline_ = Clock::time_point::max(), accept_again_ = Clock::time_point::max(), drain_start_{};
    std::atomic<bool> running_{false}, draining_{false}, stopping_{false};
    bool drain_begun_ = false;

    std::mutex mutex_;  // of what others tell the edge's thread
    std::vector<Connection*> returned_;
    std::vector<std::pair<int, std::promise<void>*>> arrived_;

    Pool requests_, side_;  // the second: probes and refusals
    std::thread thread_;
};

}  // namespace penumbra
