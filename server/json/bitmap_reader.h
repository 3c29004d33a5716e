// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "core/scene/limits.h"
#include "server/json/value_reader.h"

namespace penumbra {

// Decodes the pictures of a scene, which share one budget of texels.
class BitmapReader {
public:
    BitmapReader(ValueReader& reader, const Limits& limits)
        : reader_(reader), limits_(limits), texels_left_(limits.max_bitmap_texels) {}

    // The picture in the data URL at `id`; nullptr when there is a problem with it.
    std::shared_ptr<const Texels> read(const Path& where, NodeId id);

private:
    ValueReader& reader_;
    const Limits& limits_;
    double texels_left_;
};

}  // namespace penumbra
