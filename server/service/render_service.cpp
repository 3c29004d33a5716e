// SPDX-License-Identifier: MIT
#include "server/service/render_service.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <iterator>

#include "core/scene/normal_form.h"
#include "core/scene/words.h"
#include "server/service/digest.h"
#include "server/service/identity.h"

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

SharedAnswer make_answer(RenderResult&& result, const OutputSettings& output) {
    auto answer = std::make_shared<Answer>();
    const Clock::time_point start = Clock::now();
    answer->picture = encode_picture(result, output.format, bit_depth_of(output.format, output.bit_depth));
    answer->picture.shrink_to_fit();  // it may be kept for long
    answer->format = output.format;
    answer->encode_ms = ms_since(start);
    answer->stats = std::move(result.stats);
    return answer;
}

// Pictures with the tone map "tony" follow from its table as well. Empty without one.
std::string digest_of_file(const std::string& path) {
    if (path.empty()) return "";
    std::ifstream file(path, std::ios::binary);
    return sha256({std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}});
}

// The key of texts that are worth remembering: a few hundred bytes each.
constexpr std::size_t kKnownTexts = 4096;

RenderResponse refused(CheckedScene&& checked) {
    RenderResponse response;
    response.failure = checked.failure;
    response.problems = std::move(checked.problems);
    response.problems_left_out = checked.problems_left_out;
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
    if (checked.failure != RenderFailure::none) return refused(std::move(checked));
    RenderResponse response;
    response.parse_ms = ms_since(start);
    response.answer = make_answer(render(*checked.scene), checked.scene->output);
    return response;
}

// One render that one or more requests wait for. The first of them that sees it done encodes it for all.
struct RenderService::Flight {
    OutputSettings output;
    std::mutex mutex;
    std::condition_variable changed;
    int waiting = 1;
    StopFlag stop = std::make_shared<std::atomic<bool>>(false);
    std::optional<RenderOutcome> outcome;
    bool encoding = false;
    bool done = false;
    // When done:
    RenderFailure failure = RenderFailure::none;
    std::string error;
    SharedAnswer answer;
    double queue_ms = 0;
    bool stored = false;
};

RenderService::RenderService(RenderWorker& worker, UnsupportedFeatures unsupported, const Config& config)
    : worker_(worker),
      unsupported_(std::move(unsupported)),
      limits_(limits_of(config)),
      parse_slots_(std::ptrdiff_t(std::max<std::size_t>(config.parse_slots, 1))),
      keys_(kKnownTexts),
      cache_(config.cache_bytes),
      table_id_(digest_of_file(config.tone_lut)),
      lethal_(kKnownTexts) {}

RenderService::~RenderService() = default;

RenderService::CacheFigures RenderService::cache_figures() const {
    return {cache_.figures(), hits_, misses_, shared_, not_modified_};
}

std::string RenderService::tag_of(const std::string& key) const {
    const std::string device = device_class(worker_.status().device);
    return device.empty() ? "" : sha256({key, build_id(), device, table_id_});
}

CheckedScene RenderService::check(const RenderRequest& request, const std::string& text_key, std::string& key) {
    const Slot slot(parse_slots_);
    CheckedScene checked = check_scene(request, limits_, unsupported_);
    if (checked.scene) {
        key = sha256({normal_form(*checked.scene)});
        keys_.put(text_key, key);
    }
    return checked;
}

RenderResponse RenderService::render(const RenderRequest& request) {
    const Clock::time_point start = Clock::now();
    // A text that was right once is known without being parsed.
    const std::string text_key = sha256({request.text, to_string(request.formats)});
    std::string key = keys_.find(text_key);
    CheckedScene checked;
    const auto parse = [&] {
        // A scene that cannot be rendered now is not worth its parsing.
        if (const auto refusal = worker_.refusal()) {
            // Unless an equal request has made its key known meanwhile: its picture can be shared, which takes no place.
            const bool known = !key.empty();
            if (!known) key = keys_.find(text_key);
            if (known || key.empty()) checked.failure = failure_of(*refusal);
        } else {
            checked = check(request, text_key, key);
        }
        return checked.failure == RenderFailure::none;
    };
    if (key.empty() && !parse()) return refused(std::move(checked));

    RenderResponse response;
    if (!lethal_.find(key).empty()) {
        response.failure = RenderFailure::lethal;
        return response;
    }
    response.tag = tag_of(key);
    if (!response.tag.empty() && !request.anew) {
        if (request.client_has && request.client_has(response.tag)) {
            ++not_modified_;
            response.not_modified = true;
            return response;
        }
        response.answer = cache_.find(response.tag);
        if (response.answer) {
            ++hits_;
            response.source = Source::cache;
            response.parse_ms = ms_since(start);
            return response;
        }
    }
    std::shared_ptr<Flight> flight = join(key);
    if (!flight && !checked.scene && !parse()) {
        flight = join(key);  // an equal one may have taken the last place just now
        if (!flight) return refused(std::move(checked));
    }
    if (flight) {
        response.source = Source::shared;
    } else {
        flight = begin(key, std::make_shared<const Scene>(std::move(*checked.scene)), response);
        if (!flight) return response;
    }
    response.parse_ms = ms_since(start);
    wait_for(request, key, *flight, response);
    return response;
}

