// SPDX-License-Identifier: MIT
// The list of problems: places, suggestions, order, what is left out.
#include <gmock/gmock.h>

#include "test_scenes.h"

namespace penumbra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const LocatedProblem& only(const ParsedScene& parsed) {
    static const LocatedProblem kNone;
    EXPECT_EQ(parsed.problems.size(), 1u) << all_text(parsed);
    return parsed.problems.empty() ? kNone : parsed.problems[0];
}

TEST(Problems, AllInOneGoInTheOrderOfTheText) {
    const std::string text = R"({
  "output": {"tonemap": "acse", "exposure": "1"},
  "shapes": [
    {"type": "circle", "center": [1, 2], "radius": -1, "emision": 3},
    {"type": "circle", "centre": [1, 2], "radius": 1},
    {"type": "rekt"}
  ],
  "canvas": {"width": 3.5, "height": 0},
  "version": 1,
  "version": 1
})";
    const ParsedScene parsed = parse_scene(text);
    std::vector<std::string> lines;
    for (const LocatedProblem& p : parsed.problems) {
        lines.push_back(std::to_string(p.line) + ":" + std::to_string(p.column) + " " +
                        p.problem.pointer + " " + p.problem.code + " " + p.suggestion);
    }
    EXPECT_THAT(
        lines,
        ElementsAre("2:25 /output/tonemap unknown_value aces", "2:45 /output/exposure unknown_value ",
                    "4:52 /shapes/0/radius out_of_range ",
                    "4:56 /shapes/0/emision unknown_key emission",
                    "5:5 /shapes/1/center missing_key ", "5:24 /shapes/1/centre unknown_key center",
                    "6:14 /shapes/2/type unknown_value rect", "8:23 /canvas/width wrong_type ",
                    "8:38 /canvas/height out_of_range ", "10:3 /version duplicate_key "));
    EXPECT_TRUE(parsed.is_json);
    EXPECT_EQ(parsed.problems_left_out, 0u);
}

TEST(Problems, ReadWellOnATerminal) {
    EXPECT_EQ(to_string(only(parse_scene(
                  with_shape("\n{\"type\": \"circle\", \"center\": [1, 2], \"radius\": -1}")))),
              "/shapes/0/radius (line 2, column 48): must be more than 0, is -1");
    EXPECT_EQ(to_string(only(parse_scene("[]"))),
              "line 1, column 1: must be a scene, an object in braces, is a list");
    EXPECT_EQ(to_string(LocatedProblem{{"/a", "c", "m"}, 0, 0, ""}), "/a: m");
    EXPECT_EQ(to_string(LocatedProblem{{"", "c", "m"}, 0, 0, ""}), "m");
}

TEST(Problems, ColumnsCountBytesAndLinesEndInNewline) {
    const ParsedScene parsed =
        parse_scene("{\r\n\"\xc3\xa4\": 1, \"version\": 2,\r\n\"canvas\": 1}");
    EXPECT_THAT(brief(parsed), ElementsAre("/\xc3\xa4 unknown_key", "/version unsupported_version",
                                           "/canvas wrong_type"));
    EXPECT_EQ(parsed.problems[0].column, 1);
    EXPECT_EQ(parsed.problems[1].line, 2);
    EXPECT_EQ(parsed.problems[1].column, 21);
    EXPECT_EQ(parsed.problems[2].line, 3);
    EXPECT_EQ(parsed.problems[2].column, 11);
}

TEST(Problems, AMissingKeyStandsAtItsObject) {
    const LocatedProblem problem =
        only(parse_scene("{\"version\": 1,\n \"canvas\": {\"width\": 4}}"));
    EXPECT_EQ(problem.problem.pointer, "/canvas/height");
    EXPECT_EQ(problem.problem.message, "is missing: a canvas needs \"height\"");
    EXPECT_EQ(problem.line, 2);
    EXPECT_EQ(problem.column, 12);
}

