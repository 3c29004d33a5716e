// SPDX-License-Identifier: MIT
#include "tests/stability/judge.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <variant>

#include <glm/common.hpp>

#include "core/compare/error_figures.h"
#include "core/reference/solver.h"
#include "tests/support/pictures.h"

namespace penumbra::test {

ImageF truth_of(const Scene& scene, int stride) {
    reference::SolveOptions options;
    options.stride = stride;
    options.threads = 1;
    reference::Solution solution = reference::solve(scene, options);
    if (!solution.problems.empty()) throw std::logic_error(solution.problems.front().message);
    return std::move(solution.image);
}

Colour brightest_source(const Scene& scene) {
    Colour most = scene.sky.gradient.empty() ? scene.sky.radiance : Colour(0);
    for (const SkyStop& stop : scene.sky.gradient) most = glm::max(most, stop.radiance);
    for (const Shape& shape : scene.shapes) {
        const auto* bitmap = std::get_if<Bitmap>(&shape.geometry);
        if (bitmap == nullptr) {
            most = glm::max(most, shape.emission);
        } else if (!bitmap->as_albedo) {
            for (std::size_t i = 0; i + 3 < bitmap->image->rgba.size(); i += 4)
                for (int c = 0; c < 3; ++c)
                    most[c] = std::max(most[c], bitmap->emission_scale * srgb_decode(bitmap->image->rgba[i + std::size_t(c)]));
        }
    }
    return most;
}

std::string impossible(const Scene& scene, const ImageF& picture) {
    const Colour most = brightest_source(scene);
    for (std::size_t i = 0; i < picture.data.size(); ++i) {
        const float value = picture.data[i];
        const double above = most[static_cast<int>(i % 3)] * (1 + 1e-5) + 1e-37;
        if (std::isfinite(value) && !std::signbit(value) && value <= above) continue;
        std::ostringstream text;
        const std::size_t pixel = i / 3;
        text << value << " at " << pixel % std::size_t(picture.width) << ", " << pixel / std::size_t(picture.width)
             << " where the brightest source has " << most[static_cast<int>(i % 3)];
        return text.str();
    }
    return {};
}

Off off_by(const Scene& scene, const ImageF& picture, const ImageF& truth) {
    const auto figures = error_figures(picture, truth);
    const auto* e = std::get_if<ErrorFigures>(&figures);
    if (e == nullptr) throw std::logic_error(std::get<Problem>(figures).message);
    Off off{e->rel.value_or(0), e->max.value_or(0), std::abs(e->bias.value_or(0)), e->leak.value_or(0), e->nrmse.value_or(0)};
    const Colour most = brightest_source(scene);
    const double peak = std::max({most.r, most.g, most.b});
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < truth.data.size(); ++i)
        if (std::isfinite(truth.data[i])) sum += std::abs(double(picture.data[i]) - double(truth.data[i])), ++count;
    if (peak > 0 && count > 0) off.of_peak = sum / double(count) / peak;
    if (peak > 0) off.max_of_peak = e->max_abs.value_or(0) / peak;
    return off;
}

Apart apart(const ImageF& a, const ImageF& b) {
    double mean_b = 0;
    std::size_t count = 0;
    const auto both = [&](std::size_t i) { return std::isfinite(a.data[i]) && std::isfinite(b.data[i]); };
    for (std::size_t i = 0; i < b.data.size(); ++i)
        if (both(i)) mean_b += double(b.data[i]), ++count;
    Apart result;
    if (count == 0 || mean_b <= 0) return result;
    mean_b /= double(count);
    for (std::size_t i = 0; i < b.data.size(); ++i) {
        if (!both(i)) continue;
        const double d = std::abs(double(a.data[i]) - double(b.data[i]));
        result.rel += d / (double(b.data[i]) + 0.05 * mean_b) / double(count);
        result.max = std::max(result.max, d / mean_b);
    }
    return result;
}

}  // namespace penumbra::test
