// SPDX-License-Identifier: MIT
// The only user of cpp-httplib (with its guard). Routes by itself, before the library's regular
// expressions, so that a path and a method are refused before a body is read.
#include "server/http/http_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <thread>

#include <nlohmann/json.hpp>

#include "server/http/http_server_guard.h"
#include "server/http/negotiate.h"
#include "server/http/problem.h"
#include "server/service/report.h"
#include "server/service/version.h"

namespace penumbra {
namespace {

using httplib::Request;
using httplib::Response;

constexpr int kOk = 200;
constexpr int kNotModified = 304;
constexpr const char* kRenderPath = "/v1/render";

constexpr const char* kHint =
    "penumbra: a scene goes in as JSON, a lit picture comes out.\n\n"
    "  curl -s -X POST --data-binary @scene.json -H 'Content-Type: application/json' \\\n"
    "       http://HOST:PORT/v1/render -o picture.png\n\n"
    "  POST /v1/render   the picture (Accept: image/png or image/x-pfm)\n"
    "  GET  /v1/info     version, device, limits, formats\n"
    "  GET  /healthz     the process is alive\n"
    "  GET  /readyz      it renders, and rightly\n"
    "  GET  /problems/NAME  what a problem's `type` means\n";

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::vector<std::string> header_values(const Request& request, const char* name) {
    std::vector<std::string> values;
    const auto [begin, end] = request.headers.equal_range(name);
    for (auto it = begin; it != end; ++it) values.push_back(it->second);
    return values;
}

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::string joined(const std::vector<std::string>& values) {
    std::string text;
    for (const std::string& value : values) text += (text.empty() ? "" : ", ") + value;
    return text;
}

GuardLimits guard_limits(const Config& config) {
    GuardLimits limits;
    limits.header_bytes = config.max_header_bytes;
    limits.header_lines = config.max_header_lines;
    // The framing of chunks counts: room for ordinary chunks, none for a body of chunk lines.
    limits.body_bytes = config.max_body_bytes + config.max_body_bytes / 8 + (64u << 10);
    limits.request_time = std::chrono::seconds(config.request_timeout_s);
    limits.response_time = std::chrono::seconds(config.response_timeout_s);
    limits.keep_alive = std::chrono::seconds(config.keep_alive_s);
    limits.threads = config.queue_capacity + 1 + config.spare_http_threads;
    limits.waiting_connections = config.max_waiting_connections;
    return limits;
}

ProblemKind kind_of(Fault fault) {
    switch (fault) {
        case Fault::headers_too_large: return ProblemKind::headers_too_large;
        case Fault::body_too_large: return ProblemKind::body_too_large;
        case Fault::timeout: return ProblemKind::request_timeout;
        case Fault::too_many_connections: return ProblemKind::too_many_connections;
        case Fault::malformed:
        case Fault::none: break;
    }
    return ProblemKind::bad_request;
}

}  // namespace

struct HttpServer::Impl {
    using Handler = void (Impl::*)(const Request&, Response&);
    struct Endpoint {
        const char* path;
        const char* allow;
        Handler get;  // null: not for GET
    };
    static const std::array<Endpoint, 5> kEndpoints;

