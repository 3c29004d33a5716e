// SPDX-License-Identifier: MIT
// The bounds on scenes that operators may lower: each at its limit and one past it, through the service.
#include <gmock/gmock.h>

#include "core/image/codec.h"
#include "server/http/access.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

std::string scene_with(const std::string& more) { return R"({"version": 1, "canvas": {"width": 40, "height": 30})" + more + "}"; }

std::string repeated(const std::string& item, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += (i ? ", " : "") + item;
    return text;
}

std::string bitmap(int width, int height) {
    Image8 image(width, height, 4);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = std::uint8_t(i * 7);
    const Bytes png = encode_png(image);
    return R"(, "shapes": [{"type": "bitmap", "image": "data:image/png;base64,)" + encode_base64({reinterpret_cast<const char*>(png.data()), png.size()}) +
           R"(", "position": [0, 0], "size": [10, 10]}])";
}

struct Bound {
    const char* name;
    std::function<void(SceneBounds&)> lower;
    std::function<std::string(int over)> body;  // at the limit for 0, one past for 1
};

std::ostream& operator<<(std::ostream& out, const Bound& bound) { return out << bound.name; }

class SceneBound : public testing::TestWithParam<Bound> {};

TEST_P(SceneBound, HoldsAtTheLimitAndNotOnePast) {
    Config config;
    GetParam().lower(config.bounds);
    const Service service(config);
    const auto at = service.post(GetParam().body(0));
    ASSERT_TRUE(at);
    EXPECT_EQ(at->status, 200) << at->body;
    const auto past = service.post(GetParam().body(1));
    ASSERT_TRUE(past);
    EXPECT_THAT(past->status, testing::AnyOf(400, 422)) << past->body;
    // Without the option it is within the format's own.
    EXPECT_EQ(Service().post(GetParam().body(1))->status, 200);
}

const std::string kCircle = R"({"type": "circle", "center": [5, 5], "radius": 1})";

INSTANTIATE_TEST_SUITE_P(
    All, SceneBound,
    testing::Values(
        Bound{"shapes", [](SceneBounds& b) { b.max_shapes = 3; },
              [](int over) { return scene_with(R"(, "shapes": [)" + repeated(kCircle, 3 + over) + "]"); }},
        Bound{"points", [](SceneBounds& b) { b.max_points = 8; },
              [](int over) {
                  return scene_with(R"(, "shapes": [{"type": "polyline", "width": 1, "points": [[0, 0], [1, 0], [2, 0], [3, 0]]}, {"type": "polyline", "width": 1, "points": [)" +
                                    repeated("[1, 2], [3, 4]", 2) + (over ? ", [9, 9]" : "") + "]}]");
              }},
        Bound{"lights", [](SceneBounds& b) { b.max_lights = 2; },
              [](int over) { return scene_with(R"(, "lights": [)" + repeated(R"({"type": "point", "position": [1, 2], "intensity": 1})", 2 + over) + "]"); }},
        Bound{"texels", [](SceneBounds& b) { b.max_bitmap_texels = 64; }, [](int over) { return scene_with(bitmap(8 + over, 8)); }},
        Bound{"bounces", [](SceneBounds& b) { b.max_bounces = 5; },
              [](int over) { return scene_with(R"(, "render": {"bounces": )" + std::to_string(5 + over) + "}"); }}),
    [](const auto& instance) { return std::string(instance.param.name); });

int values_in(const nlohmann::json& json) {
    int count = 1;
    if (json.is_structured()) {
        for (const auto& item : json) count += values_in(item);
    }
    return count;
}
int depth_of(const nlohmann::json& json) {
    int deepest = 0;
    if (json.is_structured()) {
        for (const auto& item : json) deepest = std::max(deepest, depth_of(item));
        return deepest + 1;
    }
    return deepest;
}

// These are known by counting, so the limit moves and the text stays.
TEST(TextBound, ValuesAndDepthHoldAtTheLimitAndNotOnePast) {
    const std::string scene = scene_with(R"(, "shapes": [)" + repeated(kCircle, 20) + "]");
    const nlohmann::json json = nlohmann::json::parse(scene);
    for (const int over : {0, 1}) {
        Config values, depth;
        values.bounds.max_json_values = std::size_t(values_in(json) - over);
        depth.bounds.max_json_depth = depth_of(json) - over;
        const auto by_values = Service(values).post(scene), by_depth = Service(depth).post(scene);
        ASSERT_TRUE(by_values && by_depth);
        EXPECT_EQ(by_values->status == 200, over == 0) << by_values->body;
        EXPECT_EQ(by_depth->status == 200, over == 0) << by_depth->body;
        if (over == 1) {
            EXPECT_THAT(by_values->body, testing::HasSubstr("too_many"));
            EXPECT_THAT(by_depth->body, testing::HasSubstr("too_deep"));
        }
    }
}

}  // namespace
}  // namespace penumbra::test
