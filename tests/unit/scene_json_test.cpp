// SPDX-License-Identifier: MIT
// What good documents become.
#include <gmock/gmock.h>

#include <cmath>

#include "test_scenes.h"

namespace penumbra {
namespace {

using testing::ElementsAre;

Scene good(const std::string& text, const Limits& limits = {}) {
    const ParsedScene parsed = parse_scene(text, limits);
    EXPECT_TRUE(parsed.scene) << text.substr(0, 300) << "\n" << all_text(parsed);
    EXPECT_TRUE(parsed.problems.empty());
    return parsed.scene.value_or(Scene{});
}

template <class T>
T only_shape(const std::string& shape) {
    const Scene scene = good(with_shape(shape));
    if (scene.shapes.size() != 1 || !std::holds_alternative<T>(scene.shapes[0].geometry)) {
        ADD_FAILURE() << shape;
        return T{};
    }
    return std::get<T>(scene.shapes[0].geometry);
}

template <class T>
T only_light(const std::string& light) {
    const Scene scene = good(document(R"(, "lights": [)" + light + "]"));
    if (scene.lights.size() != 1 || !std::holds_alternative<T>(scene.lights[0])) {
        ADD_FAILURE() << light;
        return T{};
    }
    return std::get<T>(scene.lights[0]);
}

TEST(SceneJson, DefaultsAreThoseOfTheFormat) {
    const Scene scene = good(document());
    EXPECT_EQ(scene.canvas.width, 32);
    EXPECT_EQ(scene.canvas.height, 24);
    EXPECT_FALSE(scene.canvas.view);
    EXPECT_EQ(scene.canvas.margin, 0);
    EXPECT_EQ(scene.canvas.floor_albedo, Colour(1));
    EXPECT_EQ(scene.sky.radiance, Colour(0));
    EXPECT_TRUE(scene.sky.gradient.empty());
    EXPECT_TRUE(scene.shapes.empty());
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.render.method, "auto");
    EXPECT_EQ(scene.render.quality, Quality::standard);
    EXPECT_EQ(scene.render.bounces, 0);
    EXPECT_EQ(scene.render.skip, Skip::all);
    EXPECT_EQ(scene.render.view, "final");
    EXPECT_EQ(scene.output.format, "png");
    EXPECT_FALSE(scene.output.bit_depth);
    EXPECT_FALSE(scene.output.camera);
    EXPECT_FALSE(scene.output.auto_key);
    EXPECT_FALSE(scene.output.look);
    EXPECT_FALSE(scene.output.white);
    EXPECT_EQ(scene.output.dither, Dither::none);
    EXPECT_TRUE(scene.output.antialias);
    EXPECT_EQ(scene.output.solids, Solids::emission);
    EXPECT_EQ(scene.output.exposure_ev, 0);
    EXPECT_EQ(scene.output.tonemap, "none");
}

TEST(SceneJson, EverySetting) {
    const Scene scene = good(R"({"version": 1,
        "canvas": {"width": 40, "height": 20, "view": [-1, -2, 4, 2], "margin": 0.5,
                   "floor": {"albedo": [0.1, 0.2, 0.3]}},
        "sky": {"gradient": [{"angle": 10, "radiance": 1}, {"angle": 20.5, "radiance": [1, 2, 3]}]},
        "render": {"method": "rc", "quality": "high", "bounces": 7, "skip": "none", "view": "cascade2"},
        "output": {"format": "exr", "bit_depth": 16, "look": "punchy", "dither": "triangular", "antialias": false, "solids": "lit",
                   "exposure": -1.5, "tonemap": "agx"}})");
    EXPECT_EQ(scene.canvas.view->x, -1);
    EXPECT_EQ(scene.canvas.view->y, -2);
    EXPECT_EQ(scene.canvas.view->w, 4);
    EXPECT_EQ(scene.canvas.view->h, 2);
    EXPECT_DOUBLE_EQ(scene.canvas.pixel_size(), 0.1);
    EXPECT_EQ(scene.canvas.margin, 0.5);
    EXPECT_EQ(scene.canvas.floor_albedo, Colour(0.1, 0.2, 0.3));
    ASSERT_EQ(scene.sky.gradient.size(), 2u);
    EXPECT_EQ(scene.sky.gradient[1].angle_deg, 20.5);
    EXPECT_EQ(scene.sky.gradient[1].radiance, Colour(1, 2, 3));
    EXPECT_EQ(scene.render.method, "rc");
    EXPECT_EQ(scene.render.quality, Quality::high);
    EXPECT_EQ(scene.render.bounces, 7);
    EXPECT_EQ(scene.render.skip, Skip::none);
    EXPECT_EQ(scene.render.view, "cascade2");
    EXPECT_EQ(scene.output.format, "exr");
    EXPECT_EQ(scene.output.look, "punchy");
    EXPECT_EQ(scene.output.dither, Dither::triangular);
    EXPECT_EQ(scene.output.bit_depth, 16);
    EXPECT_FALSE(scene.output.antialias);
    EXPECT_EQ(scene.output.solids, Solids::lit);
    EXPECT_EQ(scene.output.exposure_ev, -1.5);
    EXPECT_EQ(scene.output.tonemap, "agx");
}

