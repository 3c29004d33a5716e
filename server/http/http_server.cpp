// SPDX-License-Identifier: MIT
// The listening sockets: the library, its guard, and what is the same for every request.
#include "server/http/http_server.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>

#include "server/http/api.h"
#include "server/http/http_server_guard.h"
#include "server/http/negotiate.h"
#include "server/http/problem.h"

namespace penumbra {
namespace {

using httplib::Request;
using httplib::Response;

// Probes and one or two that scrape.
constexpr std::size_t kOperators = 8, kOperatorConnections = 64;

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

EdgeLimits edge_limits(const Config& config, Door door) {
    EdgeLimits limits;
    limits.request.header_bytes = config.max_header_bytes;
    limits.request.header_lines = config.max_header_lines;
    limits.request.body_bytes = config.max_body_bytes;
    // The framing of chunks counts: room for ordinary chunks, none for a body of chunk lines.
    limits.request.framed_bytes = config.max_body_bytes + config.max_body_bytes / 8 + (64u << 10);
    limits.request_time = std::chrono::seconds(config.request_timeout_s);
    limits.response_time = std::chrono::seconds(config.response_timeout_s);
    limits.keep_alive = std::chrono::seconds(config.keep_alive_s);
    limits.threads = door == Door::operators ? kOperators : config.queue_capacity + 1 + config.spare_http_threads;
    limits.waiting_connections = door == Door::operators ? kOperatorConnections : config.max_waiting_connections;
    limits.held_bytes = std::max(config.held_bytes, 2 * config.max_body_bytes);
    return limits;
}

// One socket and what it answers.
class Listener {
public:
    Listener(RenderService& service, Jobs* jobs, const Config& config, const Log& log, Door door)
        : service_(service),
          log_(log),
          limits_(edge_limits(config, door)),
          server_(
              limits_, [this](Request& request, Exchange& exchange) { api_.read_headers(request, exchange); },
              [this](Exchange& exchange) { return refuse_connection(exchange); },
              [this](const RequestHead& head, const RequestReader& reader) { return api_.judge(head, reader.framing_refusal()); }),
          api_(service, jobs, config, log, server_, door) {
        using Handled = httplib::Server::HandlerResponse;
        server_.set_pre_routing_handler([this](const Request& request, Response& response) {
            return api_.route(request, response) ? Handled::Handled : Handled::Unhandled;
        });
        server_.Post("/.*", [this](const Request& request, Response& response, const httplib::ContentReader&) {
            api_.with_body(request, response);
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
            api_.respond().problem(response, exchange.fault != Fault::none ? problem_of(exchange.fault) : problem_of_status(response.status));
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
        server_.serve();
        if (const std::size_t most = server_.most_connections(); most < limits_.threads + limits_.waiting_connections) {
            log_.warning("few files may be open", {{"connections", std::int64_t(most)}});
        }
        return "";
    }

    void serve(int socket) { server_.serve(socket); }
    int port() const { return port_; }
    bool listening() const { return server_.serving(); }
    void drain() { server_.drain(); }
    // Answers what was asked: events of jobs end at once, animations with their last frame, or when the service ends all renders.
    void stop() { server_.finish(); }

private:
    std::string refuse_connection(Exchange& exchange) const {
        if (exchange.request_id.empty()) exchange.request_id = new_request_id();
        const HttpProblem problem = problem_of(exchange.fault);
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
    const EdgeLimits limits_;
    GuardedServer server_;
    Api api_;
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
    impl_->clients.stop();
    impl_->operators.stop();
}

}  // namespace penumbra
