// SPDX-License-Identifier: MIT
// Private to http_server.cpp. What cpp-httplib leaves open on Debian 12 (0.11.4): no limit on headers,
// on chunked bodies or on the time of a whole request, connections that drip block all others.
// The guard stands between the socket and the library and holds every limit itself. It compiles with
// 0.11.4 (Debian 12) and 0.18.7 (Debian 13).
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <httplib.h>

#include "server/http/fault.h"
#include "server/http/header_grammar.h"

namespace penumbra {

struct GuardLimits {
    std::size_t header_bytes = 0;
    std::size_t header_lines = 0;
    std::size_t body_bytes = 0;  // with its chunk framing
    std::chrono::milliseconds request_time{0};
    std::chrono::milliseconds response_time{0};
    std::chrono::milliseconds keep_alive{0};
    std::size_t threads = 0;
    std::size_t waiting_connections = 0;
};

// One request and its answer. cpp-httplib gives its handlers no way to their connection; since one
// thread serves a connection from its start to its end, the exchange is found by the thread.
struct Exchange {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    std::string request_id;
    std::string malformed;      // why the framing is refused
    Fault fault = Fault::none;  // a limit that was met
    bool expects_body = false;
    bool body_read = false;
    std::uint32_t body_end = 0;  // the last four bytes of the body, framing and all
    bool close = false;  // end the connection after the answer
    bool streaming = false;  // the answer comes in parts: each has the time that a whole one has
    bool accepts_gzip = false;
    std::string trace_parent, trace_id;  // as sent, when it was sound
    std::string origin;                  // of a browser's script
    std::string client;                  // whose share of the renderers it takes
    const char* endpoint = "none";       // for figures: the path's pattern
    std::function<bool()> client_gone;
};

// The library only says that it could not bind: the system's reason, as far as it is known.
std::string why_not_bound(const std::string& host, int error);

// A socket as cpp-httplib wants it, with the limits. One per connection.
class GuardedStream final : public httplib::Stream {
public:
    GuardedStream(int socket, const GuardLimits& limits) : socket_(socket), limits_(limits) {}

    // Waits for the first byte of a request; false when there will be none.
    bool wait_for_request(const std::function<bool(std::chrono::milliseconds idle)>& give_up);
    void begin(Exchange& exchange);
    bool answered() const { return answered_; }
    // Whether the client has closed its side. One that only says that it has nothing more to say counts as gone.
    bool client_gone() const;
    // Reads and forgets what the client still sends, so that closing does not destroy the answer.
    void linger();

    bool is_readable() const override;
    bool is_writable() const override;
    ssize_t read(char* data, std::size_t size) override;
    ssize_t write(const char* data, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return socket_; }

private:
    using Clock = std::chrono::steady_clock;

    bool fill(Clock::time_point deadline);
    Fault count_header(char c);

    int socket_;
    const GuardLimits& limits_;
    Exchange* exchange_ = nullptr;
    std::vector<char> buffer_;
    std::size_t buffer_at_ = 0;
    Clock::time_point request_deadline_, response_deadline_;
    bool answered_ = false;
    bool in_header_ = true;
    std::size_t header_bytes_ = 0, header_lines_ = 0, body_bytes_ = 0;
    HeaderGrammar grammar_;
    int line_end_ = 0;  // how much of CR LF CR LF has been seen
};

// Threads for connections, made when needed. Too many connections are refused on the spot: the library
// of Debian 12 cannot be told that a queue is full.
class ConnectionQueue final : public httplib::TaskQueue {
public:
    // void in 0.11, bool in 0.18.
    using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue(std::function<void()>()));

    ConnectionQueue(const GuardLimits& limits, std::atomic<std::size_t>& waiting)
        : limits_(limits), waiting_(waiting) {}

    Enqueued enqueue(std::function<void()> connection) override;
    void shutdown() override;

    static bool refusing();  // whether the connection served by this thread is one too many

private:
    void work();

    const GuardLimits& limits_;
    std::atomic<std::size_t>& waiting_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> connections_;
    std::vector<std::thread> threads_;
    std::size_t idle_ = 0;
    bool stopping_ = false;
};

class GuardedServer final : public httplib::Server {
public:
    // `read_headers` sees each request before it is routed. `refuse` gives the whole text of the answer
    // to what never became a request.
    using ReadHeaders = std::function<void(httplib::Request&, Exchange&)>;
    using Refuse = std::function<std::string(Exchange&)>;

    GuardedServer(const GuardLimits& limits, ReadHeaders read_headers, Refuse refuse);

    // The exchange of the calling handler.
    static Exchange& exchange();

    // Connections end after their present request. Called before stop().
    void drain() { draining_ = true; }
    bool draining() const { return draining_; }
    // Whether connections wait that have not been taken on: closing the socket would reset them.
    bool has_backlog() const;
    void serve(socket_t socket) { process_and_close_socket(socket); }  // one connection, on this thread
    void widen_backlog();  // after binding: the library listens with a backlog of 5

private:
    bool process_and_close_socket(socket_t socket) override;
    void serve_connection(GuardedStream& stream);
    bool serve_request(GuardedStream& stream, Exchange& exchange, bool last);

    const GuardLimits limits_;
    const ReadHeaders read_headers_;
    const Refuse refuse_;
    std::atomic<bool> draining_{false};
    std::atomic<std::size_t> waiting_{0};
};

}  // namespace penumbra
