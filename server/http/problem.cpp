// SPDX-License-Identifier: MIT
#include "server/http/problem.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "server/service/report.h"

namespace penumbra {
namespace {

struct Row {
    ProblemKind kind;
    int status;
    const char* name;
    const char* title;
    const char* explanation;
};

constexpr std::array<Row, 27> kRows{{
    {ProblemKind::bad_request, 400, "bad-request", "Malformed request",
     "The request breaks the rules of HTTP or carries something that this endpoint does not take. "
     "`detail` says what."},
    {ProblemKind::not_json, 400, "not-json", "The body is not JSON",
     "The text could not be parsed. `errors` says where it went wrong. A body must be one JSON object in "
     "UTF-8."},
    {ProblemKind::unauthorized, 401, "unauthorized", "A token is needed",
     "This service answers those who send one of its tokens: Authorization: Bearer TOKEN (--token-file)."},
    {ProblemKind::bad_signature, 403, "bad-signature", "The address is not signed",
     "A picture by GET needs an address that was signed with the service's key (penumbra sign-url), has not expired, and was not changed."},
    {ProblemKind::not_found, 404, "not-found", "No such resource",
     "There is nothing under this path. GET / lists what there is."},
    {ProblemKind::method_not_allowed, 405, "method-not-allowed", "Method not allowed",
     "The path exists, but not for this method. The Allow header lists the methods it takes."},
    {ProblemKind::not_acceptable, 406, "not-acceptable", "No acceptable picture format",
     "The Accept header rules out every format there is. `detail` lists them."},
    {ProblemKind::request_timeout, 408, "request-timeout", "The request took too long to arrive",
     "A request, its body included, has to arrive within the time that the operator set "
     "(--request-timeout)."},
    {ProblemKind::job_not_done, 409, "job-not-done", "The job has not ended yet",
     "Its result is there when it has: GET /v1/jobs/ID/events tells when, Retry-After when to look again."},
    {ProblemKind::body_too_large, 413, "body-too-large", "The body is too large",
     "Bodies are limited (--max-body-mb). Shrink the bitmaps: they are decoded at their own size "
     "whatever their size in the scene."},
    {ProblemKind::uri_too_long, 414, "uri-too-long", "The address is too long",
     "Addresses are limited to 8192 bytes. Scenes go into the body."},
    {ProblemKind::unsupported_media_type, 415, "unsupported-media-type", "Unsupported kind of body",
     "A scene is sent as application/json (or a type that ends in +json) in UTF-8, without a "
     "Content-Encoding."},
    {ProblemKind::invalid_scene, 422, "invalid-scene", "The scene is invalid",
     "The body is JSON, but no scene that can be rendered. `errors` lists all problems found: the JSON "
     "pointer, line and column, what is wrong, and the nearest known key or value where there is one."},
    {ProblemKind::not_supported_yet, 422, "not-supported-yet", "The scene asks for what is not built yet",
     "The scene is right, but asks for features of the format that this version does not render. "
     "`errors` names each key. GET /v1/info lists the formats, methods and tone maps there are."},
    {ProblemKind::too_expensive, 422, "too-expensive", "The render takes longer than the request may",
     "By itself, without any wait, the render is expected to take longer than the request's deadline allows (Prefer: wait=SECONDS, at "
     "most --max-deadline). Ask for less: a lower quality, a smaller canvas; or for a best effort (Prefer: on-deadline=partial). "
     "POST /v1/estimate tells prices."},
    {ProblemKind::beyond_device, 422, "beyond-device", "The device cannot hold the scene",
     "The scene keeps the format's limits, but the device or the method does not take it; `detail` says why."},
    {ProblemKind::scene_refused, 422, "scene-refused", "The scene has ended two renderers",
     "Rendering this scene has ended two renderers, by a crash or because they hung. It is not tried again until the service "
     "starts anew. The operator finds the reason in the log."},
    {ProblemKind::budget_spent, 429, "budget-spent", "This client's share of the renderers is spent",
     "Each client may have so many seconds of rendering a minute (--client-budget). Retry-After says when there is enough again for this "
     "render; RateLimit tells what is left. Pictures that are kept cost nothing."},
    {ProblemKind::headers_too_large, 431, "headers-too-large", "The headers are too large",
     "The header section is limited in bytes and in lines."},
    {ProblemKind::internal, 500, "internal", "The render failed",
     "Something failed that the request is not to blame for. The operator finds the reason in the log "
     "under the request id (`instance`)."},
    {ProblemKind::queue_full, 503, "queue-full", "The queue is full",
     "More renders wait than the operator allows (--queue). Retry-After is computed from the measured "
     "time of the renders before."},
    {ProblemKind::deadline_unreachable, 503, "deadline-unreachable", "It would not be done in time",
     "The renders that come first and this one are expected to take longer than the request may. Retry-After is the time after which, as "
     "things stand, it would be taken."},
    {ProblemKind::not_ready, 503, "not-ready", "The renderer is not ready",
     "The renderer is starting, or its self test failed. GET /readyz says which."},
    {ProblemKind::too_many_jobs, 503, "too-many-jobs", "Too many jobs",
     "As many jobs are waiting or under way as the operator allows (--max-jobs). Those that have ended go first."},
    {ProblemKind::too_many_connections, 503, "too-many-connections", "Too many connections",
     "More connections are open than the service has room for (--waiting-connections), or they hold more bytes (--max-held-mb)."},
    {ProblemKind::client_closed, 499, "client-closed", "The client closed its connection",
     "The connection was closed before the answer, so the render was ended. Nobody reads this but the log."},
    {ProblemKind::deadline_exceeded, 504, "deadline-exceeded", "The render was not done in time",
     "The request's deadline came first: the one that the client set (Prefer: wait=SECONDS), or the longest that the operator "
     "allows (--max-deadline)."},
}};

const Row& row_of(ProblemKind kind) {
    return *std::find_if(kRows.begin(), kRows.end(), [&](const Row& row) { return row.kind == kind; });
}

const char* reason_phrase(int status) {
    switch (status) {
        case 400: return "Bad Request";
        case 408: return "Request Timeout";
        case 413: return "Content Too Large";
        case 431: return "Request Header Fields Too Large";
        case 503: return "Service Unavailable";
        default: return "Error";
    }
}

}  // namespace

HttpProblem make_problem(ProblemKind kind, std::string detail) {
    HttpProblem problem;
    problem.kind = kind;
    problem.detail = std::move(detail);
    return problem;
}

HttpProblem problem_of(Fault fault) {
    switch (fault) {
        case Fault::headers_too_large: return make_problem(ProblemKind::headers_too_large, "");
        case Fault::body_too_large: return make_problem(ProblemKind::body_too_large, "");
        case Fault::timeout: return make_problem(ProblemKind::request_timeout, "");
        case Fault::too_many_connections: return make_problem(ProblemKind::too_many_connections, "");
        case Fault::stopping: return make_problem(ProblemKind::not_ready, "The service is stopping.");
        case Fault::malformed:
        case Fault::none: break;
    }
    return make_problem(ProblemKind::bad_request, "The request line or a header is malformed.");
}

HttpProblem method_not_allowed(const std::string& method, const std::string& allow) {
    HttpProblem problem =
        make_problem(ProblemKind::method_not_allowed, method + " is not for this path; it takes " + allow + ".");
    problem.headers = {{"Allow", allow}};
    return problem;
}

HttpProblem problem_of(const RenderResponse& response, int retry_after_s) {
    HttpProblem problem;
    const auto count = [&](const char* one, const char* many) {
        const std::size_t total = response.problems.size() + response.problems_left_out;
        return std::to_string(total) + (total == 1 ? one : many);
    };
    switch (response.failure) {
        case RenderFailure::not_json:
            problem = make_problem(ProblemKind::not_json,
                                   response.problems.empty() ? "The body is not JSON."
                                                             : to_string(response.problems.front()));
            break;
        case RenderFailure::invalid_scene:
            problem = make_problem(ProblemKind::invalid_scene,
                                   "The scene has " + count(" problem.", " problems."));
            break;
        case RenderFailure::not_supported:
            problem = make_problem(ProblemKind::not_supported_yet,
                                   "The scene uses " + count(" feature", " features") +
                                       " of the format that this version does not render yet.");
            break;
        case RenderFailure::queue_full:
            problem = make_problem(ProblemKind::queue_full,
                                   "Every place in the queue is taken. Try again in " +
                                       std::to_string(retry_after_s) + " s.");
            problem.headers = {{"Retry-After", std::to_string(retry_after_s)}};
            break;
        case RenderFailure::not_ready:
            problem = make_problem(ProblemKind::not_ready, "The renderer cannot take work now.");
            problem.headers = {{"Retry-After", std::to_string(retry_after_s)}};
            break;
        case RenderFailure::too_dear: problem = make_problem(ProblemKind::too_expensive, response.detail); break;
        case RenderFailure::beyond_device: problem = make_problem(ProblemKind::beyond_device, response.detail); break;
        case RenderFailure::too_late:
        case RenderFailure::budget_spent:
            problem = make_problem(response.failure == RenderFailure::too_late ? ProblemKind::deadline_unreachable : ProblemKind::budget_spent,
                                   response.detail);
            problem.headers = {{"Retry-After", std::to_string(int(std::clamp(std::ceil(response.retry_after_s), 1.0, 3600.0)))}};
            break;
        case RenderFailure::lethal: problem = make_problem(ProblemKind::scene_refused, ""); break;
        case RenderFailure::gone: problem = make_problem(ProblemKind::client_closed, ""); break;
        case RenderFailure::timed_out:
            problem = make_problem(ProblemKind::deadline_exceeded, "The render was not done by the request's deadline.");
            break;
        case RenderFailure::failed:
        case RenderFailure::none:
            problem = make_problem(ProblemKind::internal, "The render failed on the service's side.");
            break;
    }
    if (response.quote) problem.figures = {{"price_ms", response.quote->ms}};
    problem.errors = response.problems;
    problem.errors_left_out = response.problems_left_out;
    return problem;
}

HttpProblem problem_of_status(int status) {
    for (const Row& row : kRows) {
        if (row.status == status) {
            return make_problem(row.kind, status == 400 ? "The request line or a header is malformed." : "");
        }
    }
    if (status < 500) return make_problem(ProblemKind::bad_request, "The request cannot be answered.");
    return make_problem(ProblemKind::internal, "The request failed on the service's side.");
}

int status_of(const HttpProblem& problem) { return row_of(problem.kind).status; }

std::vector<std::pair<std::string, std::string>> headers_of(const HttpProblem& problem) {
    auto headers = problem.headers;
    headers.emplace_back("Cache-Control", "no-store");
    if (problem.kind == ProblemKind::unauthorized) headers.emplace_back("WWW-Authenticate", "Bearer realm=\"penumbra\"");
    if (problem.kind == ProblemKind::too_many_connections) headers.emplace_back("Retry-After", "1");
    if (problem.kind == ProblemKind::unsupported_media_type) {
        headers.emplace_back("Accept-Post", "application/json");
    }
    return headers;
}

std::string body_of(const HttpProblem& problem, const std::string& request_id) {
    const Row& row = row_of(problem.kind);
    nlohmann::ordered_json json = {{"type", std::string("/problems/") + row.name},
                                   {"title", row.title},
                                   {"status", row.status},
                                   {"detail", problem.detail.empty() ? row.explanation : problem.detail},
                                   {"instance", request_id}};
    for (const auto& [name, value] : problem.figures) json[name] = value;
    if (!problem.errors.empty()) {
        json["errors"] = nlohmann::ordered_json::array();
        for (const LocatedProblem& error : problem.errors) {
            json["errors"].push_back(nlohmann::ordered_json::parse(problem_json(error)));
        }
        if (problem.errors_left_out > 0) json["errors_left_out"] = problem.errors_left_out;
    }
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string response_text(const HttpProblem& problem, const std::string& request_id) {
    const std::string body = body_of(problem, request_id);
    const int status = status_of(problem);
    std::string text = "HTTP/1.1 " + std::to_string(status) + " " + reason_phrase(status) + "\r\n";
    text += "Content-Type: " + std::string(kProblemMediaType) + "\r\n";
    text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    text += "X-Request-Id: " + request_id + "\r\nConnection: close\r\n";
    for (const auto& [name, value] : headers_of(problem)) text += name + ": " + value + "\r\n";
    return text + "\r\n" + body;
}

std::string explanation(std::string_view name) {
    for (const Row& row : kRows) {
        if (name == row.name) return std::string(row.title) + "\n\n" + row.explanation + "\n";
    }
    return "";
}

}  // namespace penumbra
