// SPDX-License-Identifier: MIT
#include "core/gl/texture_pool.h"

#include <algorithm>

namespace penumbra::gl {

Texture2D TexturePool::take(GLenum internal_format, glm::ivec2 size, Filter filter) {
    const auto found = std::find_if(free_.rbegin(), free_.rend(), [&](const Texture2D& t) {
        return t.format() == internal_format && t.size() == size && t.filter() == filter;
    });
    if (found == free_.rend()) return Texture2D(internal_format, size, filter);
    Texture2D texture = std::move(*found);
    free_.erase(std::next(found).base());
    bytes_ -= texture.bytes();
    return texture;
}

void TexturePool::give(Texture2D texture) {
    if (!texture || texture.bytes() < kLeastBytes || texture.bytes() > most_bytes_) return;
    bytes_ += texture.bytes();
    free_.push_back(std::move(texture));
    while (bytes_ > most_bytes_ || free_.size() > kMostTextures) {
        bytes_ -= free_.front().bytes();
        free_.erase(free_.begin());
    }
}

}  // namespace penumbra::gl
