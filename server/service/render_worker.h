// SPDX-License-Identifier: MIT
// One bounded queue of renders, and the threads that take from it. Each owns one backend: a GL context belongs to a thread. A
// backend that is lost, wrong or worn out is replaced by a new one.
#pragma once

#include <atomic>
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
#include <unordered_map>
#include <vector>

#include "server/service/engine.h"
#include "server/service/log.h"
#include "server/service/warm_up.h"

namespace penumbra {

struct RenderOutcome {
    std::optional<RenderResult> result;
    std::string error;       // for the log, never for a client; empty with a result
    bool not_ready = false;  // it was not tried: there is no renderer that works
    bool stopped = false;    // nobody wanted it any more
    bool lethal = false;     // two backends were lost over it
    double wait_ms = 0;      // in the queue
    double render_ms = 0;    // of the last try
};

// Shared by those who want a render and those who make it.
using StopFlag = std::shared_ptr<std::atomic<bool>>;

struct RenderOrder {
    std::shared_ptr<const Scene> scene;  // has passed validation
    // Called on a worker's thread, once, unless the order is refused. It must not take long.
    std::function<void(RenderOutcome)> done{};
    StopFlag stop{};          // once set, the render ends soon, or is not begun
    std::string client{};     // of equal clients, each gets the same share of the renderers' time
    double expected_ms = 0;   // 0: as long as renders took lately
    std::shared_ptr<std::atomic<std::uint64_t>> slices{};  // told how many dispatches there were so far
};

class RenderWorker {
public:
    enum class State {
        starting,  // making the first backends and testing them
        ready,     // there is one that works
        failing,   // the self test gave a wrong picture
        broken,    // there is no backend: it could not be made
    };
    struct Status {
        State state = State::starting;
        std::string reason;  // a sentence unless ready
        bool ever_ready = false;
        DeviceInfo device;   // empty while there is none
        std::size_t workers = 0;        // threads with a backend each
        std::size_t ready_workers = 0;  // of them, those that take work now
        std::size_t waiting = 0, running = 0;
        std::size_t capacity = 0;
        std::uint64_t rendered = 0;
        std::uint64_t lost = 0;      // backends that ended in the middle of their work, or while idle
        std::uint64_t replaced = 0;  // backends that were made after the first ones
        std::string last_loss;       // why, "" when there was none
        double render_ms = 0;        // moving average, 0 before the first render
        double backlog_ms = 0;       // expected until all that waits or runs is rendered
    };
    enum class Refusal { queue_full, not_ready };

    // Renders `warm_up` before it is ready; requests that come meanwhile go before the rest of it.
    RenderWorker(BackendFactory factory, std::size_t queue_capacity, const Log& log, std::vector<WarmUpScene> warm_up = {},
                 std::size_t workers = 1);
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
    std::optional<Refusal> submit(RenderOrder order);

    // Whether submit() would refuse now: asked before the work of parsing a scene.
    std::optional<Refusal> refusal() const;

    Status status() const;

    // How long until what waits now is rendered, by the measured rate; at least 1.
    int retry_after_s() const;

    // Waits until the state is not `starting`.
    State wait_until_started() const;

private:
    struct Job {
        RenderOrder order;
        std::chrono::steady_clock::time_point since;
        double turn = 0;  // least first
        int losses = 0;
        double wait_ms = 0;
    };
    // One thread and its backend. Its state is read and written under the mutex, the rest by its thread alone.
    struct Slot {
        State state = State::starting;
        std::string reason = "The renderer is starting.";
        bool was_ready = false;
        std::unique_ptr<RenderBackend> backend;
        std::size_t warmed = 0;  // scenes of the warm-up
        double warm_up_ms = 0;
        double expected_ms = 0;  // of the render under way; 0: none is
        std::chrono::steady_clock::time_point since;
        std::chrono::milliseconds pause{0};  // before another one is made
    };

    void run(Slot& slot);
    std::optional<Job> next_job(Slot& slot);
    void work(Slot& slot, Job job);
    bool make_backend(Slot& slot);  // false: there is none
    void test_backend(Slot& slot, State when_right);
    void warm_up_next(Slot& slot);
    void recover(Slot& slot);
    void replace(Slot& slot);
    void count_loss(const std::string& why);
    void set_state(Slot& slot, State state, std::string reason);
    State state_of(const Slot& slot) const;
    Status status_locked() const;
    double backlog_locked() const;
    double expected_locked(const RenderOrder& order) const;
    void settle_locked(const RenderOrder& order, double spent_ms);
    std::optional<Refusal> refusal_locked() const;

    const BackendFactory factory_;
    const Log& log_;
    const std::size_t capacity_;
    const std::vector<WarmUpScene> warm_up_;

    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::deque<Job> queue_;
    // Start-time fair queueing: a client's next turn comes after what it has had; one that was idle begins at the present turn.
    double turn_ = 0;
    std::unordered_map<std::string, double> turns_;  // of clients that had more than their share
    bool stopping_ = false;
    bool started_ = false;  // every slot has ended its start
    Status counts_;         // the members that count; the others are worked out
    std::vector<std::unique_ptr<Slot>> slots_;
    std::vector<std::thread> threads_;  // last: they use all above
};

}  // namespace penumbra