std::shared_ptr<RenderService::Flight> RenderService::join(const std::string& key) {
    const std::lock_guard lock(flights_mutex_);
    return join_locked(key);
}

std::shared_ptr<RenderService::Flight> RenderService::join_locked(const std::string& key) {
    const auto found = flights_.find(key);
    if (found == flights_.end()) return nullptr;
    const std::lock_guard inner(found->second->mutex);
    ++found->second->waiting;
    ++shared_;
    return found->second;
}

// Null: it is refused, as the response says.
std::shared_ptr<RenderService::Flight> RenderService::begin(const std::string& key, std::shared_ptr<const Scene> scene,
                                                            RenderResponse& response) {
    const std::lock_guard lock(flights_mutex_);
    // Another one may have begun it meanwhile.
    if (auto flight = join_locked(key)) {
        response.source = Source::shared;
        return flight;
    }
    auto flight = std::make_shared<Flight>();
    flight->output = scene->output;
    const auto done = [flight](RenderOutcome outcome) {
        {
            const std::lock_guard inner(flight->mutex);
            flight->outcome = std::move(outcome);
        }
        flight->changed.notify_all();
    };
    if (const auto refusal = worker_.submit(std::move(scene), done, flight->stop)) {
        response.failure = failure_of(*refusal);
        return nullptr;
    }
    flights_.emplace(key, flight);
    ++misses_;
    return flight;
}

// How often those who wait look whether they still have reason to.
constexpr std::chrono::milliseconds kLookUp{50};

void RenderService::wait_for(const RenderRequest& request, const std::string& key, Flight& flight, RenderResponse& response) {
    std::unique_lock lock(flight.mutex);
    const auto ready = [&] { return flight.done || (flight.outcome && !flight.encoding); };
    while (!flight.changed.wait_until(lock, std::min(Clock::now() + kLookUp, request.deadline), ready)) {
        lock.unlock();
        response.failure = stopping_                            ? RenderFailure::not_ready
                           : Clock::now() >= request.deadline   ? RenderFailure::timed_out
                           : request.gone && request.gone()     ? RenderFailure::gone
                                                                : RenderFailure::none;
        if (response.failure != RenderFailure::none) {
            leave(key, flight);
            return;
        }
        lock.lock();
    }
    if (!flight.done) {
        flight.encoding = true;
        RenderOutcome outcome = std::move(*flight.outcome);
        lock.unlock();
        finish(key, flight, std::move(outcome));
        lock.lock();
    }
    response.failure = flight.failure;
    response.error = flight.error;
    response.answer = flight.answer;
    response.queue_ms = flight.queue_ms;
    response.stored = flight.stored;
    lock.unlock();
    if (response.tag.empty()) response.tag = tag_of(key);
}

// The last one who leaves ends the render; who asks next begins a new one.
void RenderService::leave(const std::string& key, Flight& flight) {
    const std::lock_guard flights_lock(flights_mutex_);
    const std::lock_guard lock(flight.mutex);
    if (--flight.waiting > 0 || flight.done || flight.encoding) return;
    *flight.stop = true;
    if (const auto found = flights_.find(key); found != flights_.end() && found->second.get() == &flight) flights_.erase(found);
}

void RenderService::finish(const std::string& key, Flight& flight, RenderOutcome outcome) {
    SharedAnswer answer;
    bool stored = false;
    std::string error = std::move(outcome.error);
    try {
        if (outcome.result) {
            answer = make_answer(std::move(*outcome.result), flight.output);
            // Only now is it certain which device it was.
            if (const std::string tag = tag_of(key); !tag.empty()) stored = cache_.put(tag, answer);
        }
        if (outcome.lethal) lethal_.put(key, "lost");
    } catch (const std::exception& problem) {
        error = problem.what();
    }
    {
        const std::lock_guard flights_lock(flights_mutex_);
        if (const auto found = flights_.find(key); found != flights_.end() && found->second.get() == &flight) flights_.erase(found);
    }
    {
        const std::lock_guard lock(flight.mutex);
        flight.failure = answer              ? RenderFailure::none
                         : outcome.lethal    ? RenderFailure::lethal
                         : outcome.not_ready ? RenderFailure::not_ready
                                             : RenderFailure::failed;
        flight.error = std::move(error);
        flight.answer = std::move(answer);
        flight.queue_ms = outcome.wait_ms;
        flight.stored = stored;
        flight.done = true;
    }
    flight.changed.notify_all();
}

}  // namespace penumbra
