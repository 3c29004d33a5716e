// SPDX-License-Identifier: MIT
// What a render will take, told before it runs: amounts of work that follow from its plan, times what a unit of each was measured
// to take of a processor (docs/decisions/0062). Pure arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <glm/ext/vector_int2.hpp>

#include "core/plan/device_limits.h"
#include "core/scene/scene.h"

namespace penumbra {

// Kinds of work. Their names are those of GET /v1/estimate's `work`.
enum class Work : std::size_t {
    render,         // one: what every render takes
    grid_pixels,    // distances, of the domain
    flood_pixels,   // jump flooding, of every step
    shape_edges,    // on the host: packing, lists
    rays,           // of rc
    fixed_rays,     // of rc_fix
    tests,          // of reference: rays times shapes
    ray_pieces,     // of hrc, with what merges them
    pixels,         // light, picture, reading back
    seen,           // of exact: pixels times the intervals that a point sees
    asked,          // of exact: pixels times intervals times pieces of outline
    pieces,         // of exact, on the host and in lists
    light_tests,    // lights without a size: pixels times lights
    bounced,        // bounces times pieces
    count_
};
constexpr std::size_t kWorkKinds = static_cast<std::size_t>(Work::count_);
const char* name_of(Work work);

struct Price {
    std::string method;
    std::string method_reason;
    glm::ivec2 size{0};
    bool planned = true;           // false: its outline is too large to be looked at before its turn, and this is a rough guess
    std::size_t device_bytes = 0;  // 0 without a plan
    std::array<double, kWorkKinds> work{};
    double cpu_ms = 0;  // of all threads of llvmpipe on the machine of docs/benchmarks.md
};

// As make_plan(): throws DeviceError when the device cannot hold the picture. Bounded, whatever the scene: some thousand edges and a
// bitmap of some hundred texels a side are planned, of more only the amounts are counted.
Price price_of(const Scene& scene, const DeviceLimits& limits);

}  // namespace penumbra
