// SPDX-License-Identifier: MIT
#include "server/service/render_worker.h"

#include <algorithm>
#include <cmath>
#include <exception>

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

RenderWorker::RenderWorker(BackendFactory factory, std::size_t queue_capacity, const Log& log, std::vector<WarmUpScene> warm_up)
    : log_(log), capacity_(std::max<std::size_t>(queue_capacity, 1)), warm_up_(std::move(warm_up)) {
    status_.reason = "The renderer is starting.";
    status_.capacity = capacity_;
    thread_ = std::thread([this, make = std::move(factory)] { run(make); });
}

RenderWorker::~RenderWorker() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

std::optional<RenderWorker::Refusal> RenderWorker::refusal_locked() const {
    if (status_.state == State::failing || status_.state == State::broken) return Refusal::not_ready;
    if (queue_.size() >= capacity_) return Refusal::queue_full;
    return std::nullopt;
}

std::optional<RenderWorker::Refusal> RenderWorker::refusal() const {
    const std::lock_guard lock(mutex_);
    return refusal_locked();
}

RenderWorker::Ticket RenderWorker::submit(std::shared_ptr<const Scene> scene) {
    Ticket ticket;
    auto promise = std::make_shared<std::promise<RenderOutcome>>();
    ticket.outcome = promise->get_future();
    ticket.refusal = submit(std::move(scene), [promise](RenderOutcome outcome) { promise->set_value(std::move(outcome)); });
    return ticket;
}

std::optional<RenderWorker::Refusal> RenderWorker::submit(std::shared_ptr<const Scene> scene, Done done) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto refusal = refusal_locked()) return refusal;
        queue_.push_back({std::move(scene), std::move(done), Clock::now()});
    }
    changed_.notify_all();
    return std::nullopt;
}

RenderWorker::Status RenderWorker::status() const {
    const std::lock_guard lock(mutex_);
    Status status = status_;
    status.waiting = queue_.size();
    return status;
}

int RenderWorker::retry_after_s() const {
    const std::lock_guard lock(mutex_);
    // One more than waits: the render that runs is on average half done, a whole one is the safe guess.
    const double seconds = status_.render_ms * double(queue_.size() + 1) / 1000;
    return int(std::clamp(std::ceil(seconds), 1.0, 3600.0));
}

RenderWorker::State RenderWorker::wait_until_started() const {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return status_.state != State::starting; });
    return status_.state;
}

void RenderWorker::set_state(State state, std::string reason) {
    {
        const std::lock_guard lock(mutex_);
        status_.state = state;
        status_.reason = std::move(reason);
    }
    changed_.notify_all();
}

bool RenderWorker::make_backend(const BackendFactory& factory) {
    backend_.reset();  // the old context goes before a new one comes
    try {
        backend_ = factory();
        const std::lock_guard lock(mutex_);
        status_.device = backend_->device();
        return true;
    } catch (const std::exception& error) {
        log_.error("The renderer could not start", {{"error", std::string(error.what())}});
        set_state(State::broken, error.what());
    } catch (...) {
        log_.error("The renderer could not start", {{"error", std::string("unknown exception")}});
        set_state(State::broken, "The renderer could not start.");
    }
    return false;
}

void RenderWorker::test_backend(State when_right) {
    std::string wrong;
    try {
        wrong = backend_->self_test();
    } catch (const std::exception& error) {
        wrong = error.what();
    } catch (...) {
        wrong = "The self test ended with an unknown exception.";
    }
    if (wrong.empty()) {
        set_state(when_right, when_right == State::ready ? "" : "The renderer is starting.");
    } else {
        log_.error("The self test failed", {{"error", wrong}});
        set_state(State::failing, wrong);
    }
}

// One scene of the warm-up; after the last it is ready.
void RenderWorker::warm_up_next() {
    const Clock::time_point start = Clock::now();
    if (warmed_ < warm_up_.size()) {
        const WarmUpScene& item = warm_up_[warmed_++];
        try {
            backend_->render(item.scene);
        } catch (const std::exception& error) {
            // Such a scene will fail when a client sends it; others need not.
            log_.warning("A scene of the warm-up failed", {{"scene", item.name}, {"error", std::string(error.what())}});
        }
        warm_up_ms_ += ms_since(start);
    }
    if (warmed_ < warm_up_.size()) return;
    if (!warm_up_.empty()) log_.info("warm", {{"scenes", std::int64_t(warmed_)}, {"ms", warm_up_ms_}});
    set_state(State::ready, "");
}

// After an exception the context may be lost. A wrong test is answered with a fresh one, once.
void RenderWorker::recover(const BackendFactory& factory) {
    test_backend();
    if (status().state == State::ready) return;
    log_.warning("Making a new context");
    if (make_backend(factory)) test_backend();
}

RenderOutcome RenderWorker::render(const Scene& scene, const BackendFactory& factory) {
    RenderOutcome outcome;
    const Clock::time_point start = Clock::now();
    try {
        outcome.result = backend_->render(scene);
    } catch (const std::exception& error) {
        outcome.error = error.what();
    } catch (...) {
        outcome.error = "unknown exception";
    }
    if (!outcome.result) {
        if (outcome.error.empty()) outcome.error = "exception without a text";
        recover(factory);
        return outcome;
    }
    const double ms = ms_since(start);
    const std::lock_guard lock(mutex_);
    // The weight of 1/8 forgets a burst of small scenes after some ten large ones.
    status_.render_ms = status_.rendered == 0 ? ms : status_.render_ms + (ms - status_.render_ms) / 8;
    ++status_.rendered;
    return outcome;
}

void RenderWorker::run(const BackendFactory& factory) {
    if (make_backend(factory)) test_backend(State::starting);
    bool warming = status().state == State::starting;  // the self test was right
    for (;;) {
        Job job;
        bool usable = warming;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return stopping_ || warming || !queue_.empty(); });
            if (queue_.empty() && stopping_) break;
            if (!queue_.empty()) {
                job = std::move(queue_.front());
                queue_.pop_front();
            }
            usable = usable || status_.state == State::ready;
        }
        if (job.scene) {
            const double wait_ms = ms_since(job.since);
            RenderOutcome outcome;
            if (usable) {
                outcome = render(*job.scene, factory);
            } else {
                outcome.not_ready = true;
                outcome.error = "the renderer is not ready: " + status().reason;
            }
            outcome.wait_ms = wait_ms;
            job.done(std::move(outcome));
        }
        // Whoever cannot wait until it is ready waits for one scene of the warm-up, not for all.
        if (warming) {
            if (status().state == State::starting) warm_up_next();
            warming = status().state == State::starting;
        }
    }
    backend_.reset();
}

}  // namespace penumbra
