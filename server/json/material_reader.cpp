// SPDX-License-Identifier: MIT
#include "server/json/material_reader.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/scene/wording.h"
#include "server/json/scene_keys.h"

namespace penumbra {

namespace {

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

}  // namespace

void read_material(ValueReader& reader, const Members& members, const Path& where, const Limits& limits, Shape& shape) {
    members.colour("emission", shape.emission);
    members.colour("albedo", shape.albedo);
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

}  // namespace penumbra
