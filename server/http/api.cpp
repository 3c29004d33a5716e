// SPDX-License-Identifier: MIT
// Routes by itself, before the library's regular expressions, so that a path and a method are refused before a body is read.
#include "server/http/api.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "server/http/documents.h"
#include "server/http/negotiate.h"
#include "server/http/problem.h"
#include "server/service/identity.h"
#include "server/service/report.h"
#include "server/service/version.h"

namespace penumbra {
namespace {

constexpr const char* kHint =
    "penumbra: a scene goes in as JSON, a lit picture comes out.\n\n"
    "  curl -s -X POST --data-binary @scene.json -H 'Content-Type: application/json' \\\n"
    "       http://HOST:PORT/v1/render -o picture.png\n\n"
    "  POST /v1/render      the picture (Accept: image/png, image/x-pfm, image/x-exr, image/vnd.radiance, application/x-npy)\n"
    "  POST /v1/animate     many pictures of one scene (image/apng, application/zip, multipart/mixed)\n"
    "  POST /v1/jobs        a render that may take long: progress, previews, cancelling\n"
    "  POST /v1/estimate    what it would take\n"
    "  GET  /v1/info        version, device, limits, formats\n"
    "  GET  /v1/schema      the scene format as JSON Schema\n"
    "  GET  /openapi.json   all of this for programs\n"
    "  GET  /livez, /readyz, /startupz   for probes\n"
    "  GET  /problems/NAME  what a problem's `type` means\n";

constexpr const char* kText = "text/plain; charset=utf-8";

std::size_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t all = 0, resident = 0;
    file >> all >> resident;
    return resident * std::size_t(::sysconf(_SC_PAGESIZE));
}

nlohmann::ordered_json cache_json(const RenderService::CacheFigures& figures) {
    return {{"pictures", figures.kept.entries},        {"bytes", figures.kept.bytes},
            {"capacity_bytes", figures.kept.capacity_bytes}, {"evicted", figures.kept.evicted},
            {"hits", figures.hits},                    {"misses", figures.misses},
            {"shared", figures.shared},                {"not_modified", figures.not_modified}};
}

// The last one in the list is the one that our own proxy added.
std::string last_entry(const std::string& list) {
    const std::size_t comma = list.rfind(',');
    std::string entry = comma == std::string::npos ? list : list.substr(comma + 1);
    std::erase_if(entry, [](char c) { return c == ' ' || c == '\t'; });
    return entry.substr(0, 64);
}

}  // namespace

std::vector<std::string> header_values(const httplib::Request& request, const char* name) {
    std::vector<std::string> values;
    const auto [begin, end] = request.headers.equal_range(name);
    for (auto it = begin; it != end; ++it) values.push_back(it->second);
    return values;
}

std::string joined(const std::vector<std::string>& values) {
    std::string text;
    for (const std::string& value : values) text += (text.empty() ? "" : ", ") + value;
    return text;
}

Api::Api(RenderService& service, Jobs* jobs, const Config& config, const Log& log, const GuardedServer& server, Door door)
    : service_(service), config_(config), log_(log), server_(server), door_(door), respond_(config, server), jobs_(jobs) {}

const std::vector<Api::Endpoint>& Api::endpoints() {
    static const std::vector<Endpoint> list{
        {.pattern = "/", .get = &Api::hint},
        {.pattern = "/livez", .get = &Api::alive, .operators = true, .probe = true},
        {.pattern = "/healthz", .get = &Api::alive, .operators = true, .probe = true},
        {.pattern = "/readyz", .get = &Api::ready, .operators = true, .probe = true},
        {.pattern = "/startupz", .get = &Api::started, .operators = true, .probe = true},
        {.pattern = "/metrics", .get = &Api::metrics, .clients = false, .operators = true},
        {.pattern = "/openapi.json", .get = &Api::openapi},
        {.pattern = "/problems/*", .get = &Api::problem_page},
        {.pattern = "/v1/schema", .get = &Api::schema},
        {.pattern = "/v1/info", .get = &Api::info, .guarded = true},
        {.pattern = "/v1/animate", .post = &Api::animate, .guarded = true},
        {.pattern = "/v1/estimate", .post = &Api::estimate, .guarded = true},
        {.pattern = "/v1/jobs", .post = &Api::begin_job, .guarded = true},
        {.pattern = "/v1/jobs/*", .get = &Api::tell_job, .remove = &Api::end_job, .guarded = true},
        {.pattern = "/v1/jobs/*/events", .get = &Api::stream_job, .guarded = true},
        {.pattern = "/v1/jobs/*/result", .get = &Api::give_job, .guarded = true},
        {.pattern = "/v1/render", .get = &Api::render_signed, .post = &Api::render, .guarded = true},
    };
    return list;
}

