// SPDX-License-Identifier: MIT
#include "server/service/jobs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;

// Pixels of a preview's longer side.
constexpr int kPreviewSide = 128;
constexpr std::chrono::milliseconds kPatience{100};

// 128 bits, which nobody guesses.
std::string new_id() {
    std::random_device device;
    char id[33];
    std::snprintf(id, sizeof id, "%08x%08x%08x%08x", unsigned(device()), unsigned(device()), unsigned(device()), unsigned(device()));
    return id;
}

// The same part of the world in fewer pixels.
Scene small(const Scene& scene) {
    Scene made = scene;
    const double longer = std::max(scene.canvas.width, scene.canvas.height);
    const double share = std::min(1.0, kPreviewSide / longer);
    const ViewRect view = scene.canvas.view_or_default();
    made.canvas.width = std::max(1, int(std::round(scene.canvas.width * share)));
    made.canvas.height = std::max(1, int(std::round(scene.canvas.height * share)));
    // Pixels stay square.
    made.canvas.view = {view.x, view.y, view.w, view.w * made.canvas.height / made.canvas.width};
    made.canvas.region.reset();
    made.render.quality = Quality::draft;
    made.output.format = "png";
    made.output.bit_depth.reset();
    return made;
}

}  // namespace

const char* word_of(Job::State state) {
    switch (state) {
        case Job::State::waiting: return "waiting";
        case Job::State::rendering: return "rendering";
        case Job::State::done: return "done";
        case Job::State::failed: return "failed";
        case Job::State::cancelled: return "cancelled";
    }
    return "";
}

Jobs::Jobs(RenderService& service, const Config& config, const Log& log) : service_(service), config_(config), log_(log) {
    // One for each renderer keeps them busy, one more keeps the queue filled.
    const std::size_t count = config.max_jobs == 0 ? 0 : service.worker().status().workers + 1;
    for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { run(); });
}

Jobs::~Jobs() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        for (auto& [id, job] : jobs_) job->cancel = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void Jobs::forget_old() {
    const Clock::time_point now = Clock::now();
    std::size_t bytes = 0;
    std::vector<std::pair<Clock::time_point, std::string>> ended;
    for (auto& [id, job] : jobs_) {
        const std::lock_guard lock(job->mutex);
        if (!job->over()) continue;
        ended.emplace_back(job->ended, id);
        if (job->response.answer) bytes += job->response.answer->picture.size();
    }
    std::sort(ended.begin(), ended.end());
    for (const auto& [time, id] : ended) {
        const bool old = now - time > std::chrono::seconds(config_.job_ttl_s);
        if (!old && bytes <= config_.job_bytes && jobs_.size() < config_.max_jobs) return;
        const auto found = jobs_.find(id);
        if (found->second->response.answer) bytes -= found->second->response.answer->picture.size();
        jobs_.erase(found);
    }
}

std::shared_ptr<Job> Jobs::submit(std::string text, FormatWishes formats, std::string client) {
    auto job = std::make_shared<Job>();
    job->id = new_id();
    job->client = std::move(client);
    job->text = std::move(text);
    job->formats = std::move(formats);
    {
        const std::lock_guard lock(mutex_);
        forget_old();
        if (stopping_ || jobs_.size() >= config_.max_jobs) return nullptr;
        jobs_.emplace(job->id, job);
        waiting_.push_back(job);
    }
    changed_.notify_one();
    return job;
}

std::shared_ptr<Job> Jobs::find(const std::string& id) {
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    return found == jobs_.end() ? nullptr : found->second;
}

bool Jobs::remove(const std::string& id) {
    std::shared_ptr<Job> job;
    {
        const std::lock_guard lock(mutex_);
        const auto found = jobs_.find(id);
        if (found == jobs_.end()) return false;
        job = found->second;
        jobs_.erase(found);
        std::erase(waiting_, job);
    }
    job->cancel = true;
    {
        const std::lock_guard lock(job->mutex);
        if (job->state == Job::State::waiting) job->state = Job::State::cancelled;
    }
    job->changed.notify_all();
    return true;
}

std::size_t Jobs::count() {
    const std::lock_guard lock(mutex_);
    return jobs_.size();
}

void Jobs::preview(Job& job, const Scene& scene, const RenderRequest& order) {
    const RenderResponse response = service_.render_scene(order, small(scene));
    if (!response.answer) return;  // the picture itself will tell why
    {
        const std::lock_guard lock(job.mutex);
        job.preview = response.answer;
    }
    job.changed.notify_all();
}

void Jobs::work(Job& job) {
    const auto set_state = [&](Job::State state) {
        {
            const std::lock_guard lock(job.mutex);
            if (job.over()) return;
            job.state = state;
            (state == Job::State::rendering ? job.began : job.ended) = Clock::now();
        }
        job.changed.notify_all();
    };
    RenderRequest order;
    order.text = job.text;
    order.formats = job.formats;
    order.client = job.client;
    order.allowance_ms = 1000.0 * config_.max_job_s;
    order.deadline = Clock::now() + std::chrono::seconds(config_.max_job_s);
    order.gone = [&] { return job.cancel.load(); };
    set_state(Job::State::rendering);
    RenderResponse response;
    if (RenderEstimate estimate = service_.estimate(order); estimate.refusal.failure != RenderFailure::none) {
        response = std::move(estimate.refusal);
    } else {
        {
            const std::lock_guard lock(job.mutex);
            job.expected_ms = estimate.quote.ms;
            job.method = estimate.quote.price.method;
        }
        job.changed.notify_all();
        const bool large = std::max(estimate.scene->canvas.width, estimate.scene->canvas.height) > kPreviewSide;
        if (large && !estimate.cached) preview(job, *estimate.scene, order);
        order.progress = [&](std::uint64_t slices) {
            const std::lock_guard lock(job.mutex);
            job.slices = slices;
        };
        for (;;) {
            response = service_.render(order);
            const bool later = response.failure == RenderFailure::queue_full || response.failure == RenderFailure::too_late ||
                               response.failure == RenderFailure::budget_spent ||
                               (response.failure == RenderFailure::not_ready && !service_.worker().status().ever_ready);
            if (!later || job.cancel || Clock::now() > order.deadline) break;
            std::this_thread::sleep_for(kPatience);
        }
    }
    const bool cancelled = job.cancel || response.failure == RenderFailure::gone;
    const Job::State state = response.failure == RenderFailure::none ? Job::State::done : cancelled ? Job::State::cancelled : Job::State::failed;
    if (!response.error.empty()) log_.error("A job failed", {{"error", response.error}, {"job", job.id}});
    {
        const std::lock_guard lock(job.mutex);
        job.response = std::move(response);
    }
    set_state(state);
    service_.metrics().count("penumbra_jobs_total", {{"outcome", word_of(state)}});
}

void Jobs::run() {
    for (;;) {
        std::shared_ptr<Job> job;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
            if (stopping_) return;
            job = std::move(waiting_.front());
            waiting_.pop_front();
        }
        try {
            work(*job);
        } catch (const std::exception& error) {
            log_.error("A job failed", {{"error", std::string(error.what())}, {"job", job->id}});
            {
                const std::lock_guard lock(job->mutex);
                job->response.failure = RenderFailure::failed;
                job->state = Job::State::failed;
                job->ended = Clock::now();
            }
            job->changed.notify_all();
        }
    }
}

}  // namespace penumbra
