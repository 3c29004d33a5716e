// SPDX-License-Identifier: MIT
// Text in, picture out: the one path that the command line and the server share, so that both give
// the same bytes. Knows nothing of HTTP.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <semaphore>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/limits.h"
#include "server/json/scene_json.h"
#include "server/service/config.h"
#include "server/service/engine.h"
#include "server/service/formats.h"
#include "server/service/render_worker.h"

namespace penumbra {

struct RenderRequest {
    std::string_view text;
    FormatWishes formats = any_format();
    std::vector<Override> overrides;
};

enum class RenderFailure {
    none,
    not_json,       // the text is no JSON
    invalid_scene,  // the scene breaks the format's rules or limits
    not_supported,  // a right scene that asks for what this build cannot do yet
    queue_full,
    not_ready,
    failed,  // the world failed: told in the log
};

struct RenderResponse {
    RenderFailure failure = RenderFailure::none;

    Bytes picture;
    std::string format;  // of `picture`, as output.format
    RenderStats stats;
    double queue_ms = 0, parse_ms = 0, encode_ms = 0;

    std::vector<LocatedProblem> problems;
    std::size_t problems_left_out = 0;
    std::string error;  // for operators, not for clients
};

// Where a valid scene goes: straight to a backend, or through the worker's queue.
struct RenderedScene {
    RenderFailure failure = RenderFailure::none;
    RenderOutcome outcome;
};
using SceneRenderer = std::function<RenderedScene(Scene&&)>;

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

// render_to_bytes() through the worker. Any thread may call it; it waits for its render.
class RenderService {
public:
    RenderService(RenderWorker& worker, UnsupportedFeatures unsupported, const Config& config);

    RenderResponse render(const RenderRequest& request);

    RenderWorker& worker() { return worker_; }
    const SceneLimits& limits() const { return limits_; }
    const UnsupportedFeatures& unsupported() const { return unsupported_; }

private:
    RenderWorker& worker_;
    UnsupportedFeatures unsupported_;
    SceneLimits limits_;
    std::counting_semaphore<> parse_slots_;
};

}  // namespace penumbra
