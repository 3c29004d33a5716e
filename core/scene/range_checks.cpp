// SPDX-License-Identifier: MIT
#include "core/scene/range_checks.h"

#include <array>
#include <cmath>
#include <utility>

#include "core/scene/wording.h"

namespace penumbra {

void RangeChecks::add(const Path& where, std::string_view code, std::string message) {
    problems_.push_back(Problem{where.pointer(), std::string(code), std::move(message)});
}

bool RangeChecks::finite(const Path& where, double value) {
    if (std::isfinite(value)) {
        return true;
    }
    add(where, "not_finite", "must be a finite number, is " + number_text(value));
    return false;
}

bool RangeChecks::at_least(const Path& where, double value, double low) {
    if (!finite(where, value)) {
        return false;
    }
    if (value < low) {
        add(where, "out_of_range",
            "must be at least " + number_text(low) + ", is " + number_text(value));
        return false;
    }
    return true;
}

bool RangeChecks::at_most(const Path& where, double value, double high) {
    if (!finite(where, value)) {
        return false;
    }
    if (value > high) {
        add(where, "out_of_range",
            "must be at most " + number_text(high) + ", is " + number_text(value));
        return false;
    }
    return true;
}

bool RangeChecks::between(const Path& where, double value, double low, double high) {
    if (!finite(where, value)) {
        return false;
    }
    if (value < low || value > high) {
        add(where, "out_of_range",
            "must be from " + number_text(low) + " to " + number_text(high) + ", is " +
                number_text(value));
        return false;
    }
    return true;
}

bool RangeChecks::positive_length(const Path& where, double value) {
    if (!finite(where, value)) {
        return false;
    }
    if (value <= 0) {
        add(where, "out_of_range", "must be more than 0, is " + number_text(value));
        return false;
    }
    return at_most(where, value, limits_.max_coordinate);
}

bool RangeChecks::coordinates(const Path& where, const Point& point) {
    const double high = limits_.max_coordinate;
    const bool x = between(where.index(0), point.x, -high, high);
    const bool y = between(where.index(1), point.y, -high, high);
    return x && y;
}

bool RangeChecks::colour(const Path& where, const Colour& colour, double high) {
    // A grey is most likely written as one number: one problem, not three.
    const bool grey = colour.r == colour.g && colour.g == colour.b;
    const bool all_nan = std::isnan(colour.r) && std::isnan(colour.g) && std::isnan(colour.b);
    if (grey || all_nan) {
        return between(where, colour.r, 0, high);
    }
    bool good = true;
    const std::array<double, 3> channels{colour.r, colour.g, colour.b};
    for (std::size_t i = 0; i < channels.size(); ++i) {
        good = between(where.index(i), channels[i], 0, high) && good;
    }
    return good;
}

bool RangeChecks::count(const Path& where, std::size_t count, std::size_t high,
                        std::string_view of_what) {
    if (count <= high) {
        return true;
    }
    add(where, "too_many",
        "must hold at most " + std::to_string(high) + " " + std::string(of_what) + ", holds " +
            std::to_string(count));
    return false;
}

}  // namespace penumbra
