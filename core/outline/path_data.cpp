// SPDX-License-Identifier: MIT
#include "core/outline/path_data.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace penumbra {
namespace {

// Far beyond all coordinates that a scene may have; four of them multiplied are finite.
constexpr double kMostNumber = 1e60;

constexpr double kMostEdges = 4096;  // of one curve: more than any picture shows

double length(Point p) { return std::hypot(p.x, p.y); }

double edges_for(double count) { return std::clamp(std::ceil(count), 1.0, kMostEdges); }

// Reads numbers and flags as the grammar has them: commas and spaces are optional where a number ends by itself.
class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) {}

    std::size_t at() const { return at_; }
    bool at_end() {
        skip_spaces();
        return at_ >= text_.size();
    }
    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    char take() { return text_[at_++]; }

    bool starts_number() {
        const char c = peek();
        return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
    }
    std::optional<double> number() {
        std::size_t end = at_;
        const auto digits = [&] {
            const std::size_t start = end;
            while (end < text_.size() && text_[end] >= '0' && text_[end] <= '9') ++end;
            return end - start;
        };
        if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
        std::size_t count = digits();
        if (end < text_.size() && text_[end] == '.') {
            ++end;
            count += digits();
        }
        if (count == 0) return std::nullopt;
        if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
            const std::size_t mantissa = end++;
            if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
            if (digits() == 0) end = mantissa;
        }
        // from_chars knows no plus sign.
        const char* first = text_.data() + at_ + (text_[at_] == '+' ? 1 : 0);
        double value = 0;
        const auto result = std::from_chars(first, text_.data() + end, value);
        if (result.ec != std::errc() || std::abs(value) > kMostNumber) return std::nullopt;
        at_ = end;
        return value;
    }
    std::optional<bool> flag() {
        if (peek() != '0' && peek() != '1') return std::nullopt;
        return take() == '1';
    }
    void skip_spaces() {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    }
    void skip_separator() {
        skip_spaces();
        if (peek() == ',') {
            ++at_;
            skip_spaces();
        }
    }

private:
    static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
    std::string_view text_;
    std::size_t at_ = 0;
};

// SVG 2, appendix B.2.4: from end points to a centre, radii made large enough.
void append_arc(Ring& ring, Point radii, double rotation_deg, bool large, bool sweep, Point end, double tolerance) {
    const Point start = ring.back();
    double rx = std::abs(radii.x), ry = std::abs(radii.y);
    if (start == end) return;
    if (rx == 0 || ry == 0) {
        ring.push_back(end);
        return;
    }
    const double phi = rotation_deg * std::numbers::pi / 180, c = std::cos(phi), s = std::sin(phi);
    const Point half = (start - end) * 0.5;
    const Point p{c * half.x + s * half.y, c * half.y - s * half.x};
    const double reach = p.x * p.x / (rx * rx) + p.y * p.y / (ry * ry);
    if (reach > 1) {
        rx *= std::sqrt(reach);
        ry *= std::sqrt(reach);
    }
    const double q = p.x * p.x * ry * ry + p.y * p.y * rx * rx;
    const double root = std::sqrt(std::max(0.0, rx * rx * ry * ry / q - 1)) * (large == sweep ? -1 : 1);
    const Point centre{root * rx * p.y / ry, -root * ry * p.x / rx};
    const Point middle = (start + end) * 0.5 + Point(c * centre.x - s * centre.y, s * centre.x + c * centre.y);
    const double from = std::atan2((p.y - centre.y) / ry, (p.x - centre.x) / rx);
    const double to = std::atan2((-p.y - centre.y) / ry, (-p.x - centre.x) / rx);
    double turn = to - from;
    if (sweep && turn < 0) turn += 2 * std::numbers::pi;
    if (!sweep && turn > 0) turn -= 2 * std::numbers::pi;
    // Radii that are nothing beside the way to the end, whose squares are lost.
    if (!std::isfinite(rx) || !std::isfinite(ry) || !std::isfinite(middle.x) || !std::isfinite(middle.y) || !std::isfinite(turn)) {
        ring.push_back(end);
        return;
    }
    // The sagitta of a chord over the angle a is r (1 - cos(a/2)).
    const double chord = 2 * std::acos(std::clamp(1 - tolerance / std::max(rx, ry), -1.0, 1.0));
    const double edges = edges_for(std::abs(turn) / std::max(chord, 1e-9));
    for (double i = 1; i < edges; ++i) {
        const double t = from + turn * i / edges;
        const Point on{rx * std::cos(t), ry * std::sin(t)};
        ring.push_back(middle + Point(c * on.x - s * on.y, s * on.x + c * on.y));
    }
    ring.push_back(end);
}

class Reader {
public:
    Reader(std::string_view data, double tolerance, std::size_t most_points)
        : scanner_(data), tolerance_(tolerance), most_points_(most_points) {}

    std::variant<std::vector<Ring>, PathError> read() {
        while (!scanner_.at_end() && !error_ && points_ <= most_points_) {
            const std::size_t at = scanner_.at();
            const char letter = scanner_.take();
            const char command = upper(letter);
            if (std::string_view("MLHVCSQTAZ").find(command) == std::string_view::npos) {
                error_ = PathError{at, "must be one of the commands M L H V C S Q T A Z, is \"" + std::string(1, letter) + "\""};
            } else if (!started_ && command != 'M') {
                error_ = PathError{at, "must begin with M"};
            } else {
                run(command, letter != command);
            }
        }
        if (error_) return *error_;
        finish();
        return std::move(rings_);
    }

private:
    static char upper(char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; }

