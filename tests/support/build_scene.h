// SPDX-License-Identifier: MIT
// Scenes as short expressions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "core/scene/scene.h"

namespace penumbra::test {

inline Scene canvas(int width, int height, const char* format = "pfm") {
    Scene scene;
    scene.canvas.width = width;
    scene.canvas.height = height;
    scene.output.format = format;
    return scene;
}

// The cascades whose errors the tests of light, symmetry and closed forms bound; other methods have tests of their own.
inline Scene rc_canvas(int width, int height) {
    Scene scene = canvas(width, height);
    scene.render.method = "rc";
    return scene;
}

inline Shape shape(Geometry geometry, Colour emission = Colour(0)) {
    Shape result;
    result.geometry = std::move(geometry);
    result.emission = emission;
    return result;
}

inline Scene with(Scene scene, std::initializer_list<Shape> shapes) {
    for (const Shape& one : shapes) scene.shapes.push_back(one);  // insert() makes GCC 12 warn wrongly
    return scene;
}

// A picture of `width` x `height` texels: white where `solid` says so, transparent elsewhere.
template <class Solid>
std::shared_ptr<const Texels> picture(int width, int height, Solid solid) {
    auto texels = std::make_shared<Texels>();
    texels->width = width;
    texels->height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 4; ++c) texels->rgba.push_back(solid(x, y) ? 255 : 0);
    return texels;
}

// Pseudo-random numbers in [0, 1), the same on every machine.
class Numbers {
public:
    explicit Numbers(std::uint64_t seed) : state_(seed * 2 + 1) {}
    double next() {
        state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
        return double(state_ >> 11) / double(1ull << 53);
    }
    double between(double lo, double hi) { return lo + (hi - lo) * next(); }

private:
    std::uint64_t state_;
};

}  // namespace penumbra::test
