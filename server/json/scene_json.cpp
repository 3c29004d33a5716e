// SPDX-License-Identifier: MIT
#include "server/json/scene_json.h"

#include <span>
#include <utility>

#include "core/scene/validate.h"
#include "core/scene/wording.h"
#include "core/scene/words.h"
#include "server/json/json_tree.h"
#include "server/json/overrides.h"
#include "server/json/problem_list.h"
#include "server/json/scene_builder.h"
#include "server/json/tree_parser.h"

namespace penumbra {

namespace {

void add_duplicates(const JsonTree& tree, ProblemList& problems) {
    for (const DuplicateKey& duplicate : tree.duplicates) {
        problems.add({{duplicate.pointer, "duplicate_key",
                       "the key " + in_quotes(duplicate.key) + " is given twice: keep one"},
                      duplicate.offset,
                      {}});
    }
    problems.leave_out(tree.duplicates_left_out);
}

// What validate() compared a word with; empty for other places.
std::span<const std::string_view> words_at(std::string_view pointer) {
    if (pointer == "/render/method") {
        return known_methods();
    }
    if (pointer == "/render/view") {
        return known_views();
    }
    if (pointer == "/output/format") {
        return known_formats();
    }
    if (pointer == "/output/look") {
        return known_looks();
    }
    return pointer == "/output/tonemap" ? known_tonemaps() : std::span<const std::string_view>();
}

// A problem of the plain scene, as one of the document: at the value, or at what should hold it.
PendingProblem place(const JsonTree& tree, Problem problem) {
    const Resolved resolved = resolve(tree, problem.pointer);
    PendingProblem pending{std::move(problem), kNotInText, {}};
    if (resolved.node == kNoNode) {
        return pending;
    }
    pending.offset = tree[resolved.node].offset;
    if (resolved.through_leaf) {
        pending.problem.pointer = resolved.existing;  // a channel of "#rrggbb" has no pointer
    }
    const auto words = words_at(pending.problem.pointer);
    if (resolved.complete && !words.empty() && tree[resolved.node].kind == NodeKind::string) {
        pending.suggestion = std::string(nearest_word(tree[resolved.node].string, words));
    }
    return pending;
}

void add_validation(const JsonTree& tree, Problems found, ProblemList& problems) {
    for (Problem& problem : found) {
        if (problems.full()) {
            problems.leave_out();
        } else if (!problems.follows_from_others(problem)) {
            problems.add(place(tree, std::move(problem)));
        }
    }
}

ParsedScene no_json(std::string_view text, TextError error) {
    ParsedScene result;
    result.is_json = false;
    ProblemList problems(1);
    problems.add({{std::move(error.pointer), std::move(error.code), std::move(error.message)},
                  TextOffset(error.offset),
                  {}});
    result.problems = problems.take_located(text, {});
    return result;
}

}  // namespace

ParsedScene parse_scene(std::string_view text, const Limits& limits, const TextLimits& text_limits,
                        const std::vector<Override>& overrides, const FontSource& fonts) {
    JsonTree tree;
    ParsedText parsed = parse_text(text, text_limits, tree);
    if (parsed.error) {
        return no_json(text, std::move(*parsed.error));
    }
    ProblemList problems(text_limits.max_problems);
    add_duplicates(tree, problems);
    apply_overrides(tree, overrides, text_limits, problems);
    Scene scene = build_scene(tree, limits, fonts, problems);
    if (!problems.full()) {
        add_validation(tree, validate(scene, limits), problems);
    }
    ParsedScene result;
    if (problems.empty()) {
        result.scene = std::move(scene);
        return result;
    }
    result.problems_left_out = problems.left_out();
    result.problems = problems.take_located(text, overrides);
    return result;
}

std::string to_string(const LocatedProblem& problem) {
    std::string text = problem.problem.pointer;
    std::string place;
    if (problem.line > 0) {
        place =
            "line " + std::to_string(problem.line) + ", column " + std::to_string(problem.column);
    } else if (!problem.set_at.empty()) {
        place = "--set " + problem.set_at;
    }
    if (!place.empty()) {
        text += text.empty() ? place : " (" + place + ")";
    }
    return text.empty() ? problem.problem.message : text + ": " + problem.problem.message;
}

std::vector<LocatedProblem> locate(std::string_view text, const Problems& problems,
                                   const std::vector<Override>& overrides) {
    JsonTree tree;
    const ParsedText parsed = parse_text(text, TextLimits{}, tree);
    if (parsed.error) {
        tree.nodes.clear();  // half a tree would give half the places
    } else {
        ProblemList told(0);  // that one is bad was said when the text was parsed
        apply_overrides(tree, overrides, TextLimits{}, told);
    }
    ProblemList list(problems.size());
    for (const Problem& problem : problems) {
        list.add(place(tree, problem));
    }
    return list.take_located(text, overrides);
}

}  // namespace penumbra
