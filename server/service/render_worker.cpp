// SPDX-License-Identifier: MIT
#include "server/service/render_worker.h"

#include <algorithm>
#include <cmath>
#include <exception>

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

// How often an idle thread looks after its backend.
constexpr std::chrono::milliseconds kLookUp{250};
// Between two attempts to make a backend that could not be made: it doubles up to the second.
constexpr std::chrono::milliseconds kFirstPause{500}, kLongestPause{30'000};
// A render that has cost so many backends is not tried again.
constexpr int kMostLosses = 2;
// More clients than this are not told apart: the books are closed and begun anew.
constexpr std::size_t kMostClients = 10'000;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

RenderWorker::RenderWorker(BackendFactory factory, std::size_t queue_capacity, const Log& log, std::vector<WarmUpScene> warm_up,
                           std::size_t workers)
    : factory_(std::move(factory)),
      log_(log),
      capacity_(std::max<std::size_t>(queue_capacity, 1)),
      warm_up_(std::move(warm_up)) {
    for (std::size_t i = 0; i < std::max<std::size_t>(workers, 1); ++i) slots_.push_back(std::make_unique<Slot>());
    for (const auto& slot : slots_) threads_.emplace_back([this, one = slot.get()] { run(*one); });
}

RenderWorker::~RenderWorker() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

// ---- asked from outside

RenderWorker::Status RenderWorker::status_locked() const {
    Status status = counts_;
    status.workers = slots_.size();
    status.capacity = capacity_;
    status.waiting = queue_.size();
    status.backlog_ms = backlog_locked();
    // The best that there is; but before all have started, one that is ready would have to do the work of all.
    const Slot* best = nullptr;
    for (const auto& slot : slots_) {
        status.ever_ready = status.ever_ready || slot->was_ready;
        status.ready_workers += slot->state == State::ready ? 1 : 0;
        const auto rank = [](State state) {
            return state == State::ready ? 0 : state == State::starting ? 1 : state == State::failing ? 2 : 3;
        };
        if (!best || rank(slot->state) < rank(best->state)) best = slot.get();
    }
    status.state = started_ ? best->state : State::starting;
    status.reason = status.state == State::ready      ? ""
                    : status.state == State::starting ? "The renderer is starting."
                                                      : best->reason;
    return status;
}

RenderWorker::Status RenderWorker::status() const {
    const std::lock_guard lock(mutex_);
    return status_locked();
}

std::optional<RenderWorker::Refusal> RenderWorker::refusal_locked() const {
    const State state = status_locked().state;
    if (state == State::failing || state == State::broken) return Refusal::not_ready;
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
    ticket.refusal = submit({std::move(scene), [promise](RenderOutcome outcome) { promise->set_value(std::move(outcome)); }});
    return ticket;
}

double RenderWorker::expected_locked(const RenderOrder& order) const {
    return order.expected_ms > 0 ? order.expected_ms : std::max(counts_.render_ms, 1.0);
}

std::optional<RenderWorker::Refusal> RenderWorker::submit(RenderOrder order) {
    {
        const std::lock_guard lock(mutex_);
        if (const auto refusal = refusal_locked()) return refusal;
        // Who had more before an idle moment has it no longer: nobody waited for it.
        if (turns_.size() >= kMostClients || (queue_.empty() && counts_.running == 0)) turns_.clear();
        double& next = turns_[order.client];
        Job job;
        job.turn = std::max(turn_, next);
        next = job.turn + expected_locked(order);
        job.order = std::move(order);
        job.since = Clock::now();
        queue_.push_back(std::move(job));
    }
    changed_.notify_all();
    return std::nullopt;
}

// What it took counts, not what was expected.
void RenderWorker::settle_locked(const RenderOrder& order, double spent_ms) {
    const auto found = turns_.find(order.client);
    if (found == turns_.end()) return;
    found->second += spent_ms - expected_locked(order);
    if (found->second <= turn_) turns_.erase(found);  // as one who was never here
}

double RenderWorker::backlog_locked() const {
    double ms = 0, ready = 0;
    for (const Job& job : queue_) ms += expected_locked(job.order);
    for (const auto& slot : slots_) {
        ready += slot->state == State::ready ? 1 : 0;
        if (slot->expected_ms > 0) ms += std::max(slot->expected_ms - ms_since(slot->since), 0.1 * slot->expected_ms);
    }
    return ms / std::max(ready, 1.0);
}

int RenderWorker::retry_after_s() const {
    const std::lock_guard lock(mutex_);
    return int(std::clamp(std::ceil(backlog_locked() / 1000), 1.0, 3600.0));
}

RenderWorker::State RenderWorker::wait_until_started() const {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return status_locked().state != State::starting; });
    return status_locked().state;
}