// ---- requests

void Api::read_headers(Request& request, Exchange& exchange) const {
    const auto ids = header_values(request, "X-Request-Id");
    exchange.request_id = ids.size() == 1 && is_request_id(ids[0]) ? ids[0] : new_request_id();
    // 100 Continue has been sent to those whose body is wanted; the library would say it to others as well.
    if (!declared_too_large(request)) request.headers.erase("Expect");
    const auto parents = header_values(request, "traceparent");
    if (parents.size() == 1) exchange.trace_id = trace_id_of(parents[0]);
    if (!exchange.trace_id.empty()) exchange.trace_parent = parents[0];
    exchange.origin = request.get_header_value("Origin");
    exchange.accepts_gzip = accepts_gzip(joined(header_values(request, "Accept-Encoding")));
    request.headers.erase("Accept-Encoding");  // the library would compress what is compressed
    request.ranges.clear();  // pictures are whole; the library would cut any body to a Range
}

const Api::Endpoint* Api::find(const std::string& path) const {
    for (const Endpoint& endpoint : endpoints()) {
        if (door_ == Door::clients ? !endpoint.clients : !endpoint.operators) continue;
        const std::string_view pattern = endpoint.pattern;
        if (const std::size_t star = pattern.find('*'); star != std::string_view::npos) {
            const std::string_view before = pattern.substr(0, star), after = pattern.substr(star + 1);
            if (path.size() <= before.size() + after.size() || !path.starts_with(before) || !path.ends_with(after)) continue;
            const std::string_view name = std::string_view(path).substr(before.size(), path.size() - before.size() - after.size());
            if (name.find('/') == std::string_view::npos) return &endpoint;
        } else if (path == pattern) {
            return &endpoint;
        }
    }
    return nullptr;
}

std::string Api::allow_of(const Endpoint& endpoint) {
    std::string allow;
    if (endpoint.get) allow = "GET, HEAD, ";
    if (endpoint.post) allow += "POST, ";
    if (endpoint.remove) allow += "DELETE, ";
    return allow + "OPTIONS";
}

bool Api::route(const Request& request, Response& response) {
    bool handled = true;
    guarded(request, response, [&] { handled = try_route(request, response); });
    return handled;
}

bool Api::try_route(const Request& request, Response& response) {
    Exchange& exchange = GuardedServer::exchange();
    const Endpoint* endpoint = find(request.path);
    if (exchange.malformed.empty() && request.method == "OPTIONS" && (endpoint || request.path == "*")) {
        preflight(endpoint, request, response);
        return true;
    }
    if (const auto problem = refusal(endpoint, request, exchange)) {
        respond_.problem(response, *problem);
        return true;
    }
    if (request.method == "POST") return false;
    (this->*(endpoint->get && request.method != "DELETE" ? endpoint->get : endpoint->remove))(request, response);
    return true;
}

std::optional<HttpProblem> Api::refusal(const Endpoint* endpoint, const Request& request, Exchange& exchange) const {
    if (!exchange.malformed.empty()) return make_problem(ProblemKind::bad_request, exchange.malformed);
    if (!endpoint) return make_problem(ProblemKind::not_found, "There is nothing under " + request.path + ".");
    exchange.endpoint = endpoint->pattern;
    const bool get = request.method == "GET" || request.method == "HEAD";
    const bool known = (get && endpoint->get) || (request.method == "POST" && endpoint->post) || (request.method == "DELETE" && endpoint->remove);
    const bool no_key = endpoint->get == &Api::render_signed && config_.url_key.empty();
    if (!known || (no_key && get)) return method_not_allowed(request.method, no_key ? "POST, OPTIONS" : allow_of(*endpoint));
    if (auto problem = refuse_client(*endpoint, request, exchange)) return problem;
    return request.method == "POST" ? refuse_body(*endpoint, request) : std::nullopt;
}

std::optional<HttpProblem> Api::refuse_client(const Endpoint& endpoint, const Request& request, Exchange& exchange) const {
    exchange.client = request.remote_addr;
    if (config_.trust_forwarded_for) {
        if (const std::string entry = last_entry(joined(header_values(request, "X-Forwarded-For"))); !entry.empty()) exchange.client = entry;
    }
    const bool is_signed = endpoint.get == &Api::render_signed && request.method != "POST";  // which is checked by itself
    if (!endpoint.guarded || !config_.tokens.required() || is_signed) return std::nullopt;
    const auto headers = header_values(request, "Authorization");
    const auto name = headers.size() == 1 ? config_.tokens.name_of(headers[0]) : std::nullopt;
    if (!name) return make_problem(ProblemKind::unauthorized, headers.empty() ? "" : "The token is not one of this service.");
    exchange.client = *name;
    return std::nullopt;
}

