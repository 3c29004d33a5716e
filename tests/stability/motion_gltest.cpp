// SPDX-License-Identifier: MIT
// A lamp that moves on by a sixteenth of a pixel a frame: the picture may change by what the light changes by, no more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/stability/judge.h"
#include "tests/stability/ledger.h"
#include "tests/stability/scenes.h"
#include "tests/support/build_scene.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

TEST(Motion, ALampThatGlidesDoesNotPop) {
    const int frames = 65;
    const int films = scale() > 1 ? 3 : 1;
    for (int film = 0; film < films; ++film) {
        const Point way_on = film == 0 ? Point(1, 0.37) : film == 1 ? Point(0, 1) : Point(-0.6, 0.8);
        const double radius = film == 2 ? 1.1 : 3.2;
        std::vector<ImageF> before(main_ways().size());
        ImageF truth_before;
        std::vector<double> most_step(main_ways().size(), 0.0), step_sum(main_ways().size(), 0.0);
        double truth_step = 0;
        for (int frame = 0; frame < frames; ++frame) {
            Scene scene = canvas(56, 48);
            scene.shapes = {shape(Circle{Point(24.1, 14.3) + way_on * (frame / 16.0), radius}, Colour(1)), shape(Rect{{30.2, 27.3}, {12, 1.5}, 20, 0}),
                            shape(Circle{{14.3, 30.2}, 4}), shape(Line{{42.3, 30.1}, {45.2, 43.3}, 0.8})};
            const ImageF truth = truth_of(scene);
            double mean = 0;
            std::size_t count = 0;
            for (const float v : truth.data)
                if (std::isfinite(v)) mean += double(v), ++count;
            mean /= double(count);
            for (std::size_t k = 0; k < main_ways().size(); ++k) {
                ImageF picture = render_linear(as(scene, main_ways()[k]));
                if (frame > 0) {
                    // Pixels that the lamp's outline crosses are left out: there the truth itself jumps.
                    double most = 0, sum = 0, own = 0;
                    for (std::size_t i = 0; i < picture.data.size(); ++i) {
                        if (!std::isfinite(truth.data[i]) || !std::isfinite(truth_before.data[i])) continue;
                        const double change = double(picture.data[i]) - double(before[k].data[i]);
                        const double due = double(truth.data[i]) - double(truth_before.data[i]);
                        most = std::max(most, std::abs(change - due) / mean);
                        sum += std::abs(change - due);
                        own += std::abs(due);
                    }
                    const std::string what = "film " + std::to_string(film) + ", frame " + std::to_string(frame);
                    hold("motion", main_ways()[k], "largest pop / mean", most, what);
                    hold("motion", main_ways()[k], "undue change / due change", sum / own, what);
                    if (film == 0) plot("undue change over frames", to_string(main_ways()[k]), frame, sum / own);
                    step_sum[k] += sum;
                    if (k == 0) truth_step += own;
                }
                before[k] = std::move(picture);
            }
            truth_before = truth;
        }
    }
}

}  // namespace
}  // namespace penumbra::test