    Impl(RenderService& render_service, const Config& settings, const Log& the_log)
        : service(render_service),
          config(settings),
          log(the_log),
          server(
              guard_limits(settings), [](Request& request, Exchange& exchange) { read_headers(request, exchange); },
              [this](Exchange& exchange) { return refuse_connection(exchange); }) {
        using Handled = httplib::Server::HandlerResponse;
        server.set_pre_routing_handler([this](const Request& request, Response& response) {
            return route(request, response) ? Handled::Handled : Handled::Unhandled;
        });
        server.Post(kRenderPath, [this](const Request& request, Response& response,
                                        const httplib::ContentReader& reader) {
            guarded(request, response, [&] { render(request, response, reader); });
        });
        server.set_expect_100_continue_handler([this](const Request& request, Response& response) {
            // Refused before the body is sent, where its length alone says so.
            if (!declared_too_large(request)) return 100;
            send(response, too_large());
            return response.status;
        });
        const httplib::Server::HandlerWithResponse on_error = [this](const Request&, Response& response) {
            if (!response.body.empty()) return Handled::Unhandled;  // already told
            Exchange& exchange = GuardedServer::exchange();
            exchange.expects_body = true;  // what follows on the connection cannot be trusted
            send(response, exchange.fault != Fault::none ? make_problem(kind_of(exchange.fault), "")
                                                         : problem_of_status(response.status));
            return Handled::Handled;
        };
        server.set_error_handler(on_error);
        server.set_exception_handler([this](const Request& request, Response& response, std::exception_ptr) {
            log.error("Unexpected exception", {{"path", request.path}, {"id", exchange_id()}});
            send(response, make_problem(ProblemKind::internal, ""));
        });
        server.set_post_routing_handler([this](const Request&, Response& response) { mend_headers(response); });
        server.set_logger([this](const Request& request, const Response& response) {
            log.info("request", {{"method", request.method},
                                 {"path", request.path},
                                 {"status", std::int64_t(response.status)},
                                 {"ms", ms_since(GuardedServer::exchange().start)},
                                 {"bytes", std::int64_t(response.body.size())},
                                 {"id", exchange_id()},
                                 {"peer", request.remote_addr}});
        });
    }

    static std::string exchange_id() { return GuardedServer::exchange().request_id; }

    static void read_headers(Request& request, Exchange& exchange) {
        const auto ids = header_values(request, "X-Request-Id");
        exchange.request_id = ids.size() == 1 && is_request_id(ids[0]) ? ids[0] : new_request_id();
        const auto lengths = header_values(request, "Content-Length");
        const auto encodings = header_values(request, "Transfer-Encoding");
        exchange.malformed = refuse_framing(lengths, encodings);
        exchange.expects_body =
            !exchange.malformed.empty() || !encodings.empty() || (!lengths.empty() && lengths[0] != "0");
        request.ranges.clear();  // pictures are whole; the library would cut any body to a Range
    }

    std::string refuse_connection(Exchange& exchange) const {
        if (exchange.request_id.empty()) exchange.request_id = new_request_id();
        const HttpProblem problem =
            make_problem(kind_of(exchange.fault), exchange.fault == Fault::malformed ? "The request line or a header is malformed." : "");
        log.info("refused", {{"status", std::int64_t(status_of(problem))},
                             {"ms", ms_since(exchange.start)},
                             {"id", exchange.request_id}});
        return response_text(problem, exchange.request_id);
    }

    // ---- answers

    void finish(Response& response) {
        Exchange& exchange = GuardedServer::exchange();
        if (exchange.request_id.empty()) exchange.request_id = new_request_id();
        response.set_header("X-Request-Id", exchange.request_id);
        if (exchange.expects_body && !exchange.body_read) exchange.close = true;
        if (server.draining()) exchange.close = true;
        if (exchange.close) response.set_header("Connection", "close");
    }

    // The library's own headers are not true here: it offers ranges, counts requests that nobody
    // counts, and says how long a connection is kept that is closed.
    void mend_headers(Response& response) const {
        response.headers.erase("Accept-Ranges");
        // What it would say is the length of the picture (RFC 9110, 8.6).
        if (response.status == kNotModified) response.headers.erase("Content-Length");
        if (response.headers.erase("Keep-Alive") > 0 && response.get_header_value("Connection") != "close") {
            response.set_header("Keep-Alive", "timeout=" + std::to_string(config.keep_alive_s));
        }
    }

    void send(Response& response, const HttpProblem& problem) {
        finish(response);
        response.status = status_of(problem);
        for (const auto& [name, value] : headers_of(problem)) response.set_header(name, value);
        response.set_content(body_of(problem, exchange_id()), std::string(kProblemMediaType));
    }

    void send(Response& response, std::string body, const char* media_type) {
        finish(response);
        response.status = kOk;
        response.set_header("Cache-Control", "no-store");
        response.set_content(std::move(body), media_type);
    }

