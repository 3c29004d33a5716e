// SPDX-License-Identifier: MIT
#include "server/json/material_reader.h"

#include <limits>
#include <utility>

#include "server/json/scene_keys.h"

namespace penumbra {

namespace {

constexpr double kUnread = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void read_material(ValueReader& reader, const Path& where, const Members& members, Shape& shape) {
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

void read_stroke_material(ValueReader& reader, const Path& where, const Members& members, Shape& shape) {
    const NodeId id = members.find("emission");
    if (id == kNoNode || reader.node(id).kind != NodeKind::object ||
        reader.tree().child(id, "gradient") == kNoNode) {
        read_material(reader, where, members, shape);
        return;
    }
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
