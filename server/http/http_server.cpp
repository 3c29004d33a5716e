// SPDX-License-Identifier: MIT
// The listening sockets: the library, its guard, and what is the same for every request.
#include "server/http/http_server.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <thread>

#include "server/http/api.h"
#include "server/http/http_server_guard.h"
#include "server/http/negotiate.h"
#include "server/http/problem.h"

namespace penumbra {
namespace {

using httplib::Request;
using httplib::Response;

// Clients that keep coming while the service ends: after this they find nobody.
constexpr std::chrono::seconds kBacklogTime{1};
// Probes and one or two that scrape.
constexpr std::size_t kOperators = 8;

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

GuardLimits guard_limits(const Config& config, Door door) {
    GuardLimits limits;
    limits.header_bytes = config.max_header_bytes;
    limits.header_lines = config.max_header_lines;
    // The framing of chunks counts: room for ordinary chunks, none for a body of chunk lines.
    limits.body_bytes = config.max_body_bytes + config.max_body_bytes / 8 + (64u << 10);
    limits.request_time = std::chrono::seconds(config.request_timeout_s);
    limits.response_time = std::chrono::seconds(config.response_timeout_s);
    limits.keep_alive = std::chrono::seconds(config.keep_alive_s);
    limits.threads = door == Door::operators ? kOperators : config.queue_capacity + 1 + config.spare_http_threads;
    limits.waiting_connections = door == Door::operators ? kOperators : config.max_waiting_connections;
    return limits;
}

// One socket and what it answers.
class Listener {
public:
    Listener(RenderService& service, Jobs* jobs, const Config& config, const Log& log, Door door)
        : service_(service),
          log_(log),
          server_(
              guard_limits(config, door), [this](Request& request, Exchange& exchange) { api_.read_headers(request, exchange); },
              [this](Exchange& exchange) { return refuse_connection(exchange); }),
          api_(service, jobs, config, log, server_, door) {
        using Handled = httplib::Server::HandlerResponse;
        server_.set_pre_routing_handler([this](const Request& request, Response& response) {
            return api_.route(request, response) ? Handled::Handled : Handled::Unhandled;
        });
        server_.Post("/.*", [this](const Request& request, Response& response, const httplib::ContentReader& reader) {
            api_.with_body(request, response, reader);
        });
        server_.set_expect_100_continue_handler([this](const Request& request, Response& response) {
            // Refused before the body is sent, where its length alone says so.
            if (!api_.declared_too_large(request)) return 100;
            api_.respond().problem(response, api_.too_large());
            return response.status;
        });
        const httplib::Server::HandlerWithResponse on_error = [this](const Request&, Response& response) {
            if (!response.body.empty()) return Handled::Unhandled;  // already told
            Exchange& exchange = GuardedServer::exchange();
            exchange.expects_body = true;  // what follows on the connection cannot be trusted
            api_.respond().problem(response, exchange.fault != Fault::none ? make_problem(kind_of(exchange.fault), "")
                                                                           : problem_of_status(response.status));
            return Handled::Handled;
        };
        server_.set_error_handler(on_error);
        server_.set_exception_handler([this](const Request& request, Response& response, std::exception_ptr) {
            log_.error("Unexpected exception", {{"path", request.path}, {"id", Responder::request_id()}});
            api_.respond().problem(response, make_problem(ProblemKind::internal, ""));
        });
        server_.set_post_routing_handler([this](const Request&, Response& response) { api_.respond().mend_headers(response); });
        server_.set_logger([this](const Request& request, const Response& response) { write_log(request, response); });
    }
    ~Listener() { stop(); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    // Empty when it listens.
    std::string start(const std::string& host, int wanted_port) {
        errno = 0;
        if (wanted_port == 0) {
            port_ = server_.bind_to_any_port(host);
        } else {
            port_ = server_.bind_to_port(host, wanted_port) ? wanted_port : -1;
        }
        const int error = errno;
        if (port_ <= 0) return "Cannot listen on " + host + " port " + std::to_string(wanted_port) + ": " + why_not_bound(host, error);
        server_.widen_backlog();
        listening_ = true;
        thread_ = std::thread([this] {
            server_.listen_after_bind();
            listening_ = false;
        });
        // stop() does nothing before the library runs.
        while (listening_ && !server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return "";
    }

    void serve(int socket) { server_.serve(socket); }
    int port() const { return port_; }
    bool listening() const { return listening_; }
    void drain() { server_.drain(); }
    // The library would cut answers that come in parts, and reset connections that it has not taken on yet. Events of jobs end at
    // once, animations with their last frame, or when the service ends all renders.
    void finish_streams_and_backlog() {
        const auto end = std::chrono::steady_clock::now() + kBacklogTime;
        while (listening_ && server_.has_backlog() && std::chrono::steady_clock::now() < end) pause();
        while (api_.streams() > 0) pause();
    }
    void stop() {
        if (!thread_.joinable()) return;
        server_.drain();
        server_.stop();
        thread_.join();
    }

private:
    static void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

    std::string refuse_connection(Exchange& exchange) const {
        if (exchange.request_id.empty()) exchange.request_id = new_request_id();
        const HttpProblem problem =
            make_problem(kind_of(exchange.fault), exchange.fault == Fault::malformed ? "The request line or a header is malformed." : "");
        log_.info("refused", {{"status", std::int64_t(status_of(problem))}, {"ms", ms_since(exchange.start)}, {"id", exchange.request_id}});
        count(exchange, status_of(problem));
        return response_text(problem, exchange.request_id);
    }

    void count(const Exchange& exchange, int status) const {
        service_.metrics().count("penumbra_http_requests_total", {{"endpoint", exchange.endpoint}, {"status", std::to_string(status)}});
        service_.metrics().observe("penumbra_http_request_seconds", {{"endpoint", exchange.endpoint}}, ms_since(exchange.start) / 1000);
    }

    void write_log(const Request& request, const Response& response) const {
        const Exchange& exchange = GuardedServer::exchange();
        count(exchange, response.status);
        log_.info("request", {{"method", request.method},
                              {"path", request.path},
                              {"status", std::int64_t(response.status)},
                              {"ms", ms_since(exchange.start)},
                              {"bytes", std::int64_t(response.body.size())},
                              {"id", exchange.request_id},
                              {"peer", request.remote_addr},
                              {"client", exchange.client == request.remote_addr ? std::string() : exchange.client},
                              {"trace", exchange.trace_id}});
    }

    RenderService& service_;
    const Log& log_;
    GuardedServer server_;
    Api api_;
    std::thread thread_;
    std::atomic<bool> listening_{false};
    int port_ = 0;
};

}  // namespace

struct HttpServer::Impl {
    Impl(RenderService& service, const Config& settings, const Log& log)
        : config(settings),
          jobs(service, config, log),
          clients(service, &jobs, config, log, Door::clients),
          operators(service, &jobs, config, log, Door::operators) {}

