// SPDX-License-Identifier: MIT
// /v1/jobs: renders that outlive their request.
#include <algorithm>
#include <cmath>
#include <ctime>

#include <nlohmann/json.hpp>

#include "server/http/api.h"
#include "server/http/negotiate.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr int kAccepted = 202;
// How often a stream of events tells how far it is.
constexpr std::chrono::milliseconds kBeat{300};
constexpr std::string_view kPath = "/v1/jobs/";

std::string time_text(std::chrono::system_clock::time_point time) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

std::string path_of(const Job& job) { return std::string(kPath) + job.id; }

// Under the job's mutex.
Json progress_of(const Job& job) {
    const bool begun = job.began != Clock::time_point();
    const Clock::time_point until = job.over() ? job.ended : Clock::now();
    const double elapsed = begun ? std::chrono::duration<double, std::milli>(until - job.began).count() : 0;
    double share = job.state == Job::State::done ? 1 : 0;
    // Never quite there: what was expected may be too little.
    if (job.state == Job::State::rendering && job.expected_ms > 0) share = 1 - std::exp(-1.5 * elapsed / job.expected_ms);
    return {{"state", word_of(job.state)},
            {"elapsed_ms", std::round(elapsed)},
            {"expected_ms", std::round(job.expected_ms)},
            {"share", std::round(1000 * share) / 1000},
            {"slices", job.slices}};
}

Json json_of(const Job& job) {
    const std::lock_guard lock(job.mutex);
    Json json = {{"id", job.id}, {"created", time_text(job.created)}};
    json.update(progress_of(job));
    if (!job.method.empty()) json["method"] = job.method;
    json["links"] = {{"self", path_of(job)}, {"events", path_of(job) + "/events"}, {"result", path_of(job) + "/result"}};
    return json;
}

std::string event(const char* name, const std::string& data) { return std::string("event: ") + name + "\ndata: " + data + "\n\n"; }

// Reads a job's changes one after another as events.
class EventSource {
public:
    EventSource(std::shared_ptr<Job> job, std::string problem_id) : job_(std::move(job)), problem_id_(std::move(problem_id)) {}

    // False after the last one.
    bool next(std::string& part, int retry_after_s) {
        std::unique_lock lock(job_->mutex);
        job_->changed.wait_for(lock, told_ ? kBeat : std::chrono::milliseconds(0), [&] { return job_->over() || (job_->preview && !previewed_); });
        told_ = true;
        if (job_->preview && !previewed_) {
            previewed_ = true;
            const Answer& answer = *job_->preview;
            part += event("preview", Json({{"media_type", "image/png"},
                                           {"size", {answer.stats.width, answer.stats.height}},
                                           {"base64", encode_base64({reinterpret_cast<const char*>(answer.picture.data()), answer.picture.size()})}})
                                         .dump());
        }
        part += event("progress", progress_of(*job_).dump());
        if (!job_->over()) return true;
        if (job_->state == Job::State::done) {
            const Answer& answer = *job_->response.answer;
            const PictureFormat* format = find_format(answer.format);
            part += event("done", Json({{"result", path_of(*job_) + "/result"},
                                        {"media_type", format->media_type},
                                        {"size", {answer.stats.width, answer.stats.height}},
                                        {"bytes", answer.picture.size()}})
                                      .dump());
        } else if (job_->state == Job::State::failed) {
            // In one line, as an event's data is.
            part += event("failed", Json::parse(body_of(problem_of(job_->response, retry_after_s), problem_id_)).dump());
        } else {
            part += event("cancelled", "{}");
        }
        return false;
    }

private:
    const std::shared_ptr<Job> job_;
    const std::string problem_id_;
    bool told_ = false, previewed_ = false;
};

}  // namespace

void Api::begin_job(const Request& request, Response& response, std::string&& body) {
    const FormatWishes wishes = parse_accept(joined(header_values(request, "Accept")));
    // What is wrong with the scene is told now, not later.
    RenderRequest order;
    order.text = body;
    order.formats = wishes;
    order.allowance_ms = 1000.0 * config_.max_job_s;
    if (RenderEstimate estimate = service_.estimate(order); estimate.refusal.failure != RenderFailure::none) {
        send_failure(response, estimate.refusal);
        return;
    }
    const std::shared_ptr<Job> job = jobs_->submit(std::move(body), wishes, GuardedServer::exchange().client);
    if (!job) {
        HttpProblem problem = make_problem(ProblemKind::too_many_jobs, "");
        problem.headers = {{"Retry-After", std::to_string(service_.worker().retry_after_s())}};
        respond_.problem(response, problem);
        return;
    }
    response.set_header("Location", path_of(*job));
    respond_.json(response, json_of(*job).dump(2) + "\n");
    response.status = kAccepted;
}

std::shared_ptr<Job> Api::find_job(const Request& request, Response& response) {
    std::string id = request.path.substr(kPath.size());
    id = id.substr(0, id.find('/'));
    std::shared_ptr<Job> job = jobs_->find(id);
    if (!job) respond_.problem(response, make_problem(ProblemKind::not_found, "There is no such job, or it ended too long ago."));
    return job;
}

void Api::tell_job(const Request& request, Response& response) {
    if (const std::shared_ptr<Job> job = find_job(request, response)) respond_.json(response, json_of(*job).dump(2) + "\n");
}

void Api::stream_job(const Request& request, Response& response) {
    const std::shared_ptr<Job> job = find_job(request, response);
    const StreamPlace place = job ? place_for_stream(response) : nullptr;
    if (!place) return;
    response.set_header("Cache-Control", "no-store");
    response.set_header("X-Accel-Buffering", "no");  // nginx would keep events back
    const auto source = std::make_shared<EventSource>(job, Responder::request_id());
    stream(response, place, "text/event-stream", [this, source](std::string& part) {
        return source->next(part, service_.worker().retry_after_s()) && !server_.draining();
    });
}

void Api::give_job(const Request& request, Response& response) {
    const std::shared_ptr<Job> job = find_job(request, response);
    if (!job) return;
    std::unique_lock lock(job->mutex);
    if (!job->over()) {
        HttpProblem problem = make_problem(ProblemKind::job_not_done, std::string("The job is ") + word_of(job->state) + ".");
        problem.headers = {{"Retry-After", "1"}};
        lock.unlock();
        respond_.problem(response, problem);
        return;
    }
    RenderResponse rendered = job->response;
    if (job->state == Job::State::cancelled) rendered.failure = RenderFailure::gone;
    lock.unlock();
    if (rendered.failure == RenderFailure::gone) {
        respond_.problem(response, make_problem(ProblemKind::not_found, "The job was cancelled."));
        return;
    }
    RenderRequest order;
    const EntityTags tags = parse_entity_tags(joined(header_values(request, "If-None-Match")));
    rendered.not_modified = rendered.failure == RenderFailure::none && tags.has(rendered.tag);
    send_picture(response, order, rendered);
}

void Api::end_job(const Request& request, Response& response) {
    if (!find_job(request, response)) return;
    const std::string id = request.path.substr(kPath.size());
    jobs_->remove(id);
    respond_.nothing(response);
}

}  // namespace penumbra
