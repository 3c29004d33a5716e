// SPDX-License-Identifier: MIT
// One thread that owns the one backend (a GL context belongs to a thread), behind one bounded queue.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/service/engine.h"
#include "server/service/log.h"
#include "server/service/warm_up.h"

namespace penumbra {

struct RenderOutcome {
    std::optional<RenderResult> result;
    std::string error;   // for the log, never for a client; empty with a result
    bool not_ready = false;  // it was not tried: there is no renderer that works
    double wait_ms = 0;      // in the queue
};

class RenderWorker {
public:
    enum class State {
        starting,  // making the context and testing it
        ready,
        failing,   // the self test gave a wrong picture
        broken,    // there is no backend: it could not be made
    };
    struct Status {
        State state = State::starting;
        std::string reason;  // a sentence unless ready
        DeviceInfo device;   // empty while there is none
        std::size_t waiting = 0;
        std::size_t capacity = 0;
        std::uint64_t rendered = 0;
        double render_ms = 0;  // moving average, 0 before the first render
    };
    enum class Refusal { queue_full, not_ready };

    // Renders `warm_up` before it is ready; requests that come meanwhile go before the rest of it.
    RenderWorker(BackendFactory factory, std::size_t queue_capacity, const Log& log, std::vector<WarmUpScene> warm_up = {});
    // Finishes what is queued.
    ~RenderWorker();
    RenderWorker(const RenderWorker&) = delete;
    RenderWorker& operator=(const RenderWorker&) = delete;

    struct Ticket {
        std::optional<Refusal> refusal;
        std::future<RenderOutcome> outcome;  // never comes after a refusal
    };
    // Never waits. The scene has passed validation.
    Ticket submit(std::shared_ptr<const Scene> scene);
    // The same; `done` is called on the worker's thread, once, unless it is refused. It must not take long.
    using Done = std::function<void(RenderOutcome)>;
    std::optional<Refusal> submit(std::shared_ptr<const Scene> scene, Done done);

    // Whether submit() would refuse now: asked before the work of parsing a scene.
    std::optional<Refusal> refusal() const;

    Status status() const;

    // How long until what waits now is rendered, by the measured rate; at least 1.
    int retry_after_s() const;

    // Waits until the state is not `starting`.
    State wait_until_started() const;

private:
    struct Job {
        std::shared_ptr<const Scene> scene;
        Done done;
        std::chrono::steady_clock::time_point since;
    };

    void run(const BackendFactory& factory);
    bool make_backend(const BackendFactory& factory);  // false: there is none
    void test_backend(State when_right = State::ready);
    void warm_up_next();
    RenderOutcome render(const Scene& scene, const BackendFactory& factory);
    void recover(const BackendFactory& factory);
    void set_state(State state, std::string reason);
    std::optional<Refusal> refusal_locked() const;

    const Log& log_;
    const std::size_t capacity_;

    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::deque<Job> queue_;
    bool stopping_ = false;
    Status status_;

    // Touched by the thread alone:
    const std::vector<WarmUpScene> warm_up_;
    std::size_t warmed_ = 0;  // how many of them
    double warm_up_ms_ = 0;
    std::unique_ptr<RenderBackend> backend_;

    std::thread thread_;                      // last: it uses all above
};

}  // namespace penumbra
