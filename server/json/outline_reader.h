// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/outline/rings.h"
#include "core/scene/limits.h"
#include "server/json/font_source.h"
#include "server/json/value_reader.h"

namespace penumbra {

// Paths and texts: what they draw, as polygons. What is wrong with them is reported here, since the scene has only what comes of them.
class OutlineReader {
public:
    OutlineReader(ValueReader& reader, const Limits& limits, const FontSource& fonts);

    // Of the canvas, in world units: curves become edges as fine as it asks for.
    void set_pixel_size(double size);

    Polygon path(const Path& where, NodeId id, Shape& shape);
    Polygon text(const Path& where, NodeId id, Shape& shape);

private:
    bool is_length(const Path& where, NodeId id, double value);
    std::size_t choice(const Members& members, const Path& where, std::string_view key, std::span<const std::string_view> words);
    Polygon drawn(const Path& where, NodeId id, std::vector<Ring> rings, bool nonzero, double scale, Point position, OutlineKey key);
    Polygon nothing(const Path& where, OutlineKey key);

    ValueReader& reader_;
    const Limits& limits_;
    const FontSource& fonts_;
    double tolerance_ = 0.05;  // world units
    CrossingWork work_;        // left for all outlines
    std::size_t points_ = 0;   // of those that were read
    bool too_many_ = false;    // of these
};

}  // namespace penumbra
