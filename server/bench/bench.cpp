// SPDX-License-Identifier: MIT
#include "server/bench/bench.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "core/compare/error_figures.h"
#include "server/bench/measure.h"
#include "server/cli/files.h"
#include "server/service/version.h"

namespace penumbra {
namespace {

using nlohmann::ordered_json;

ordered_json rounded(double value, double step) { return std::round(value / step) * step; }

ordered_json spread(const std::vector<double>& values) {
    return {{"median", rounded(median(values), 1e-4)},
            {"min", rounded(*std::min_element(values.begin(), values.end()), 1e-4)},
            {"max", rounded(*std::max_element(values.begin(), values.end()), 1e-4)}};
}

std::string brief_name(const std::string& path) { return std::filesystem::path(path).stem().string(); }

// The scene at another size: the same view, other pixels. The view's height gives way by less than a pixel where the
// proportions do not divide.
std::vector<Override> resize(const Scene& scene, int size) {
    const ViewRect view = scene.canvas.view_or_default();
    const int height = std::max(1, static_cast<int>(std::lround(double(size) * scene.canvas.height / scene.canvas.width)));
    const ordered_json box = {view.x, view.y, view.w, view.w * height / size};
    return {{"/canvas/width", std::to_string(size)}, {"/canvas/height", std::to_string(height)}, {"/canvas/view", box.dump()}};
}

ordered_json error_json(const ErrorFigures& e) {
    const auto number = [](const std::optional<double>& v) { return v ? ordered_json(*v) : ordered_json(nullptr); };
    return {{"nrmse", number(e.nrmse)}, {"rel", number(e.rel)}, {"p99", number(e.p99)}, {"max", number(e.max)},
            {"bias", number(e.bias)}, {"leak", number(e.leak)}, {"rmse", number(e.rmse)}, {"max_abs", number(e.max_abs)},
            {"nan_only_a", e.nan_only_a}, {"count", e.count}};
}

// Medians over the repeats, pass by pass.
ordered_json pass_json(const std::vector<RenderStats>& runs) {
    ordered_json passes = ordered_json::array();
    for (std::size_t i = 0; i < runs.front().passes.size(); ++i) {
        const PassStats& first = runs.front().passes[i];
        std::vector<double> gpu;
        std::vector<double> wall;
        for (const RenderStats& run : runs) {
            gpu.push_back(run.passes[i].gpu_ms);
            wall.push_back(run.passes[i].wall_ms);
        }
        passes.push_back({{"name", first.name}, {"gpu_ms", rounded(median(gpu), 1e-4)}, {"wall_ms", rounded(median(wall), 1e-4)},
                          {"width", first.width}, {"height", first.height}, {"dispatches", first.dispatches}, {"rays", first.rays}});
    }
    return passes;
}

ordered_json counters(const RenderStats& stats) {
    const Work work = work_of(stats);
    return {{"rays", work.rays}, {"points", work.points}, {"dispatches", work.dispatches}, {"invocations", work.invocations}};
}

}  // namespace

std::string case_key(const BenchCase& c, const DeviceInfo& device) {
    const std::string text = read_text(c.scene, std::size_t(64) << 20);
    return brief_name(c.scene) + "|" + hex(hash_text(text)) + "|" + std::to_string(c.size) + "|" + c.method + "|" + c.quality +
           "|" + device.renderer + "|" + device.gl_version + "|" + version();
}

std::set<std::string> finished_cases(const std::string& path) {
    std::set<std::string> keys;
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        const auto row = nlohmann::json::parse(line, nullptr, false);
        if (row.is_object() && row.contains("key")) keys.insert(row["key"].get<std::string>());
    }
    return keys;
}

std::string run_case(const BenchCase& c, const BenchSettings& settings, RenderBackend& backend, const Engine& engine,
                     const TruthCache& truths, const std::function<bool(double)>& progress) {
    const std::string text = read_text(c.scene, std::size_t(64) << 20);
    std::vector<Override> overrides;
    if (c.size > 0) overrides = resize(bench_scene(c.scene, text, {}), c.size);
    // What the light depends on, before the method enters.
    std::string identity = text;
    for (const Override& o : overrides) identity += "\n" + o.pointer + "=" + o.value;
    overrides.push_back({"/render/method", c.method});
    overrides.push_back({"/render/quality", c.quality});
    overrides.push_back({"/output/format", "pfm"});
    const Scene scene = bench_scene(c.scene, text, overrides);
    for (const Problem& problem : engine.unsupported_with({})(scene)) throw std::runtime_error(problem.pointer + ": " + problem.message);

    for (int i = 0; i < settings.warm_up; ++i) backend.render(scene, {});
    std::vector<RenderStats> runs;
    std::vector<double> wall;
    std::vector<double> gpu;
    std::vector<double> cpu;
    ImageF picture;
    double spent_ms = 0;
    for (int i = 0; i < settings.repeats && (i < 3 || spent_ms < 1e3 * settings.most_seconds); ++i) {
        const auto start = std::chrono::steady_clock::now();
        const double cpu_start = process_cpu_ms();
        RenderResult result = backend.render(scene, {});
        cpu.push_back(process_cpu_ms() - cpu_start);
        wall.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        spent_ms += wall.back();
        double device_ms = 0;
        for (const PassStats& pass : result.stats.passes) device_ms += pass.gpu_ms;
        gpu.push_back(device_ms);
        picture = std::move(std::get<ImageF>(result.picture));
        runs.push_back(std::move(result.stats));
    }

    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const DeviceInfo& device = backend.device();
    ordered_json row = {{"key", case_key(c, device)}, {"scene", brief_name(c.scene)}, {"width", scene.canvas.width},
                        {"height", scene.canvas.height}, {"method", c.method}, {"quality", c.quality},
                        {"ran", runs.front().method}, {"device", device.kind}, {"renderer", device.renderer},
                        {"driver", device.gl_version}, {"version", version()}, {"repeats", runs.size()},
                        {"wall_ms", spread(wall)}, {"gpu_ms", spread(gpu)}, {"cpu_ms", spread(cpu)},
                        {"counters", counters(runs.front())}, {"gpu_bytes", runs.front().gpu_bytes},
                        {"peak_rss_kb", usage.ru_maxrss}, {"passes", pass_json(runs)}};
    if (settings.errors) {
        const int stride = std::max(1, std::max(scene.canvas.width, scene.canvas.height) / settings.truth_pixels);
        const Truth truth = truths.get(scene, identity, stride, progress);
        const auto figures = error_figures(picture, truth.image);
        if (const auto* problem = std::get_if<Problem>(&figures)) throw std::runtime_error(problem->message);
        row["errors"] = error_json(std::get<ErrorFigures>(figures));
        row["truth"] = {{"hash", truth.hash}, {"stride", stride}, {"seconds", truth.seconds}};
    }
    return row.dump();
}

}  // namespace penumbra
