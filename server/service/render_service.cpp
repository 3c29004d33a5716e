// SPDX-License-Identifier: MIT
#include "server/service/render_service.h"

#include <algorithm>
#include <chrono>

#include "core/scene/words.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

RenderFailure failure_of(RenderWorker::Refusal refusal) {
    return refusal == RenderWorker::Refusal::queue_full ? RenderFailure::queue_full
                                                        : RenderFailure::not_ready;
}

class Slot {
public:
    explicit Slot(std::counting_semaphore<>& slots) : slots_(slots) { slots_.acquire(); }
    ~Slot() { slots_.release(); }
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;

private:
    std::counting_semaphore<>& slots_;
};

// The second half of render_to_bytes(): the server parses under a slot and must not render under it.
RenderResponse render_checked(CheckedScene&& checked, double parse_ms, const SceneRenderer& render) {
    RenderResponse response;
    response.parse_ms = parse_ms;
    if (checked.failure != RenderFailure::none) {
        response.failure = checked.failure;
        response.problems = std::move(checked.problems);
        response.problems_left_out = checked.problems_left_out;
        return response;
    }
    response.format = checked.scene->output.format;
    const int bit_depth = bit_depth_of(response.format, checked.scene->output.bit_depth);
    RenderedScene rendered = render(std::move(*checked.scene));
    response.failure = rendered.failure;
    response.error = std::move(rendered.outcome.error);
    response.queue_ms = rendered.outcome.wait_ms;
    if (response.failure != RenderFailure::none) return response;
    if (!rendered.outcome.result) {
        response.failure =
            rendered.outcome.not_ready ? RenderFailure::not_ready : RenderFailure::failed;
        return response;
    }
    const Clock::time_point start = Clock::now();
    response.picture = encode_picture(*rendered.outcome.result, response.format, bit_depth);
    response.encode_ms = ms_since(start);
    response.stats = std::move(rendered.outcome.result->stats);
    return response;
}

}  // namespace

SceneLimits limits_of(const Config& config) {
    SceneLimits limits;
    limits.scene.max_canvas_pixels = std::min(limits.scene.max_canvas_pixels, config.max_pixels);
    limits.text.max_bytes = config.max_body_bytes;
    limits.text.max_string_bytes = std::min(limits.text.max_string_bytes, config.max_body_bytes);
    limits.fonts = std::make_shared<const FontSource>(config.font);
    return limits;
}

CheckedScene check_scene(const RenderRequest& request, const SceneLimits& limits,
                         const UnsupportedFeatures& unsupported) {
    CheckedScene checked;
    ParsedScene parsed = parse_scene(request.text, limits.scene, limits.text, request.overrides, *limits.fonts);
    if (!parsed.scene) {
        checked.failure = parsed.is_json ? RenderFailure::invalid_scene : RenderFailure::not_json;
        checked.problems = std::move(parsed.problems);
        checked.problems_left_out = parsed.problems_left_out;
        return checked;
    }
    parsed.scene->output.format = request.formats.choose(parsed.scene->output.format);
    const Problems missing = unsupported(*parsed.scene);
    if (!missing.empty()) {
        checked.failure = RenderFailure::not_supported;
        checked.problems = locate(request.text, missing, request.overrides);
        if (checked.problems.size() > limits.text.max_problems) {
            checked.problems_left_out = checked.problems.size() - limits.text.max_problems;
            checked.problems.resize(limits.text.max_problems);
        }
        return checked;
    }
    checked.scene = std::move(parsed.scene);
    return checked;
}

RenderResponse render_to_bytes(const RenderRequest& request, const SceneLimits& limits,
                               const UnsupportedFeatures& unsupported, const SceneRenderer& render) {
    const Clock::time_point start = Clock::now();
    CheckedScene checked = check_scene(request, limits, unsupported);
    return render_checked(std::move(checked), ms_since(start), render);
}

RenderService::RenderService(RenderWorker& worker, UnsupportedFeatures unsupported, const Config& config)
    : worker_(worker),
      unsupported_(std::move(unsupported)),
      limits_(limits_of(config)),
      parse_slots_(std::ptrdiff_t(std::max<std::size_t>(config.parse_slots, 1))) {}

RenderResponse RenderService::render(const RenderRequest& request) {
    const auto refused = [](RenderWorker::Refusal refusal) {
        RenderResponse response;
        response.failure = failure_of(refusal);
        return response;
    };
    // A scene that cannot be rendered now is not worth its parsing.
    if (const auto refusal = worker_.refusal()) return refused(*refusal);

    const Clock::time_point start = Clock::now();
    CheckedScene checked;
    {
        const Slot slot(parse_slots_);
        checked = check_scene(request, limits_, unsupported_);
    }
    return render_checked(std::move(checked), ms_since(start), [&](Scene&& scene) {
        RenderedScene rendered;
        auto ticket = worker_.submit(std::make_shared<const Scene>(std::move(scene)));
        if (ticket.refusal) {
            rendered.failure = failure_of(*ticket.refusal);
        } else {
            rendered.outcome = ticket.outcome.get();
        }
        return rendered;
    });
}

}  // namespace penumbra
