// SPDX-License-Identifier: MIT
#include "server/http/responder.h"

#include <algorithm>

#include "core/image/gzip.h"
#include "server/http/negotiate.h"

namespace penumbra {
namespace {

constexpr int kOk = 200;
constexpr int kNoContent = 204;
constexpr int kNotModified = 304;
// Shorter answers fit in one packet as they are.
constexpr std::size_t kWorthPacking = 1400;
// What scripts may read beyond the headers that they always may.
constexpr const char* kExposed =
    "ETag, Location, Retry-After, Server-Timing, X-Request-Id, Cache-Status, Preference-Applied, Penumbra-Partial, RateLimit, RateLimit-Policy, "
    "traceparent";

}  // namespace

bool Responder::allows_origin(std::string_view origin) const {
    return !origin.empty() && std::any_of(config_.cors_origins.begin(), config_.cors_origins.end(),
                                          [&](const std::string& allowed) { return allowed == "*" || allowed == origin; });
}

void Responder::finish(httplib::Response& response) const {
    Exchange& exchange = GuardedServer::exchange();
    if (exchange.request_id.empty()) exchange.request_id = new_request_id();
    response.set_header("X-Request-Id", exchange.request_id);
    if (!exchange.trace_parent.empty()) response.set_header("traceparent", exchange.trace_parent);
    if (!config_.cors_origins.empty()) {
        // Answers differ by who asks, unless all may.
        const bool all = std::find(config_.cors_origins.begin(), config_.cors_origins.end(), "*") != config_.cors_origins.end();
        if (!all) response.headers.emplace("Vary", "Origin");
        if (allows_origin(exchange.origin)) {
            response.set_header("Access-Control-Allow-Origin", all ? "*" : exchange.origin);
            response.set_header("Access-Control-Expose-Headers", kExposed);
        }
    }
    if (exchange.expects_body && !exchange.body_read) exchange.close = true;
    if (server_.draining()) exchange.close = true;
    if (exchange.close) response.set_header("Connection", "close");
}

void Responder::compress(httplib::Response& response, std::string& body) const {
    if (body.size() < kWorthPacking) return;
    response.headers.emplace("Vary", "Accept-Encoding");
    if (!GuardedServer::exchange().accepts_gzip) return;
    body = gzip(body);
    response.set_header("Content-Encoding", "gzip");
}

void Responder::problem(httplib::Response& response, const HttpProblem& problem) const {
    finish(response);
    response.status = status_of(problem);
    for (const auto& [name, value] : headers_of(problem)) response.set_header(name, value);
    std::string body = body_of(problem, request_id());
    compress(response, body);
    response.set_content(std::move(body), std::string(kProblemMediaType));
}

void Responder::text(httplib::Response& response, std::string body, const char* media_type) const {
    finish(response);
    response.status = kOk;
    if (!response.has_header("Cache-Control")) response.set_header("Cache-Control", "no-store");
    compress(response, body);
    response.set_content(std::move(body), media_type);
}

void Responder::nothing(httplib::Response& response) const {
    finish(response);
    response.status = kNoContent;
    response.set_header("Cache-Control", "no-store");
}

void Responder::mend_headers(httplib::Response& response) const {
    response.headers.erase("Accept-Ranges");
    // What it would say is the length of the picture (RFC 9110, 8.6); of nothing there is no length.
    if (response.status == kNotModified || response.status == kNoContent) response.headers.erase("Content-Length");
    if (response.headers.erase("Keep-Alive") > 0 && response.get_header_value("Connection") != "close") {
        response.set_header("Keep-Alive", "timeout=" + std::to_string(config_.keep_alive_s));
    }
}

}  // namespace penumbra