TEST(Problems, ADefaultThatIsWrongStandsAtWhatShouldHoldIt) {
    Limits limits;
    limits.max_exposure_ev = -1;  // an operator's slip, to make an absent key wrong
    const LocatedProblem problem = only(parse_scene(document(",\n\"output\": {}"), limits));
    EXPECT_EQ(problem.problem.pointer, "/output/exposure");
    EXPECT_EQ(problem.line, 2);
    EXPECT_EQ(problem.column, 11);
}

TEST(Problems, Suggestions) {
    const std::pair<std::string, std::string> cases[] = {
        {R"({"type": "circle", "center": [1, 1], "radius": 1, "emision": 1})", "emission"},
        {R"({"type": "circle", "center": [1, 1], "radius": 1, "color": 1})", "emission"},
        {R"({"type": "circle", "center": [1, 1], "radius": 1, "Albedo": 1})", "albedo"},
        {R"({"type": "rect", "center": [1, 1], "size": [1, 1], "angle": 1})", "rotation"},
        {R"({"type": "rect", "center": [1, 1], "size": [1, 1], "cornerRadius": 1})",
         "corner_radius"},
        {R"({"type": "polygon", "points": [[0, 0], [1, 0], [0, 1]], "vertices": 1})", "points"},
        {R"({"type": "circle", "center": [1, 1], "radius": 1, "zzz": 1})", ""},
        {R"({"type": "elipse", "center": [1, 1]})", "ellipse"},
        {R"({"type": "box"})", ""},
    };
    for (const auto& [shape, suggestion] : cases) {
        const LocatedProblem problem = only(parse_scene(with_shape(shape)));
        EXPECT_EQ(problem.suggestion, suggestion) << shape;
        if (!suggestion.empty()) {
            EXPECT_THAT(problem.problem.message, HasSubstr("did you mean \"" + suggestion + "\"?"));
        }
    }
    // British spelling means the format's own key where it has that one, and what it calls light
    // elsewhere.
    const std::string circle =
        R"({"type": "circle", "center": [1, 1], "radius": 1, "emission": {"color": 1, )";
    for (const char* written : {"colour", "Colour", "colr", "colors"}) {
        const std::string text = with_shape(circle + "\"" + written + "\": 1}}");
        EXPECT_EQ(only(parse_scene(text)).suggestion, "color") << written;
    }
    for (const char* written : {"color", "colour", "Colour"}) {
        const std::string key = std::string("\"") + written + "\": 1";
        const std::pair<std::string, std::string> places[] = {
            {with_shape(R"({"type": "circle", "center": [1, 1], "radius": 1, )" + key + "}"),
             "emission"},
            {document(R"(, "sky": {)" + key + "}"), "radiance"},
            {document(R"(, "lights": [{"type": "point", "position": [1, 1], "intensity": 1, )" +
                      key + "}]"),
             "intensity"},
            {document(R"(, "lights": [{"type": "directional", "direction": 1, "irradiance": 1, )" +
                      key + "}]"),
             "irradiance"},
        };
        for (const auto& [text, suggestion] : places) {
            EXPECT_EQ(only(parse_scene(text)).suggestion, suggestion) << text;
        }
    }
    EXPECT_EQ(only(parse_scene(document(R"(, "render": {"quality": "hihg"})"))).suggestion, "high");
    EXPECT_EQ(only(parse_scene(document(R"(, "render": {"method": "refrence"})"))).suggestion,
              "reference");
    EXPECT_EQ(only(parse_scene(document(R"(, "shape": [])"))).suggestion, "shapes");
}

TEST(Problems, AKeyInTheWrongObjectIsSentHome) {
    EXPECT_THAT(only(parse_scene(document(R"(, "render": {"exposure": 1})"))).problem.message,
                HasSubstr("it belongs in \"output\""));
    EXPECT_THAT(only(parse_scene(document(R"(, "bounces": 1)"))).problem.message,
                HasSubstr("it belongs in \"render\""));
}

