// SPDX-License-Identifier: MIT
// docs/scene.schema.json against the parser: the same keys, required keys and words, both ways.
// schema_corpus.py puts the corpus through a validator of the schema.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "core/scene/words.h"
#include "server/json/scene_keys.h"
#include "test_scenes.h"

namespace penumbra {
namespace {

using nlohmann::json;
using Words = std::set<std::string>;

Words words_of(std::span<const std::string_view> words) { return {words.begin(), words.end()}; }

Words strings_of(const json& list) {
    Words words;
    for (const json& word : list) {
        words.insert(word.get<std::string>());
    }
    return words;
}

const json& schema() {
    static const json kSchema =
        json::parse(read_file(PENUMBRA_SOURCE_DIR "/docs/scene.schema.json"));
    return kSchema;
}

const json& at(const std::string& pointer) { return schema().at(json::json_pointer(pointer)); }

// An object of the format: where the schema has it, its keys, and a document with `{}` or only its
// type in its place, whose missing keys are those required.
struct Object {
    std::string schema;
    std::span<const std::string_view> keys;
    std::string bare, pointer;
};

std::vector<Object> objects() {
    std::vector<Object> list = {
        {"", kSceneKeys, "{}", ""},
        {"/properties/canvas", kCanvasKeys, R"({"version": 1, "canvas": {}})", "/canvas"},
        {"/properties/canvas/properties/floor", kFloorKeys,
         R"({"version": 1, "canvas": {"width": 1, "height": 1, "floor": {}}})", "/canvas/floor"},
        {"/$defs/emission_gradient", kGradientKeys, "", ""},
        {"/$defs/emission_gradient/properties/gradient/items", kEmissionStopKeys,
         with_shape(R"({"type": "line", "from": [1, 1], "to": [5, 5], "emission": {"gradient": [{}]}})"),
         "/shapes/0/emission/gradient/0"},
        {"/properties/sky", kSkyKeys, document(R"(, "sky": {})"), "/sky"},
        {"/properties/sky/properties/gradient/items", kStopKeys,
         document(R"(, "sky": {"gradient": [{}]})"), "/sky/gradient/0"},
        {"/properties/render", kRenderKeys, document(R"(, "render": {})"), "/render"},
        {"/properties/output", kOutputKeys, document(R"(, "output": {})"), "/output"},
        {"/properties/output/properties/exposure/anyOf/2", kCameraKeys,
         document(R"(, "output": {"exposure": {}})"), "/output/exposure"},
        {"/properties/output/properties/exposure/anyOf/3", kAutoExposureKeys, "", ""},
        {"/$defs/radiance/anyOf/3", kColourKeys, document(R"(, "sky": {"radiance": {}})"),
         "/sky/radiance"},
        {"/$defs/reflectance/anyOf/3", kColourKeys,
         R"({"version": 1, "canvas": {"width": 1, "height": 1, "floor": {"albedo": {}}}})",
         "/canvas/floor/albedo"},
    };
    list.push_back({"/$defs/medium", kMediumKeys, with_shape(R"({"type": "circle", "center": [0, 0], "radius": 1, "medium": {}})"),
                    "/shapes/0/medium"});
    const std::pair<std::string, std::span<const std::string_view>> shapes[] = {
        {"circle", kCircleKeys}, {"ellipse", kEllipseKeys},   {"rect", kRectKeys},
        {"line", kLineKeys},     {"polyline", kPolylineKeys}, {"polygon", kPolygonKeys},
        {"bitmap", kBitmapKeys}, {"path", kPathKeys},         {"text", kTextKeys}};
    for (const auto& [type, keys] : shapes) {
        list.push_back(
            {"/$defs/" + type, keys, with_shape(R"({"type": ")" + type + "\"}"), "/shapes/0"});
    }
    const std::pair<std::string, std::span<const std::string_view>> lights[] = {
        {"point", kPointLightKeys}, {"spot", kSpotKeys}, {"directional", kDirectionalKeys}};
    for (const auto& [type, keys] : lights) {
        list.push_back({"/$defs/" + type + "_light", keys,
                        document(R"(, "lights": [{"type": ")" + type + "\"}]"), "/lights/0"});
    }
    return list;
}

// Pointers to all schemas with the keyword, wherever they stand.
void find_all(const json& value, const std::string& keyword, const std::string& pointer,
              Words& found) {
    if (value.is_object() && value.contains(keyword)) {
        found.insert(pointer);
    }
    if (value.is_structured()) {
        for (const auto& [key, child] : value.items()) {
            find_all(child, keyword, pointer + "/" + key, found);
        }
    }
}

TEST(Schema, ObjectsHaveTheParsersKeys) {
    Words known;
    for (const Object& object : objects()) {
        known.insert(object.schema);
        Words keys;
        for (const auto& [key, value] : at(object.schema).at("properties").items()) {
            keys.insert(key);
        }
        EXPECT_EQ(keys, words_of(object.keys)) << object.schema;
        EXPECT_EQ(at(object.schema).at("additionalProperties"), false) << object.schema;
    }
    // No object of the schema is left out here. The albedo's factor in "if" repeats a bitmap's
    // keys.
    Words all;
    find_all(schema(), "additionalProperties", "", all);
    EXPECT_EQ(all, known);
}