    // Whatever happens inside ends as an answer without internals.
    template <class Work>
    void guarded(const Request& request, Response& response, const Work& work) {
        std::string what;
        try {
            work();
            return;
        } catch (const std::exception& error) {
            what = error.what();
        } catch (...) {
            what = "unknown exception";
        }
        log.error("Unexpected exception", {{"path", request.path}, {"error", what}, {"id", exchange_id()}});
        send(response, make_problem(ProblemKind::internal, ""));
    }

    // ---- routing

    // False: the library goes on to the handler that reads the body.
    bool route(const Request& request, Response& response) {
        bool handled = true;
        guarded(request, response, [&] { handled = try_route(request, response); });
        return handled;
    }

    bool try_route(const Request& request, Response& response) {
        if (const std::string& malformed = GuardedServer::exchange().malformed; !malformed.empty()) {
            send(response, make_problem(ProblemKind::bad_request, malformed));
            return true;
        }
        const bool get = request.method == "GET" || request.method == "HEAD";
        if (constexpr std::string_view kPrefix = "/problems/"; request.path.starts_with(kPrefix)) {
            const std::string text = explanation(std::string_view(request.path).substr(kPrefix.size()));
            if (!text.empty()) {
                get ? send(response, text, "text/plain; charset=utf-8")
                    : send(response, method_not_allowed(request.method, "GET, HEAD"));
                return true;
            }
        }
        for (const Endpoint& endpoint : kEndpoints) {
            if (request.path != endpoint.path) continue;
            if (endpoint.get && get) {
                (this->*endpoint.get)(request, response);
                return true;
            }
            if (!endpoint.get && request.method == "POST") return false;
            send(response, method_not_allowed(request.method, endpoint.allow));
            return true;
        }
        send(response, make_problem(ProblemKind::not_found, "There is nothing under " + request.path + "."));
        return true;
    }

    // ---- endpoints

    void hint(const Request&, Response& response) { send(response, kHint, "text/plain; charset=utf-8"); }

    void health(const Request&, Response& response) {
        send(response, "{\"status\": \"alive\"}\n", "application/json");
    }

    void readiness(const Request&, Response& response) {
        const RenderWorker::Status status = service.worker().status();
        if (status.state != RenderWorker::State::ready) {
            // A broken driver's own words stay in the log.
            send(response, make_problem(ProblemKind::not_ready,
                                        status.state == RenderWorker::State::starting
                                            ? "The renderer is starting."
                                            : "The renderer's self test does not pass; the log says why."));
            return;
        }
        const nlohmann::ordered_json json = {{"status", "ready"},
                                             {"version", version()},
                                             {"device", status.device.renderer},
                                             {"workers", status.workers},
                                             {"ready_workers", status.ready_workers},
                                             {"lost", status.lost},
                                             {"replaced", status.replaced},
                                             {"waiting", status.waiting},
                                             {"capacity", status.capacity},
                                             {"rendered", status.rendered},
                                             {"render_ms", status.render_ms},
                                             {"cache", cache_json(service.cache_figures())}};
        send(response, json.dump(2) + "\n", "application/json");
    }

    static nlohmann::ordered_json cache_json(const RenderService::CacheFigures& figures) {
        return {{"pictures", figures.kept.entries},        {"bytes", figures.kept.bytes},
                {"capacity_bytes", figures.kept.capacity_bytes}, {"evicted", figures.kept.evicted},
                {"hits", figures.hits},                    {"misses", figures.misses},
                {"shared", figures.shared},                {"not_modified", figures.not_modified}};
    }

    void info(const Request&, Response& response) {
        const RenderWorker::Status status = service.worker().status();
        const DeviceInfo* device = status.device.renderer.empty() ? nullptr : &status.device;
        send(response, info_json(device, nullptr, service.limits(), service.unsupported()), "application/json");
    }

    // ---- POST /v1/render

    HttpProblem too_large() const {
        return make_problem(ProblemKind::body_too_large,
                            "The body is longer than " + std::to_string(config.max_body_bytes) + " bytes.");
    }

