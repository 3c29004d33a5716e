// SPDX-License-Identifier: MIT
#include "tests/stability/scene_text.h"

#include <cstdint>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/image/codec.h"
#include "core/scene/words.h"

namespace penumbra::test {
namespace {

using Json = nlohmann::ordered_json;

Json pair(glm::dvec2 p) { return Json::array({p.x, p.y}); }
Json colour(const Colour& c) { return Json::array({c.r, c.g, c.b}); }

Json points(const std::vector<Point>& list) {
    Json json = Json::array();
    for (const Point& p : list) json.push_back(pair(p));
    return json;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

struct Geometries {
    Json operator()(const Circle& g) const { return {{"type", "circle"}, {"center", pair(g.center)}, {"radius", g.radius}}; }
    Json operator()(const Ellipse& g) const {
        return {{"type", "ellipse"}, {"center", pair(g.center)}, {"radii", pair(g.radii)}, {"rotation", g.rotation_deg}};
    }
    Json operator()(const Rect& g) const {
        return {{"type", "rect"}, {"center", pair(g.center)}, {"size", pair(g.size)}, {"rotation", g.rotation_deg}, {"corner_radius", g.corner_radius}};
    }
    Json operator()(const Line& g) const { return {{"type", "line"}, {"from", pair(g.from)}, {"to", pair(g.to)}, {"width", g.width}}; }
    Json operator()(const Polyline& g) const {
        return {{"type", "polyline"}, {"points", points(g.points)}, {"width", g.width}, {"closed", g.closed}};
    }
    Json operator()(const Polygon& g) const { return {{"type", "polygon"}, {"points", points(g.points)}}; }
    Json operator()(const Bitmap& g) const {
        Image8 image(g.image->width, g.image->height, 4);
        image.data = g.image->rgba;
        return {{"type", "bitmap"}, {"image", "data:image/png;base64," + base64(encode_png(image))}, {"position", pair(g.position)}, {"size", pair(g.size)},
                {"solid_above", g.solid_above}, {"as", g.as_albedo ? "albedo" : "emission"}, {"emission_scale", g.emission_scale}};
    }
};

}  // namespace

std::string scene_text(const Scene& scene) {
    constexpr const char* kQualities[] = {"draft", "standard", "high"};
    Json json = {{"version", 1}};
    json["canvas"] = {{"width", scene.canvas.width}, {"height", scene.canvas.height}, {"margin", scene.canvas.margin}};
    if (scene.canvas.view) {
        const ViewRect& v = *scene.canvas.view;
        json["canvas"]["view"] = Json::array({v.x, v.y, v.w, v.h});
    }
    if (scene.sky.gradient.empty()) {
        json["sky"] = {{"radiance", colour(scene.sky.radiance)}};
    } else {
        json["sky"]["gradient"] = Json::array();
        for (const SkyStop& stop : scene.sky.gradient)
            json["sky"]["gradient"].push_back({{"angle", stop.angle_deg}, {"radiance", colour(stop.radiance)}});
    }
    json["shapes"] = Json::array();
    for (const Shape& shape : scene.shapes) {
        Json one = std::visit(Geometries{}, shape.geometry);
        if (!std::holds_alternative<Bitmap>(shape.geometry)) {
            one["emission"] = colour(shape.emission);
            one["albedo"] = colour(shape.albedo);
        }
        json["shapes"].push_back(std::move(one));
    }
    json["render"] = {{"method", scene.render.method}, {"quality", kQualities[static_cast<int>(scene.render.quality)]}};
    json["output"] = {{"format", scene.output.format}};
    // One shape a line.
    std::string text = "{\n";
    bool first = true;
    for (const auto& [key, value] : json.items()) {
        if (!first) text += ",\n";
        first = false;
        text += "  \"" + key + "\": ";
        if (key != "shapes" || value.empty()) {
            text += value.dump();
            continue;
        }
        text += "[";
        for (std::size_t i = 0; i < value.size(); ++i) text += (i > 0 ? ",\n    " : "\n    ") + value[i].dump();
        text += "\n  ]";
    }
    return text + "\n}\n";
}

}  // namespace penumbra::test
