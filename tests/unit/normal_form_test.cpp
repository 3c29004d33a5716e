// SPDX-License-Identifier: MIT
// The normal form: one for all texts of a scene, another one for every other scene.
#include "core/scene/normal_form.h"

#include <map>

#include "test_scenes.h"

namespace penumbra {
namespace {

std::string form(const std::string& text, const std::vector<Override>& overrides = {}) {
    const ParsedScene parsed = parse_scene(text, {}, {}, overrides);
    EXPECT_TRUE(parsed.scene) << text << (parsed.problems.empty() ? "" : to_string(parsed.problems.front()));
    return parsed.scene ? normal_form(*parsed.scene) : "";
}

TEST(NormalForm, TextsThatMeanTheSameAreTheSame) {
    const std::string one = form(R"({"version": 1, "canvas": {"width": 32, "height": 24},
        "sky": {"radiance": [1, 0, 0]}, "shapes": [{"type": "circle", "center": [3, 4], "radius": 2, "emission": [1, 1, 1]}]})");
    for (const char* other : {
             R"({"shapes":[{"emission":1,"radius":2.0,"center":[3,4e0],"type":"circle"}],"sky":{"radiance":"#ff0000"},
                 "canvas":{"height":24,"width":32},"version":1})",
             R"({"version": 1, "canvas": {"width": 32, "height": 24, "view": [0, 0, 32, 24], "margin": -0.0, "floor": {"albedo": 1}},
                 "sky": {"radiance": [1, 0, 0]}, "render": {"method": "auto", "quality": "standard"},
                 "shapes": [{"type": "circle", "center": [3, 4], "radius": 2, "emission": "#ffffff"}]})"}) {
        EXPECT_EQ(form(other), one) << other;
    }
}

