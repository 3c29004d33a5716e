// SPDX-License-Identifier: MIT
// Private to render_service.cpp and admission.cpp.
#pragma once

#include <algorithm>
#include <semaphore>
#include <string>
#include <utility>

#include "server/service/digest.h"
#include "server/service/render_service.h"

namespace penumbra {

struct RenderService::Books {
    explicit Books(const Config& config) : pricing(config.render_threads), budgets(1000.0 * config.client_budget_s) {}

    // What a render was, whoever waited for it.
    void enter(const std::string& key, const std::string& client, const Pricing::Quote& quote, const RenderOutcome& outcome) {
        const std::string& method = quote.price.method;
        budgets.settle(client, outcome.render_ms - quote.ms);
        metrics.count("penumbra_renders_total", {{"method", method}, {"outcome", outcome.result    ? "done"
                                                                                 : outcome.stopped ? "cancelled"
                                                                                 : outcome.lethal  ? "lost"
                                                                                                   : "failed"}});
        metrics.observe("penumbra_queue_wait_seconds", {}, outcome.wait_ms / 1000);
        if (!outcome.result) return;
        pricing.learn(key, quote, outcome.render_ms);
        metrics.observe("penumbra_render_seconds", {{"method", method}}, outcome.render_ms / 1000);
        metrics.observe("penumbra_price_ratio", {}, outcome.render_ms / std::max(quote.ms, 1e-3));
        for (const PassStats& pass : outcome.result->stats.passes) {
            metrics.count("penumbra_pass_seconds_total", {{"method", method}, {"pass", pass.name}}, pass.wall_ms / 1000);
        }
    }

    Pricing pricing;
    ClientBudgets budgets;
    Metrics metrics;
};

// A place among those who parse and plan.
class ParseSlot {
public:
    explicit ParseSlot(std::counting_semaphore<>& slots) : slots_(slots) { slots_.acquire(); }
    ~ParseSlot() { slots_.release(); }
    ParseSlot(const ParseSlot&) = delete;
    ParseSlot& operator=(const ParseSlot&) = delete;

private:
    std::counting_semaphore<>& slots_;
};

// Requests that agree in it are of the same scene.
inline std::string text_key_of(const RenderRequest& request) {
    std::string overrides;
    for (const Override& one : request.overrides) overrides += sha256({one.pointer, one.value});
    return sha256({request.text, to_string(request.formats), overrides});
}

inline RenderResponse refused(CheckedScene&& checked) {
    RenderResponse response;
    response.failure = checked.failure;
    response.problems = std::move(checked.problems);
    response.problems_left_out = checked.problems_left_out;
    return response;
}

}  // namespace penumbra
