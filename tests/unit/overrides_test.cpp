// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "test_scenes.h"

namespace penumbra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

ParsedScene with_overrides(const std::string& text, const std::vector<Override>& overrides) {
    return parse_scene(text, {}, {}, overrides);
}

Scene good(const std::string& text, const std::vector<Override>& overrides) {
    const ParsedScene parsed = with_overrides(text, overrides);
    EXPECT_TRUE(parsed.scene) << all_text(parsed);
    return parsed.scene.value_or(Scene{});
}

const std::string kCircle = R"({"type": "circle", "center": [1, 2], "radius": 3})";

TEST(Overrides, ReplaceValues) {
    const Scene scene = good(with_shape(kCircle), {{"/canvas/width", "64"},
                                                   {"/shapes/0/radius", "7.5"},
                                                   {"/shapes/0/center/1", "-4"},
                                                   {"/canvas/width", "65"}});
    EXPECT_EQ(scene.canvas.width, 65);  // the last one wins
    EXPECT_EQ(std::get<Circle>(scene.shapes[0].geometry).radius, 7.5);
    EXPECT_EQ(std::get<Circle>(scene.shapes[0].geometry).center, Point(1, -4));
}

TEST(Overrides, MakeWhatIsMissingOnTheWay) {
    const Scene scene = good(document(), {{"/output/exposure", "2"},
                                          {"/canvas/floor/albedo", "[0.5, 0.25, 1]"},
                                          {"/sky/gradient/-/angle", "10"},
                                          {"/sky/gradient/0/radiance", "0.5"},
                                          {"/output/tonemap", "aces"}});
    EXPECT_EQ(scene.output.exposure_ev, 2);
    EXPECT_EQ(scene.output.tonemap, "aces");  // no JSON, so a string
    EXPECT_EQ(scene.canvas.floor_albedo, Colour(0.5, 0.25, 1));
    ASSERT_EQ(scene.sky.gradient.size(), 1u);
    EXPECT_EQ(scene.sky.gradient[0].angle_deg, 10);
}

TEST(Overrides, AppendToLists) {
    const Scene scene =
        good(with_shape(kCircle),
             {{"/shapes/-", kCircle}, {"/shapes/2", kCircle}, {"/shapes/2/radius", "9"}});
    ASSERT_EQ(scene.shapes.size(), 3u);
    EXPECT_EQ(std::get<Circle>(scene.shapes[2].geometry).radius, 9);
    EXPECT_EQ(std::get<Circle>(scene.shapes[1].geometry).radius, 3);
}

TEST(Overrides, ReplaceWholeObjects) {
    const Scene scene = good(document(), {{"/canvas", R"({"width": 5, "height": 6})"}});
    EXPECT_EQ(scene.canvas.width, 5);
    EXPECT_EQ(scene.canvas.height, 6);
}

TEST(Overrides, QuotedTextIsTheSameString) {
    EXPECT_EQ(good(document(), {{"/output/tonemap", "\"agx\""}}).output.tonemap, "agx");
}

TEST(Overrides, MayMendAScene) {
    EXPECT_TRUE(with_overrides(with_shape(R"({"type": "circle", "center": [1, 2], "radius": -3})"),
                               {{"/shapes/0/radius", "3"}})
                    .scene);
}

TEST(Overrides, ProblemsWithTheirValuesHaveNoPlaceInTheText) {
    const ParsedScene parsed =
        with_overrides(document(), {{"/canvas/width", "-1"}, {"/lamp/x", "3"}});
    EXPECT_THAT(brief(parsed), ElementsAre("/lamp unknown_key", "/canvas/width out_of_range"));
    EXPECT_EQ(parsed.problems[0].line, 0);
    EXPECT_EQ(parsed.problems[1].line, 0);
    EXPECT_TRUE(parsed.is_json);
}

