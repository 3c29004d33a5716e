// SPDX-License-Identifier: MIT
#include "server/json/value_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scene/wording.h"
#include "core/scene/words.h"

namespace penumbra {

namespace {

constexpr double kUnread = std::numeric_limits<double>::quiet_NaN();

// What people write for what the format calls otherwise; used where the second is a known key. The
// first row that fits counts, so that another spelling of a key comes before another name for one.
struct OtherName {
    std::string_view written;
    std::string_view meant;
};
constexpr OtherName kOtherNames[] = {
    {"colour", "color"},
    {"color", "emission"},
    {"colour", "emission"},
    {"fill", "emission"},
    {"color", "intensity"},
    {"colour", "intensity"},
    {"color", "irradiance"},
    {"colour", "irradiance"},
    {"color", "radiance"},
    {"colour", "radiance"},
    {"emission", "emission_scale"},
    {"emissive", "emission"},
    {"reflectance", "albedo"},
    {"position", "center"},
    {"center", "position"},
    {"x", "center"},
    {"y", "center"},
    {"x", "position"},
    {"y", "position"},
    {"angle", "rotation"},
    {"angle", "direction"},
    {"vertices", "points"},
    {"thickness", "width"},
    {"stroke", "width"},
    {"path", "d"},
    {"data", "d"},
    {"content", "text"},
    {"font_size", "size"},
    {"text_anchor", "anchor"},
    {"fill-rule", "fill_rule"},
    {"r", "radius"},
    {"size", "radius"},
    {"start", "from"},
    {"end", "to"},
    {"src", "image"},
    {"url", "image"},
    {"threshold", "solid_above"},
    {"ev", "exposure"},
    {"f", "aperture"},
    {"f_number", "aperture"},
    {"shutter_speed", "shutter"},
    {"ev", "compensation"},
    {"white_point", "white"},
    {"samples", "quality"},
};

// Keys that stand in one object only, for those written into another.
struct Home {
    std::string_view key;
    std::string_view object;
};
constexpr Home kHomes[] = {
    {"width", "canvas"},     {"height", "canvas"}, {"margin", "canvas"},   {"floor", "canvas"},
    {"radiance", "sky"},     {"gradient", "sky"},  {"method", "render"},   {"quality", "render"},
    {"bounces", "render"},   {"skip", "render"},   {"format", "output"},   {"bit_depth", "output"},
    {"antialias", "output"}, {"solids", "output"}, {"exposure", "output"}, {"tonemap", "output"},
    {"look", "output"},      {"white", "output"},  {"dither", "output"},
};

std::string_view other_name(std::string_view key, std::span<const std::string_view> known) {
    for (const OtherName& name : kOtherNames) {
        if (is_known_word(name.meant, known) && same_letters(name.written, key)) {
            return name.meant;
        }
    }
    return {};
}

std::string_view home_of(std::string_view key) {
    const auto* home = std::find_if(std::begin(kHomes), std::end(kHomes),
                                    [&](const Home& h) { return h.key == key; });
    return home == std::end(kHomes) ? std::string_view() : home->object;
}

}  // namespace

bool ValueReader::expect(const Path& where, NodeId id, NodeKind kind, std::string_view form) {
    if (node(id).kind == kind) {
        return true;
    }
    report(where, id, "wrong_type", [&] {
        return "must be " + std::string(form) + ", is " + std::string(kind_name(node(id).kind));
    });
    return false;
}

double ValueReader::number(const Path& where, NodeId id) {
    return expect(where, id, NodeKind::number, "a number") ? node(id).number : kUnread;
}

int ValueReader::integer(const Path& where, NodeId id, std::string_view allowed) {
    if (!expect(where, id, NodeKind::number, "a whole number")) {
        return 0;
    }
    const double value = node(id).number;
    if (value != std::floor(value)) {
        report(where, id, "wrong_type",
               [&] { return "must be a whole number, is " + number_text(value); });
        return 0;
    }
    if (std::abs(value) > std::numeric_limits<int>::max()) {
        // The validation cannot see what no int holds.
        report(where, id, "out_of_range",
               [&] { return "must be " + std::string(allowed) + ", is " + number_text(value); });
        return 0;
    }
    return int(value);
}

bool ValueReader::boolean(const Path& where, NodeId id) {
    return expect(where, id, NodeKind::boolean, "true or false") && node(id).number != 0;
}

std::optional<std::string_view> ValueReader::string(const Path& where, NodeId id) {
    if (!expect(where, id, NodeKind::string, "a string")) {
        return std::nullopt;
    }
    return node(id).string;
}

std::optional<std::size_t> ValueReader::choice(const Path& where, NodeId id,
                                               std::span<const std::string_view> words) {
    const auto word = string(where, id);
    if (!word) {
        return std::nullopt;
    }
    const auto found = std::find(words.begin(), words.end(), *word);
    if (found != words.end()) {
        return std::size_t(found - words.begin());
    }
    if (problems_.full()) {
        problems_.leave_out();
        return std::nullopt;
    }
    const std::string_view near = nearest_word(*word, words);
    report_at(
        where, node(id).offset, "unknown_value",
        [&] {
            return "must be " + join_words(words) + ", is " + in_quotes(*word) + did_you_mean(near);
        },
        near);
    return std::nullopt;
}

std::vector<double> ValueReader::numbers(const Path& where, NodeId id, std::size_t count,
                                         std::string_view form) {
    std::vector<double> values(count, kUnread);
    if (!expect(where, id, NodeKind::array, form)) {
        return values;
    }
    if (node(id).child_count != count) {
        report(where, id, "wrong_length", [&] {
            return "must be " + std::string(form) + ", holds " +
                   std::to_string(node(id).child_count) +
                   (node(id).child_count == 1 ? " value" : " values");
        });
        return values;
    }
    NodeId element = node(id).first_child;
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = number(where.index(i), element);
        element = node(element).next_sibling;
    }
    return values;
}