TEST(Problems, LongValuesAreCut) {
    const std::string longest(100000, 'q');
    for (const std::string& text :
         {document(R"(, "output": {"format": ")" + longest + "\"}"),
          document(", \"" + longest + "\": 1"), with_shape(R"({"type": ")" + longest + "\"}"),
          with_shape(R"({"type": "circle", "center": [1, 1], "radius": 1, "emission": ")" +
                     longest + "\"}"),
          with_shape(R"({"type": "bitmap", "position": [1, 1], "size": [1, 1], "image": ")" +
                     longest + "\"}"),
          "[" + longest + "]"}) {
        EXPECT_LT(only(parse_scene(text)).problem.message.size(), 260u);
    }
}

TEST(Problems, AreCappedAndTheRestCounted) {
    TextLimits limits;
    limits.max_problems = 10;
    std::string shapes;
    for (int i = 0; i < 25; ++i) {
        shapes += R"({"type": "circle", "center": [1, 1], "radius": 1, "oops": 1},)";
    }
    shapes.pop_back();
    const ParsedScene parsed = parse_scene(with_shape(shapes), {}, limits);
    EXPECT_EQ(parsed.problems.size(), 10u);
    EXPECT_EQ(parsed.problems_left_out, 15u);
    EXPECT_EQ(parsed.problems[9].problem.pointer, "/shapes/9/oops");
    limits.max_problems = 25;
    EXPECT_EQ(parse_scene(with_shape(shapes), {}, limits).problems_left_out, 0u);
}

TEST(Problems, ValidationIsCappedToo) {
    TextLimits limits;
    limits.max_problems = 3;
    const std::string bad = R"({"type": "circle", "center": [1, 1], "radius": -1})";
    const ParsedScene parsed =
        parse_scene(with_shape(bad + "," + bad + "," + bad + "," + bad), {}, limits);
    EXPECT_EQ(parsed.problems.size(), 3u);
    EXPECT_EQ(parsed.problems_left_out, 1u);
    EXPECT_FALSE(parsed.scene);
}

TEST(Problems, WhatOnlyFollowsIsNotSaid) {
    // The radius cannot be judged, the view and so its pixels cannot, the type cannot.
    EXPECT_THAT(brief(parse_scene(R"({"version": 1, "canvas": {"width": 4, "height": "4",
        "view": [0, 0, null, 4], "margin": 1e8}, "shapes": [
        {"type": "circle", "center": [1, "x"], "radius": null, "emission": [1, 2]},
        {"type": "polygon", "points": [[1, 1], [2], [3, 3]]}, {"kind": "circle"},
        {"type": "circle", "center": [0, 0], "radius": 1,
         "emission": {"color": "#zzzzzz", "intensity": -1}}]})")),
                ElementsAre("/canvas/height wrong_type", "/canvas/view/2 wrong_type",
                            "/shapes/0/center/1 wrong_type", "/shapes/0/radius wrong_type",
                            "/shapes/0/emission wrong_length", "/shapes/1/points/1 wrong_length",
                            "/shapes/2/type missing_key", "/shapes/3/emission/color bad_colour",
                            "/shapes/3/emission/intensity out_of_range"));
}

TEST(Problems, AConflictHidesNoOtherProblem) {
    EXPECT_THAT(
        brief(parse_scene(document(R"(, "sky": {"radiance": -1, "gradient": [
        {"angle": 10, "radiance": 1}, {"angle": 5, "radiance": -2}, {"angle": 400, "radiance": "x"}]})"))),
        ElementsAre("/sky/radiance out_of_range", "/sky/gradient conflict",
                    "/sky/gradient/1/angle not_in_order", "/sky/gradient/1/radiance out_of_range",
                    "/sky/gradient/2/angle out_of_range", "/sky/gradient/2/radiance bad_colour"));
    Limits limits;
    limits.max_sky_stops = 1;
    EXPECT_THAT(brief(parse_scene(document(R"(, "sky": {"radiance": 1, "gradient": [
        {"angle": 1, "radiance": 1}, {"angle": 2, "radiance": 2}]})"),
                                  limits)),
                ElementsAre("/sky/gradient conflict", "/sky/gradient too_many"));
}