TEST(Overrides, ProblemsNameTheOverrideThatMadeThem) {
    const ParsedScene parsed =
        with_overrides(with_shape(R"({"type": "circle", "center": [1, 2], "radius": -1})"),
                       {{"/canvas/width", "8"},
                        {"/canvas/width", "0"},
                        {"/shapes/-", R"({"type": "circle", "center": [1, "x"]})"},
                        {"/shapes/-/radius", "1"},
                        {"/output/tonemap", "acse"},
                        {"/version/x", "1"}});
    std::vector<std::string> places;
    for (const LocatedProblem& p : parsed.problems) {
        places.push_back(p.problem.pointer + " " + p.set_at + " " + std::to_string(p.line));
    }
    EXPECT_THAT(places, testing::UnorderedElementsAre(
                            "/version/x /version/x 0", "/shapes/1/center/1 /shapes/- 0",
                            "/shapes/1/radius /shapes/- 0", "/shapes/2/type /shapes/-/radius 0",
                            "/canvas/width /canvas/width 0", "/output/tonemap /output/tonemap 0",
                            "/shapes/0/radius  1"));
    EXPECT_EQ(to_string(LocatedProblem{{"/a/b", "c", "m"}, 0, 0, "", "/a"}), "/a/b (--set /a): m");
}

TEST(Overrides, ProblemsOfOthersNameThemToo) {
    const std::string text = document(R"(, "render": {"bounces": 0, "method": "rc"})");
    const auto located = locate(text,
                                {{"/render/bounces", "x", "a"},
                                 {"/output/tonemap", "x", "b"},
                                 {"/render/method", "x", "c"}},
                                {{"/render/bounces", "2"}, {"/output/tonemap", "aces"}});
    ASSERT_EQ(located.size(), 3u);
    EXPECT_EQ(to_string(located[0]), "/render/bounces (--set /render/bounces): a");
    EXPECT_EQ(to_string(located[1]), "/output/tonemap (--set /output/tonemap): b");
    EXPECT_EQ(located[2].set_at, "");
    EXPECT_EQ(located[2].line, 1);
}

TEST(Overrides, BadPointersAreNamed) {
    const std::pair<std::string, std::string> cases[] = {
        {"", "must start with /"},
        {"canvas/width", "must start with /"},
        {"/version/x", "goes on inside a number"},
        {"/shapes/7", "the list holds 1"},
        {"/shapes/01", "has no place \"01\""},
        {"/shapes/x/radius", "has no place \"x\""},
        {"/shapes/0/type/x", "goes on inside a string"},
    };
    for (const auto& [pointer, part] : cases) {
        const ParsedScene parsed = with_overrides(with_shape(kCircle), {{pointer, "1"}});
        ASSERT_EQ(parsed.problems.size(), 1u) << pointer << "\n" << all_text(parsed);
        EXPECT_EQ(parsed.problems[0].problem.code, "bad_override");
        EXPECT_EQ(parsed.problems[0].line, 0);
        EXPECT_THAT(parsed.problems[0].problem.message, HasSubstr("the override of \"" + pointer));
        EXPECT_THAT(parsed.problems[0].problem.message, HasSubstr(part));
    }
}

TEST(Overrides, EscapedTokens) {
    const ParsedScene parsed = with_overrides(document(), {{"/a~1b~0", "1"}});
    EXPECT_THAT(brief(parsed), ElementsAre("/a~1b~0 unknown_key"));
}

TEST(Overrides, KeepTheLimitsOfTheText) {
    const ParsedScene parsed = with_overrides(document(), {{"/sky", std::string(40, '[')}});
    ASSERT_EQ(parsed.problems.size(), 1u);
    EXPECT_EQ(parsed.problems[0].problem.code, "bad_override");
    EXPECT_THAT(parsed.problems[0].problem.message, HasSubstr("nested"));
}

TEST(Overrides, DoNotRescueATextThatIsNoJson) {
    EXPECT_FALSE(with_overrides("{", {{"/version", "1"}}).is_json);
    EXPECT_FALSE(with_overrides("", {{"/version", "1"}}).is_json);
}

}  // namespace
}  // namespace penumbra
