// SPDX-License-Identifier: MIT
#include "server/json/material_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/scene/wording.h"
#include "server/json/scene_keys.h"

namespace penumbra {

namespace {

constexpr double kUnread = std::numeric_limits<double>::quiet_NaN();

// Extinction from the share of light that passes `depth` world units: a share of 0 is as opaque as the format can say.
void read_transmission(ValueReader& reader, const Members& members, const Path& where, const Limits& limits, Medium& medium) {
    const NodeId transmission = members.find("transmission");
    const NodeId depth_id = members.find("depth");
    if (transmission == kNoNode) {
        if (depth_id != kNoNode) {
            reader.report(where.key("depth"), depth_id, "conflict", [] { return "is for a medium with a \"transmission\" only"; });
        }
        return;
    }
    if (members.find("extinction") != kNoNode) {
        reader.report(where.key("transmission"), transmission, "conflict",
                      [] { return "must not stand together with \"extinction\": keep one"; });
    }
    Colour share(0);
    members.colour("transmission", share);
    double depth = 1;
    members.number("depth", depth);
    if (std::isnan(share.r) || std::isnan(share.g) || std::isnan(share.b) || std::isnan(depth)) {
        return;
    }
    if (!(depth > 0 && depth <= limits.max_coordinate)) {
        reader.report(where.key("depth"), depth_id, "out_of_range", [&] {
            return "must be more than 0, at most " + number_text(limits.max_coordinate) + ", is " + number_text(depth);
        });
        return;
    }
    for (int c = 0; c < 3; ++c) {
        if (!(share[c] >= 0 && share[c] <= 1)) {
            reader.report(where.key("transmission"), transmission, "out_of_range",
                          [&] { return "must be from 0 to 1 in each channel, is " + number_text(share[c]); });
            return;
        }
        medium.extinction[c] = std::min(share[c] > 0 ? std::max(-std::log(share[c]) / depth, 0.0) : limits.max_radiance, limits.max_radiance);
    }
}

void read_medium(ValueReader& reader, const Limits& limits, const Path& where, const Members& members, Shape& shape) {
    const NodeId id = members.find("medium");
    const Path medium_path = where.key("medium");
    if (id == kNoNode || !reader.expect(medium_path, id, NodeKind::object, "an object")) {
        return;
    }
    for (const std::string_view key : {"emission", "albedo"}) {
        if (const NodeId other = members.find(key); other != kNoNode) {
            reader.report(where.key(key), other, "conflict",
                          [] { return "must not stand together with \"medium\": a translucent shape has no surface"; });
        }
    }
    const Members medium_members(reader, medium_path, id, kMediumKeys, "a medium");
    Medium medium;
    medium_members.colour("extinction", medium.extinction);
    medium_members.colour("emission", medium.emission);
    read_transmission(reader, medium_members, medium_path, limits, medium);
    shape.medium = medium;
}

}  // namespace

void read_material(ValueReader& reader, const Limits& limits, const Path& where, const Members& members, Shape& shape) {
    read_medium(reader, limits, where, members, shape);
    const NodeId emission = members.find("emission");
    const NodeId gradient = emission != kNoNode && reader.node(emission).kind == NodeKind::object
                                ? reader.tree().child(emission, "gradient")
                                : kNoNode;
    if (gradient == kNoNode) {
        members.colour("emission", shape.emission);
    } else {
        reader.report(where.key("emission").key("gradient"), gradient, "conflict",
                       [] { return "is for lines and polylines"; });
    }
    members.colour("albedo", shape.albedo);
}

void read_stroke_material(ValueReader& reader, const Limits& limits, const Path& where, const Members& members, Shape& shape) {
    const NodeId id = members.find("emission");
    if (id == kNoNode || reader.node(id).kind != NodeKind::object ||
        reader.tree().child(id, "gradient") == kNoNode) {
        read_material(reader, limits, where, members, shape);
        return;
    }
    read_medium(reader, limits, where, members, shape);
    members.colour("albedo", shape.albedo);
    const Path emission = where.key("emission");
    const Members gradient(reader, emission, id, kGradientKeys, "a gradient");
    const NodeId list = gradient.find("gradient");
    const Path stops = emission.key("gradient");
    if (!reader.expect(stops, list, NodeKind::array, "a list of stops")) {
        return;
    }
    if (reader.node(list).child_count == 0) {
        reader.report(stops, list, "too_few",
                       [] { return "must hold at least 1 stop, holds 0"; });
    }
    for (NodeId stop = reader.node(list).first_child; stop != kNoNode;
         stop = reader.node(stop).next_sibling) {
        const Path here = stops.index(shape.gradient.size());
        EmissionStop read{kUnread, Colour(kUnread)};
        if (reader.expect(here, stop, NodeKind::object, "an object")) {
            const Members keys(reader, here, stop, kEmissionStopKeys, "a stop of a gradient");
            keys.need_number("at", read.at);
            keys.need_colour("emission", read.emission);
        }
        shape.gradient.push_back(read);
    }
}

void read_floor_material(ValueReader& reader, BitmapReader& bitmaps, const Path& where, const Members& members, FloorMaterial& floor) {
    if (const NodeId image = members.find("image"); image != kNoNode) {
        floor.image = bitmaps.read(where.key("image"), image);
    }
    if (const NodeId normals = members.find("normal_map"); normals != kNoNode) {
        floor.normals = bitmaps.read(where.key("normal_map"), normals);
    }
    if (const NodeId tile = members.find("tile"); tile != kNoNode) {
        const auto t = reader.numbers(where.key("tile"), tile, 4,
                                       "a rectangle of four numbers [x, y, width, height]");
        floor.tile = ViewRect{t[0], t[1], t[2], t[3]};
        if (members.find("image") == kNoNode && members.find("normal_map") == kNoNode) {
            refuse(reader, members, where, "tile", "is for a floor with an image or a normal_map");
        }
    }
    for (const auto& [key, member] : {std::pair{"roughness", &Gloss::roughness},
                                      std::pair{"metallic", &Gloss::metallic},
                                      std::pair{"reflectance", &Gloss::reflectance}}) {
        if (members.find(key) == kNoNode) {
            continue;
        }
        if (!floor.gloss) {
            floor.gloss = Gloss{};
        }
        members.number(key, (*floor.gloss).*member);
    }
}

}  // namespace penumbra