std::optional<HttpProblem> Api::refuse_body(const Endpoint& endpoint, const Request& request) const {
    if (!request.params.empty()) return make_problem(ProblemKind::bad_request, "This endpoint takes no query parameters.");
    for (const std::string& coding : header_values(request, "Content-Encoding")) {
        if (coding == "identity") continue;
        return make_problem(ProblemKind::unsupported_media_type, "The body is encoded (" + coding + "); send it as it is.");
    }
    if (const std::string refusal = refuse_content_type(joined(header_values(request, "Content-Type"))); !refusal.empty()) {
        return make_problem(ProblemKind::unsupported_media_type, refusal);
    }
    const bool picture = endpoint.post == &Api::render || endpoint.post == &Api::begin_job;
    if (picture && parse_accept(joined(header_values(request, "Accept"))).nothing_fits()) {
        std::string types;
        for (const PictureFormat& format : picture_formats()) types += (types.empty() ? "" : ", ") + std::string(format.media_type);
        return make_problem(ProblemKind::not_acceptable, "Pictures come as " + types + ".");
    }
    if (declared_too_large(request)) return too_large();
    return std::nullopt;
}

Edge::Judgement Api::judge(const RequestHead& head, const std::string& malformed) const {
    Edge::Judgement judgement;
    const std::size_t query = head.target.find('?');
    Request request;
    request.method = head.method;
    request.path = head.target.substr(0, query);
    const Endpoint* endpoint = find(request.path);
    judgement.probe = endpoint && endpoint->probe;
    judgement.at_once = endpoint && endpoint->get == &Api::alive;
    // What is written in another way is known when the library has read it.
    if (head.target.find_first_of("%#") != std::string_view::npos) return judgement;
    if (request.method != "POST") {
        judgement.wants_body = false;
        return judgement;
    }
    for (const auto& [name, value] : head.fields) request.headers.emplace(name, value);
    if (query != std::string_view::npos && query + 1 < head.target.size()) request.params.emplace("", "");
    Exchange exchange;
    exchange.malformed = malformed;
    judgement.wants_body = !refusal(endpoint, request, exchange);
    return judgement;
}

void Api::preflight(const Endpoint* endpoint, const Request& request, Response& response) {
    const std::string allow = endpoint ? allow_of(*endpoint) : "GET, HEAD, POST, DELETE, OPTIONS";
    response.set_header("Allow", allow);
    if (respond_.allows_origin(request.get_header_value("Origin")) && request.has_header("Access-Control-Request-Method")) {
        response.set_header("Access-Control-Allow-Methods", allow);
        response.set_header("Access-Control-Allow-Headers",
                            "Accept, Authorization, Cache-Control, Content-Type, If-None-Match, Prefer, X-Request-Id, traceparent");
        response.set_header("Access-Control-Max-Age", "86400");
    }
    respond_.nothing(response);
}

// ---- bodies

HttpProblem Api::too_large() const {
    return make_problem(ProblemKind::body_too_large, "The body is longer than " + std::to_string(config_.max_body_bytes) + " bytes.");
}

bool Api::declared_too_large(const Request& request) const {
    const auto lengths = header_values(request, "Content-Length");
    if (lengths.size() != 1 || !refuse_framing(lengths, {}).empty()) return false;  // told elsewhere
    return std::stoull(lengths[0]) > config_.max_body_bytes;
}

void Api::with_body(const Request& request, Response& response) {
    guarded(request, response, [&] {
        Exchange& exchange = GuardedServer::exchange();
        if (exchange.expects_body && !exchange.body_read) {
            if (exchange.fault == Fault::body_too_large) {
                respond_.problem(response, too_large());
            } else if (exchange.fault != Fault::none) {
                respond_.problem(response, problem_of(exchange.fault));
            } else {
                respond_.problem(response, make_problem(ProblemKind::bad_request, "The body ends early or is framed wrongly."));
            }
            return;
        }
        (this->*find(request.path)->post)(request, response, std::move(exchange.body));  // no length and no chunks is no body
    });
}

// ---- answers in parts

