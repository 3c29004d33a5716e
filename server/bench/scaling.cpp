// SPDX-License-Identifier: MIT
#include "server/bench/scaling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "server/bench/measure.h"
#include "server/service/version.h"

namespace penumbra {
namespace {

struct Curve {
    const char* name;
    std::vector<int> steps;
    Scene (*scene)(int);
};

std::vector<Curve> curves() {
    return {{"shapes", {1, 3, 10, 30, 100, 300, 1000, 3000, 10000}, [](int n) { return scaling_scene(n, std::min(n, 4), 512); }},
            {"canvas", {64, 128, 256, 512, 1024, 2048, 4096, 8192}, [](int side) { return scaling_scene(12, 4, side); }},
            {"emitters", {1, 3, 10, 30, 100, 300, 1000}, [](int n) { return scaling_scene(1000, n, 512); }}};
}

// Points that cost more than this together are not repeated: their spread is small.
constexpr double kRepeatedMs = 1e4;

}  // namespace

std::vector<std::string> scaling_curves() {
    std::vector<std::string> names;
    for (const Curve& curve : curves()) names.emplace_back(curve.name);
    return names;
}

Scene scaling_scene(int shapes, int emitters, int side) {
    constexpr double kView = 1000;
    constexpr double kCovered = 0.1;
    Scene scene;
    scene.canvas.width = scene.canvas.height = side;
    scene.canvas.view = ViewRect{0, 0, kView, kView};
    const double radius = kView * std::sqrt(kCovered / (std::numbers::pi * shapes));
    for (int i = 0; i < shapes; ++i) {
        // Two-dimensional golden ratio (Roberts 2018): spread evenly, without a grid.
        const double x = std::fmod(0.5 + (i + 1) * 0.7548776662466927, 1.0);
        const double y = std::fmod(0.5 + (i + 1) * 0.5698402909980532, 1.0);
        Shape disc;
        disc.geometry = Circle{{kView * x, kView * y}, radius};
        if (i < emitters) disc.emission = Colour(4, 3, 2);
        scene.shapes.push_back(disc);
    }
    return scene;
}

void measure_scaling(const ScalingSettings& settings, RenderBackend& backend, const Engine& engine,
                     const std::function<void(const std::string& row)>& tell) {
    for (const Curve& curve : curves()) {
        const auto& wanted = settings.curves;
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), curve.name) == wanted.end()) continue;
        for (const std::string& method : settings.methods) {
            double spent_ms = 0;
            for (const int step : curve.steps) {
                if (spent_ms > 1e3 * settings.most_seconds) break;
                Scene scene = curve.scene(step);
                scene.render.method = method;
                scene.render.quality = settings.quality == "draft" ? Quality::draft : settings.quality == "high" ? Quality::high : Quality::standard;
                if (!engine.unsupported_with({})(scene).empty()) continue;
                std::vector<double> cpu;
                RenderStats stats;
                try {
                    // The first renders of a process and of a kind of scene compile: a second or two, nothing beside long ones.
                    const int first_renders = step == curve.steps.front() ? 3 : spent_ms > kRepeatedMs ? 0 : 1;
                    for (int i = 0; i < first_renders; ++i) backend.render(scene, {});
                    double together_ms = 0;
                    for (int i = 0; i < settings.repeats && together_ms < kRepeatedMs; ++i) {
                        const double start = process_cpu_ms();
                        stats = backend.render(scene, {}).stats;
                        cpu.push_back(process_cpu_ms() - start);
                        together_ms += cpu.back();
                    }
                } catch (const std::exception& refused) {
                    tell(nlohmann::ordered_json({{"curve", curve.name}, {"step", step}, {"method", method}, {"refused", refused.what()}}).dump());
                    break;
                }
                spent_ms = median(cpu);
                const Work work = work_of(stats);
                tell(nlohmann::ordered_json({{"curve", curve.name}, {"step", step}, {"method", method}, {"ran", stats.method},
                                             {"quality", settings.quality}, {"cpu_ms", spent_ms}, {"rays", work.rays},
                                             {"points", work.points}, {"dispatches", work.dispatches},
                                             {"invocations", work.invocations}, {"gpu_bytes", stats.gpu_bytes},
                                             {"renderer", stats.device}, {"version", version()}}).dump());
            }
        }
    }
}

}  // namespace penumbra
