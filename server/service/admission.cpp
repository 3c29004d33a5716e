// SPDX-License-Identifier: MIT
// What a request will take, whether it is taken on, and what can be had instead.
#include <algorithm>
#include <cstdio>

#include "core/scene/normal_form.h"
#include "server/service/digest.h"
#include "server/service/render_service_parts.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

std::string decimal(double value) {
    char text[40];
    std::snprintf(text, sizeof text, value < 10 ? "%.2f" : "%.0f", value);
    return text;
}

double ms_until(Clock::time_point deadline) {
    return std::chrono::duration<double, std::milli>(deadline - Clock::now()).count();
}

}  // namespace

Pricing::Quote RenderService::price(const std::string& key, const Scene& scene) {
    const ParseSlot slot(parse_slots_);  // planning a dense scene takes memory and time as parsing does
    return books_->pricing.quote(key, scene, worker_.status().device);
}

bool RenderService::admit(const RenderRequest& request, const Pricing::Quote& quote, RenderResponse& response) {
    const double left_ms = ms_until(request.deadline);
    const double backlog_ms = worker_.status().backlog_ms;
    const auto seconds = [](double ms) { return decimal(ms / 1000); };
    if (left_ms <= 0) {
        response.failure = RenderFailure::timed_out;
        return false;
    }
    if (quote.low_ms > request.allowance_ms) {
        response.failure = RenderFailure::too_dear;
        response.detail = "The render takes about " + seconds(quote.ms) + " s, and the request may take " +
                          seconds(request.allowance_ms) + " s.";
    } else if (backlog_ms + quote.low_ms > left_ms) {
        response.failure = RenderFailure::too_late;
        // By then so much of what waits is done that this one fits.
        response.retry_after_s = std::max((backlog_ms + quote.ms - request.allowance_ms) / 1000, 0.0);
        response.detail = "Renders of about " + seconds(backlog_ms) + " s come first, this one takes about " + seconds(quote.ms) +
                          " s, and " + seconds(std::max(left_ms, 0.0)) + " s are left.";
    } else if (books_->budgets.limited() && !books_->budgets.take(request.client, quote.ms)) {
        response.failure = RenderFailure::budget_spent;
        response.budget = books_->budgets.state(request.client);
        response.retry_after_s = books_->budgets.seconds_until(request.client, quote.ms);
        response.detail = "The render takes about " + seconds(quote.ms) + " s, and of your share " +
                          seconds(response.budget->left_ms) + " s are left.";
    }
    if (response.failure != RenderFailure::none) {
        books_->metrics.count("penumbra_admission_total", {{"reason", response.failure == RenderFailure::too_dear   ? "too-expensive"
                                                               : response.failure == RenderFailure::too_late ? "deadline-unreachable"
                                                                                                             : "budget-spent"}});
    }
    return response.failure == RenderFailure::none;
}

RenderEstimate RenderService::estimate(const RenderRequest& request) {
    RenderEstimate estimate;
    const std::string text_key = text_key_of(request);
    CheckedScene checked = check(request, text_key, estimate.key);
    if (checked.failure != RenderFailure::none) {
        estimate.refusal = refused(std::move(checked));
        return estimate;
    }
    estimate.scene = std::move(checked.scene);
    if (!lethal_.find(estimate.key).empty()) {
        estimate.refusal.failure = RenderFailure::lethal;
        return estimate;
    }
    try {
        estimate.quote = price(estimate.key, *estimate.scene);
    } catch (const DeviceError& error) {
        estimate.refusal.failure = RenderFailure::beyond_device;
        estimate.refusal.detail = error.what();
        return estimate;
    }
    const std::string tag = tag_of(estimate.key);
    estimate.cached = !tag.empty() && cache_.find(tag) != nullptr;
    estimate.wait_ms = estimate.cached ? 0 : worker_.status().backlog_ms;
    estimate.in_time = estimate.cached || estimate.wait_ms + estimate.quote.high_ms <= request.allowance_ms;
    return estimate;
}

namespace {

// What can be had for less, the best first: lower qualities, then the cheapest sampled ones.
std::vector<Scene> cheaper_than(const Scene& scene, const std::string& method) {
    std::vector<Scene> rungs;
    for (const Quality quality : {Quality::standard, Quality::draft}) {
        if (quality >= scene.render.quality) continue;
        Scene rung = scene;
        rung.render.quality = quality;
        rungs.push_back(std::move(rung));
    }
    for (const char* sampled : {"hrc", "rc"}) {
        if (method == sampled && scene.render.quality == Quality::draft) continue;
        Scene rung = scene;
        rung.render.method = sampled;
        rung.render.quality = Quality::draft;
        rungs.push_back(std::move(rung));
    }
    return rungs;
}

const char* word_of(Quality quality) {
    return quality == Quality::draft ? "draft" : quality == Quality::standard ? "standard" : "high";
}

}  // namespace

// The best picture that is done by the deadline: when the one that was asked for may be late, a cheaper one is rendered first.
RenderResponse RenderService::render_in_time(const RenderRequest& request) {
    RenderEstimate asked = estimate(request);
    RenderRequest whole = request;
    whole.partial = false;
    if (asked.refusal.failure != RenderFailure::none) return asked.refusal;
    const auto deliver_asked = [&] {
        CheckedScene checked;
        checked.scene = std::move(asked.scene);
        return deliver(whole, "", asked.key, std::move(checked));
    };
    const double left_ms = ms_until(request.deadline);
    if (asked.in_time && asked.wait_ms + asked.quote.high_ms <= left_ms) return deliver_asked();

    const Scene* best = nullptr;
    const Scene* cheapest = nullptr;
    double least_ms = asked.quote.ms;
    const std::vector<Scene> rungs = cheaper_than(*asked.scene, asked.quote.price.method);
    std::string best_key, cheapest_key;
    for (const Scene& rung : rungs) {
        const std::string key = sha256({normal_form(rung)});
        try {
            const Pricing::Quote quote = price(key, rung);
            // Half of the time is for it, half for what was asked.
            if (!best && asked.wait_ms + quote.high_ms <= left_ms / 2) {
                best = &rung;
                best_key = key;
            }
            if (quote.ms < least_ms) {
                least_ms = quote.ms;
                cheapest = &rung;
                cheapest_key = key;
            }
        } catch (const DeviceError&) {
            // It cannot be had this way.
        }
    }
    if (!best && !rungs.empty()) {
        // None is sure to be in time: the one that should be soonest.
        best = cheapest ? cheapest : &rungs.back();
        best_key = cheapest ? cheapest_key : sha256({normal_form(rungs.back())});
    }
    if (!best) return deliver_asked();
    RenderRequest first = whole;
    first.client_has = nullptr;
    CheckedScene checked;
    checked.scene = *best;
    RenderResponse partial = deliver(first, "", best_key, std::move(checked));
    if (partial.failure != RenderFailure::none) return partial;
    RenderResponse rest = deliver_asked();
    const bool late = rest.failure == RenderFailure::timed_out || rest.failure == RenderFailure::too_late ||
                      rest.failure == RenderFailure::too_dear || rest.failure == RenderFailure::queue_full;
    if (!late) return rest;
    partial.partial = std::string("quality=") + word_of(best->render.quality) + "; method=" + partial.answer->stats.method;
    return partial;
}

}  // namespace penumbra
