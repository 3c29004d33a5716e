// SPDX-License-Identifier: MIT
// Any bytes as a scene: a scene that is within the limits, or problems that can be told as JSON.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "check.h"
#include "core/scene/normal_form.h"
#include "core/scene/validate.h"
#include "server/http/problem.h"
#include "server/json/scene_json.h"

using namespace penumbra;
using fuzz::check;

namespace {

Limits limits() {
    Limits limits;
    limits.max_points_per_shape = 1024;  // outlines take time by the square of their points
    limits.max_points = 8192;
    limits.max_bitmap_side_px = 512;
    limits.max_bitmap_texels = 512.0 * 512.0;
    return limits;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Limits kLimits = limits();
    static const FontSource kFonts;
    static const TextLimits kText;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const ParsedScene parsed = parse_scene(text, kLimits, kText, {}, kFonts);
    check(parsed.scene.has_value() == parsed.problems.empty(), "a scene or problems, never both or neither");
    check(parsed.problems.size() <= kText.max_problems, "no more problems than the limit");
    check(parsed.is_json || parsed.problems.size() == 1, "what is no JSON has one problem");
    if (parsed.scene) {
        check(validate(*parsed.scene, kLimits).empty(), "a parsed scene is valid");
        check(normal_form(*parsed.scene) == normal_form(*parse_scene(text, kLimits, kText, {}, kFonts).scene),
              "one text is one scene");
        return 0;
    }
    RenderResponse response;
    response.failure = parsed.is_json ? RenderFailure::invalid_scene : RenderFailure::not_json;
    response.problems = parsed.problems;
    response.problems_left_out = parsed.problems_left_out;
    const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
    for (const LocatedProblem& problem : parsed.problems) {
        check(!problem.problem.code.empty() && !problem.problem.message.empty(), "a problem has a code and a message");
        check(problem.problem.message.size() < 2000, "a message is short");
        check(problem.line >= 0 && problem.line <= lines, "a problem's line is in the text");
        check(problem.column >= 0 && std::size_t(problem.column) <= size + 1, "a problem's column is in the text");
        check((problem.line == 0) == (problem.column == 0), "a place has a line and a column");
    }
    const HttpProblem told = problem_of(response, 1);
    const auto json = nlohmann::json::parse(body_of(told, "id"), nullptr, false);
    check(json.is_object() && json.at("errors").size() == parsed.problems.size(), "problems are told as JSON");
    check(status_of(told) >= 400 && status_of(told) < 500, "a bad scene is the client's fault");
    return 0;
}
