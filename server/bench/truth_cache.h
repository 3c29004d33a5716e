// SPDX-License-Identifier: MIT
// Exact solutions, kept on disk under the hash of the scene that they solve.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/image/image.h"
#include "core/scene/scene.h"

namespace penumbra {

// FNV-1a, 64 bits: for file names, not against adversaries.
std::uint64_t hash_text(std::string_view text, std::uint64_t seed = 14695981039346656037ull);
std::string hex(std::uint64_t value);

struct Truth {
    ImageF image;
    double seconds = 0;  // that solving took, now or then
    std::string hash;
};

class TruthCache {
public:
    explicit TruthCache(std::string folder);  // made when the first truth is written

    // `identity` is what the light depends on: the scene's text and its overrides. Throws std::runtime_error when the
    // solver refuses the scene or the folder cannot be written.
    Truth get(const Scene& scene, const std::string& identity, int stride,
              const std::function<bool(double)>& progress) const;

private:
    std::string folder_;
};

}  // namespace penumbra