std::vector<int> ValueReader::integers(const Path& where, NodeId id, std::size_t count,
                                       std::string_view form) {
    std::vector<int> values(count, 0);
    if (!expect(where, id, NodeKind::array, form)) {
        return values;
    }
    if (node(id).child_count != count) {
        report(where, id, "wrong_length", [&] {
            return "must be " + std::string(form) + ", holds " +
                   std::to_string(node(id).child_count) +
                   (node(id).child_count == 1 ? " value" : " values");
        });
        return values;
    }
    NodeId element = node(id).first_child;
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = integer(where.index(i), element, "within the canvas");
        element = node(element).next_sibling;
    }
    return values;
}

Point ValueReader::pair(const Path& where, NodeId id, std::string_view form) {
    // Points come by the ten thousand: the usual case takes no memory.
    const Node& list = node(id);
    if (list.kind == NodeKind::array && list.child_count == 2) {
        const NodeId first = list.first_child;
        const NodeId second = node(first).next_sibling;
        const double x = number(where.index(0), first);
        const double y = number(where.index(1), second);
        return {x, y};
    }
    const std::vector<double> values = numbers(where, id, 2, form);
    return {values[0], values[1]};
}

std::vector<Point> ValueReader::points(const Path& where, NodeId id) {
    std::vector<Point> list;
    if (!expect(where, id, NodeKind::array, "a list of points [x, y]")) {
        return list;
    }
    list.reserve(node(id).child_count);
    for (NodeId element = node(id).first_child; element != kNoNode;
         element = node(element).next_sibling) {
        list.push_back(pair(where.index(list.size()), element, "a point [x, y]"));
    }
    return list;
}

Members::Members(ValueReader& reader, const Path& where, NodeId object,
                 std::span<const std::string_view> known, std::string_view of_what)
    : reader_(reader), where_(where), object_(object), of_what_(of_what) {
    for (NodeId id = reader.node(object).first_child; id != kNoNode;
         id = reader.node(id).next_sibling) {
        const std::string_view key = reader.node(id).key;
        if (is_known_word(key, known)) {
            continue;
        }
        if (reader.problems().full()) {
            reader.problems().leave_out();
            continue;
        }
        std::string_view meant = other_name(key, known);
        if (meant.empty()) {
            meant = nearest_word(key, known);
        }
        const std::string_view home = meant.empty() ? home_of(key) : std::string_view();
        reader.report_at(
            where.key(key), reader.node(id).key_offset, "unknown_key",
            [&] {
                return in_quotes(key) + " is not a key of " + std::string(of_what) +
                       did_you_mean(meant) +
                       (home.empty() ? std::string() : " (it belongs in " + in_quotes(home) + ")");
            },
            meant);
    }
}

NodeId Members::require(std::string_view key) const {
    const NodeId id = find(key);
    if (id == kNoNode) {
        reader_.report_at(where_.key(key), reader_.node(object_).offset, "missing_key", [&] {
            return "is missing: " + std::string(of_what_) + " needs " + in_quotes(key);
        });
    }
    return id;
}

void Members::number(std::string_view key, double& to) const {
    if (const NodeId id = find(key); id != kNoNode) {
        to = reader_.number(where_.key(key), id);
    }
}

void Members::colour(std::string_view key, Colour& to) const {
    if (const NodeId id = find(key); id != kNoNode) {
        to = reader_.colour(where_.key(key), id);
    }
}

void Members::boolean(std::string_view key, bool& to) const {
    if (const NodeId id = find(key); id != kNoNode) {
        to = reader_.boolean(where_.key(key), id);
    }
}

void Members::integer(std::string_view key, int& to, std::string_view allowed) const {
    if (const NodeId id = find(key); id != kNoNode) {
        to = reader_.integer(where_.key(key), id, allowed);
    }
}

void Members::string(std::string_view key, std::string& to) const {
    if (const NodeId id = find(key); id != kNoNode) {
        to = reader_.string(where_.key(key), id).value_or(std::string_view());
    }
}

void Members::need_number(std::string_view key, double& to) const {
    const NodeId id = require(key);
    to = id == kNoNode ? kUnread : reader_.number(where_.key(key), id);
}

void Members::need_colour(std::string_view key, Colour& to) const {
    const NodeId id = require(key);
    to = id == kNoNode ? Colour(kUnread) : reader_.colour(where_.key(key), id);
}

void Members::need_pair(std::string_view key, std::string_view form, glm::dvec2& to) const {
    const NodeId id = require(key);
    to = id == kNoNode ? glm::dvec2(kUnread) : reader_.pair(where_.key(key), id, form);
}

void Members::need_points(std::string_view key, std::vector<Point>& to) const {
    if (const NodeId id = require(key); id != kNoNode) {
        to = reader_.points(where_.key(key), id);
    }
}

void Members::need_integer(std::string_view key, int& to, std::string_view allowed) const {
    if (const NodeId id = require(key); id != kNoNode) {
        to = reader_.integer(where_.key(key), id, allowed);
    }
}

void refuse(ValueReader& reader, const Members& members, const Path& where, std::string_view key, std::string_view message) {
    if (const NodeId id = members.find(key); id != kNoNode) {
        reader.report(where.key(key), id, "conflict", [&] { return std::string(message); });
    }
}

}  // namespace penumbra
