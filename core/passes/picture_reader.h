// SPDX-License-Identifier: MIT
// The composed picture from the device, band by band.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/gl/handles.h"
#include "core/image/image.h"

namespace penumbra {

using Pixels = std::variant<Image8, Image16, ImageF>;

// Collects the bands of the picture, without their alpha.
class Reader {
public:
    Reader(glm::ivec2 size, GLenum format) {
        if (format == GL_RGBA32F)
            picture_ = ImageF(size.x, size.y, 3);
        else if (format == GL_RGBA16)
            picture_ = Image16(size.x, size.y, 3);
        else
            picture_ = Image8(size.x, size.y, 3);
    }

    void read(const gl::Texture2D& band, int first_row) {
        std::visit([&](auto& picture) { read_into(picture, band, first_row); }, picture_);
    }

    Pixels take() { return std::move(picture_); }

private:
    template <class T>
    static void read_into(BasicImage<T>& picture, const gl::Texture2D& band, int first_row) {
        const glm::ivec2 size = band.size();
        BasicImage<T> rgba(size.x, size.y, 4);
        band.read(GL_RGBA, kType<T>, rgba.data.data());
        const std::size_t count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
        const T* from = rgba.data.data();
        T* to = picture.at(0, first_row);
        for (std::size_t i = 0; i < count; ++i, from += 4, to += 3) {
            to[0] = from[0];
            to[1] = from[1];
            to[2] = from[2];
        }
    }

    template <class T>
    static constexpr GLenum kType = std::is_same_v<T, float> ? GL_FLOAT : sizeof(T) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE;

    Pixels picture_;
};

// A picture of one pixel, as large as this.
template <class T>
BasicImage<T> filled(const BasicImage<T>& pixel, glm::ivec2 size) {
    BasicImage<T> picture(size.x, size.y, pixel.channels);
    if (std::all_of(pixel.data.begin(), pixel.data.end(), [](T value) { return value == T(0); })) return picture;
    const std::size_t row = static_cast<std::size_t>(size.x) * pixel.data.size();
    for (std::size_t i = 0; i < row; i += pixel.data.size()) std::copy(pixel.data.begin(), pixel.data.end(), picture.data.begin() + static_cast<std::ptrdiff_t>(i));
    for (int y = 1; y < size.y; ++y) std::copy_n(picture.at(0, 0), row, picture.at(0, y));
    return picture;
}

}  // namespace penumbra