    void fail(const char* expected) {
        if (!error_) error_ = PathError{scanner_.at(), std::string("must be ") + expected};
    }
    double number() {
        scanner_.skip_separator();
        const auto value = scanner_.number();
        if (!value) fail("a number");
        return value.value_or(0);
    }
    bool flag() {
        scanner_.skip_separator();
        const auto value = scanner_.flag();
        if (!value) fail("a flag, 0 or 1");
        return value.value_or(false);
    }
    Point point(bool relative) {
        const double x = number();
        const double y = number();
        return Point(x, y) + (relative ? at_ : Point(0));
    }
    bool more() {
        if (error_ || points_ > most_points_) return false;
        Scanner ahead = scanner_;
        ahead.skip_separator();
        if (!ahead.starts_number()) return false;
        scanner_ = ahead;
        return true;
    }

    void run(char command, bool relative) {
        if (command == 'Z') {
            finish();
            at_ = start_;
            last_ = 'Z';
            return;
        }
        do {
            step(command, relative);
            last_ = command;
            if (command == 'M') command = 'L';  // what follows are lines
        } while (more());
    }

    void step(char command, bool relative) {
        if (command == 'M') {
            finish();
            started_ = true;
            start_ = at_ = point(relative);
            return;
        }
        if (ring_.empty()) ring_.push_back(at_);
        const std::size_t before = ring_.size();
        switch (command) {
            case 'L': line_to(point(relative)); break;
            case 'H': line_to({number() + (relative ? at_.x : 0), at_.y}); break;
            case 'V': line_to({at_.x, number() + (relative ? at_.y : 0)}); break;
            case 'C': {
                const Point first = point(relative), second = point(relative);
                cubic_to(first, second, point(relative));
                break;
            }
            case 'S': {
                const Point first = last_ == 'C' || last_ == 'S' ? at_ * 2.0 - control_ : at_;
                const Point second = point(relative);
                cubic_to(first, second, point(relative));
                break;
            }
            case 'Q': {
                const Point control = point(relative);
                quadratic_to(control, point(relative));
                break;
            }
            case 'T': quadratic_to(last_ == 'Q' || last_ == 'T' ? at_ * 2.0 - control_ : at_, point(relative)); break;
            default: {
                const double rx = number(), ry = number(), rotation = number();
                const bool large = flag(), sweep = flag();
                const Point end = point(relative);
                if (!error_) append_arc(ring_, {rx, ry}, rotation, large, sweep, end, tolerance_);
                at_ = end;
            }
        }
        points_ += ring_.size() - before;
    }

    void line_to(Point end) {
        if (error_) return;
        ring_.push_back(end);
        at_ = end;
    }
    void cubic_to(Point first, Point second, Point end) {
        if (error_) return;
        append_cubic(ring_, first, second, end, tolerance_);
        control_ = second;
        at_ = end;
    }
    void quadratic_to(Point control, Point end) {
        if (error_) return;
        append_quadratic(ring_, control, end, tolerance_);
        control_ = control;
        at_ = end;
    }

    // The ring so far is whole; what comes next begins a new one.
    void finish() {
        if (ring_.size() > 1 && ring_.back() == ring_.front()) ring_.pop_back();
        if (ring_.size() > 1) rings_.push_back(std::move(ring_));
        ring_.clear();
    }

    Scanner scanner_;
    double tolerance_;
    std::size_t most_points_;
    std::size_t points_ = 0;
    std::vector<Ring> rings_;
    Ring ring_;
    Point at_{0}, start_{0}, control_{0};
    char last_ = 'M';
    bool started_ = false;
    std::optional<PathError> error_;
};

}  // namespace

// A chord over 1/n of a curve is at most |B''| / (8 n^2) from it.
void append_quadratic(Ring& ring, Point control, Point end, double tolerance) {
    const Point start = ring.back();
    const double bend = 2 * length(start - control * 2.0 + end);
    const double edges = edges_for(std::sqrt(bend / (8 * tolerance)));
    for (double i = 1; i < edges; ++i) {
        const double t = i / edges, u = 1 - t;
        ring.push_back(start * (u * u) + control * (2 * u * t) + end * (t * t));
    }
    ring.push_back(end);
}

void append_cubic(Ring& ring, Point first, Point second, Point end, double tolerance) {
    const Point start = ring.back();
    const double bend = 6 * std::max(length(start - first * 2.0 + second), length(first - second * 2.0 + end));
    const double edges = edges_for(std::sqrt(bend / (8 * tolerance)));
    for (double i = 1; i < edges; ++i) {
        const double t = i / edges, u = 1 - t;
        ring.push_back(start * (u * u * u) + first * (3 * u * u * t) + second * (3 * u * t * t) + end * (t * t * t));
    }
    ring.push_back(end);
}

std::variant<std::vector<Ring>, PathError> rings_of_path(std::string_view data, double tolerance, std::size_t most_points) {
    return Reader(data, tolerance, most_points).read();
}

}  // namespace penumbra
