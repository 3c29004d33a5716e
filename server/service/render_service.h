// SPDX-License-Identifier: MIT
// Text in, picture out: the one path that the command line and the server share, so that both give
// the same bytes. Knows nothing of HTTP.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/scene/limits.h"
#include "server/json/scene_json.h"
#include "server/service/answer_cache.h"
#include "server/service/client_budgets.h"
#include "server/service/config.h"
#include "server/service/engine.h"
#include "server/service/formats.h"
#include "server/service/metrics.h"
#include "server/service/pricing.h"
#include "server/service/render_worker.h"

namespace penumbra {

struct RenderRequest {
    std::string_view text;
    FormatWishes formats = any_format();
    std::vector<Override> overrides;
    // Of the server alone:
    // Whether the client says that it has the picture with this tag already; empty: it says nothing.
    std::function<bool(const std::string& tag)> client_has;
    bool anew = false;  // no answer from the cache
    // Until when it is wanted, and whether it still is: asked some times a second while it waits.
    std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
    std::function<bool()> gone;
    // How long it may take in all, milliseconds: what `deadline` was made of.
    double allowance_ms = 1e12;
    std::string client;    // whose share of the renderers it takes
    std::function<void(std::uint64_t slices)> progress;  // told now and then how many dispatches there were
    bool partial = false;  // at the deadline the best that is done by then, instead of a failure
};

// Where an answer came from.
enum class Source {
    rendered,
    cache,
    shared,  // another request's render of the same scene, which was under way
};

enum class RenderFailure {
    none,
    not_json,       // the text is no JSON
    invalid_scene,  // the scene breaks the format's rules or limits
    not_supported,  // a right scene that asks for what this build cannot do yet
    queue_full,
    not_ready,
    failed,     // the world failed: told in the log
    timed_out,  // it was not done by the deadline
    gone,       // the client did not wait
    lethal,     // rendering this scene has cost two renderers
    too_dear,       // by itself it takes longer than the request may
    too_late,       // it would be done in time, but for those before it
    beyond_device,  // the device cannot hold it
    budget_spent,   // this client has had its share
};

struct RenderResponse {
    RenderFailure failure = RenderFailure::none;

    SharedAnswer answer;        // set exactly without a failure, unless not_modified
    bool not_modified = false;  // the client has the picture
    std::string tag;            // names the picture's bytes; "" while the device is not known
    Source source = Source::rendered;
    bool stored = false;  // in the cache, now
    double queue_ms = 0, parse_ms = 0;

    std::vector<LocatedProblem> problems;
    std::size_t problems_left_out = 0;
    std::string error;   // for operators, not for clients
    std::string detail;  // of the failure, for clients

    std::optional<Pricing::Quote> quote;  // of what was to be rendered; not for pictures that were there
    double retry_after_s = 0;             // with too_late and budget_spent: when it is worth trying again
    std::optional<ClientBudgets::State> budget;  // where clients have one
    std::string partial;  // not empty: what the picture is instead of what was asked for
};

// What a request would take, told without rendering it.
struct RenderEstimate {
    RenderResponse refusal;  // its failure is none when there is an estimate
    std::string key;
    std::optional<Scene> scene;
    Pricing::Quote quote;
    bool cached = false;
    double wait_ms = 0;   // for those before it
    bool in_time = true;  // it would be taken, and seldom be late
};

// Where a valid scene goes.
using SceneRenderer = std::function<RenderResult(const Scene&)>;

struct SceneLimits {
    Limits scene;
    TextLimits text;
    std::shared_ptr<const FontSource> fonts = std::make_shared<const FontSource>();
};
SceneLimits limits_of(const Config& config);

using UnsupportedFeatures = std::function<Problems(const Scene&)>;

struct CheckedScene {
    RenderFailure failure = RenderFailure::none;
    std::optional<Scene> scene;  // set exactly without a failure
    std::vector<LocatedProblem> problems;
    std::size_t problems_left_out = 0;
};
CheckedScene check_scene(const RenderRequest& request, const SceneLimits& limits,
                         const UnsupportedFeatures& unsupported);

RenderResponse render_to_bytes(const RenderRequest& request, const SceneLimits& limits,
                               const UnsupportedFeatures& unsupported, const SceneRenderer& render);

// The same through the worker's queue, and past it where nothing new is to be rendered. Any thread may call it; it waits for
// its render.
class RenderService {
public:
    RenderService(RenderWorker& worker, UnsupportedFeatures unsupported, const Config& config);
    ~RenderService();
    RenderService(const RenderService&) = delete;
    RenderService& operator=(const RenderService&) = delete;

    RenderResponse render(const RenderRequest& request);
    RenderEstimate estimate(const RenderRequest& request);
    // The same for a scene that has passed validation; the request's text says nothing then.
    RenderResponse render_scene(const RenderRequest& request, Scene scene);

    struct CacheFigures {
        AnswerCache::Figures kept;
        std::uint64_t hits = 0, misses = 0, shared = 0, not_modified = 0;
    };
    CacheFigures cache_figures() const;

    // Ends what is under way: those who wait are refused as if there were no renderer.
    void stop_all() { stopping_ = true; }

    RenderWorker& worker() { return worker_; }
    Metrics& metrics();
    const ClientBudgets& budgets() const;
    const SceneLimits& limits() const { return limits_; }
    const UnsupportedFeatures& unsupported() const { return unsupported_; }

private:
    struct Flight;

    // Parses and checks; the scene's key goes to `key`.
    CheckedScene check(const RenderRequest& request, const std::string& text_key, std::string& key);
    // The render of this scene that is under way; null when there is none.
    std::shared_ptr<Flight> join(const std::string& key);
    std::shared_ptr<Flight> join_locked(const std::string& key);
    std::shared_ptr<Flight> begin(const RenderRequest& request, const std::string& key, std::shared_ptr<const Scene> scene,
                                  RenderResponse& response);
    // From the cache, from another request, or rendered.
    RenderResponse deliver(const RenderRequest& request, const std::string& text_key, std::string key, CheckedScene checked);
    RenderResponse render_in_time(const RenderRequest& request);
    // Whether it will be done in time; else the response says why not.
    bool admit(const RenderRequest& request, const Pricing::Quote& quote, RenderResponse& response);
    Pricing::Quote price(const std::string& key, const Scene& scene);
    void wait_for(const RenderRequest& request, const std::string& key, Flight& flight, RenderResponse& response);
    void finish(const std::string& key, Flight& flight, RenderOutcome outcome);
    void leave(const std::string& key, Flight& flight);
    std::string tag_of(const std::string& key) const;

    RenderWorker& worker_;
    UnsupportedFeatures unsupported_;
    SceneLimits limits_;
    std::counting_semaphore<> parse_slots_;
    TextMemo keys_;  // of right scenes, by their text
    AnswerCache cache_;
    std::string table_id_;  // of the tone map "tony"
    TextMemo lethal_;  // keys of scenes that have cost two renderers
    // Kept by renders that nobody waits for any more.
    struct Books;
    std::shared_ptr<Books> books_;
    std::atomic<bool> stopping_{false};
    std::mutex flights_mutex_;
    std::unordered_map<std::string, std::shared_ptr<Flight>> flights_;  // by the scene's key
    std::atomic<std::uint64_t> hits_{0}, misses_{0}, shared_{0}, not_modified_{0};
};

}  // namespace penumbra
