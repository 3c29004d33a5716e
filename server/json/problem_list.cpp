// SPDX-License-Identifier: MIT
#include "server/json/problem_list.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace penumbra {

namespace {

template <class Visit>
bool any_pointer_above(std::string pointer, Visit visit) {
    for (std::size_t end = pointer.rfind('/'); end != pointer.npos; end = pointer.rfind('/')) {
        pointer.resize(end);
        if (visit(pointer)) {
            return true;
        }
    }
    return false;
}

}  // namespace

void ProblemList::add(PendingProblem problem) {
    if (full()) {
        leave_out();
        return;
    }
    // That two keys exclude each other says nothing about their values.
    if (problem.problem.code != "conflict") {
        silenced_.insert(problem.problem.pointer);
    }
    any_pointer_above(problem.problem.pointer, [&](const std::string& above) {
        above_.insert(above);
        return false;
    });
    problems_.push_back(std::move(problem));
}

bool ProblemList::follows_from_others(const Problem& problem) const {
    const auto silenced = [&](const std::string& above) { return silenced_.contains(above); };
    if (silenced(problem.pointer) || any_pointer_above(problem.pointer, silenced)) {
        return true;
    }
    // Of a value with a bad part only its size can be judged.
    const bool about_size = problem.code == "too_many" || problem.code == "too_large";
    return !about_size && above_.contains(problem.pointer);
}

std::vector<LocatedProblem> ProblemList::take_located(std::string_view text,
                                                      const std::vector<Override>& overrides) {
    const auto place = [](const PendingProblem& p) {
        return p.offset > kLongestText ? 0 : std::uint64_t(p.offset) + 1;
    };
    std::stable_sort(problems_.begin(), problems_.end(),
                     [&](const auto& a, const auto& b) { return place(a) < place(b); });
    std::vector<LocatedProblem> located;
    located.reserve(problems_.size());
    int line = 1;
    std::size_t line_start = 0;
    for (PendingProblem& pending : problems_) {
        LocatedProblem& out = located.emplace_back();
        out.problem = std::move(pending.problem);
        out.suggestion = std::move(pending.suggestion);
        if (pending.offset > kLongestText) {
            if (is_override(pending.offset)) {
                out.set_at = overrides.at(override_index(pending.offset)).pointer;
            }
            continue;
        }
        const std::size_t offset = std::min<std::size_t>(pending.offset, text.size());
        while (line_start < offset) {
            const void* end = std::memchr(text.data() + line_start, '\n', offset - line_start);
            if (!end) {
                break;
            }
            line_start = std::size_t(static_cast<const char*>(end) - text.data()) + 1;
            ++line;
        }
        out.line = line;
        out.column = int(offset - line_start) + 1;
    }
    problems_.clear();
    return located;
}

}  // namespace penumbra
