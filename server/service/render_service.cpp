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
#include "server/service/render_service_parts.h"

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

}  // namespace

SceneLimits limits_of(const Config& config) {
    SceneLimits limits;
    limits.scene.max_canvas_pixels = std::min(limits.scene.max_canvas_pixels, config.max_pixels);
    limits.scene.max_shapes = std::min(limits.scene.max_shapes, config.bounds.max_shapes);
    limits.scene.max_points = std::min(limits.scene.max_points, config.bounds.max_points);
    limits.scene.max_lights = std::min(limits.scene.max_lights, config.bounds.max_lights);
    limits.scene.max_bitmap_texels = std::min(limits.scene.max_bitmap_texels, config.bounds.max_bitmap_texels);
    limits.scene.max_bounces = std::min(limits.scene.max_bounces, config.bounds.max_bounces);
    limits.scene.max_converging_bounces = std::min(limits.scene.max_converging_bounces, config.bounds.max_bounces);
    limits.text.max_depth = std::min(limits.text.max_depth, config.bounds.max_json_depth);
    limits.text.max_nodes = std::min(limits.text.max_nodes, config.bounds.max_json_values);
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
    Pricing::Quote quote;
    std::string client;  // who pays for it
    std::mutex mutex;
    std::condition_variable changed;
    int waiting = 1;
    StopFlag stop = std::make_shared<std::atomic<bool>>(false);
    std::shared_ptr<std::atomic<std::uint64_t>> slices = std::make_shared<std::atomic<std::uint64_t>>(0);
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
      lethal_(kKnownTexts),
      books_(std::make_shared<Books>(config)) {
    build_id();  // takes a tenth of a second, which no request should wait for
}

RenderService::~RenderService() = default;

Metrics& RenderService::metrics() { return books_->metrics; }
const ClientBudgets& RenderService::budgets() const { return books_->budgets; }

RenderService::CacheFigures RenderService::cache_figures() const {
    return {cache_.figures(), hits_, misses_, shared_, not_modified_};
}

std::string RenderService::tag_of(const std::string& key) const {
    const std::string device = device_class(worker_.status().device);
    return device.empty() ? "" : sha256({key, build_id(), device, table_id_});
}

CheckedScene RenderService::check(const RenderRequest& request, const std::string& text_key, std::string& key) {
    const ParseSlot slot(parse_slots_);
    CheckedScene checked = check_scene(request, limits_, unsupported_);
    if (checked.scene) {
        key = sha256({normal_form(*checked.scene)});
        keys_.put(text_key, key);
    }
    return checked;
}

RenderResponse RenderService::render(const RenderRequest& request) {
    if (request.partial) return render_in_time(request);
    // A text that was right once is known without being parsed.
    const std::string text_key = text_key_of(request);
    return deliver(request, text_key, keys_.find(text_key), {});
}

RenderResponse RenderService::render_scene(const RenderRequest& request, Scene scene) {
    CheckedScene checked;
    std::string key = sha256({normal_form(scene)});
    checked.scene = std::move(scene);
    return deliver(request, "", std::move(key), std::move(checked));
}

RenderResponse RenderService::deliver(const RenderRequest& request, const std::string& text_key, std::string key, CheckedScene checked) {
    const Clock::time_point start = Clock::now();
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
    if (books_->budgets.limited()) response.budget = books_->budgets.state(request.client);
    if (!lethal_.find(key).empty()) {
        response.failure = RenderFailure::lethal;
        return response;
    }
    response.tag = tag_of(key);
    if (!response.tag.empty() && !request.anew) {
        if (request.client_has && request.client_has(response.tag)) {
            ++not_modified_;
            books_->metrics.count("penumbra_cache_requests_total", {{"source", "client"}});
            response.not_modified = true;
            return response;
        }
        response.answer = cache_.find(response.tag);
        if (response.answer) {
            ++hits_;
            books_->metrics.count("penumbra_cache_requests_total", {{"source", "cache"}});
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
        flight = begin(request, key, std::make_shared<const Scene>(std::move(*checked.scene)), response);
        if (!flight) return response;
    }
    books_->metrics.count("penumbra_cache_requests_total", {{"source", response.source == Source::shared ? "shared" : "render"}});
    response.parse_ms = ms_since(start);
    wait_for(request, key, *flight, response);
    if (books_->budgets.limited()) response.budget = books_->budgets.state(request.client);
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
std::shared_ptr<RenderService::Flight> RenderService::begin(const RenderRequest& request, const std::string& key,
                                                            std::shared_ptr<const Scene> scene, RenderResponse& response) {
    auto flight = std::make_shared<Flight>();
    try {
        flight->quote = price(key, *scene);
    } catch (const DeviceError& error) {
        response.failure = RenderFailure::beyond_device;
        response.detail = error.what();
        return nullptr;
    }
    response.quote = flight->quote;
    const std::lock_guard lock(flights_mutex_);
    // Another one may have begun it meanwhile.
    if (auto other = join_locked(key)) {
        response.source = Source::shared;
        return other;
    }
    if (!admit(request, flight->quote, response)) return nullptr;
    flight->output = scene->output;
    flight->client = request.client;
    const auto done = [flight, books = books_, key](RenderOutcome outcome) {
        books->enter(key, flight->client, flight->quote, outcome);
        {
            const std::lock_guard inner(flight->mutex);
            flight->outcome = std::move(outcome);
        }
        flight->changed.notify_all();
    };
    if (const auto refusal = worker_.submit({std::move(scene), done, flight->stop, request.client, flight->quote.ms, flight->slices})) {
        books_->budgets.settle(request.client, -flight->quote.ms);
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
        if (request.progress) request.progress(*flight.slices);
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
            books_->metrics.count("penumbra_encode_seconds_total", {{"format", answer->format}}, answer->encode_ms / 1000);
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
