// SPDX-License-Identifier: MIT
#include "server/http/pool.h"

#include <algorithm>

#include <pthread.h>

namespace penumbra {

Pool::Pool(const char* name, std::size_t most_threads, std::function<void(Connection&)> work)
    : name_(name),
      most_threads_(most_threads),
      most_at_once_(std::min<std::size_t>(most_threads, std::max(2u, std::thread::hardware_concurrency()))),
      work_(std::move(work)) {}

bool Pool::may_begin() const {
    const Clock::time_point now = Clock::now();
    return stopping_ || std::size_t(std::count_if(begun_.begin(), begun_.end(), [&](Clock::time_point begun) { return now - begun < kSoonDone; })) < most_at_once_;
}

void Pool::begin_another() {
    if (waiting_.empty() || !may_begin()) return;
    if (idle_ > 0) {
        changed_.notify_one();
    } else if (threads_.size() < most_threads_) {
        threads_.emplace_back([this] { run(); });
    }
}

void Pool::add(Connection& connection, bool first) {
    const std::lock_guard lock(mutex_);
    first ? waiting_.push_front(&connection) : waiting_.push_back(&connection);
    begin_another();
}

bool Pool::nudge() {
    const std::lock_guard lock(mutex_);
    begin_another();
    return !waiting_.empty();
}

void Pool::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
}

void Pool::run() {
    ::pthread_setname_np(::pthread_self(), name_);
    std::unique_lock lock(mutex_);
    while (true) {
        ++idle_;
        changed_.wait(lock, [&] { return stopping_ || (!waiting_.empty() && may_begin()); });
        --idle_;
        if (waiting_.empty()) return;
        Connection& connection = *waiting_.front();
        waiting_.pop_front();
        const Clock::time_point begun = Clock::now();
        begun_.push_back(begun);
        begin_another();
        lock.unlock();
        work_(connection);
        lock.lock();
        begun_.erase(std::find(begun_.begin(), begun_.end(), begun));
    }
}

}  // namespace penumbra
