// SPDX-License-Identifier: MIT
// The checks that validate.cpp and validate_shapes.cpp share: each adds at most one problem per
// value and returns whether the value is good, so that what depends on it can be left out.
#pragma once

#include <string>
#include <string_view>

#include "core/scene/limits.h"
#include "core/scene/path.h"
#include "core/scene/problem.h"
#include "core/scene/scene.h"

namespace penumbra {

class RangeChecks {
public:
    explicit RangeChecks(const Limits& limits) : limits_(limits) {}

    const Limits& limits() const { return limits_; }
    Problems take() { return std::move(problems_); }

    void add(const Path& where, std::string_view code, std::string message);

    bool finite(const Path& where, double value);
    bool at_least(const Path& where, double value, double low);
    bool at_most(const Path& where, double value, double high);
    bool between(const Path& where, double value, double low, double high);
    // More than 0, at most Limits::max_coordinate.
    bool positive_length(const Path& where, double value);
    // Every coordinate finite and at most Limits::max_coordinate either way.
    bool coordinates(const Path& where, const Point& point);
    // Every channel from 0 to `high`.
    bool colour(const Path& where, const Colour& colour, double high);
    bool count(const Path& where, std::size_t count, std::size_t high, std::string_view of_what);

private:
    Limits limits_;
    Problems problems_;
};

}  // namespace penumbra
