// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <variant>

#include "core/image/image.h"

namespace penumbra {

using Picture = std::variant<ImageF, Image8, Image16>;

// Any picture that this program writes, told by its first bytes: PFM, EXR, HDR, NPY as linear values, PNG as RGBA codes.
// Throws InputError.
Picture read_picture(const std::string& path);

Image16 widened(const Image8& image);    // the same values in 16 bits
Image8 narrowed(const Image16& image);  // to the nearest

}  // namespace penumbra