    bool declared_too_large(const Request& request) const {
        const auto lengths = header_values(request, "Content-Length");
        if (lengths.size() != 1 || !refuse_framing(lengths, {}).empty()) return false;  // told elsewhere
        return std::stoull(lengths[0]) > config.max_body_bytes;
    }

    // Reads at most what is allowed, whatever the headers promise. False: `problem` says why not.
    bool read_body(const Request& request, const httplib::ContentReader& reader, std::string& body,
                   HttpProblem& problem) const {
        Exchange& exchange = GuardedServer::exchange();
        if (!exchange.expects_body) return true;  // no length and no chunks is no body
        if (declared_too_large(request)) {
            problem = too_large();
            return false;
        }
        bool too_long = false;
        exchange.body_read = reader([&](const char* data, std::size_t size) {
            too_long = body.size() + size > config.max_body_bytes;
            if (!too_long) body.append(data, size);
            return !too_long;
        });
        // The library of Debian 12 takes chunks that do not end as they must for the end of the body.
        constexpr std::uint32_t kTwoLines = 0x0d0a0d0a;
        if (exchange.body_read && exchange.body_end != kTwoLines && request.has_header("Transfer-Encoding")) exchange.body_read = false;
        if (exchange.body_read) return true;
        if (too_long || exchange.fault == Fault::body_too_large) {
            problem = too_large();
        } else {
            problem = make_problem(kind_of(exchange.fault),
                                   exchange.fault == Fault::none ? "The body ends early or is framed wrongly." : "");
        }
        return false;
    }

    void render(const Request& request, Response& response, const httplib::ContentReader& reader) {
        if (!request.params.empty()) {
            send(response, make_problem(ProblemKind::bad_request, "This endpoint takes no query parameters."));
            return;
        }
        for (const std::string& coding : header_values(request, "Content-Encoding")) {
            if (coding == "identity") continue;
            send(response, make_problem(ProblemKind::unsupported_media_type,
                                        "The body is encoded (" + coding + "); send it as it is."));
            return;
        }
        const std::string refusal = refuse_content_type(joined(header_values(request, "Content-Type")));
        if (!refusal.empty()) {
            send(response, make_problem(ProblemKind::unsupported_media_type, refusal));
            return;
        }
        const FormatWishes wishes = parse_accept(joined(header_values(request, "Accept")));
        if (wishes.nothing_fits()) {
            std::string types;
            for (const PictureFormat& format : picture_formats()) {
                types += (types.empty() ? "" : ", ") + std::string(format.media_type);
            }
            send(response, make_problem(ProblemKind::not_acceptable, "Pictures come as " + types + "."));
            return;
        }
        std::string body;
        HttpProblem problem;
        if (!read_body(request, reader, body, problem)) {
            send(response, problem);
            return;
        }
        RenderRequest wanted;
        wanted.text = body;
        wanted.formats = wishes;
        wanted.anew = has_directive(joined(header_values(request, "Cache-Control")), "no-cache");
        const Exchange& exchange = GuardedServer::exchange();
        const std::optional<double> wait = parse_wait(joined(header_values(request, "Prefer")));
        const double seconds = std::min(wait.value_or(config.max_deadline_s), double(config.max_deadline_s));
        wanted.deadline = exchange.start + std::chrono::milliseconds(std::int64_t(1000 * seconds));
        wanted.gone = exchange.client_gone;
        if (wait) response.set_header("Preference-Applied", "wait=" + short_number(seconds));
        const EntityTags tags = parse_entity_tags(joined(header_values(request, "If-None-Match")));
        if (!tags.empty()) wanted.client_has = [&](const std::string& tag) { return tags.has(tag); };
        send_picture(response, service.render(wanted), wanted.anew);
    }

    // RFC 9211.
    static std::string cache_status(const RenderResponse& rendered, bool anew) {
        if (rendered.not_modified || rendered.source == Source::cache) return "penumbra; hit";
        std::string status = anew ? "penumbra; fwd=request" : "penumbra; fwd=miss";
        if (rendered.stored) status += "; stored";
        if (rendered.source == Source::shared) status += "; collapsed";
        return status;
    }

