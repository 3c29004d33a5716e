// SPDX-License-Identifier: MIT
#include "server/redis/batch_worker.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

#include "server/redis/result_place.h"
#include "server/service/report.h"

namespace penumbra {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

// How long a worker without work waits before it looks whether it is to stop.
constexpr milliseconds kPatience{500};
constexpr milliseconds kLongestRest{10'000};
constexpr int kBackendTries = 5;

bool is_ours(std::string_view name) {
    for (const std::string_view known : {"scene", "name", "format", "put", "set"}) {
        if (name == known) return true;
    }
    return false;
}

std::vector<Override> overrides_of(const StreamFields& fields, std::string& wrong) {
    std::vector<Override> overrides;
    for (const auto& [name, value] : fields) {
        if (name != "set") continue;
        const std::size_t equals = value.find('=');
        if (equals == std::string::npos || value.front() != '/') wrong = "set takes /json/pointer=value, not " + value;
        else overrides.push_back({value.substr(0, equals), value.substr(equals + 1)});
    }
    return overrides;
}

}  // namespace

// Says of the job under way that it is, on a connection of its own: the worker's own thread renders.
class BatchWorker::Heart {
public:
    Heart(const BatchSettings& settings, const std::string& consumer)
        : settings_(settings), consumer_(consumer), thread_([this] { run(); }) {}
    ~Heart() {
        {
            const std::lock_guard lock(mutex_);
            ending_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    void beat_for(const std::string& id) {
        const std::lock_guard lock(mutex_);
        id_ = id;
    }

private:
    void run() {
        std::unique_lock lock(mutex_);
        while (!changed_.wait_for(lock, settings_.abandoned_after / 4, [&] { return ending_; })) {
            const std::string id = id_;
            if (id.empty()) continue;
            lock.unlock();
            try {
                if (!redis_) {
                    redis_ = std::make_unique<Redis>(settings_.redis);
                    stream_ = std::make_unique<JobStream>(*redis_, settings_.names, consumer_);
                }
                stream_->keep(id);
            } catch (const std::exception&) {  // the worker will notice, or the job is taken over: both are provided for
                stream_.reset();
                redis_.reset();
            }
            lock.lock();
        }
    }

    const BatchSettings& settings_;
    const std::string consumer_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string id_;
    bool ending_ = false;
    std::unique_ptr<Redis> redis_;
    std::unique_ptr<JobStream> stream_;
    std::thread thread_;
};

BatchWorker::BatchWorker(BatchSettings settings, SceneLimits limits, UnsupportedFeatures unsupported, BackendFactory make_backend, const Log& log)
    : settings_(std::move(settings)),
      limits_(std::move(limits)),
      unsupported_(std::move(unsupported)),
      make_backend_(std::move(make_backend)),
      log_(log) {}

BatchWorker::~BatchWorker() {
    stop();
    if (thread_.joinable()) thread_.join();
}

void BatchWorker::start() {
    thread_ = std::thread([this] { run(); });
}

bool BatchWorker::rest(milliseconds time) const {
    for (const Clock::time_point end = Clock::now() + time; Clock::now() < end && !finishing_;) std::this_thread::sleep_for(milliseconds(50));
    return !finishing_;
}

void BatchWorker::run() {
    milliseconds pause{200};
    // Before any job is taken: one that cannot render must not hold one.
    bool good = prepare_backend();
    while (good && !finishing_) {
        const Clock::time_point start = Clock::now();
        try {
            serve();
            continue;
        } catch (const RedisLost& error) {
            log_.warning("no Redis", {{"error", error.what()}, {"retry_ms", std::int64_t(pause.count())}});
        } catch (const RedisError& error) {
            // From the start: a wrong password, no right to the stream. Later: the stream was deleted, say, and is made anew.
            if (!connected_once_) {
                broken_ = "Redis refuses: " + std::string(error.what());
                good = false;
                break;
            }
            log_.warning("Redis refuses", {{"error", error.what()}, {"retry_ms", std::int64_t(pause.count())}});
        } catch (const std::exception& error) {
            broken_ = error.what();
            good = false;
            break;
        }
        if (Clock::now() - start > kLongestRest) pause = milliseconds(200);
        rest(pause);
        pause = std::min(2 * pause, kLongestRest);
    }
    backend_.reset();
    ended_ = true;
}

bool BatchWorker::prepare_backend() {
    milliseconds pause{500};
    std::string why;
    for (int i = 0; i < kBackendTries; ++i) {
        try {
            backend_ = make_backend_();
            why = backend_->self_test();
            if (why.empty()) return true;
        } catch (const std::exception& error) {
            why = error.what();
        }
        backend_.reset();
        log_.error("no renderer", {{"error", why}});
        if (!rest(pause)) break;
        pause *= 2;
    }
    broken_ = "No renderer can be made: " + why;
    return false;
}

void BatchWorker::serve() {
    Redis redis(settings_.redis);
    JobStream stream(redis, settings_.names, settings_.consumer);
    connected_once_ = true;
    log_.info("waiting for jobs", {{"redis", to_string(settings_.redis)}, {"stream", settings_.names.stream}, {"worker", settings_.consumer}});
    Heart heart(settings_, settings_.consumer);
    while (!finishing_) {
        if (!backend_ && !prepare_backend()) throw std::runtime_error(broken_);
        const std::optional<StreamJob> job = stream.next(kPatience, settings_.abandoned_after);
        if (!job) continue;
        heart.beat_for(job->id);
        work(stream, *job, heart);
        heart.beat_for("");
    }
    stream.leave();
}

std::string BatchWorker::refused(const StreamJob& job) const {
    const std::string_view name = field_of(job.fields, "name"), format = field_of(job.fields, "format"), put = field_of(job.fields, "put");
    if (field_of(job.fields, "scene").empty()) return "the job has no scene";
    if (!name.empty()) {
        if (const std::string why = refuse_name(name); !why.empty()) return why;
    }
    if (!format.empty() && find_format(format) == nullptr) return "format takes one of " + format_names() + ", not " + std::string(format);
    if (!put.empty() && (settings_.put_prefix.empty() || !put.starts_with(settings_.put_prefix))) {
        return "this worker does not put results there (--put says where)";
    }
    return "";
}

void BatchWorker::work(JobStream& stream, const StreamJob& job, Heart& heart) {
    const auto bury = [&](const std::string& reason, const std::string& problems = "") {
        heart.beat_for("");
        log_.error("job is dead", {{"job", job.id}, {"deliveries", job.deliveries}, {"reason", reason}});
        stream.bury(job, reason, problems);
    };
    // What may go well another time: left to be taken over, as long as it has not been so too often.
    const auto fail = [&](const std::string& reason) {
        if (job.deliveries >= settings_.most_deliveries) return bury(reason);
        log_.warning("job failed", {{"job", job.id}, {"deliveries", job.deliveries}, {"error", reason}});
    };
    if (job.deliveries > settings_.most_deliveries) {
        return bury("it was handed out " + std::to_string(job.deliveries - 1) + " times, and no worker came back");
    }
    std::string wrong = refused(job);
    const Clock::time_point start = Clock::now();
    RenderRequest request;
    request.text = field_of(job.fields, "scene");
    request.overrides = overrides_of(job.fields, wrong);
    if (!wrong.empty()) return bury(wrong);
    const std::string_view format_name = field_of(job.fields, "format"), name_of_job = field_of(job.fields, "name");
    const PictureFormat* format = !format_name.empty() ? find_format(format_name) : find_format_of_file(name_of_job);
    if (format != nullptr) request.formats = only_format(format->name);

    RenderResponse response;
    try {
        response = render_to_bytes(request, limits_, unsupported_, [&](const Scene& scene) {
            return backend_->render(scene, [&, end = start + settings_.longest_render] { return stopping_ || Clock::now() > end; });
        });
    } catch (const RenderStopped&) {
        if (stopping_) return;  // another worker's, in due time
        return bury("it takes more than " + std::to_string(settings_.longest_render.count()) + " s");
    } catch (const BackendLost& error) {
        backend_.reset();
        return fail(error.what());
    } catch (const std::exception& error) {
        backend_.reset();
        return fail(error.what());
    }
    if (response.failure != RenderFailure::none) {
        CheckedScene checked;
        checked.failure = response.failure;
        checked.problems = response.problems;
        checked.problems_left_out = response.problems_left_out;
        return bury(response.problems.empty() ? "the scene is refused" : to_string(response.problems.front()), validation_json(checked));
    }

    const Bytes& picture = response.answer->picture;
    const PictureFormat* made = find_format(response.answer->format);
    const std::string name = name_of_job.empty() ? job.id + std::string(made->extension) : std::string(name_of_job);
    const std::string_view own_url = field_of(job.fields, "put");
    const std::string url = !own_url.empty() ? std::string(own_url) : settings_.put_prefix.empty() ? "" : settings_.put_prefix + name;
    const Delivery delivery = url.empty() ? deliver_to_folder(settings_.folder, name, picture, settings_.consumer)
                                          : deliver_by_put(url, picture, made->media_type);
    if (!delivery.good) return delivery.final ? bury(delivery.why) : fail(delivery.why);

    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    StreamFields note = {{"job", job.id}, {"name", name}, {"format", response.answer->format}, {"bytes", std::to_string(picture.size())},
                         {"ms", std::to_string(std::int64_t(ms))}, {"deliveries", std::to_string(job.deliveries)}, {"worker", settings_.consumer}};
    for (const auto& field : job.fields) {
        if (!is_ours(field.first)) note.push_back(field);
    }
    heart.beat_for("");
    const bool first = stream.finish(job.id, note);
    log_.info(first ? "job done" : "job was done by another", {{"job", job.id}, {"name", name}, {"ms", ms}, {"bytes", std::int64_t(picture.size())}});
}

}  // namespace penumbra
