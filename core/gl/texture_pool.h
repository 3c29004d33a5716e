// SPDX-License-Identifier: MIT
// Textures kept between frames: making one costs a device up to milliseconds, and renders of one size need the same ones
// again.
#pragma once

#include <cstddef>
#include <vector>

#include "core/gl/handles.h"

namespace penumbra::gl {

class TexturePool {
public:
    // Keeps at most this many bytes and kMostTextures; the longest unused go first.
    explicit TexturePool(std::size_t most_bytes) : most_bytes_(most_bytes) {}

    // One that was given back with the same format, size and filter, contents as they were left; else a new one.
    Texture2D take(GLenum internal_format, glm::ivec2 size, Filter filter = Filter::nearest);
    void give(Texture2D texture);

    std::size_t bytes() const { return bytes_; }
    std::size_t count() const { return free_.size(); }

    // A texture takes some kilobytes beside its texels, and each is looked at when one is taken.
    static constexpr std::size_t kMostTextures = 128;
    // What is smaller is made as quickly as it is found.
    static constexpr std::size_t kLeastBytes = 1024;

private:
    std::size_t most_bytes_;
    std::size_t bytes_ = 0;
    std::vector<Texture2D> free_;  // the longest unused first
};

}  // namespace penumbra::gl
