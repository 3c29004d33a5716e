// SPDX-License-Identifier: MIT
#include "server/redis/job_stream.h"

#include <algorithm>

namespace penumbra {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// Notes of what is done are kept so many; the dead are never forgotten.
constexpr std::size_t kMostNotes = 100'000;
constexpr int kMostClaims = 100;

// KEYS: stream, notes. ARGV: group, id, most notes (0: all), then the note. Who is first settles it.
constexpr const char* kSettle = R"(
if redis.call('XACK', KEYS[1], ARGV[1], ARGV[2]) == 0 then return 0 end
redis.call('XDEL', KEYS[1], ARGV[2])
local note = {}
for i = 4, #ARGV do note[#note + 1] = ARGV[i] end
if ARGV[3] == '0' then
  redis.call('XADD', KEYS[2], '*', unpack(note))
else
  redis.call('XADD', KEYS[2], 'MAXLEN', '~', ARGV[3], '*', unpack(note))
end
return 1)";

// KEYS: stream. ARGV: group, consumer.
constexpr const char* kLeave = R"(
if #redis.call('XPENDING', KEYS[1], ARGV[1], '-', '+', 1, ARGV[2]) > 0 then return 0 end
redis.call('XGROUP', 'DELCONSUMER', KEYS[1], ARGV[1], ARGV[2])
return 1)";

// KEYS: stream. ARGV: group, consumer, id. Only as long as it is this worker's, and without counting it as a delivery.
constexpr const char* kKeep = R"(
if #redis.call('XPENDING', KEYS[1], ARGV[1], ARGV[3], ARGV[3], 1, ARGV[2]) == 0 then return 0 end
redis.call('XCLAIM', KEYS[1], ARGV[1], ARGV[2], 0, ARGV[3], 'JUSTID')
return 1)";

}  // namespace

std::string_view field_of(const StreamFields& fields, std::string_view name) {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.first == name; });
    return found == fields.end() ? std::string_view() : std::string_view(found->second);
}

JobStream::JobStream(Redis& redis, StreamNames names, std::string consumer)
    : redis_(redis), names_(std::move(names)), consumer_(std::move(consumer)) {
    try {
        redis_.command({"XGROUP", "CREATE", names_.stream, names_.group, "0", "MKSTREAM"});
    } catch (const RedisError& error) {
        if (!std::string_view(error.what()).starts_with("BUSYGROUP")) throw;
    }
}

// [id, [name, value, name, value, ...]]
std::optional<StreamJob> JobStream::job_of(const RedisReply& entry) {
    if (entry.list.empty()) return std::nullopt;
    StreamJob job;
    job.id = entry.at(0).text;
    const std::vector<RedisReply>& fields = entry.at(1).list;
    for (std::size_t i = 0; i + 1 < fields.size(); i += 2) job.fields.emplace_back(fields[i].text, fields[i + 1].text);
    return job;
}

std::optional<StreamJob> JobStream::next(milliseconds patience, milliseconds abandoned_after) {
    // Asking costs a look at the whole list of what is under way: now and then will do.
    if (steady_clock::now() >= next_claim_) {
        // One call looks at a few entries alone, and says where the next is to go on.
        for (int call = 0; call < kMostClaims; ++call) {
            const RedisReply claimed = redis_.command({"XAUTOCLAIM", names_.stream, names_.group, consumer_,
                                                       std::to_string(abandoned_after.count()), cursor_, "COUNT", "1"});
            cursor_ = claimed.at(0).text.empty() ? "0-0" : claimed.at(0).text;
            if (auto job = job_of(claimed.at(1).at(0))) {
                // Each time that it is handed out counts, the first one too.
                const RedisReply pending = redis_.command({"XPENDING", names_.stream, names_.group, job->id, job->id, "1"});
                job->deliveries = std::max<std::int64_t>(pending.at(0).at(3).number, 1);
                return job;
            }
            if (cursor_ == "0-0") break;
        }
        next_claim_ = steady_clock::now() + std::min(abandoned_after / 4, milliseconds(5000));
    }
    const RedisReply read = redis_.command({"XREADGROUP", "GROUP", names_.group, consumer_, "COUNT", "1", "BLOCK",
                                            std::to_string(std::max<milliseconds::rep>(patience.count(), 1)), "STREAMS", names_.stream, ">"},
                                           patience);
    return job_of(read.at(0).at(1).at(0));
}

void JobStream::keep(const std::string& id) { redis_.command({"EVAL", kKeep, "1", names_.stream, names_.group, consumer_, id}); }

bool JobStream::settle(const std::string& id, const std::string& stream, std::size_t most_notes, const StreamFields& note) {
    std::vector<std::string> words = {"EVAL", kSettle, "2", names_.stream, stream, names_.group, id, std::to_string(most_notes)};
    for (const auto& [name, value] : note) {
        words.push_back(name);
        words.push_back(value);
    }
    return redis_.command(words).number == 1;
}

bool JobStream::finish(const std::string& id, const StreamFields& note) { return settle(id, names_.done(), kMostNotes, note); }

bool JobStream::bury(const StreamJob& job, const std::string& reason, const std::string& problems) {
    StreamFields note = job.fields;
    note.emplace_back("job", job.id);
    note.emplace_back("deliveries", std::to_string(job.deliveries));
    note.emplace_back("reason", reason);
    if (!problems.empty()) note.emplace_back("problems", problems);
    return settle(job.id, names_.dead(), 0, note);
}

void JobStream::leave() { redis_.command({"EVAL", kLeave, "1", names_.stream, names_.group, consumer_}); }

std::string submit_job(Redis& redis, const StreamNames& names, const StreamFields& fields) {
    std::vector<std::string> words = {"XADD", names.stream, "*"};
    for (const auto& [name, value] : fields) {
        words.push_back(name);
        words.push_back(value);
    }
    return redis.command(words).text;
}

}  // namespace penumbra
