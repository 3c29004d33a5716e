// SPDX-License-Identifier: MIT
#include "core/error_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/device_error.h"
#include "core/reference/solver.h"
#include "core/views/light_views.h"

namespace penumbra {
namespace {

constexpr int kPoints = 128;  // along the longer side, at most
constexpr double kLow = 1e-4, kHigh = 1;
constexpr std::size_t kMostPieces = 20'000;

}  // namespace

Scene as_compared(const Scene& scene) {
    Scene result = scene;
    result.render.view = "final";
    result.output = {};
    result.output.format = "pfm";
    return result;
}

Image8 draw_error(const Scene& scene, const ImageF& picture, const std::string& method, const StopCheck& stop) {
    const PixelRect shown = scene.canvas.region_or_all();
    reference::SolveOptions options;
    options.stride = std::max((std::max(shown.w, shown.h) + kPoints - 1) / kPoints, 1);
    options.element_length_px = 2;
    options.max_pieces = kMostPieces;
    options.progress = [&](double) { return !stop || !stop(); };
    const reference::Solution truth = reference::solve(as_compared(scene), options);
    if (truth.cancelled) throw RenderStopped();
    if (!truth.problems.empty()) throw DeviceError("The view 'error' needs the exact solver, which refuses this scene: " + truth.problems.front().message);
    double mean = 0;
    std::size_t count = 0;
    for (const float value : truth.image.data)
        if (!std::isnan(value)) mean += double(value), ++count;
    mean /= double(std::max<std::size_t>(count, 1));
    // As docs/methods/light-transport.md defines it, over the channels of a pixel.
    const auto error_at = [&](int x, int y) {
        const float* a = picture.at(x, y);
        const float* b = truth.image.at(x, y);
        if (std::isnan(b[0])) return std::numeric_limits<float>::quiet_NaN();
        double sum = 0;
        for (int c = 0; c < 3; ++c) sum += std::abs(double(a[c]) - double(b[c])) / std::max(double(b[c]) + 0.05 * mean, 1e-30);
        return static_cast<float>(sum / 3);
    };
    HeatField field{{shown.w, shown.h}, {}};
    double all = 0;
    std::size_t solved = 0;
    for (int y = 0; y < shown.h; ++y)
        for (int x = 0; x < shown.w; ++x) {
            // The solved pixel of its square of the canvas.
            const auto middle = [&](int at, int first, int size) {
                return std::clamp((at + first) / options.stride * options.stride + options.stride / 2 - first, 0, size - 1);
            };
            const int u = middle(x, shown.x, shown.w), v = middle(y, shown.y, shown.h);
            const float error = error_at(u, v);
            field.values.push_back(error);
            if (u == x && v == y && !std::isnan(error)) all += double(error), ++solved;
        }
    char text[64];
    std::snprintf(text, sizeof text, "mean: %.3g", all / double(std::max<std::size_t>(solved, 1)));
    return draw_log_heat(field, kLow, kHigh, method + ": error, relative", text);
}

}  // namespace penumbra
