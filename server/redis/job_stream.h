// SPDX-License-Identifier: MIT
// Renders to be done, as entries of a Redis stream that workers share by a consumer group. An entry that is done is deleted: the
// stream's length is what is left. Redis does each step whole, or not at all (scripts).
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/redis/connection.h"

namespace penumbra {

struct StreamNames {
    std::string stream = "penumbra";
    std::string group = "penumbra";
    std::string done() const { return stream + ":done"; }
    std::string dead() const { return stream + ":dead"; }
};

using StreamFields = std::vector<std::pair<std::string, std::string>>;

// The field's value, "" when there is none.
std::string_view field_of(const StreamFields& fields, std::string_view name);

struct StreamJob {
    std::string id;
    StreamFields fields;
    std::int64_t deliveries = 1;  // with this one
};

class JobStream {
public:
    // `consumer` names this worker. Makes stream and group when they are not there. Throws as Redis does.
    JobStream(Redis& redis, StreamNames names, std::string consumer);

    // Waits for a job at most so long. One that another worker has had for `abandoned_after` without a sign of life comes first.
    std::optional<StreamJob> next(std::chrono::milliseconds patience, std::chrono::milliseconds abandoned_after);
    // A sign of life: the job is not to be taken away.
    void keep(const std::string& id);
    // Takes the job from the stream, with a note in the stream of what is done: once, by whoever is first. False: it was another.
    bool finish(const std::string& id, const StreamFields& note);
    // The same with its fields and the reason in the stream of the dead.
    bool bury(const StreamJob& job, const std::string& reason, const std::string& problems);
    // Gives its name back, unless it still holds jobs, which then wait to be taken over.
    void leave();

private:
    std::optional<StreamJob> job_of(const RedisReply& entry);
    bool settle(const std::string& id, const std::string& stream, std::size_t most_notes, const StreamFields& note);

    Redis& redis_;
    StreamNames names_;
    std::string consumer_;
    std::chrono::steady_clock::time_point next_claim_{};
    std::string cursor_ = "0-0";  // how far the search for abandoned jobs has come
};

// Puts a job on the stream; its id.
std::string submit_job(Redis& redis, const StreamNames& names, const StreamFields& fields);

}  // namespace penumbra