TEST(Problems, NumbersThatNoIntegerHoldsAreToldTheRealLimit) {
    const std::pair<std::string, std::string> cases[] = {
        {R"({"version": 1, "canvas": {"width": 3000000001, "height": 4}})",
         "must be from 1 to 8192, is 3000000001"},
        {R"({"version": 1, "canvas": {"width": 4, "height": -1e300}})",
         "must be from 1 to 8192, is -1e+300"},
        {document(R"(, "render": {"bounces": 2147483648})"), "must be from 0 to 64, or \"converged\", is 2147483648"},
        {document(R"(, "output": {"bit_depth": 1e10})"), "must be 8, 16 or 32, is 1e+10"},
    };
    for (const auto& [text, message] : cases) {
        EXPECT_EQ(only(parse_scene(text)).problem.message, message);
    }
    Limits limits;
    limits.max_canvas_side_px = 100;
    EXPECT_EQ(only(parse_scene(cases[0].first, limits)).problem.message,
              "must be from 1 to 100, is 3000000001");
}

TEST(Problems, ChannelsOfAColourThatIsNoListStandAtTheColour) {
    const LocatedProblem problem = only(parse_scene(with_shape(
        R"({"type": "circle", "center": [1, 1], "radius": 1, "emission": {"color": "#ff0000", "intensity": 1e10}})")));
    EXPECT_EQ(problem.problem.pointer, "/shapes/0/emission");
    EXPECT_THAT(problem.problem.message, HasSubstr("is 1e+10"));
}

TEST(Problems, DuplicatesAreFoundUnderEscapesAndInUnknownObjects) {
    EXPECT_THAT(brief(parse_scene(document(R"(, "x": [{"a": 1, "\u0061": 2}])"))),
                ElementsAre("/x unknown_key", "/x/0/a duplicate_key"));
}

TEST(Problems, ThreeOfOneKeyAreTwoProblems) {
    const ParsedScene parsed = parse_scene(document(R"(, "version": 1, "version": 1)"));
    EXPECT_THAT(brief(parsed), ElementsAre("/version duplicate_key", "/version duplicate_key"));
    EXPECT_LT(parsed.problems[0].column, parsed.problems[1].column);
}

TEST(Locate, FindsPlacesForTheProblemsOfOthers) {
    const std::string text = document(",\n\"render\": {\n\"bounces\": 2}, \"lights\": [1,\n {}]");
    const auto located = locate(text, {{"/render/bounces", "not_supported_yet", "a"},
                                       {"/lights/1", "x", "b"},
                                       {"/output/tonemap", "x", "c"},
                                       {"", "x", "d"}});
    ASSERT_EQ(located.size(), 4u);
    EXPECT_EQ(located[0].problem.message, "c");  // absent: at the whole document
    EXPECT_EQ(located[0].line, 1);
    EXPECT_EQ(located[1].problem.message, "d");
    EXPECT_EQ(located[2].problem.message, "a");
    EXPECT_EQ(located[2].line, 3);
    EXPECT_EQ(located[2].column, 12);
    EXPECT_EQ(located[3].problem.pointer, "/lights/1");
    EXPECT_EQ(located[3].line, 4);
    EXPECT_EQ(located[3].column, 2);
}

TEST(Locate, WithoutADocumentThereAreNoPlaces) {
    const auto located = locate("{", {{"/a", "x", "m"}});
    ASSERT_EQ(located.size(), 1u);
    EXPECT_EQ(located[0].line, 0);
    EXPECT_TRUE(locate("{}", {}).empty());
}

}  // namespace
}  // namespace penumbra