// ---- a thread and its backend

void RenderWorker::set_state(Slot& slot, State state, std::string reason) {
    {
        const std::lock_guard lock(mutex_);
        slot.state = state;
        slot.reason = std::move(reason);
        slot.was_ready = slot.was_ready || state == State::ready;
        started_ = started_ || std::none_of(slots_.begin(), slots_.end(),
                                            [](const auto& one) { return one->state == State::starting; });
    }
    changed_.notify_all();
}

RenderWorker::State RenderWorker::state_of(const Slot& slot) const {
    const std::lock_guard lock(mutex_);
    return slot.state;
}

void RenderWorker::count_loss(const std::string& why) {
    const std::lock_guard lock(mutex_);
    ++counts_.lost;
    counts_.last_loss = why;
}

bool RenderWorker::make_backend(Slot& slot) {
    slot.backend.reset();  // the old context goes before a new one comes
    std::string why = "The renderer could not start.";
    try {
        slot.backend = factory_();
        const std::lock_guard lock(mutex_);
        counts_.device = slot.backend->device();
        return true;
    } catch (const std::exception& error) {
        why = error.what();
    } catch (...) {
    }
    log_.error("The renderer could not start", {{"error", why}});
    // One that has worked before is tried again; one that never did says that the machine has none.
    set_state(slot, slot.was_ready ? State::failing : State::broken, why);
    return false;
}

void RenderWorker::test_backend(Slot& slot, State when_right) {
    std::string wrong;
    try {
        wrong = slot.backend->self_test();
    } catch (const std::exception& error) {
        wrong = error.what();
    } catch (...) {
        wrong = "The self test ended with an unknown exception.";
    }
    if (wrong.empty()) {
        set_state(slot, when_right, "The renderer is starting.");
    } else {
        log_.error("The self test failed", {{"error", wrong}});
        set_state(slot, State::failing, wrong);
    }
}

// One scene of the warm-up; after the last it is ready.
void RenderWorker::warm_up_next(Slot& slot) {
    const Clock::time_point start = Clock::now();
    if (slot.warmed < warm_up_.size()) {
        const WarmUpScene& item = warm_up_[slot.warmed++];
        const auto failed = [&](const char* why) {
            // Such a scene will fail when a client sends it; others need not.
            log_.warning("A scene of the warm-up failed", {{"scene", item.name}, {"error", std::string(why)}});
        };
        try {
            slot.backend->render(item.scene, {});
        } catch (const BackendLost& error) {
            failed(error.what());
            count_loss(error.what());
            replace(slot);
            return;
        } catch (const std::exception& error) {
            failed(error.what());
        }
        slot.warm_up_ms += ms_since(start);
    }
    if (slot.warmed < warm_up_.size()) return;
    if (!warm_up_.empty()) log_.info("warm", {{"scenes", std::int64_t(slot.warmed)}, {"ms", slot.warm_up_ms}});
    set_state(slot, State::ready, "");
}

// Another backend instead of one that is lost or worn out. It is as ready as that was: what it compiles lies in the driver's cache.
void RenderWorker::replace(Slot& slot) {
    {
        const std::lock_guard lock(mutex_);
        ++counts_.replaced;
    }
    const State wanted = slot.was_ready || slot.warmed >= warm_up_.size() ? State::ready : State::starting;
    const Clock::time_point start = Clock::now();
    if (!make_backend(slot)) return;
    test_backend(slot, wanted);
    if (state_of(slot) == wanted) log_.info("A new renderer has started", {{"ms", ms_since(start)}});
}

// After an exception the context may be lost. A wrong test is answered with a fresh one, once.
void RenderWorker::recover(Slot& slot) {
    const State before = state_of(slot);
    test_backend(slot, before);
    if (state_of(slot) == before) return;
    log_.warning("Making a new context");
    replace(slot);
}