TEST(SceneJson, ASkysPictureIsAGradient) {
    Image8 image(4, 3, 3);
    for (int x = 0; x < 4; ++x) image.at(x, 1)[0] = std::uint8_t(60 * x);
    image.at(2, 2)[1] = 255;
    const auto sky = [&](const std::string& rest) { return good(document(R"(, "sky": {"image": ")" + data_url(encode_png(image)) + "\"" + rest + "}")).sky; };
    const Sky middle = sky(R"(, "scale": 2)");
    ASSERT_EQ(middle.gradient.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(middle.gradient[i].angle_deg, 45 + 90.0 * double(i));
        const double s = 60.0 * double(i) / 255;
        EXPECT_NEAR(middle.gradient[i].radiance.r, 2 * (s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4)), 1e-12);
        EXPECT_EQ(middle.gradient[i].radiance.g, 0);
    }
    EXPECT_EQ(sky(R"(, "row": 2)").gradient[2].radiance, Colour(0, 1, 0));
}

TEST(SceneJson, AWideSkyKeepsItsMean) {
    Image8 image(1000, 1, 3);
    double sum = 0;
    for (int x = 0; x < 1000; ++x) {
        const int code = (x * 37) % 256;
        image.at(x, 0)[1] = std::uint8_t(code);
        const double s = code / 255.0;
        sum += s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    }
    const Sky sky = good(document(R"(, "sky": {"image": ")" + data_url(encode_png(image)) + "\"}")).sky;
    ASSERT_EQ(sky.gradient.size(), 256u);
    double mean = 0;
    for (const SkyStop& stop : sky.gradient) mean += stop.radiance.g / 256;
    EXPECT_NEAR(mean, sum / 1000, 1e-12);
}

TEST(SceneJson, ExposureHasFourForms) {
    const auto output = [](const std::string& exposure) { return good(document(R"(, "output": {"exposure": )" + exposure + "}")).output; };
    EXPECT_EQ(output("2.5").exposure_ev, 2.5);
    EXPECT_EQ(output(R"("auto")").auto_key, kDefaultKey);
    EXPECT_EQ(output(R"({"key": 0.4})").auto_key, 0.4);
    const OutputSettings camera = output(R"({"aperture": 2.8, "shutter": 0.01, "iso": 400, "compensation": -1})");
    ASSERT_TRUE(camera.camera);
    EXPECT_EQ(camera.camera->aperture, 2.8);
    EXPECT_EQ(camera.camera->shutter_s, 0.01);
    EXPECT_EQ(camera.camera->iso, 400);
    EXPECT_EQ(camera.exposure_ev, -1);
    EXPECT_FALSE(camera.auto_key);
    EXPECT_EQ(output(R"({"aperture": 2.8, "shutter": 0.01})").camera->iso, 100);
    EXPECT_EQ(good(document(R"(, "output": {"tonemap": "reinhard_extended", "white": 9})")).output.white, 9);
}

