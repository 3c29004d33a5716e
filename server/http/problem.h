// SPDX-License-Identifier: MIT
// Every way in which the service refuses or fails, as RFC 9457 tells it. The one place that knows
// HTTP status codes of failures.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/http/fault.h"
#include "server/service/render_service.h"

namespace penumbra {

enum class ProblemKind {
    bad_request,
    not_json,
    not_found,
    method_not_allowed,
    not_acceptable,
    request_timeout,
    body_too_large,
    uri_too_long,
    unsupported_media_type,
    invalid_scene,
    not_supported_yet,
    headers_too_large,
    internal,
    queue_full,
    not_ready,
    too_many_connections,
    scene_refused,
    client_closed,
    unauthorized,
    bad_signature,
    too_expensive,
    beyond_device,
    budget_spent,
    deadline_unreachable,
    job_not_done,
    too_many_jobs,
    deadline_exceeded,
};

struct HttpProblem {
    ProblemKind kind = ProblemKind::internal;
    std::string detail;  // this case, for the client's eyes
    std::vector<LocatedProblem> errors;
    std::size_t errors_left_out = 0;
    std::vector<std::pair<std::string, std::string>> headers;  // beyond the common ones
    std::vector<std::pair<std::string, double>> figures;       // further members, where numbers tell more
};

inline constexpr std::string_view kProblemMediaType = "application/problem+json";

// A limit that was met; the body may be meant.
HttpProblem problem_of(Fault fault);
HttpProblem make_problem(ProblemKind kind, std::string detail);
HttpProblem method_not_allowed(const std::string& method, const std::string& allow);
// Precondition: response.failure is not none.
HttpProblem problem_of(const RenderResponse& response, int retry_after_s);
// A failure that the HTTP library found by itself.
HttpProblem problem_of_status(int status);

int status_of(const HttpProblem& problem);
std::vector<std::pair<std::string, std::string>> headers_of(const HttpProblem& problem);
std::string body_of(const HttpProblem& problem, const std::string& request_id);

// A whole response that ends its connection, for where there is no library to write one.
std::string response_text(const HttpProblem& problem, const std::string& request_id);

// "type" is "/problems/NAME", and GET answers it with this text; empty for an unknown name.
std::string explanation(std::string_view name);

}  // namespace penumbra
