// SPDX-License-Identifier: MIT
#include "core/reference/solver.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <numbers>
#include <thread>
#include <vector>

#include "core/floor/floor.h"
#include "core/reference/boundary.h"
#include "core/reference/delta.h"
#include "core/reference/media.h"
#include "core/reference/radiosity.h"
#include "core/reference/sky.h"
#include "core/reference/sweep.h"
#include "core/scene/lower.h"

namespace penumbra::reference {

namespace {

using Clock = std::chrono::steady_clock;

// How much of the whole work lies before and in the step that runs now.
struct Share {
    double before = 0, of_step = 1;
};

// Runs body(0) ... body(count - 1) on several threads, each with its own Sweep. False when
// cancelled.
bool run_parallel(const Sweep& fresh, std::size_t count, const SolveOptions& options, Share share,
                  const std::function<void(std::size_t, Sweep&)>& body) {
    const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
    const std::size_t wanted = options.threads > 0 ? std::size_t(options.threads) : processors;
    const std::size_t workers = std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(count, 1));
    std::atomic<std::size_t> next{0}, finished{0};
    std::atomic<bool> stop{false};
    std::mutex mutex;
    std::condition_variable done;
    std::size_t running = workers;
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            Sweep sweep = fresh;
            for (std::size_t i = next++; i < count && !stop; i = next++) {
                body(i, sweep);
                ++finished;
            }
        } catch (...) {
            const std::lock_guard lock(mutex);
            failure = std::current_exception();
            stop = true;
        }
        const std::lock_guard lock(mutex);
        --running;
        done.notify_one();
    };
    {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < workers; ++i) threads.emplace_back(work);
        std::unique_lock lock(mutex);
        while (running > 0) {
            done.wait_for(lock, std::chrono::milliseconds(100));
            if (!options.progress || stop) continue;
            lock.unlock();
            const double part = count == 0 ? 1 : double(finished) / double(count);
            if (!options.progress(share.before + share.of_step * part)) stop = true;
            lock.lock();
        }
    }
    if (failure) std::rethrow_exception(failure);
    return !stop;
}

// By piece: whether it sends light, by itself or with bounces.
std::vector<char> shining_pieces(const Boundary& boundary, bool reflecting) {
    std::vector<char> shining;
    for (const Piece& piece : boundary.pieces()) {
        const Material& material = boundary.material_of(piece);
        shining.push_back(material.shines() ||
                          (reflecting && material.albedo != Colour(0)));
    }
    return shining;
}

}  // namespace

struct ExactSolver::State {
    Scene scene;
    SolveOptions options;
    Boundary boundary;
    SkyIntegral sky;
    Media media;
    DeltaLights lights;
    Problems problems;
    std::optional<Floor> floor;  // of more than an albedo
    std::optional<Elements> elements;
    bool cancelled = false;
    Share pixels_share;
    bool is_black = false;  // nothing shines
    std::vector<char> shining;
    Sweep sweep;

    State(const Scene& given, const SolveOptions& with)
        : scene(lowered(given)),
          options(with),
          boundary(scene, with.max_pieces, scene.render.bounces > 0),
          sky(scene.sky),
          media(scene, boundary),
          lights(scene, boundary, media),
          problems(boundary.problems()),
          shining(shining_pieces(boundary, false)),
          sweep(fresh_sweep()) {
        if (!media.empty() && scene.canvas.floor.has_relief())
            problems.push_back({"/canvas/floor", "not_supported_yet", "a floor with relief in a scene with translucent shapes is not supported yet"});
        if (!media.empty() && scene.render.bounces > 0)
            problems.push_back({"/render/bounces", "not_supported_yet", "light that bounces in a scene with translucent shapes is not supported yet"});
        if (!scene.canvas.floor.is_plain()) floor.emplace(scene.canvas);
        is_black =
            needs_only_shining() && std::find(shining.begin(), shining.end(), 1) == shining.end();
        if (!problems.empty() || scene.render.bounces <= 0 || is_black) return;
        shining = shining_pieces(boundary, true);
        elements.emplace(boundary, lights, options.element_length_px * scene.canvas.pixel_size());
        reflect_all();
    }

    // The sky, delta lights and media ask what every direction meets; emitters only where they can be
    // seen.
    bool needs_only_shining() const { return sky.is_black() && lights.empty() && media.empty(); }
    Sweep fresh_sweep() const { return Sweep(boundary, needs_only_shining() ? &shining : nullptr); }

    void reflect_all() {
        // Progress: gathers and pixels cost about the same. Refinement runs as many rounds as it
        // needs and grows the count of elements, so its part is a guess that never runs backwards.
        const double stride = std::max(options.stride, 1);
        const double pixels = double(scene.canvas.width) * scene.canvas.height / (stride * stride);
        const int bounces = scene.render.bounces;
        const Refinement refinement{5, options.element_length_px * scene.canvas.pixel_size() / 32,
                                    3e-5};
        const double rounds = bounces + refinement.rounds;
        const double gathers = 1.5 * double(elements->count()) * rounds;
        const double part = gathers / std::max(pixels + gathers, 1.0);
        pixels_share = {part, 1 - part};
        int round = 0;
        cancelled =
            !reflect(*elements, boundary, sky, lights, bounces,
                     scene.render.converged ? scene.render.tolerance : 0, refinement,
                     [&](std::size_t count, const std::function<void(std::size_t, Sweep&)>& body) {
                         const Share share{part * round / rounds, part / rounds};
                         ++round;
                         return run_parallel(fresh_sweep(), count, options, share, body);
                     });
    }