    void send_picture(Response& response, const RenderResponse& rendered, bool anew) {
        if (!rendered.error.empty()) {
            log.error("A render failed", {{"error", rendered.error}, {"id", exchange_id()}});
        }
        if (rendered.failure != RenderFailure::none) {
            send(response, problem_of(rendered, service.worker().retry_after_s()));
            return;
        }
        finish(response);
        response.status = rendered.not_modified ? kNotModified : kOk;
        response.set_header("Vary", "Accept");
        response.set_header("Cache-Control", "no-cache");  // to be kept, and asked after by its tag
        response.set_header("Cache-Status", cache_status(rendered, anew));
        if (!rendered.tag.empty()) response.set_header("ETag", '"' + rendered.tag + '"');
        if (rendered.not_modified) return;
        const Answer& answer = *rendered.answer;
        std::string timing;
        if (rendered.source != Source::cache) {
            timing = timing_entry("queue", rendered.queue_ms) + ", " + timing_entry("parse", rendered.parse_ms) + ", ";
            for (const PassStats& pass : answer.stats.passes) timing += timing_entry(pass.name, pass.wall_ms) + ", ";
            timing += timing_entry("render", answer.stats.total_ms) + ", " + timing_entry("encode", answer.encode_ms) + ", ";
        }
        timing += timing_entry("total", ms_since(GuardedServer::exchange().start));
        response.set_header("Server-Timing", timing);
        const PictureFormat* format = find_format(answer.format);
        response.set_content(reinterpret_cast<const char*>(answer.picture.data()), answer.picture.size(),
                             std::string(format ? format->media_type : "application/octet-stream"));
    }

    RenderService& service;
    const Config config;
    const Log& log;
    GuardedServer server;
    std::thread thread;
    std::atomic<bool> listening{false};
    int port = 0;
};

const std::array<HttpServer::Impl::Endpoint, 5> HttpServer::Impl::kEndpoints{{
    {"/", "GET, HEAD", &Impl::hint},
    {"/healthz", "GET, HEAD", &Impl::health},
    {"/readyz", "GET, HEAD", &Impl::readiness},
    {"/v1/info", "GET, HEAD", &Impl::info},
    {kRenderPath, "POST", nullptr},
}};

HttpServer::HttpServer(RenderService& service, const Config& config, const Log& log)
    : impl_(std::make_unique<Impl>(service, config, log)) {}

HttpServer::~HttpServer() { stop(); }

std::string HttpServer::start() {
    Impl& impl = *impl_;
    errno = 0;
    if (impl.config.port == 0) {
        impl.port = impl.server.bind_to_any_port(impl.config.host);
    } else {
        impl.port = impl.server.bind_to_port(impl.config.host, impl.config.port) ? impl.config.port : -1;
    }
    const int error = errno;
    if (impl.port <= 0) {
        return "Cannot listen on " + impl.config.host + " port " + std::to_string(impl.config.port) + ": " +
               why_not_bound(impl.config.host, error);
    }
    impl.server.widen_backlog();
    impl.listening = true;
    impl.thread = std::thread([&impl] {
        impl.server.listen_after_bind();
        impl.listening = false;
    });
    // stop() does nothing before the library runs.
    while (impl.listening && !impl.server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return "";
}

int HttpServer::port() const { return impl_->port; }

std::string HttpServer::url() const {
    const std::string& host = impl_->config.host;
    const bool v6 = host.find(':') != std::string::npos;
    return "http://" + (v6 ? "[" + host + "]" : host) + ":" + std::to_string(impl_->port);
}

bool HttpServer::listening() const { return impl_->listening; }

void HttpServer::serve_connection(int socket) { impl_->server.serve(socket); }

void HttpServer::stop() {
    if (!impl_->thread.joinable()) return;
    impl_->server.drain();
    impl_->server.stop();
    impl_->thread.join();
}

}  // namespace penumbra