void RenderWorker::work(Slot& slot, Job job) {
    RenderOutcome outcome;
    outcome.wait_ms = job.wait_ms;
    const Clock::time_point start = Clock::now();
    bool lost = false;
    try {
        outcome.result = slot.backend->render(*job.order.scene, [&] {
            if (job.order.slices) *job.order.slices = slot.backend->slices();
            return job.order.stop && *job.order.stop;
        });
    } catch (const RenderStopped&) {
        outcome.stopped = true;
    } catch (const BackendLost& error) {
        lost = true;
        outcome.error = error.what();
    } catch (const std::exception& error) {
        outcome.error = error.what();
    } catch (...) {
        outcome.error = "unknown exception";
    }
    if (lost) {
        count_loss(outcome.error);
        log_.error("A renderer was lost", {{"error", outcome.error}, {"times", std::int64_t(job.losses + 1)}});
        set_state(slot, State::starting, "The renderer is starting again.");
        if (++job.losses < kMostLosses) {
            {
                const std::lock_guard lock(mutex_);
                --counts_.running;
                slot.expected_ms = 0;
                job.since = Clock::now();
                job.turn = -1;  // before all others
                queue_.push_front(std::move(job));
            }
            changed_.notify_all();
            replace(slot);
            return;
        }
        outcome.lethal = true;
    }
    const double ms = ms_since(start);
    const bool failed = !outcome.result && !outcome.stopped && !lost;
    if (failed && outcome.error.empty()) outcome.error = "exception without a text";
    if (failed) recover(slot);  // before the answer: who asks next finds the state that it left
    outcome.render_ms = ms;
    {
        const std::lock_guard lock(mutex_);
        --counts_.running;
        slot.expected_ms = 0;
        settle_locked(job.order, ms);
        if (outcome.result) {
            // The weight of 1/8 forgets a burst of small scenes after some ten large ones.
            counts_.render_ms = counts_.rendered == 0 ? ms : counts_.render_ms + (ms - counts_.render_ms) / 8;
            ++counts_.rendered;
        }
    }
    job.order.done(std::move(outcome));
    if (lost) replace(slot);
}

// Nothing: there is other work, or it is time to end.
std::optional<RenderWorker::Job> RenderWorker::next_job(Slot& slot) {
    std::unique_lock lock(mutex_);
    const bool warming = slot.state == State::starting && slot.backend;
    // Where no slot works, each throws out what is queued; where another does, this one leaves it to that.
    const auto mine = [&] {
        return !queue_.empty() && (slot.state == State::ready || warming || refusal_locked() == Refusal::not_ready);
    };
    changed_.wait_for(lock, std::max(kLookUp, slot.pause), [&] { return stopping_ || warming || mine(); });
    if (!mine()) return std::nullopt;
    const auto first = std::min_element(queue_.begin(), queue_.end(), [](const Job& a, const Job& b) { return a.turn < b.turn; });
    Job job = std::move(*first);
    queue_.erase(first);
    turn_ = std::max(turn_, job.turn);
    job.wait_ms += ms_since(job.since);
    slot.expected_ms = expected_locked(job.order);
    slot.since = Clock::now();
    ++counts_.running;
    return job;
}

void RenderWorker::run(Slot& slot) {
    if (make_backend(slot)) {
        test_backend(slot, State::starting);
        if (warm_up_.empty() && state_of(slot) == State::starting) set_state(slot, State::ready, "");
    }
    for (;;) {
        std::optional<Job> job = next_job(slot);
        {
            const std::lock_guard lock(mutex_);
            if (!job && stopping_ && queue_.empty()) break;
        }
        if (job) {
            const State state = state_of(slot);
            RenderOutcome outcome;
            outcome.wait_ms = job->wait_ms;
            outcome.stopped = job->order.stop && *job->order.stop;
            outcome.not_ready = state == State::failing || state == State::broken;
            if (outcome.stopped || outcome.not_ready) {
                if (outcome.not_ready) outcome.error = "the renderer is not ready: " + status().reason;
                {
                    const std::lock_guard lock(mutex_);
                    --counts_.running;
                    slot.expected_ms = 0;
                    settle_locked(job->order, 0);
                }
                job->order.done(std::move(outcome));
            } else {
                work(slot, std::move(*job));
            }
        }
        const State state = state_of(slot);
        if (state == State::starting && slot.backend) {
            // Whoever cannot wait until it is ready waits for one scene of the warm-up, not for all.
            warm_up_next(slot);
        } else if (!slot.backend && !job) {
            replace(slot);
            slot.pause = slot.backend ? std::chrono::milliseconds(0) : std::clamp(2 * slot.pause, kFirstPause, kLongestPause);
        } else if (state == State::ready && slot.backend) {
            if (const std::string why = slot.backend->worn_out(); !why.empty()) {
                log_.warning("A renderer is replaced", {{"why", why}});
                replace(slot);
            }
        }
    }
    slot.backend.reset();
}

}  // namespace penumbra