TEST(Schema, TheSameKeysAreRequired) {
    for (const Object& object : objects()) {
        Words required =
            object.schema.find("$defs") != std::string::npos && object.keys[0] == "type"
                ? Words{"type"}
                : Words{};
        if (object.bare.empty()) {
            // Told from a camera's by its one key, which no bare object can lack.
            EXPECT_EQ(object.keys.size(), 1u) << object.schema;
            required.insert(std::string(object.keys[0]));
        }
        for (const LocatedProblem& problem : parse_scene(object.bare).problems) {
            const std::string& pointer = problem.problem.pointer;
            const std::string start = object.pointer + "/";
            if (problem.problem.code == "missing_key" && pointer.starts_with(start)) {
                required.insert(pointer.substr(start.size()));
            }
        }
        Words listed = strings_of(at(object.schema).value("required", json::array()));
        // Of several ways to say one thing the parser asks for the first.
        if (at(object.schema).contains("oneOf")) {
            listed.merge(strings_of(at(object.schema).at("oneOf").at(0).at("required")));
        }
        EXPECT_EQ(listed, required) << object.schema;
    }
}

TEST(Schema, ValuesHaveTheParsersWords) {
    const std::map<std::string, Words> words = {
        {"/properties/render/properties/method", words_of(known_methods())},
        {"/properties/render/properties/quality", words_of(kQualities)},
        {"/properties/render/properties/skip", words_of(kSkips)},
        {"/properties/output/properties/format", words_of(known_formats())},
        {"/properties/output/properties/solids", words_of(kSolids)},
        {"/properties/output/properties/tonemap", words_of(known_tonemaps())},
        {"/properties/output/properties/look", words_of(known_looks())},
        {"/properties/output/properties/dither", words_of(kDithers)},
        {"/$defs/bitmap/properties/as", words_of(kUses)},
        {"/$defs/path/properties/fill_rule", words_of(kFillRules)},
        {"/$defs/text/properties/anchor", words_of(kAnchors)},
    };
    Words known{"/properties/output/properties/bit_depth"};  // numbers
    for (const auto& [pointer, expected] : words) {
        known.insert(pointer);
        EXPECT_EQ(strings_of(at(pointer).at("enum")), expected) << pointer;
    }
    Words all;
    find_all(schema(), "enum", "", all);
    EXPECT_EQ(all, known);

    const auto types_of = [](const char* list) {
        Words types;
        const json shapes_or_lights = at(list).at("oneOf");
        for (const json& entry : shapes_or_lights) {
            types.insert(at(entry.at("$ref").get<std::string>().substr(1))
                             .at("properties")
                             .at("type")
                             .at("const"));
        }
        return types;
    };
    EXPECT_EQ(types_of("/$defs/shape"), words_of(kShapeTypes));
    EXPECT_EQ(types_of("/$defs/light"), words_of(kLightTypes));
}

TEST(Schema, ListsHaveTheParsersLimits) {
    const Limits limits;
    EXPECT_EQ(at("/properties/shapes/maxItems"), limits.max_shapes);
    EXPECT_EQ(at("/properties/lights/maxItems"), limits.max_lights);
    EXPECT_EQ(at("/properties/sky/properties/gradient/maxItems"), limits.max_sky_stops);
    EXPECT_EQ(at("/$defs/emission_gradient/properties/gradient/maxItems"), limits.max_emission_stops);
    EXPECT_EQ(at("/$defs/polygon/properties/points/maxItems"), limits.max_points_per_shape);
    EXPECT_EQ(at("/$defs/polyline/properties/points/maxItems"), limits.max_points_per_shape);
    EXPECT_EQ(at("/properties/canvas/properties/width/maximum"), limits.max_canvas_side_px);
    EXPECT_EQ(at("/properties/canvas/properties/height/maximum"), limits.max_canvas_side_px);
    EXPECT_EQ(at("/properties/render/properties/bounces/anyOf/0/maximum"), limits.max_bounces);
    EXPECT_EQ(at("/properties/output/properties/exposure/anyOf/0/maximum"), limits.max_exposure_ev);
    const auto range = [&](const std::string& pointer, double low, double high) {
        EXPECT_EQ(at(pointer + "/minimum"), low) << pointer;
        EXPECT_EQ(at(pointer + "/maximum"), high) << pointer;
    };
    const std::string exposure = "/properties/output/properties/exposure/anyOf/";
    range(exposure + "2/properties/aperture", limits.min_aperture, limits.max_aperture);
    range(exposure + "2/properties/shutter", limits.min_shutter_s, limits.max_shutter_s);
    range(exposure + "2/properties/iso", limits.min_iso, limits.max_iso);
    range(exposure + "2/properties/compensation", -limits.max_compensation_ev, limits.max_compensation_ev);
    range(exposure + "3/properties/key", limits.min_key, limits.max_key);
    range("/properties/output/properties/white", limits.min_white, limits.max_white);
    EXPECT_EQ(at("/$defs/radiance/anyOf/0/maximum"), limits.max_radiance);
}

}  // namespace
}  // namespace penumbra
