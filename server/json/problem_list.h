// SPDX-License-Identifier: MIT
// The problems of one document while they are found: capped, put into the text's order, located.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "server/json/json_tree.h"
#include "server/json/scene_json.h"

namespace penumbra {

struct PendingProblem {
    Problem problem;
    TextOffset offset = kNotInText;
    std::string suggestion;
};

class ProblemList {
public:
    explicit ProblemList(std::size_t most) : most_(most) {}

    // Once full, problems are counted and need no wording.
    bool full() const { return problems_.size() >= most_; }
    bool empty() const { return problems_.empty() && left_out_ == 0; }
    void leave_out(std::size_t count = 1) { left_out_ += count; }
    void add(PendingProblem problem);

    // Nothing more is to be said about the value at this pointer and what is inside it.
    void silence(std::string pointer) { silenced_.insert(std::move(pointer)); }

    // Whether a problem of the validation only follows from one that the list has already.
    bool follows_from_others(const Problem& problem) const;

    // Ends the list: in the order of the text, with lines and columns, or with the override.
    std::vector<LocatedProblem> take_located(std::string_view text,
                                             const std::vector<Override>& overrides);
    std::size_t left_out() const { return left_out_; }

private:
    std::size_t most_;
    std::size_t left_out_ = 0;
    std::vector<PendingProblem> problems_;
    std::unordered_set<std::string> silenced_;  // at most a few for each problem in the list
    std::unordered_set<std::string> above_;     // pointers to what holds a value with a problem
};

}  // namespace penumbra
