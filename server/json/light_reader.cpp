// SPDX-License-Identifier: MIT
#include "server/json/light_reader.h"

#include <limits>
#include <string>

#include "server/json/scene_keys.h"

namespace penumbra {

namespace {

void only_for_radiant(ValueReader& reader, const Members& members, const Path& where, std::string_view key, LightUnit unit) {
    if (unit != LightUnit::radiant) {
        refuse(reader, members, where, key, "is for a light with an \"intensity\", not for one in candela or lumens");
    }
}

// One of intensity, candela and lumens; the latter two with a height.
LightUnit read_strength(ValueReader& reader, const Members& members, const Path& where, Colour& intensity, double& height) {
    const bool candela = members.find("candela") != kNoNode;
    if (!candela && members.find("lumens") == kNoNode) {
        members.need_colour("intensity", intensity);
        refuse(reader, members, where, "height", "is for a light in candela or lumens");
        return LightUnit::radiant;
    }
    const std::string unit = candela ? "candela" : "lumens";
    members.need_colour(unit, intensity);
    const std::string together = "must not stand together with \"" + unit + "\": keep one";
    refuse(reader, members, where, "intensity", together);
    if (candela) {
        refuse(reader, members, where, "lumens", together);
    }
    members.need_number("height", height);
    return candela ? LightUnit::candela : LightUnit::lumens;
}

}  // namespace

Light light_of_type(ValueReader& reader, const Path& where, NodeId id, std::size_t type) {
    if (type == 0) {
        const Members members(reader, where, id, kPointLightKeys, "a point light");
        PointLight light;
        members.need_pair("position", "a point [x, y]", light.position);
        light.unit = read_strength(reader, members, where, light.intensity, light.height);
        members.number("radius", light.radius);
        only_for_radiant(reader, members, where, "radius", light.unit);
        return light;
    }
    if (type == 1) {
        const Members members(reader, where, id, kSpotKeys, "a spot light");
        SpotLight light;
        members.need_pair("position", "a point [x, y]", light.position);
        members.need_number("direction", light.direction_deg);
        members.need_number("inner_angle", light.inner_angle_deg);
        members.need_number("outer_angle", light.outer_angle_deg);
        light.unit = read_strength(reader, members, where, light.intensity, light.height);
        members.number("tilt", light.tilt_deg);
        if (light.unit == LightUnit::radiant) {
            refuse(reader, members, where, "tilt", "is for a spot in candela or lumens, at a height");
        }
        return light;
    }
    const Members members(reader, where, id, kDirectionalKeys, "a directional light");
    DirectionalLight light;
    members.need_number("direction", light.direction_deg);
    if (members.find("lux") == kNoNode) {
        members.need_colour("irradiance", light.irradiance);
        refuse(reader, members, where, "elevation", "is for a light in lux, of the world above the canvas");
        return light;
    }
    members.need_colour("lux", light.irradiance);
    refuse(reader, members, where, "irradiance", "must not stand together with \"lux\": keep one");
    light.elevation_deg = std::numeric_limits<double>::quiet_NaN();
    members.need_number("elevation", *light.elevation_deg);
    return light;
}

}  // namespace penumbra