    const Config config;
    Jobs jobs;
    Listener clients, operators;
};

HttpServer::HttpServer(RenderService& service, const Config& config, const Log& log)
    : impl_(std::make_unique<Impl>(service, config, log)) {}

HttpServer::~HttpServer() { stop(); }

std::string HttpServer::start() {
    Impl& impl = *impl_;
    if (std::string why = impl.clients.start(impl.config.host, impl.config.port); !why.empty()) return why;
    if (impl.config.admin_port < 0) return "";
    const std::string& host = impl.config.admin_host.empty() ? impl.config.host : impl.config.admin_host;
    return impl.operators.start(host, impl.config.admin_port);
}

int HttpServer::port() const { return impl_->clients.port(); }
int HttpServer::admin_port() const { return impl_->operators.port(); }

std::string HttpServer::url() const {
    const std::string& host = impl_->config.host;
    const bool v6 = host.find(':') != std::string::npos;
    return "http://" + (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port());
}

bool HttpServer::listening() const { return impl_->clients.listening(); }

void HttpServer::serve_connection(int socket) { impl_->clients.serve(socket); }

void HttpServer::stop() {
    // The operators' port tells until the end that it is stopping.
    impl_->operators.drain();
    impl_->clients.drain();
    impl_->clients.finish_streams_and_backlog();
    impl_->clients.stop();
    impl_->operators.stop();
}

}  // namespace penumbra
