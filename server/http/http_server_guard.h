// SPDX-License-Identifier: MIT
// Private to http_server.cpp. The library answers requests, and does nothing else: what arrives is read by the edge (edge.h),
// which holds every limit itself, since cpp-httplib of Debian 12 (0.11.4) has none on headers, on chunked bodies or on the time of a
// whole request, and takes a thread for each connection. It compiles with 0.11.4 (Debian 12) and 0.18.7 (Debian 13).
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include <httplib.h>

#include "server/http/edge.h"
#include "server/http/fault.h"

namespace penumbra {

// One request and its answer. cpp-httplib gives its handlers no way to their connection; since one
// thread answers a request from its start to its end, the exchange is found by the thread.
struct Exchange {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    std::string request_id;
    std::string malformed;      // why the framing is refused
    Fault fault = Fault::none;  // a limit that was met
    bool expects_body = false;
    bool body_read = false;  // the whole of it
    std::string body;
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

// A request's head and the way of its answer, as cpp-httplib wants them. The body goes by the exchange.
class GuardedStream final : public httplib::Stream {
public:
    GuardedStream(Connection& connection, Held& held, std::chrono::milliseconds response_time, const Exchange& exchange)
        : connection_(connection), held_(held), response_time_(response_time), exchange_(exchange) {}

    bool answered() const { return answered_; }
    // Whether the client has closed its side. One that only says that it has nothing more to say counts as gone.
    bool client_gone() const;

    bool is_readable() const override { return head_at_ < connection_.reader.head().size(); }
    bool is_writable() const override;
    ssize_t read(char* data, std::size_t size) override;
    ssize_t write(const char* data, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override;

private:
    using Clock = std::chrono::steady_clock;

    Connection& connection_;
    Held& held_;
    const std::chrono::milliseconds response_time_;
    const Exchange& exchange_;
    std::size_t head_at_ = 0;
    Clock::time_point response_deadline_;
    bool answered_ = false;
};

class GuardedServer final : public httplib::Server {
public:
    // Sees each request before it is routed.
    using ReadHeaders = std::function<void(httplib::Request&, Exchange&)>;
    // The whole text of the answer to what never became a request.
    using Refuse = std::function<std::string(Exchange&)>;
    using Judge = std::function<Edge::Judgement(const RequestHead&, const RequestReader&)>;

    GuardedServer(const EdgeLimits& limits, ReadHeaders read_headers, Refuse refuse, Judge judge);
    ~GuardedServer() override { finish(); }

    // The exchange of the calling handler.
    static Exchange& exchange();

    void serve();  // after binding: from now on there are answers
    bool serving() const { return edge_.running(); }
    void serve(socket_t socket) { edge_.serve(socket); }  // a connection from elsewhere, until it ends
    // Connections end after their present request.
    void drain();
    bool draining() const { return draining_; }
    void finish();  // takes no more connections and returns when all is answered
    std::size_t most_connections() const { return edge_.most_connections(); }

private:
    bool answer(Connection& connection);
    bool process(GuardedStream& stream, Exchange& exchange);

    const EdgeLimits limits_;
    const ReadHeaders read_headers_;
    const Refuse refuse_;
    std::atomic<bool> draining_{false};
    Edge edge_;
};

}  // namespace penumbra
