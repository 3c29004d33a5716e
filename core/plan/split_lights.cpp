// SPDX-License-Identifier: MIT
#include "core/plan/split_lights.h"

#include <algorithm>
#include <cmath>

#include "core/plan/look.h"
#include "core/plan/survey.h"
#include "core/reference/boundary.h"

namespace penumbra {

namespace {

using reference::Piece;

struct Lamp {
    int shape = 0;
    double power = 0;  // radiance times length
    reference::Box box;
    // About its radiance: what sampling errs by does not depend on a lamp's size, since a ray meets it or does not.
    double weight(double least_extent) const {
        return power / std::max({box.high.x - box.low.x, box.high.y - box.low.y, least_extent});
    }
};

// In world units; of an arc, by chords.
double length_of(const Piece& piece) {
    const int chords = piece.is_arc ? 32 : 1;
    double length = 0;
    for (int i = 0; i < chords; ++i) {
        const auto at = [&](int k) { return piece.at(piece.t0 + (piece.t1 - piece.t0) * k / chords); };
        length += std::sqrt(reference::length_squared(at(i + 1) - at(i)));
    }
    return length;
}

}  // namespace

LightSplit split_lights(const Scene& scene, std::size_t most_pieces) {
    LightSplit split;
    const reference::Boundary boundary(scene, most_pieces, false);
    if (!boundary.problems().empty()) return split;
    const auto shape_of = [&](const Piece& piece) { return boundary.bodies()[static_cast<std::size_t>(piece.body)].shape; };
    std::vector<Lamp> lamps(scene.shapes.size());
    for (const Piece& piece : boundary.pieces()) {
        const reference::Material& material = boundary.material_of(piece);
        if (!material.shines()) continue;
        Lamp& lamp = lamps[static_cast<std::size_t>(shape_of(piece))];
        lamp.shape = shape_of(piece);
        lamp.power += (material.emission.r + material.emission.g + material.emission.b) / 3 * length_of(piece);
        const reference::Box box = piece.box();
        lamp.box.add(box.low);
        lamp.box.add(box.high);
    }
    std::erase_if(lamps, [](const Lamp& lamp) { return !(lamp.power > 0); });
    split.lamps = lamps.size();
    if (lamps.empty()) return split;
    const auto weight = [&](const Lamp& lamp) { return lamp.weight(boundary.tolerance()); };
    // Strongest first; of equals, those drawn first, so that the same scene is always split the same way.
    std::stable_sort(lamps.begin(), lamps.end(), [&](const Lamp& a, const Lamp& b) { return weight(a) > weight(b); });
    double all = 0;
    for (const Lamp& lamp : lamps) all += weight(lamp);
    const auto cost_of = [&](std::size_t count) {
        std::vector<char> solved(scene.shapes.size()), shining;
        for (std::size_t i = 0; i < count; ++i) solved[static_cast<std::size_t>(lamps[i].shape)] = 1;
        for (const Piece& piece : boundary.pieces())
            shining.push_back(boundary.material_of(piece).shines() && solved[static_cast<std::size_t>(shape_of(piece))] != 0);
        return survey_intervals(scene, boundary, &shining) * double(boundary.pieces().size());
    };
    const double most = most_solved_cost(scene.render.quality);
    const double most_of_all = 0.5 * most;
    std::size_t count = lamps.size();
    // A survey of all takes time where there is much, and finds three intervals or more.
    double cost = 3 * double(boundary.pieces().size()) <= most_of_all ? cost_of(count) : 2 * most;
    if (cost > most_of_all) {
        count = 1;
        for (double solved = weight(lamps[0]); count < lamps.size() && solved < least_solved_share() * all; ++count) solved += weight(lamps[count]);
        cost = cost_of(count);
        while (cost > most && count > 1) {
            count /= 2;
            cost = cost_of(count);
        }
    }
    split.cost = cost;
    for (std::size_t i = 0; i < count; ++i) {
        split.solved.push_back(lamps[i].shape);
        split.share += weight(lamps[i]) / all;
    }
    return split;
}

double most_solved_cost(Quality quality) { return quality == Quality::high ? 100'000 : 50'000; }

double least_solved_share() { return 0.8; }

Scene solved_part(const Scene& scene, const std::vector<int>& solved) {
    Scene part = scene;
    for (Shape& shape : part.shapes) darken(shape);
    for (const int i : solved) part.shapes[static_cast<std::size_t>(i)] = scene.shapes[static_cast<std::size_t>(i)];
    part.sky = {};
    part.lights.clear();
    return part;
}

Scene sampled_part(const Scene& scene, const std::vector<int>& solved) {
    Scene part = scene;
    for (const int i : solved) darken(part.shapes[static_cast<std::size_t>(i)]);
    return part;
}

}  // namespace penumbra