// Every key that a scene can have, changed one at a time.
TEST(NormalForm, EveryValueShows) {
    const std::string base = R"({"version": 1, "canvas": {"width": 32, "height": 24, "view": [0, 0, 32, 24]},
      "sky": {"gradient": [{"angle": 0, "radiance": 1}, {"angle": 90, "radiance": 2}]},
      "shapes": [{"type": "circle", "center": [3, 4], "radius": 2, "emission": 1},
                 {"type": "ellipse", "center": [3, 4], "radii": [2, 3], "rotation": 5},
                 {"type": "rect", "center": [3, 4], "size": [2, 3], "rotation": 5, "corner_radius": 0.5},
                 {"type": "line", "from": [1, 2], "to": [3, 4], "width": 2},
                 {"type": "polyline", "points": [[1, 2], [3, 4], [5, 7]], "width": 2},
                 {"type": "polygon", "points": [[1, 2], [3, 4], [5, 7]]}],
      "lights": [{"type": "point", "position": [1, 2], "intensity": 1},
                 {"type": "spot", "position": [1, 2], "direction": 5, "inner_angle": 10, "outer_angle": 20, "intensity": 1},
                 {"type": "directional", "direction": 5, "irradiance": 1},
                 {"type": "point", "position": [1, 2], "lumens": 1, "height": 3},
                 {"type": "spot", "position": [1, 2], "direction": 5, "inner_angle": 10, "outer_angle": 20, "candela": 1, "height": 3},
                 {"type": "directional", "direction": 5, "lux": 1, "elevation": 30}]})";
    std::map<std::string, std::string> seen{{form(base), "base"}};
    const auto differs = [&](const std::string& pointer, const std::string& value) {
        const std::string changed = form(base, {{pointer, value}});
        const auto read = read_normal_form(changed);
        ASSERT_TRUE(read) << pointer;
        EXPECT_EQ(normal_form(*read), changed) << pointer;
        EXPECT_TRUE(validate(*read).empty()) << pointer;
        const auto [place, fresh] = seen.emplace(changed, pointer);
        EXPECT_TRUE(fresh) << pointer << " gives the same as " << place->second;
    };
    differs("/canvas/margin", "2");
    differs("/canvas/floor", "{\"albedo\": 0.5}");
    const std::string picture = R"("data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==")";
    for (const std::string& floor : {R"("image": )" + picture, R"("normal_map": )" + picture, R"("tile": [0, 0, 8, 8], "image": )" + picture,
                                    std::string(R"("roughness": 0.4)"), std::string(R"("metallic": 0.4)"), std::string(R"("reflectance": 0.4)")})
        differs("/canvas/floor", "{" + floor + "}");
    differs("/shapes/3/emission", R"({"gradient": [{"at": 0.5, "emission": 1}]})");
    differs("/shapes/3/emission", R"({"gradient": [{"at": 0.6, "emission": 1}]})");
    differs("/shapes/4/emission", R"({"gradient": [{"at": 0.5, "emission": 2}]})");
    differs("/sky/gradient/1/angle", "91");
    differs("/sky/gradient/1/radiance", "3");
    differs("/shapes/0/center/1", "5");
    differs("/shapes/0/radius", "3");
    differs("/shapes/0/emission", "[1, 1, 1.0000001]");
    differs("/shapes/0/albedo", "0.1");
    differs("/shapes/1/medium", "{\"extinction\": 0.1}");
    differs("/shapes/1/medium", "{\"extinction\": 0.1, \"emission\": 1}");
    differs("/shapes/1/medium", "{}");
    differs("/shapes/1/medium", "{\"transmission\": 0.5}");
    differs("/shapes/1/medium", "{\"transmission\": 0.5, \"depth\": 2}");
    for (const char* path : {"center/0", "radii/1", "rotation"}) differs(std::string("/shapes/1/") + path, "7");
    for (const char* path : {"center/0", "size/1", "rotation"}) differs(std::string("/shapes/2/") + path, "7");
    differs("/shapes/2/corner_radius", "0.25");
    for (const char* path : {"from/0", "to/1", "width"}) differs(std::string("/shapes/3/") + path, "7");
    for (const char* path : {"points/0/0", "points/2/1", "width"}) differs(std::string("/shapes/4/") + path, "8");
    differs("/shapes/4/closed", "true");
    differs("/shapes/5/points/1/0", "8");
    for (const char* path : {"position/0", "intensity"}) differs(std::string("/lights/0/") + path, "7");
    for (const char* path : {"position/0", "direction", "inner_angle", "outer_angle", "intensity"}) {
        differs(std::string("/lights/1/") + path, "15");
    }
    for (const char* path : {"direction", "irradiance"}) differs(std::string("/lights/2/") + path, "7");
    for (const char* path : {"position/0", "lumens", "height"}) differs(std::string("/lights/3/") + path, "7");
    for (const char* path : {"position/0", "direction", "outer_angle", "candela", "height", "tilt"}) differs(std::string("/lights/4/") + path, "25");
    for (const char* path : {"direction", "lux", "elevation"}) differs(std::string("/lights/5/") + path, "7");
    differs("/render/method", "rc");
    differs("/render/quality", "high");
    differs("/render/bounces", "1");
    differs("/render/bounces", "\"converged\"");
    differs("/render/tolerance", "0.01");
    differs("/canvas/region", "[1, 2, 8, 8]");
    differs("/lights/0/radius", "3");
    differs("/render/skip", "none");
    differs("/output/format", "pfm");
    differs("/output/antialias", "false");
    differs("/output/exposure", "1");
    differs("/output/tonemap", "aces");
}

TEST(NormalForm, ShapesAreToldApartByKindOrderAndNumber) {
    const char* circle = R"({"type": "circle", "center": [3, 4], "radius": 2})";
    const char* point = R"({"type": "circle", "center": [3, 4], "radius": 3})";
    const auto both = [&](const std::string& a, const std::string& b) { return form(document(R"(, "shapes": [)" + a + ", " + b + "]")); };
    EXPECT_NE(both(circle, point), both(point, circle));
    EXPECT_NE(both(circle, circle), form(with_shape(circle)));
    EXPECT_NE(form(with_shape(R"({"type": "polygon", "points": [[1, 2], [3, 4], [5, 7]]})")),
              form(with_shape(R"({"type": "polyline", "points": [[1, 2], [3, 4], [5, 7]], "width": 1, "closed": true})")));
}

TEST(NormalForm, BitmapsCountByTheirPixels) {
    Scene a = small_scene(), b;
    Bitmap bitmap;
    auto texels = std::make_shared<Texels>(Texels{2, 1, Bytes(8, 100)});
    bitmap.image = texels;
    a.shapes.push_back({bitmap, Colour(0), Colour(0)});
    b = a;
    std::get<Bitmap>(b.shapes[0].geometry).image = std::make_shared<Texels>(Texels{2, 1, Bytes(8, 100)});
    EXPECT_EQ(normal_form(a), normal_form(b)) << "another object with the same pixels";
    auto other = std::make_shared<Texels>(*texels);
    other->rgba[7] = 101;
    std::get<Bitmap>(b.shapes[0].geometry).image = other;
    EXPECT_NE(normal_form(a), normal_form(b));
}

}  // namespace
}  // namespace penumbra
