// SPDX-License-Identifier: MIT
// What the stability suite measures: figures held under the bounds of bounds.json, of which the worst and the scene that gave
// it are kept for docs/stability.md, and points of plots.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace penumbra::test {

// A method at a quality.
struct Way {
    std::string method;
    Quality quality = Quality::standard;
};
std::string to_string(const Way& way);  // "exact high"
Scene as(Scene scene, const Way& way);

const std::vector<Way>& all_ways();   // every method and quality; of the brute force, draft alone
const std::vector<Way>& main_ways();  // every method at standard; exact at every quality

// Notes that this law, rendered this way, was off by `value` in this scene, and expects it to be within the bound of
// bounds.json. Zero bounds are laws that hold exactly.
void hold(const std::string& law, const Way& way, const std::string& figure, double value, const std::string& scene);
// The same for what no method is asked: `who` says what.
void hold(const std::string& law, const std::string& who, const std::string& figure, double value, const std::string& scene);
// A point of a plot.
void plot(const std::string& name, const std::string& line, double x, double y);

// How many times the scenes of the quick form: PENUMBRA_STABILITY_SCALE, 1 unless set. The nightly form is 10.
int scale();

}  // namespace penumbra::test
