// SPDX-License-Identifier: MIT
// POST /v1/render, GET /v1/render with a signed address, POST /v1/estimate.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include <nlohmann/json.hpp>

#include "server/http/api.h"
#include "server/http/negotiate.h"

namespace penumbra {
namespace {

constexpr int kOk = 200;
constexpr int kNotModified = 304;

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

// RFC 9211.
std::string cache_status(const RenderResponse& rendered, bool anew) {
    if (rendered.not_modified || rendered.source == Source::cache) return "penumbra; hit";
    std::string status = anew ? "penumbra; fwd=request" : "penumbra; fwd=miss";
    if (rendered.stored) status += "; stored";
    if (rendered.source == Source::shared) status += "; collapsed";
    return status;
}

double rounded(double value) { return std::round(100 * value) / 100; }

}  // namespace

// What the headers ask for besides the scene.
std::optional<RenderRequest> Api::wanted(const Request& request, Response& response, std::string_view body) {
    RenderRequest wanted;
    wanted.text = body;
    wanted.formats = parse_accept(joined(header_values(request, "Accept")));
    wanted.anew = has_directive(joined(header_values(request, "Cache-Control")), "no-cache");
    const Exchange& exchange = GuardedServer::exchange();
    const std::string prefer = joined(header_values(request, "Prefer"));
    const std::optional<double> wait = parse_wait(prefer);
    const double seconds = std::min(wait.value_or(config_.max_deadline_s), double(config_.max_deadline_s));
    wanted.allowance_ms = 1000 * seconds;
    wanted.deadline = exchange.start + std::chrono::milliseconds(std::int64_t(1000 * seconds));
    wanted.gone = exchange.client_gone;
    wanted.client = exchange.client;
    wanted.partial = has_preference(prefer, "on-deadline", "partial");
    std::string applied = wait ? "wait=" + short_number(seconds) : "";
    if (wanted.partial) applied += (applied.empty() ? "" : ", ") + std::string("on-deadline=partial");
    if (!applied.empty()) response.set_header("Preference-Applied", applied);
    return wanted;
}

void Api::render(const Request& request, Response& response, std::string&& body) {
    std::optional<RenderRequest> order = wanted(request, response, body);
    const EntityTags tags = parse_entity_tags(joined(header_values(request, "If-None-Match")));
    if (!tags.empty()) order->client_has = [&](const std::string& tag) { return tags.has(tag); };
    send_picture(response, *order, service_.render(*order));
}

void Api::render_signed(const Request& request, Response& response) {
    std::vector<std::pair<std::string, std::string>> parameters(request.params.begin(), request.params.end());
    const SignedScene scene = open_signed_target(config_.url_key, parameters, std::time(nullptr), config_.max_body_bytes);
    if (!scene.refusal.empty()) {
        respond_.problem(response, make_problem(ProblemKind::bad_signature, scene.refusal));
        return;
    }
    std::optional<RenderRequest> order = wanted(request, response, scene.scene);
    // An address is of one picture, in the format that the scene says: <img> elements accept what they like.
    order->formats = any_format();
    const EntityTags tags = parse_entity_tags(joined(header_values(request, "If-None-Match")));
    if (!tags.empty()) order->client_has = [&](const std::string& tag) { return tags.has(tag); };
    send_picture(response, *order, service_.render(*order));
}

void Api::tell_budget(Response& response, const RenderResponse& rendered) const {
    if (!rendered.budget) return;
    const ClientBudgets::State& state = *rendered.budget;
    char text[80];
    std::snprintf(text, sizeof text, "\"compute\";q=%.0f;w=60", state.most_ms);
    response.set_header("RateLimit-Policy", text);
    std::snprintf(text, sizeof text, "\"compute\";r=%.0f;t=%.0f", std::floor(state.left_ms), std::ceil(state.full_in_s));
    response.set_header("RateLimit", text);
}

void Api::send_failure(Response& response, const RenderResponse& rendered) {
    tell_budget(response, rendered);
    respond_.problem(response, problem_of(rendered, service_.worker().retry_after_s()));
}

void Api::send_picture(Response& response, const RenderRequest& request, const RenderResponse& rendered) {
    if (!rendered.error.empty()) log_.error("A render failed", {{"error", rendered.error}, {"id", Responder::request_id()}});
    if (rendered.failure != RenderFailure::none) {
        send_failure(response, rendered);
        return;
    }
    respond_.finish(response);
    tell_budget(response, rendered);
    response.status = rendered.not_modified ? kNotModified : kOk;
    response.headers.emplace("Vary", "Accept");
    response.set_header("Cache-Status", cache_status(rendered, request.anew));
    if (rendered.partial.empty()) {
        response.set_header("Cache-Control", "no-cache");  // to be kept, and asked after by its tag
        if (!rendered.tag.empty()) response.set_header("ETag", '"' + rendered.tag + '"');
    } else {
        // It is not the picture of this scene: the next who asks may get that.
        response.set_header("Cache-Control", "no-store");
        response.set_header("Penumbra-Partial", rendered.partial);
    }
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

void Api::estimate(const Request& request, Response& response, std::string&& body) {
    RenderRequest order = *wanted(request, response, body);
    // Accept is of this answer, not of the picture's.
    order.formats = any_format();
    const RenderEstimate estimate = service_.estimate(order);
    if (estimate.refusal.failure != RenderFailure::none) {
        send_failure(response, estimate.refusal);
        return;
    }
    const Pricing::Quote& quote = estimate.quote;
    nlohmann::ordered_json work = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < kWorkKinds; ++i) {
        if (quote.price.work[i] > 0) work[name_of(Work(i))] = std::round(quote.price.work[i]);
    }
    const nlohmann::ordered_json json = {
        {"price_ms", rounded(quote.ms)},
        {"likely_ms", {rounded(quote.low_ms), rounded(quote.high_ms)}},
        {"measured", quote.measured},
        {"wait_ms", rounded(estimate.wait_ms)},
        {"deadline_ms", rounded(order.allowance_ms)},
        {"in_time", estimate.in_time},
        {"cached", estimate.cached},
        {"method", quote.price.method},
        {"method_reason", quote.price.method_reason},
        {"format", estimate.scene->output.format},
        {"size", {quote.price.size.x, quote.price.size.y}},
        {"device_bytes", quote.price.device_bytes},
        {"work", work},
    };
    respond_.json(response, json.dump(2) + "\n");
}

}  // namespace penumbra
