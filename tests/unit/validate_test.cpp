// SPDX-License-Identifier: MIT
// Both sides of every range and limit of the plain scene.
#include "core/scene/validate.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "test_scenes.h"

namespace penumbra {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// One number of a scene: the values that pass, those that do not, and what is said of them.
struct NumberCase {
    std::string pointer;
    std::function<void(Scene&, double)> set;
    std::vector<double> good;
    std::vector<std::pair<double, std::string>> bad;
    bool whole = false;  // has no NaN or infinity
};

Scene with(Geometry geometry) {
    Scene scene = small_scene();
    scene.shapes.push_back({std::move(geometry), Colour(0), Colour(0)});
    return scene;
}

template <class T>
T& shape(Scene& scene) {
    if (scene.shapes.empty()) {
        scene.shapes.push_back({T{}, Colour(0), Colour(0)});
        T& made = std::get<T>(scene.shapes[0].geometry);
        if constexpr (std::is_same_v<T, Circle>) {
            made.radius = 1;
        } else if constexpr (std::is_same_v<T, Ellipse>) {
            made.radii = {1, 1};
        } else if constexpr (std::is_same_v<T, Rect>) {
            made.size = {8, 4};
        } else if constexpr (std::is_same_v<T, Polyline>) {
            made.points = {{0, 0}, {1, 1}};
        } else if constexpr (std::is_same_v<T, Polygon>) {
            made.points = {{0, 0}, {9, 0}, {0, 9}};
        } else if constexpr (std::is_same_v<T, Bitmap>) {
            made.image = std::make_shared<Texels>(Texels{1, 1, {0, 0, 0, 255}});
            made.size = {1, 1};
        }
    }
    return std::get<T>(scene.shapes[0].geometry);
}

template <class T>
T& light(Scene& scene) {
    if (scene.lights.empty()) {
        scene.lights.push_back(T{});
        if constexpr (std::is_same_v<T, SpotLight>) {
            std::get<T>(scene.lights[0]).inner_angle_deg = 10;
            std::get<T>(scene.lights[0]).outer_angle_deg = 20;
        }
    }
    return std::get<T>(scene.lights[0]);
}

ViewRect& view(Scene& scene) {
    if (!scene.canvas.view) {
        scene.canvas.view = ViewRect{0, 0, 32, 24};
    }
    return *scene.canvas.view;
}

const std::vector<std::pair<double, std::string>> kFarBad{{1.0001e9, "out_of_range"},
                                                          {-1.0001e9, "out_of_range"}};
const std::vector<double> kFarGood{0, 1e9, -1e9};
const std::vector<double> kLengthGood{1e-9, 1, 1e9};
const std::vector<std::pair<double, std::string>> kLengthBad{
    {0, "zero_area"}, {-1, "out_of_range"}, {1.0001e9, "out_of_range"}};
const std::vector<double> kBrightGood{0, 0.5, 1e9};
const std::vector<std::pair<double, std::string>> kBrightBad{{-1e-9, "out_of_range"},
                                                             {1.0001e9, "out_of_range"}};
const std::vector<double> kAlbedoGood{0, 0.5, 1};
const std::vector<std::pair<double, std::string>> kAlbedoBad{{-1e-9, "out_of_range"},
                                                             {1.0001, "out_of_range"}};
const std::vector<double> kAnyGood{-1e6, 0, 720.5};

std::vector<NumberCase> number_cases() {
    using S = Scene;
    return {
        {"/canvas/width",
         [](S& s, double v) {
             s.canvas.width = int(v);
             s.canvas.height = 1;
         },
         {1, 8192},
         {{0, "out_of_range"}, {-1, "out_of_range"}, {8193, "out_of_range"}},
         true},
        {"/canvas/height",
         [](S& s, double v) {
             s.canvas.height = int(v);
             s.canvas.width = 1;
         },
         {1, 8192},
         {{0, "out_of_range"}, {-1, "out_of_range"}, {8193, "out_of_range"}},
         true},
        {"/canvas/view/0", [](S& s, double v) { view(s).x = v; }, kFarGood, kFarBad},
        {"/canvas/view/1", [](S& s, double v) { view(s).y = v; }, kFarGood, kFarBad},
        {"/canvas/view/2",
         [](S& s, double v) {
             s.canvas.height = 32;
             view(s).w = v;
             view(s).h = v >= 1e-6 && v < 2e9 ? v : 1;
         },
         {1e-6, 1e9},
         {{0, "out_of_range"}, {-1, "out_of_range"}, {0.99e-6, "out_of_range"}}},
        {"/canvas/view/3",
         [](S& s, double v) {
             s.canvas.height = 32;
             view(s).h = v;
             view(s).w = v >= 1e-6 && v < 2e9 ? v : 1;
         },
         {1e-6, 1e9},
         {{0, "out_of_range"}, {-1, "out_of_range"}}},
        {"/canvas/margin",
         [](S& s, double v) { s.canvas.margin = v; },
         {0, 100},
         {{-1e-9, "out_of_range"}, {2e9, "out_of_range"}}},
        {"/canvas/floor/albedo", [](S& s, double v) { s.canvas.floor_albedo = Colour(v); },
         kAlbedoGood, kAlbedoBad},
        {"/canvas/floor/albedo/1",
         [](S& s, double v) {
             s.canvas.floor_albedo = {0.25, v, 0.75};
         },
         kAlbedoGood, kAlbedoBad},
        {"/sky/radiance", [](S& s, double v) { s.sky.radiance = Colour(v); }, kBrightGood,
         kBrightBad},
        {"/sky/radiance/2",
         [](S& s, double v) {
             s.sky.radiance = {1, 2, v};
         },
         kBrightGood, kBrightBad},
        {"/sky/gradient/0/angle",
         [](S& s, double v) {
             s.sky.gradient = {{v, Colour(1)}};
         },
         {0, 180, 360},
         {{-1e-9, "out_of_range"}, {360.001, "out_of_range"}}},
        {"/sky/gradient/0/radiance",
         [](S& s, double v) {
             s.sky.gradient = {{0, Colour(v)}};
         },
         kBrightGood, kBrightBad},
        {"/shapes/0/center/0", [](S& s, double v) { shape<Circle>(s).center.x = v; }, kFarGood,
         kFarBad},
        {"/shapes/0/center/1", [](S& s, double v) { shape<Circle>(s).center.y = v; }, kFarGood,
         kFarBad},
        {"/shapes/0/radius", [](S& s, double v) { shape<Circle>(s).radius = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/emission",
         [](S& s, double v) {
             shape<Circle>(s);
             s.shapes[0].emission = Colour(v);
         },
         kBrightGood, kBrightBad},
        {"/shapes/0/emission/0",
         [](S& s, double v) {
             shape<Circle>(s);
             s.shapes[0].emission = {v, 1, 2};
         },
         kBrightGood, kBrightBad},
        {"/shapes/0/albedo",
         [](S& s, double v) {
             shape<Circle>(s);
             s.shapes[0].albedo = Colour(v);
         },
         kAlbedoGood, kAlbedoBad},
        {"/shapes/0/center/0", [](S& s, double v) { shape<Ellipse>(s).center.x = v; }, kFarGood,
         kFarBad},
        {"/shapes/0/radii/0", [](S& s, double v) { shape<Ellipse>(s).radii.x = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/radii/1", [](S& s, double v) { shape<Ellipse>(s).radii.y = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/rotation",
         [](S& s, double v) { shape<Ellipse>(s).rotation_deg = v; },
         kAnyGood,
         {}},
        {"/shapes/0/center/1", [](S& s, double v) { shape<Rect>(s).center.y = v; }, kFarGood,
         kFarBad},
        {"/shapes/0/size/0", [](S& s, double v) { shape<Rect>(s).size.x = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/size/1", [](S& s, double v) { shape<Rect>(s).size.y = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/rotation",
         [](S& s, double v) { shape<Rect>(s).rotation_deg = v; },
         kAnyGood,
         {}},
        {"/shapes/0/corner_radius",
         [](S& s, double v) { shape<Rect>(s).corner_radius = v; },
         {0, 1, 2},
         {{-1e-9, "out_of_range"}, {2.0000001, "out_of_range"}}},
        {"/shapes/0/from/0", [](S& s, double v) { shape<Line>(s).from.x = v; }, kFarGood, kFarBad},
        {"/shapes/0/to/1", [](S& s, double v) { shape<Line>(s).to.y = v; }, kFarGood, kFarBad},
        {"/shapes/0/width", [](S& s, double v) { shape<Line>(s).width = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/points/1/0", [](S& s, double v) { shape<Polyline>(s).points[1].x = v; },
         kFarGood, kFarBad},
        {"/shapes/0/width", [](S& s, double v) { shape<Polyline>(s).width = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/points/2/1",
         [](S& s, double v) { shape<Polygon>(s).points[2].y = v; },
         {1, 1e9, -1e9},
         kFarBad},
        {"/shapes/0/position/0", [](S& s, double v) { shape<Bitmap>(s).position.x = v; }, kFarGood,
         kFarBad},
        {"/shapes/0/size/1", [](S& s, double v) { shape<Bitmap>(s).size.y = v; }, kLengthGood,
         kLengthBad},
        {"/shapes/0/emission_scale", [](S& s, double v) { shape<Bitmap>(s).emission_scale = v; },
         kBrightGood, kBrightBad},
        {"/shapes/0/emission_scale",
         [](S& s, double v) {
             shape<Bitmap>(s).as_albedo = true;
             shape<Bitmap>(s).emission_scale = v;
         },
         kAlbedoGood, kAlbedoBad},
        {"/shapes/0/solid_above",
         [](S& s, double v) { shape<Bitmap>(s).solid_above = v; },
         {0, 0.5, 1},
         {{-1e-9, "out_of_range"}, {1.0001, "out_of_range"}}},
        {"/lights/0/position/0", [](S& s, double v) { light<PointLight>(s).position.x = v; },
         kFarGood, kFarBad},
        {"/lights/0/intensity", [](S& s, double v) { light<PointLight>(s).intensity = Colour(v); },
         kBrightGood, kBrightBad},
        {"/lights/0/position/1", [](S& s, double v) { light<SpotLight>(s).position.y = v; },
         kFarGood, kFarBad},
        {"/lights/0/direction",
         [](S& s, double v) { light<SpotLight>(s).direction_deg = v; },
         kAnyGood,
         {}},
        {"/lights/0/inner_angle",
         [](S& s, double v) { light<SpotLight>(s).inner_angle_deg = v; },
         {0, 20},
         {{-1e-9, "out_of_range"}, {20.001, "out_of_range"}, {180.1, "out_of_range"}}},
        {"/lights/0/outer_angle",
         [](S& s, double v) { light<SpotLight>(s).outer_angle_deg = v; },
         {10, 180},
         {{-1e-9, "out_of_range"}, {180.001, "out_of_range"}}},
        {"/lights/0/intensity/1",
         [](S& s, double v) {
             light<SpotLight>(s).intensity = {1, v, 2};
         },
         kBrightGood, kBrightBad},
        {"/lights/0/direction",
         [](S& s, double v) { light<DirectionalLight>(s).direction_deg = v; },
         kAnyGood,
         {}},
        {"/lights/0/irradiance",
         [](S& s, double v) { light<DirectionalLight>(s).irradiance = Colour(v); }, kBrightGood,
         kBrightBad},
        {"/render/bounces",
         [](S& s, double v) { s.render.bounces = int(v); },
         {0, 64},
         {{-1, "out_of_range"}, {65, "out_of_range"}},
         true},
        {"/output/bit_depth",
         [](S& s, double v) { s.output.bit_depth = int(v); },
         {8, 16},
         {{0, "unknown_value"}, {7, "unknown_value"}, {12, "unknown_value"}, {-8, "unknown_value"}},
         true},
        {"/output/exposure",
         [](S& s, double v) { s.output.exposure_ev = v; },
         {-64, 0, 64},
         {{-64.001, "out_of_range"}, {64.001, "out_of_range"}}},
    };
}

TEST(Validate, BothSidesOfEveryRange) {
    for (const NumberCase& test : number_cases()) {
        for (const double good : test.good) {
            Scene scene = small_scene();
            test.set(scene, good);
            EXPECT_THAT(brief(validate(scene)), IsEmpty()) << test.pointer << " = " << good;
        }
        auto bad = test.bad;
        if (!test.whole) {
            bad.insert(bad.end(),
                       {{kNan, "not_finite"}, {kInf, "not_finite"}, {-kInf, "not_finite"}});
        }
        for (const auto& [value, code] : bad) {
            Scene scene = small_scene();
            test.set(scene, value);
            EXPECT_THAT(brief(validate(scene)), ElementsAre(test.pointer + " " + code))
                << test.pointer << " = " << value;
        }
    }
}

TEST(Validate, MessagesSayWhatIsAllowedAndWhatWasGiven) {
    Scene scene = small_scene();
    shape<Circle>(scene).radius = -1;
    EXPECT_EQ(validate(scene)[0].message, "must be more than 0, is -1");
    shape<Circle>(scene).radius = 0;
    EXPECT_EQ(validate(scene)[0].message, "must be more than 0, is 0: shape 0 would have no area");
    shape<Circle>(scene).radius = 1;
    scene.shapes[0].albedo = Colour(1.5);
    EXPECT_EQ(validate(scene)[0].message, "must be from 0 to 1, is 1.5");
}

TEST(Validate, DefaultsAreGood) { EXPECT_THAT(brief(validate(small_scene())), IsEmpty()); }

TEST(Validate, ProblemsComeInTheOrderOfTheDocument) {
    Scene scene = small_scene();
    scene.canvas.width = 0;
    scene.sky.radiance = Colour(-1);
    scene.shapes = {{Circle{}, Colour(0), Colour(0)}, {Circle{{0, 0}, 1}, Colour(-1), Colour(2)}};
    scene.lights = {PointLight{{0, 0}, Colour(-1)}};
    scene.render.method = "none";
    scene.output.format = "bmp";
    EXPECT_THAT(brief(validate(scene)),
                ElementsAre("/canvas/width out_of_range", "/sky/radiance out_of_range",
                            "/shapes/0/radius zero_area", "/shapes/1/emission out_of_range",
                            "/shapes/1/albedo out_of_range", "/lights/0/intensity out_of_range",
                            "/render/method unknown_value", "/output/format unknown_value"));
}

TEST(Validate, AGreyIsOneProblemAColourOnePerChannel) {
    Scene scene = small_scene();
    scene.sky.radiance = {-1, 2, -3};
    EXPECT_THAT(brief(validate(scene)),
                ElementsAre("/sky/radiance/0 out_of_range", "/sky/radiance/2 out_of_range"));
}

TEST(Validate, PixelsMustBeSquare) {
    Scene scene = small_scene();
    scene.canvas.view = ViewRect{0, 0, 32, 24 * (1 + 0.9e-6)};
    EXPECT_THAT(brief(validate(scene)), IsEmpty());
    scene.canvas.view->h = 24 * (1 + 1.2e-6);
    EXPECT_THAT(brief(validate(scene)), ElementsAre("/canvas/view not_square"));
    scene.canvas.view->h = 24 * (1 - 1.2e-6);
    EXPECT_THAT(brief(validate(scene)), ElementsAre("/canvas/view not_square"));
    scene.canvas.view->h = 32;
    EXPECT_EQ(validate(scene)[0].message,
              "must make square pixels: for 32 x 24 pixels a view 32 wide must be 24 high, is 32");
}

TEST(Validate, LimitsOfTheCanvas) {
    Limits limits;
    limits.max_canvas_pixels = 32 * 24;
    EXPECT_THAT(brief(validate(small_scene(), limits)), IsEmpty());
    limits.max_canvas_pixels = 32 * 24 - 1;
    EXPECT_THAT(brief(validate(small_scene(), limits)), ElementsAre("/canvas too_large"));
}

TEST(Validate, LimitsOfTheDomain) {
    Scene scene = small_scene();
    Limits limits;
    scene.canvas.margin = 4;
    limits.max_domain_side_px = 40;
    EXPECT_THAT(brief(validate(scene, limits)), IsEmpty());
    scene.canvas.margin = 4.01;
    EXPECT_THAT(brief(validate(scene, limits)), ElementsAre("/canvas/margin too_large"));
    scene.canvas.margin = 4;
    limits.max_domain_pixels = 40 * 32;
    EXPECT_THAT(brief(validate(scene, limits)), IsEmpty());
    limits.max_domain_pixels = 40 * 32 - 1;
    EXPECT_THAT(brief(validate(scene, limits)), ElementsAre("/canvas/margin too_large"));
    scene.canvas.margin = 0;
    limits.max_domain_side_px = 31;
    EXPECT_THAT(brief(validate(scene, limits)), ElementsAre("/canvas too_large"));
}

TEST(Validate, TheMarginCountsInPixelsOfTheView) {
    Scene scene = small_scene();
    scene.canvas.view = ViewRect{0, 0, 320, 240};  // ten units a pixel
    Limits limits;
    limits.max_domain_side_px = 40;
    scene.canvas.margin = 40;
    EXPECT_THAT(brief(validate(scene, limits)), IsEmpty());
    scene.canvas.margin = 41;
    EXPECT_THAT(brief(validate(scene, limits)), ElementsAre("/canvas/margin too_large"));
}

TEST(Validate, DefaultLimitsAllowTheLargestCanvas) {
    Scene scene = small_scene();
    scene.canvas.width = scene.canvas.height = 8192;
    EXPECT_THAT(brief(validate(scene)), IsEmpty());
    scene.canvas.margin = 4096;
    EXPECT_THAT(brief(validate(scene)), ElementsAre("/canvas/margin too_large"));
}

TEST(Validate, CountsOfShapesLightsAndStops) {
    Limits limits;
    limits.max_shapes = 3;
    limits.max_lights = 2;
    limits.max_sky_stops = 4;
    Scene scene = small_scene();
    scene.shapes.assign(3, {Circle{{0, 0}, 1}, Colour(0), Colour(0)});
    scene.lights.assign(2, PointLight{});
    scene.sky.gradient = {{0, {}}, {1, {}}, {2, {}}, {3, {}}};
    EXPECT_THAT(brief(validate(scene, limits)), IsEmpty());
    scene.shapes.push_back(scene.shapes[0]);
    scene.lights.push_back(PointLight{});
    scene.sky.gradient.push_back({4, {}});
    EXPECT_THAT(brief(validate(scene, limits)),
                ElementsAre("/sky/gradient too_many", "/shapes too_many", "/lights too_many"));
    EXPECT_EQ(validate(scene, limits)[1].message, "must hold at most 3 shapes, holds 4");
}

TEST(Validate, DefaultCounts) {
    Scene scene = small_scene();
    scene.shapes.assign(20000, {Circle{{0, 0}, 1}, Colour(0), Colour(0)});
    scene.lights.assign(1000, PointLight{});
    scene.sky.gradient.assign(256, {});
    for (std::size_t i = 0; i < 256; ++i) {
        scene.sky.gradient[i].angle_deg = double(i);
    }
    EXPECT_THAT(brief(validate(scene)), IsEmpty());
    scene.shapes.push_back(scene.shapes[0]);
    scene.lights.push_back(scene.lights[0]);
    scene.sky.gradient.push_back({300, {}});
    EXPECT_THAT(brief(validate(scene)),
                ElementsAre("/sky/gradient too_many", "/shapes too_many", "/lights too_many"));
}

TEST(Validate, CountsOfPoints) {
    Limits limits;
    limits.max_points_per_shape = 5;
    limits.max_points = 9;
    Scene scene = small_scene();
    shape<Polyline>(scene).points.assign(5, {1, 2});
    EXPECT_THAT(brief(validate(scene, limits)), IsEmpty());
    shape<Polyline>(scene).points.push_back({1, 2});
    EXPECT_THAT(brief(validate(scene, limits)), ElementsAre("/shapes/0/points too_many"));
    shape<Polyline>(scene).points.assign(5, {1, 2});
    scene.shapes.push_back({Polygon{{{0, 0}, {1, 0}, {0, 1}, {0, 2}}}, Colour(0), Colour(0)});
    EXPECT_THAT(brief(validate(scene, limits)), IsEmpty());
    std::get<Polygon>(scene.shapes[1].geometry).points.push_back({0, 3});
    EXPECT_THAT(brief(validate(scene, limits)), ElementsAre("/shapes too_many"));
}

TEST(Validate, TexelsOfAllBitmapsTogether) {
    Limits limits;
    limits.max_bitmap_texels = 8;
    limits.max_bitmap_side_px = 4;
    Scene scene = small_scene();
    shape<Bitmap>(scene).image = std::make_shared<Texels>(Texels{4, 1, {}});
    scene.shapes.push_back(scene.shapes[0]);
    EXPECT_THAT(brief(validate(scene, limits)), IsEmpty());
    limits.max_bitmap_texels = 7;
    EXPECT_THAT(brief(validate(scene, limits)), ElementsAre("/shapes too_large"));
    limits.max_bitmap_texels = 8;
    limits.max_bitmap_side_px = 3;
    EXPECT_THAT(brief(validate(scene, limits)),
                ElementsAre("/shapes/0/image too_large", "/shapes/1/image too_large"));
}

TEST(Validate, BitmapsNeedTexels) {
    Scene scene = small_scene();
    shape<Bitmap>(scene).image = nullptr;
    EXPECT_THAT(brief(validate(scene)), ElementsAre("/shapes/0/image zero_area"));
    shape<Bitmap>(scene).image = std::make_shared<Texels>(Texels{0, 4, {}});
    EXPECT_THAT(brief(validate(scene)), ElementsAre("/shapes/0/image zero_area"));
}

TEST(Validate, ABitmapsOwnColoursAreNotLookedAt) {
    Scene scene = small_scene();
    shape<Bitmap>(scene);
    scene.shapes[0].emission = Colour(-1);
    EXPECT_THAT(brief(validate(scene)), IsEmpty());
}

TEST(Validate, PolygonsWithoutArea) {
    const std::vector<std::vector<Point>> bad{
        {},
        {{1, 1}},
        {{1, 1}, {2, 2}},
        {{1, 1}, {1, 1}, {1, 1}},
        {{1, 1}, {2, 5}, {1, 1}, {2, 5}},
        {{0, 0}, {1, 1}, {2, 2}},
        {{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}, {0.7, 0.7}},
        {{5, 0}, {5, 1}, {5, 7}},
        {{1e8 + 0.1, 3e7 + 0.3}, {1e8 + 0.2, 3e7 + 0.6}, {1e8 + 0.3, 3e7 + 0.9}},
    };
    for (const auto& points : bad) {
        const Problems problems = validate(with(Polygon{points}));
        EXPECT_THAT(brief(problems), ElementsAre("/shapes/0/points zero_area"));
        EXPECT_NE(problems[0].message.find("shape 0 would have no area"), std::string::npos);
    }
    const std::vector<std::vector<Point>> good{
        {{0, 0}, {1, 0}, {0, 1}},         {{0, 0}, {1, 1}, {2, 2.0001}},
        {{0, 0}, {1e-7, 0}, {0, 1e-7}},   {{1e6, 1e6}, {1e6 + 1e-3, 1e6}, {1e6, 1e6 + 1e-3}},
        {{0, 0}, {0, 0}, {1, 0}, {0, 1}}, {{0, 0}, {2, 2}, {2, 0}, {0, 2}},
    };
    for (const auto& points : good) {
        EXPECT_THAT(brief(validate(with(Polygon{points}))), IsEmpty());
    }
}

TEST(Validate, AStrokeOfNoLengthIsADisc) {
    EXPECT_THAT(brief(validate(with(Line{{1, 1}, {1, 1}, 2}))), IsEmpty());
    EXPECT_THAT(brief(validate(with(Polyline{{{1, 1}, {1, 1}}, 2, false}))), IsEmpty());
    EXPECT_THAT(brief(validate(with(Polyline{{{1, 1}}, 2, false}))),
                ElementsAre("/shapes/0/points too_few"));
}

TEST(Validate, AnglesOfASky) {
    const auto angles = [](std::vector<double> list) {
        Scene scene = small_scene();
        for (const double a : list) {
            scene.sky.gradient.push_back({a, Colour(1)});
        }
        return brief(validate(scene));
    };
    EXPECT_THAT(angles({0, 90, 360}), IsEmpty());
    EXPECT_THAT(angles({0, 0, 90}), IsEmpty());
    EXPECT_THAT(angles({5, 90, 90, 300, 300}), IsEmpty());
    EXPECT_THAT(angles({90, 89.99}), ElementsAre("/sky/gradient/1/angle not_in_order"));
    EXPECT_THAT(angles({90, 90, 90}), ElementsAre("/sky/gradient/2/angle too_many"));
    EXPECT_THAT(angles({0, 0, 360}), ElementsAre("/sky/gradient/2/angle too_many"));
    EXPECT_THAT(angles({0, 10, 360, 360}), ElementsAre("/sky/gradient/3/angle too_many"));
    EXPECT_THAT(angles({360, 360}), IsEmpty());
}

TEST(Validate, WordsWithTheNearestKnownOne) {
    Scene scene = small_scene();
    scene.render.method = "rc_fx";
    scene.render.view = "cascade99";
    scene.output.format = "PNG";
    scene.output.tonemap = "reinhardt";
    const Problems problems = validate(scene);
    EXPECT_THAT(brief(problems),
                ElementsAre("/render/method unknown_value", "/render/view unknown_value",
                            "/output/format unknown_value", "/output/tonemap unknown_value"));
    EXPECT_EQ(
        problems[0].message,
        "must be auto, rc, rc_fix, hrc, exact, hybrid or reference, is \"rc_fx\" (did you mean "
        "\"rc_fix\"?)");
    EXPECT_NE(problems[2].message.find("did you mean \"png\""), std::string::npos);
    EXPECT_NE(problems[3].message.find("did you mean \"reinhard\""), std::string::npos);
}

TEST(Validate, EveryKnownWordIsGood) {
    for (const char* word : {"auto", "rc", "rc_fix", "hrc", "exact", "hybrid", "reference"}) {
        Scene scene = small_scene();
        scene.render.method = word;
        EXPECT_THAT(brief(validate(scene)), IsEmpty()) << word;
    }
    for (const char* word :
         {"final", "distance", "cascade0", "cascade12", "probes", "steps", "normals", "skipped", "light3", "shape0", "sky", "error"}) {
        Scene scene = small_scene();
        scene.render.view = word;
        EXPECT_THAT(brief(validate(scene)), IsEmpty()) << word;
    }
    for (const char* word : {"png", "pfm", "exr", "hdr", "npy"}) {
        Scene scene = small_scene();
        scene.output.format = word;
        EXPECT_THAT(brief(validate(scene)), IsEmpty()) << word;
    }
    for (const char* word :
         {"none", "reinhard", "reinhard_extended", "aces", "agx", "pbr_neutral", "tony"}) {
        Scene scene = small_scene();
        scene.output.tonemap = word;
        EXPECT_THAT(brief(validate(scene)), IsEmpty()) << word;
    }
}

}  // namespace
}  // namespace penumbra