Api::StreamPlace Api::place_for_stream(Response& response) {
    // Half of the threads stay for answers that end.
    const bool full = ++streams_ > std::max<std::size_t>(config_.spare_http_threads / 2, 1);
    StreamPlace place(static_cast<void*>(this), [this](void*) { --streams_; });
    if (!full && !server_.draining()) return place;
    respond_.problem(response, full ? make_problem(ProblemKind::too_many_connections, "Too many answers are being sent in parts.")
                                    : make_problem(ProblemKind::not_ready, "The service is stopping."));
    return nullptr;
}

void Api::stream(Response& response, StreamPlace place, const std::string& media_type, std::function<bool(std::string& part)> next) {
    respond_.finish(response);
    GuardedServer::exchange().streaming = true;
    response.set_chunked_content_provider(media_type, [place = std::move(place), next = std::move(next)](std::size_t, httplib::DataSink& sink) {
        std::string part;
        const bool more = next(part);
        if (!part.empty() && !sink.write(part.data(), part.size())) return false;
        if (!more) sink.done();
        return true;
    });
}

// ---- endpoints

void Api::hint(const Request&, Response& response) { respond_.text(response, kHint, kText); }

void Api::alive(const Request&, Response& response) { respond_.json(response, "{\"status\": \"alive\"}\n"); }

void Api::ready(const Request&, Response& response) {
    const RenderWorker::Status status = service_.worker().status();
    if (server_.draining()) {
        respond_.problem(response, make_problem(ProblemKind::not_ready, "The service is stopping."));
        return;
    }
    if (status.state != RenderWorker::State::ready) {
        // A broken driver's own words stay in the log.
        respond_.problem(response, make_problem(ProblemKind::not_ready, status.state == RenderWorker::State::starting
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
                                         {"backlog_ms", status.backlog_ms},
                                         {"cache", cache_json(service_.cache_figures())}};
    respond_.json(response, json.dump(2) + "\n");
}

// Once it has been ready it stays so: what comes later is readiness' business.
void Api::started(const Request&, Response& response) {
    if (service_.worker().status().ever_ready) {
        respond_.json(response, "{\"status\": \"started\"}\n");
    } else {
        respond_.problem(response, make_problem(ProblemKind::not_ready, "The renderer is starting."));
    }
}

void Api::info(const Request&, Response& response) {
    const RenderWorker::Status status = service_.worker().status();
    const DeviceInfo* device = status.device.renderer.empty() ? nullptr : &status.device;
    respond_.json(response, info_json(device, nullptr, service_.limits(), service_.unsupported()));
}

void Api::schema(const Request&, Response& response) {
    respond_.text(response, std::string(scene_schema()), "application/schema+json");
}

void Api::openapi(const Request&, Response& response) { respond_.json(response, std::string(openapi_document())); }

void Api::problem_page(const Request& request, Response& response) {
    const std::string text = explanation(std::string_view(request.path).substr(std::string_view("/problems/").size()));
    if (text.empty()) {
        respond_.problem(response, make_problem(ProblemKind::not_found, "There is nothing under " + request.path + "."));
    } else {
        respond_.text(response, text, kText);
    }
}

void Api::metrics(const Request&, Response& response) {
    const RenderWorker::Status status = service_.worker().status();
    const RenderService::CacheFigures cache = service_.cache_figures();
    const std::string what = "version=\"" + version() + "\",build=\"" + build_id().substr(0, 16) + "\",device=\"" + status.device.kind + "\"";
    const std::vector<Metrics::Gauge> gauges{
        {"penumbra_queue_waiting", double(status.waiting)},
        {"penumbra_queue_capacity", double(status.capacity)},
        {"penumbra_renders_running", double(status.running)},
        {"penumbra_backlog_seconds", status.backlog_ms / 1000},
        {"penumbra_workers", double(status.workers)},
        {"penumbra_workers_ready", double(status.ready_workers)},
        {"penumbra_workers_lost_total", double(status.lost)},
        {"penumbra_workers_replaced_total", double(status.replaced)},
        {"penumbra_cache_bytes", double(cache.kept.bytes)},
        {"penumbra_cache_pictures", double(cache.kept.entries)},
        {"penumbra_cache_evicted_total", double(cache.kept.evicted)},
        {"penumbra_jobs", double(jobs_->count())},
        {"penumbra_streams", double(streams_)},
        {"penumbra_up_seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count()},
        {"penumbra_resident_bytes", double(resident_bytes())},
        {"penumbra_info", 1, what},
    };
    respond_.text(response, service_.metrics().text(gauges), "text/plain; version=0.0.4; charset=utf-8");
}

}  // namespace penumbra