TEST(SceneJson, ExposuresThatAreNone) {
    const auto problems = [](const std::string& output) { return brief(parse_scene(document(R"(, "output": )" + output))); };
    using testing::ElementsAre;
    EXPECT_THAT(problems(R"({"exposure": "automatic"})"), ElementsAre("/output/exposure unknown_value"));
    EXPECT_THAT(problems(R"({"exposure": [1]})"), ElementsAre("/output/exposure wrong_type"));
    EXPECT_THAT(problems(R"({"exposure": {"aperture": 2}})"), ElementsAre("/output/exposure/shutter missing_key"));
    EXPECT_THAT(problems(R"({"exposure": {"aperture": 0, "shutter": 1}})"), ElementsAre("/output/exposure/aperture out_of_range"));
    EXPECT_THAT(problems(R"({"exposure": {"aperture": 1, "shutter": 1, "iso": 1e8}})"), ElementsAre("/output/exposure/iso out_of_range"));
    EXPECT_THAT(problems(R"({"exposure": {"aperture": 1, "shutter": 1, "compensation": 17}})"), ElementsAre("/output/exposure/compensation out_of_range"));
    EXPECT_THAT(problems(R"({"exposure": {"key": 0}})"), ElementsAre("/output/exposure/key out_of_range"));
    EXPECT_THAT(problems(R"({"exposure": {"key": 0.2, "iso": 100}})"), ElementsAre("/output/exposure/iso unknown_key"));
    EXPECT_THAT(problems(R"({"look": "golden"})"), ElementsAre("/output/look conflict"));
    EXPECT_THAT(problems(R"({"look": "sepia", "tonemap": "agx"})"), ElementsAre("/output/look unknown_value"));
    EXPECT_THAT(problems(R"({"white": 2, "tonemap": "aces"})"), ElementsAre("/output/white conflict"));
    EXPECT_THAT(problems(R"({"white": 0, "tonemap": "reinhard_extended"})"), ElementsAre("/output/white out_of_range"));
    EXPECT_THAT(problems(R"({"dither": "blue"})"), ElementsAre("/output/dither unknown_value"));
    EXPECT_THAT(problems(R"({"format": "npy", "bit_depth": 32})"), ElementsAre("/output/bit_depth conflict"));
    EXPECT_THAT(problems(R"({"format": "exr", "bit_depth": 8})"), ElementsAre("/output/bit_depth unknown_value"));
    EXPECT_THAT(problems(R"({"format": "png", "bit_depth": 32})"), ElementsAre("/output/bit_depth unknown_value"));
}

TEST(SceneJson, EveryShape) {
    const auto circle =
        only_shape<Circle>(R"({"type": "circle", "center": [1, -2.5], "radius": 3})");
    EXPECT_EQ(circle.center, Point(1, -2.5));
    EXPECT_EQ(circle.radius, 3);

    const auto ellipse = only_shape<Ellipse>(
        R"({"type": "ellipse", "center": [1, 2], "radii": [3, 4], "rotation": 30})");
    EXPECT_EQ(ellipse.radii, glm::dvec2(3, 4));
    EXPECT_EQ(ellipse.rotation_deg, 30);

    const auto rect = only_shape<Rect>(
        R"({"type": "rect", "center": [1, 2], "size": [3, 4], "rotation": -20, "corner_radius": 1.5})");
    EXPECT_EQ(rect.size, glm::dvec2(3, 4));
    EXPECT_EQ(rect.rotation_deg, -20);
    EXPECT_EQ(rect.corner_radius, 1.5);

    const auto line = only_shape<Line>(R"({"type": "line", "from": [1, 2], "to": [3, 4]})");
    EXPECT_EQ(line.from, Point(1, 2));
    EXPECT_EQ(line.to, Point(3, 4));
    EXPECT_EQ(line.width, 1);

    const auto polyline = only_shape<Polyline>(
        R"({"type": "polyline", "points": [[1, 2], [3, 4], [5, 6]], "width": 4, "closed": true})");
    EXPECT_THAT(polyline.points, ElementsAre(Point(1, 2), Point(3, 4), Point(5, 6)));
    EXPECT_EQ(polyline.width, 4);
    EXPECT_TRUE(polyline.closed);

    const auto polygon =
        only_shape<Polygon>(R"({"type": "polygon", "points": [[0, 0], [1, 0], [0, 1]]})");
    EXPECT_EQ(polygon.points.size(), 3u);
}

