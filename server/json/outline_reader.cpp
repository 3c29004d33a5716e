// SPDX-License-Identifier: MIT
#include "server/json/outline_reader.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "core/outline/path_data.h"
#include "core/outline/text.h"
#include "core/scene/wording.h"
#include "server/json/material_reader.h"
#include "server/json/scene_keys.h"

namespace penumbra {

namespace {

constexpr double kUnread = std::numeric_limits<double>::quiet_NaN();
// Of all outlines of a scene: eight that each cross themselves as often as one may.
constexpr std::size_t kCrossingWork = std::size_t(1) << 19;
constexpr double kCurveTolerancePx = 0.05;  // changes the coverage of an edge pixel by a twentieth at most

}  // namespace

OutlineReader::OutlineReader(ValueReader& reader, const Limits& limits, const FontSource& fonts)
    : reader_(reader), limits_(limits), fonts_(fonts), work_{kCrossingWork} {}

void OutlineReader::set_pixel_size(double size) {
    if (size > 0 && size <= limits_.max_coordinate) {
        tolerance_ = kCurveTolerancePx * size;
    }
}

std::size_t OutlineReader::choice(const Members& members, const Path& where, std::string_view key,
                                  std::span<const std::string_view> words) {
    const NodeId id = members.find(key);
    return id == kNoNode ? 0 : reader_.choice(where.key(key), id, words).value_or(0);
}

// More than 0 and within the limit of lengths; reported here, since the scene only has what comes of it.
bool OutlineReader::is_length(const Path& where, NodeId id, double value) {
    if (value > 0 && value <= limits_.max_coordinate) {
        return true;
    }
    if (!std::isnan(value)) {
        reader_.report(where, id, "out_of_range", [&] {
            return "must be more than 0 and at most " + number_text(limits_.max_coordinate) + ", is " + number_text(value);
        });
    }
    return false;
}

// The rings by their fill rule, moved to their place.
Polygon OutlineReader::drawn(const Path& where, NodeId id, std::vector<Ring> rings, bool nonzero, double scale, Point position, OutlineKey key) {
    std::size_t points = 0;
    for (const Ring& ring : rings) {
        points += ring.size();
    }
    // Too many for the limits are told by the validation; a scene that is refused anyway is not worth the work.
    if (nonzero && points <= limits_.max_points_per_shape && !too_many_) {
        if (!reader_.problems().empty()) {
            return nothing(where, key);
        }
        auto filled = even_odd_of_nonzero(rings, 4 * limits_.max_points_per_shape, work_);
        if (!filled) {
            reader_.report(where, id, "too_many", [] { return "is too intricate: it, or it and the outlines before it, cross themselves too often"; });
            return nothing(where, key);
        }
        rings = std::move(*filled);
    }
    Polygon polygon = polygon_of(rings);
    polygon.key = key;
    points_ += polygon.points.size();
    too_many_ = too_many_ || polygon.points.size() > limits_.max_points_per_shape || points_ > limits_.max_points;
    for (Point& point : polygon.points) {
        point = position + point * scale;
    }
    return polygon;
}

// Nothing more is said about the value: what is wrong with it has been.
Polygon OutlineReader::nothing(const Path& where, OutlineKey key) {
    reader_.problems().silence(where.pointer());
    Polygon polygon;
    polygon.key = key;
    return polygon;
}

Polygon OutlineReader::path(const Path& where, NodeId id, Shape& shape) {
    const Members members(reader_, where, id, kPathKeys, "a path");
    read_material(reader_, limits_, where, members, shape);
    const bool nonzero = choice(members, where, "fill_rule", kFillRules) == 0;
    Point position(0);
    if (const NodeId at = members.find("position"); at != kNoNode) {
        position = reader_.pair(where.key("position"), at, "a point [x, y]");
    }
    double scale = 1;
    members.number("scale", scale);
    const Path d = where.key("d");
    const NodeId data = members.require("d");
    const bool scaled = is_length(where.key("scale"), members.find("scale"), scale);
    const auto letters = data == kNoNode ? std::nullopt : reader_.string(d, data);
    if (!letters || !scaled || std::isnan(position.x) || std::isnan(position.y)) {
        return nothing(d, OutlineKey::d);
    }
    auto rings = rings_of_path(*letters, tolerance_ / scale, limits_.max_points_per_shape);
    if (const auto* error = std::get_if<PathError>(&rings)) {
        reader_.report(d, data, "bad_path", [&] { return "at character " + std::to_string(error->at + 1) + " " + error->message; });
        return nothing(d, OutlineKey::d);
    }
    return drawn(d, data, std::move(std::get<std::vector<Ring>>(rings)), nonzero, scale, position, OutlineKey::d);
}

Polygon OutlineReader::text(const Path& where, NodeId id, Shape& shape) {
    const Members members(reader_, where, id, kTextKeys, "a text");
    read_material(reader_, limits_, where, members, shape);
    TextSettings settings;
    settings.anchor =
        std::array{TextAnchor::start, TextAnchor::middle, TextAnchor::end}[choice(members, where, "anchor", kAnchors)];
    Point position(kUnread);
    members.need_pair("position", "a point [x, y]", position);
    members.need_number("size", settings.size);
    const Path text_path = where.key("text");
    const NodeId characters = members.require("text");
    const bool sized = is_length(where.key("size"), members.find("size"), settings.size);
    const auto utf8 = characters == kNoNode ? std::nullopt : reader_.string(text_path, characters);
    if (!utf8 || !sized || std::isnan(position.x) || std::isnan(position.y)) {
        return nothing(text_path, OutlineKey::text);
    }
    settings.tolerance = tolerance_;
    settings.most_points = limits_.max_points_per_shape;
    const Font* font = fonts_.font();
    std::variant<std::vector<Ring>, FontError> rings = FontError{"no_font", fonts_.why()};
    if (font != nullptr) {
        rings = rings_of_text(*font, *utf8, settings);
    }
    if (const auto* error = std::get_if<FontError>(&rings)) {
        reader_.report(text_path, characters, error->code, [&] { return error->message; });
        return nothing(text_path, OutlineKey::text);
    }
    return drawn(text_path, characters, std::move(std::get<std::vector<Ring>>(rings)), true, 1, position, OutlineKey::text);
}

}  // namespace penumbra
