// SPDX-License-Identifier: MIT
// penumbra worker: takes renders from a Redis stream, one at a time, until it is told to stop.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "server/redis/job_stream.h"
#include "server/service/engine.h"
#include "server/service/log.h"
#include "server/service/render_service.h"

namespace penumbra {

struct BatchSettings {
    RedisAddress redis;
    StreamNames names;
    std::string consumer;      // this worker's name; its threads add a number
    std::string folder;        // where pictures go: this, or
    std::string put_prefix;    // URLs that begin so
    // A job that its worker has not spoken of for so long is taken over.
    std::chrono::milliseconds abandoned_after{30'000};
    std::int64_t most_deliveries = 3;
    std::chrono::seconds longest_render{600};
};

class BatchWorker {
public:
    BatchWorker(BatchSettings settings, SceneLimits limits, UnsupportedFeatures unsupported, BackendFactory make_backend, const Log& log);
    ~BatchWorker();
    BatchWorker(const BatchWorker&) = delete;
    BatchWorker& operator=(const BatchWorker&) = delete;

    void start();
    // No more jobs; the one under way is finished.
    void finish() { finishing_ = true; }
    // The one under way is given up as well: another worker will take it.
    void stop() { stopping_ = finishing_ = true; }
    bool ended() const { return ended_; }
    // Why it ended by itself: it cannot render, or Redis refuses it. Empty while it has not.
    const std::string& broken() const { return broken_; }

private:
    class Heart;

    void run();
    void serve();  // one connection's time
    bool prepare_backend();
    void work(JobStream& stream, const StreamJob& job, Heart& heart);
    std::string refused(const StreamJob& job) const;  // why the job itself is wrong
    bool rest(std::chrono::milliseconds time) const;   // false when it was told to finish meanwhile

    const BatchSettings settings_;
    const SceneLimits limits_;
    const UnsupportedFeatures unsupported_;
    const BackendFactory make_backend_;
    const Log& log_;
    std::unique_ptr<RenderBackend> backend_;
    std::atomic<bool> finishing_{false}, stopping_{false}, ended_{false};
    std::string broken_;  // written before ended_
    bool connected_once_ = false;
    std::thread thread_;
};

}  // namespace penumbra