TEST(SceneJson, MaterialsAndOrderOfShapes) {
    const Scene scene = good(with_shape(
        R"({"type": "circle", "center": [1, 1], "radius": 1, "emission": [1, 2, 3], "albedo": 0.5},
           {"radius": 2, "center": [1, 1], "type": "circle"})"));
    ASSERT_EQ(scene.shapes.size(), 2u);
    EXPECT_EQ(scene.shapes[0].emission, Colour(1, 2, 3));
    EXPECT_EQ(scene.shapes[0].albedo, Colour(0.5));
    EXPECT_EQ(scene.shapes[1].emission, Colour(0));
    EXPECT_EQ(std::get<Circle>(scene.shapes[1].geometry).radius, 2);
}

TEST(SceneJson, EveryLight) {
    const auto point =
        only_light<PointLight>(R"({"type": "point", "position": [5, 6], "intensity": [1, 2, 3]})");
    EXPECT_EQ(point.position, Point(5, 6));
    EXPECT_EQ(point.intensity, Colour(1, 2, 3));
    const auto spot = only_light<SpotLight>(
        R"({"type": "spot", "position": [5, 6], "direction": 45, "inner_angle": 10,
            "outer_angle": 25, "intensity": 4})");
    EXPECT_EQ(spot.position, Point(5, 6));
    EXPECT_EQ(spot.direction_deg, 45);
    EXPECT_EQ(spot.inner_angle_deg, 10);
    EXPECT_EQ(spot.outer_angle_deg, 25);
    EXPECT_EQ(spot.intensity, Colour(4));
    const auto sun = only_light<DirectionalLight>(
        R"({"type": "directional", "direction": 100, "irradiance": "#ffffff"})");
    EXPECT_EQ(sun.direction_deg, 100);
    EXPECT_EQ(sun.irradiance, Colour(1));
}

TEST(SceneJson, LightsAboveTheCanvas) {
    const auto point = only_light<PointLight>(R"({"type": "point", "position": [5, 6], "lumens": [1, 2, 3], "height": 4})");
    EXPECT_EQ(point.unit, LightUnit::lumens);
    EXPECT_EQ(point.intensity, Colour(1, 2, 3));
    EXPECT_EQ(point.height, 4);
    const auto spot = only_light<SpotLight>(
        R"({"type": "spot", "position": [5, 6], "direction": 45, "inner_angle": 10, "outer_angle": 25, "candela": 4, "height": 2, "tilt": 60})");
    EXPECT_EQ(spot.unit, LightUnit::candela);
    EXPECT_EQ(spot.height, 2);
    EXPECT_EQ(spot.tilt_deg, 60);
    const auto sun = only_light<DirectionalLight>(R"({"type": "directional", "direction": 100, "lux": 5, "elevation": 30})");
    EXPECT_EQ(sun.irradiance, Colour(5));
    EXPECT_EQ(sun.elevation_deg, 30);
    EXPECT_FALSE(only_light<DirectionalLight>(R"({"type": "directional", "direction": 100, "irradiance": 5})").elevation_deg);
}

TEST(SceneJson, GradientsOfEmission) {
    const Scene scene = good(with_shape(R"({"type": "polyline", "points": [[1, 1], [9, 9]], "albedo": 0.5,
        "emission": {"gradient": [{"at": 0.25, "emission": "#ff0000"}, {"at": 1, "emission": {"color": 0.5, "intensity": 4}}]}})"));
    const Shape& shape = scene.shapes.at(0);
    ASSERT_EQ(shape.gradient.size(), 2u);
    EXPECT_EQ(shape.gradient[0].at, 0.25);
    EXPECT_EQ(shape.gradient[0].emission, Colour(1, 0, 0));
    EXPECT_EQ(shape.gradient[1].emission, Colour(2));
    EXPECT_EQ(shape.albedo, Colour(0.5));
    EXPECT_EQ(shape.emission, Colour(0));
}

TEST(SceneJson, FloorsOfMoreThanAnAlbedo) {
    const std::string picture = R"("data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==")";
    const Scene scene = good(R"({"version": 1, "canvas": {"width": 4, "height": 4, "floor": {"image": )" + picture + R"(, "normal_map": )" +
                             picture + R"(, "tile": [1, 2, 3, 4], "metallic": 0.25}}})");
    const FloorMaterial& floor = scene.canvas.floor;
    EXPECT_TRUE(floor.image && floor.normals);
    EXPECT_EQ(floor.tile->h, 4);
    EXPECT_EQ(floor.gloss->metallic, 0.25);
    EXPECT_EQ(floor.gloss->roughness, Gloss{}.roughness);
    EXPECT_FALSE(good(R"({"version": 1, "canvas": {"width": 4, "height": 4}})").canvas.floor.gloss);
}

Colour emission(const std::string& colour) {
    const Scene scene = good(with_shape(
        R"({"type": "circle", "center": [1, 1], "radius": 1, "emission": )" + colour + "}"));
    return scene.shapes.empty() ? Colour(-1) : scene.shapes[0].emission;
}

TEST(SceneJson, ColourForms) {
    EXPECT_EQ(emission("2.5"), Colour(2.5));
    EXPECT_EQ(emission("0"), Colour(0));
    EXPECT_EQ(emission("[1, 2, 3e2]"), Colour(1, 2, 300));
    EXPECT_EQ(emission(R"("#000000")"), Colour(0));
    EXPECT_EQ(emission(R"("#ffffff")"), Colour(1));
    EXPECT_EQ(emission(R"("#FFFFFF")"), Colour(1));
    EXPECT_EQ(emission(R"({"color": [1, 2, 3], "intensity": 2})"), Colour(2, 4, 6));
    EXPECT_EQ(emission(R"({"intensity": 2, "color": 3})"), Colour(6));
    EXPECT_EQ(emission(R"({"color": 3})"), Colour(3));
    EXPECT_EQ(emission(R"({"color": "#ffffff", "intensity": 0})"), Colour(0));
}

TEST(SceneJson, HexColoursAreSrgb) {
    const Colour c = emission(R"("#bc0a01")");
    EXPECT_NEAR(c.r, 0.50288646, 1e-7);           // (188/255, on the power curve)
    EXPECT_NEAR(c.g, 10 / 255.0 / 12.92, 1e-12);  // on the straight part
    EXPECT_NEAR(c.b, 1 / 255.0 / 12.92, 1e-12);
    // The two parts of the curve meet between 10 and 11.
    EXPECT_NEAR(emission(R"("#0b0b0b")").r, std::pow((11 / 255.0 + 0.055) / 1.055, 2.4), 1e-15);
    const Colour scaled = emission(R"({"color": "#bc0a01", "intensity": 3})");
    EXPECT_DOUBLE_EQ(scaled.r, 3 * c.r);
}

TEST(SceneJson, BadColours) {
    for (const char* colour : {"\"red\"",
                               "\"#fff\"",
                               "\"#ff00000\"",
                               "\"#ff000g\"",
                               "\"ff0000\"",
                               "\"\"",
                               "\"#\"",
                               "true",
                               "null",
                               "[1, 2]",
                               "[1, 2, 3, 4]",
                               "[]",
                               "[1, 2, \"3\"]",
                               "{}",
                               "{\"color\": null}",
                               "{\"color\": 1, \"intensity\": null}",
                               "{\"color\": 1, \"intensity\": -1}",
                               "{\"color\": -1, \"intensity\": 0}",
                               "{\"color\": [1, 2, -3]}",
                               "{\"colour\": 1}",
                               "{\"color\": {\"color\": 1}}",
                               "-1",
                               "[1, -2, 3]",
                               "1e10"}) {
        const ParsedScene parsed = parse_scene(with_shape(
            std::string(R"({"type": "circle", "center": [1, 1], "radius": 1, "emission": )") +
            colour + "}"));
        EXPECT_FALSE(parsed.scene) << colour;
        EXPECT_GE(parsed.problems.size(), 1u) << colour;
        for (const LocatedProblem& problem : parsed.problems) {
            EXPECT_TRUE(problem.problem.pointer.starts_with("/shapes/0/emission"))
                << to_string(problem);
        }
    }
}

TEST(SceneJson, WholeNumbers) {
    const auto width = [](const std::string& text) {
        const ParsedScene parsed =
            parse_scene(R"({"version": 1, "canvas": {"height": 1, "width": )" + text + "}}");
        return parsed.scene ? parsed.scene->canvas.width : -1;
    };
    EXPECT_EQ(width("512"), 512);
    EXPECT_EQ(width("512.0"), 512);
    EXPECT_EQ(width("5.12e2"), 512);
    EXPECT_EQ(width("512.5"), -1);
    EXPECT_EQ(width("4294967808"), -1);  // 512 when cut to 32 bits
    EXPECT_EQ(width("18446744073709552128"), -1);
    EXPECT_EQ(width("1e300"), -1);
    EXPECT_EQ(width("-0"), -1);
}

std::string bitmap(const std::string& url, const std::string& rest = {}) {
    return R"({"type": "bitmap", "image": ")" + url + R"(", "position": [1, 2], "size": [3, 4])" +
           rest + "}";
}

TEST(SceneJson, Bitmaps) {
    Image8 image(2, 1, 4);
    image.data = {1, 2, 3, 4, 5, 6, 7, 8};
    const std::string url = data_url(encode_png(image));
    const auto plain = only_shape<Bitmap>(bitmap(url));
    ASSERT_TRUE(plain.image);
    EXPECT_EQ(plain.image->width, 2);
    EXPECT_EQ(plain.image->height, 1);
    EXPECT_EQ(plain.image->rgba, image.data);
    EXPECT_EQ(plain.position, Point(1, 2));
    EXPECT_EQ(plain.size, glm::dvec2(3, 4));
    EXPECT_EQ(plain.emission_scale, 1);
    EXPECT_EQ(plain.solid_above, 0.5);
    EXPECT_FALSE(plain.as_albedo);
    const auto set = only_shape<Bitmap>(
        bitmap(url, R"(, "emission_scale": 0.5, "solid_above": 0.25, "as": "albedo")"));
    EXPECT_EQ(set.emission_scale, 0.5);
    EXPECT_EQ(set.solid_above, 0.25);
    EXPECT_TRUE(set.as_albedo);
}

TEST(SceneJson, BitmapTextMayHaveEscapes) {
    std::string url = data_url(encode_png(Image8(3, 3, 3, 200)));
    std::string escaped;
    for (const char c : url) {
        escaped += c == '/' ? "\\/" : std::string(1, c);
    }
    EXPECT_EQ(only_shape<Bitmap>(bitmap(escaped)).image->width, 3);
}

TEST(SceneJson, BitmapsShareOneBudgetOfTexels) {
    Limits limits;
    limits.max_bitmap_texels = 50;
    limits.max_bitmap_side_px = 10;
    const std::string url = data_url(encode_png(Image8(5, 5, 1)));
    const std::string one = data_url(encode_png(Image8(1, 1, 1)));
    EXPECT_EQ(good(with_shape(bitmap(url) + "," + bitmap(url)), limits).shapes.size(), 2u);
    const ParsedScene over =
        parse_scene(with_shape(bitmap(url) + "," + bitmap(url) + "," + bitmap(one)), limits);
    EXPECT_THAT(brief(over), ElementsAre("/shapes/2/image too_large"));
    EXPECT_EQ(
        good(with_shape(bitmap(data_url(encode_png(Image8(10, 1, 1))))), limits).shapes.size(), 1u);
    const ParsedScene wide =
        parse_scene(with_shape(bitmap(data_url(encode_png(Image8(11, 1, 1))))), limits);
    EXPECT_THAT(brief(wide), ElementsAre("/shapes/0/image too_large"));
}

TEST(SceneJson, BadBitmapsSayWhy) {
    const std::string url = data_url(encode_png(Image8(3, 3, 3, 200)));
    const std::pair<std::string, std::string> cases[] = {
        {"lamp.png", "files and addresses are never opened"},
        {"http://localhost/lamp.png", "files and addresses are never opened"},
        {"data:image/gif;base64,R0lGOD", "files and addresses are never opened"},
        {"DATA:image/png;base64,AAAA", "files and addresses are never opened"},
        {"", "files and addresses are never opened"},
        {url.substr(0, 30) + "!" + url.substr(31), "base64 at character 31"},
        {url.substr(0, url.size() - 1), "base64"},
        {"data:image/png;base64,", "PNG"},
        {"data:image/png;base64,AAAA", "PNG"},
        {url.substr(0, 22 + 40), "PNG"},
    };
    for (const auto& [image, part] : cases) {
        const ParsedScene parsed = parse_scene(with_shape(bitmap(image)));
        ASSERT_EQ(parsed.problems.size(), 1u) << image << "\n" << all_text(parsed);
        EXPECT_EQ(parsed.problems[0].problem.pointer, "/shapes/0/image");
        EXPECT_EQ(parsed.problems[0].problem.code, "bad_image");
        EXPECT_NE(parsed.problems[0].problem.message.find(part), std::string::npos)
            << parsed.problems[0].problem.message;
    }
}

TEST(SceneJson, OperatorsLowerLimits) {
    Limits limits;
    limits.max_canvas_side_px = 31;
    EXPECT_THAT(brief(parse_scene(document(), limits)), ElementsAre("/canvas/width out_of_range"));
}

// Every key with a value of every wrong kind: one problem, at that value.
TEST(SceneJson, EveryKeyWithEveryWrongKind) {
    struct Key {
        const char* before;
        const char* after;
        const char* kinds;  // the first letters of the kinds that are right
    };
    const char* circle =
        R"({"version": 1, "canvas": {"width": 4, "height": 4}, "shapes": [{"type": "circle", "center": [1, 1], "radius": )";
    const Key keys[] = {
        {R"({"canvas": {"width": 4, "height": 4}, "version": )", "}", "n"},
        {R"({"version": 1, "canvas": )", "}", "o"},
        {R"({"version": 1, "canvas": {"height": 4, "width": )", "}}", "n"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4, "view": )", "}}", "a"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4, "margin": )", "}}", "n"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4, "floor": )", "}}", "o"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "sky": )", "}", "o"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "sky": {"gradient": )", "}}", "a"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "shapes": )", "}", "a"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "lights": )", "}", "a"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "render": )", "}", "o"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "output": )", "}", "o"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "render": {"method": )", "}}", "s"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "render": {"quality": )", "}}",
         "s"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "render": {"bounces": )", "}}",
         "ns"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "render": {"tolerance": )", "}}",
         "n"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "render": {"skip": )", "}}", "s"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "render": {"view": )", "}}", "s"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "output": {"antialias": )", "}}",
         "b"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "output": {"exposure": )", "}}",
         "nso"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "output": {"white": )", "}}", "n"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "output": {"look": )", "}}", "s"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "output": {"dither": )", "}}", "s"},
        {R"({"version": 1, "canvas": {"width": 4, "height": 4}, "output": {"tonemap": )", "}}",
         "s"},
        {circle, "}]}", "n"},
    };
    const std::pair<char, const char*> values[] = {{'n', "3"},   {'s', "\"x\""}, {'b', "true"},
                                                   {'a', "[1]"}, {'o', "{}"},    {'0', "null"}};
    for (const Key& key : keys) {
        for (const auto& [kind, value] : values) {
            if (std::string_view(key.kinds).find(kind) != std::string_view::npos) {
                continue;
            }
            const std::string text = key.before + std::string(value) + key.after;
            const ParsedScene parsed = parse_scene(text);
            ASSERT_EQ(parsed.problems.size(), 1u) << text << "\n" << all_text(parsed);
            EXPECT_EQ(parsed.problems[0].problem.code, "wrong_type") << text;
            EXPECT_EQ(parsed.problems[0].column, int(std::string_view(key.before).size()) + 1)
                << text;
        }
    }
}

}  // namespace
}  // namespace penumbra