    Gather gather() const { return {boundary, sky, elements ? &*elements : nullptr}; }

    static constexpr Point forward() { return {1, 0}; }

    Colour fluence(Point p, const std::vector<Interval>& seen) const {
        return media.empty() ? gather().fluence(p, seen) : media.fluence(p, seen, sky);
    }

    Colour mean_radiance(Point p, Sweep& with) const {
        if (is_black) return Colour(0);
        const auto& seen = with.look(p, forward(), 0, false);
        return fluence(p, seen) / (2 * std::numbers::pi);
    }

    // What a free pixel holds, and from how many intervals of direction.
    Colour value(Point p, Sweep& with, std::size_t& intervals) const {
        if (is_black) return Colour(0);
        const auto& seen = with.look(p, forward(), 0, false);
        intervals = seen.size();
        if (floor) {
            const Gather::Moments m = media.empty() ? gather().moments(p, seen) : Gather::Moments{fluence(p, seen), Colour(0), Colour(0)};
            const double turn = 2 * std::numbers::pi;
            const FloorPlace place = floor->at(p);
            Colour sum = floor->lit_by(place, {m.mean / turn, m.x / turn, m.y / turn});
            if (!lights.empty()) sum += lights.on_floor(*floor, place, p, forward(), seen);
            return sum;
        }
        Colour sum = fluence(p, seen) / (2 * std::numbers::pi);
        if (!lights.empty()) sum += lights.mean_radiance(p, forward(), seen);
        return scene.canvas.floor_albedo * sum;
    }
};

ExactSolver::ExactSolver(const Scene& scene, const SolveOptions& options)
    : state_(std::make_unique<State>(scene, options)) {}
ExactSolver::~ExactSolver() = default;
ExactSolver::ExactSolver(ExactSolver&&) noexcept = default;
ExactSolver& ExactSolver::operator=(ExactSolver&&) noexcept = default;

const Problems& ExactSolver::problems() const { return state_->problems; }
bool ExactSolver::cancelled() const { return state_->cancelled; }
bool ExactSolver::is_solid(Point p) const { return state_->boundary.is_solid(p); }
Colour ExactSolver::mean_radiance(Point p) { return state_->mean_radiance(p, state_->sweep); }

Colour ExactSolver::delta_radiance(Point p) {
    const auto& seen = state_->sweep.look(p, State::forward(), 0, false);
    return state_->lights.mean_radiance(p, State::forward(), seen);
}

Colour ExactSolver::value(Point p) {
    std::size_t intervals = 0;
    return state_->value(p, state_->sweep, intervals);
}

Solution solve(const Scene& scene, const SolveOptions& options) {
    const auto start = Clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(Clock::now() - start).count();
    };
    Solution solution;
    const ExactSolver solver(scene, options);
    const ExactSolver::State& state = *solver.state_;
    solution.problems = solver.problems();
    solution.cancelled = solver.cancelled();
    solution.pieces = state.boundary.pieces().size();
    solution.elements = state.elements ? state.elements->count() : 0;
    if (!solution.problems.empty() || solution.cancelled) {
        solution.seconds = elapsed();
        return solution;
    }
    const Canvas& canvas = scene.canvas;
    solution.image =
        ImageF(canvas.width, canvas.height, 3, std::numeric_limits<float>::quiet_NaN());
    const PixelRect shown = canvas.region_or_all();
    const Region region =
        options.region.value_or(Region{shown.x, shown.y, shown.x + shown.w, shown.y + shown.h});
    const int stride = std::max(options.stride, 1);
    const auto solved = [&](int from, int to, int limit) {
        std::vector<int> places;
        for (int i = stride / 2; i < limit; i += stride) {
            if (i >= from && i < to) places.push_back(i);
        }
        return places;
    };
    const std::vector<int> columns = solved(region.x0, region.x1, canvas.width);
    const std::vector<int> rows = solved(region.y0, region.y1, canvas.height);
    const ViewRect view = canvas.view_or_default();
    std::atomic<std::uint64_t> intervals{0};
    const bool complete =
        run_parallel(state.fresh_sweep(), rows.size(), options, state.pixels_share,
                     [&](std::size_t row, Sweep& sweep) {
                         const int y = rows[row];
                         std::uint64_t in_row = 0;
                         for (const int x : columns) {
                             const Point p{view.x + (x + 0.5) * view.w / canvas.width,
                                           view.y + (y + 0.5) * view.h / canvas.height};
                             if (state.boundary.is_solid(p)) continue;
                             std::size_t in_pixel = 0;
                             const Colour value = state.value(p, sweep, in_pixel);
                             in_row += in_pixel;
                             float* pixel = solution.image.at(x, y);
                             for (int c = 0; c < 3; ++c) pixel[c] = float(value[c]);
                         }
                         intervals += in_row;
                     });
    if (canvas.region) {
        ImageF part(shown.w, shown.h, 3);
        for (int y = 0; y < shown.h; ++y) {
            std::copy_n(solution.image.at(shown.x, shown.y + y), std::size_t(3) * std::size_t(shown.w), part.at(0, y));
        }
        solution.image = std::move(part);
    }
    solution.cancelled = !complete;
    solution.intervals = intervals;
    solution.seconds = elapsed();
    return solution;
}

Colour mean_radiance_at(const Scene& scene, Point p) { return ExactSolver(scene).mean_radiance(p); }

}  // namespace penumbra::reference
