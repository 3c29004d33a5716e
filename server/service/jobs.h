// SPDX-License-Identifier: MIT
// Renders that outlive the request that asked for them: they can be watched, fetched and cancelled by their name, which nobody guesses.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "server/service/config.h"
#include "server/service/log.h"
#include "server/service/render_service.h"

namespace penumbra {

// What a client may ask to have rendered, and what became of it. The members above the mutex never change.
struct Job {
    enum class State { waiting, rendering, done, failed, cancelled };

    std::string id, client, text;
    FormatWishes formats;
    std::chrono::system_clock::time_point created = std::chrono::system_clock::now();
    std::atomic<bool> cancel{false};

    mutable std::mutex mutex;
    mutable std::condition_variable changed;
    State state = State::waiting;
    std::chrono::steady_clock::time_point began, ended;
    double expected_ms = 0;
    std::string method;
    std::uint64_t slices = 0;  // dispatches of the device so far
    SharedAnswer preview;      // small, a PNG
    RenderResponse response;   // when it has ended

    bool over() const { return state == State::done || state == State::failed || state == State::cancelled; }  // under the mutex
};
const char* word_of(Job::State state);

class Jobs {
public:
    Jobs(RenderService& service, const Config& config, const Log& log);
    ~Jobs();  // cancels all
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    // Null: there are too many.
    std::shared_ptr<Job> submit(std::string text, FormatWishes formats, std::string client);
    std::shared_ptr<Job> find(const std::string& id);
    bool remove(const std::string& id);  // cancels it, too; false: there is none
    std::size_t count();

private:
    void run();
    void work(Job& job);
    void preview(Job& job, const Scene& scene, const RenderRequest& order);
    void forget_old();  // under the mutex

    RenderService& service_;
    const Config config_;
    const Log& log_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::unordered_map<std::string, std::shared_ptr<Job>> jobs_;
    std::deque<std::shared_ptr<Job>> waiting_;
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace penumbra
