// SPDX-License-Identifier: MIT
// Values of the document as plain values. Whatever cannot be read is reported and comes back as
// NaN, zero or empty, so that reading goes on; validate()'s word on such a value is then dropped.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/path.h"
#include "core/scene/scene.h"
#include "server/json/json_tree.h"
#include "server/json/problem_list.h"

namespace penumbra {

class ValueReader {
public:
    ValueReader(const JsonTree& tree, ProblemList& problems) : tree_(tree), problems_(problems) {}

    const JsonTree& tree() const { return tree_; }
    const Node& node(NodeId id) const { return tree_[id]; }
    ProblemList& problems() { return problems_; }

    double number(const Path& where, NodeId id);
    // `allowed` is for the message about a number that no int holds: "from 1 to 8192".
    int integer(const Path& where, NodeId id, std::string_view allowed);
    bool boolean(const Path& where, NodeId id);
    std::optional<std::string_view> string(const Path& where, NodeId id);
    // The place in `words` of the string at hand.
    std::optional<std::size_t> choice(const Path& where, NodeId id,
                                      std::span<const std::string_view> words);
    Point pair(const Path& where, NodeId id, std::string_view form);
    std::vector<Point> points(const Path& where, NodeId id);
    Colour colour(const Path& where, NodeId id);

    // The elements of a list of `count` numbers; NaN where there are none.
    std::vector<double> numbers(const Path& where, NodeId id, std::size_t count,
                                std::string_view form);
    std::vector<int> integers(const Path& where, NodeId id, std::size_t count,
                              std::string_view form);

    bool expect(const Path& where, NodeId id, NodeKind kind, std::string_view form);

    // Reports at the value's own place; `message` is only called while the list has room.
    template <class Message>
    void report(const Path& where, NodeId id, std::string_view code, Message message) {
        report_at(where, node(id).offset, code, message);
    }
    template <class Message>
    void report_at(const Path& where, TextOffset offset, std::string_view code, Message message,
                   std::string_view suggestion = {}) {
        if (problems_.full()) {
            problems_.leave_out();
            return;
        }
        problems_.add(
            {{where.pointer(), std::string(code), message()}, offset, std::string(suggestion)});
    }

private:
    Colour plain_colour(const Path& where, NodeId id, bool in_object);
    Colour hex_colour(const Path& where, NodeId id);
    Colour colour_object(const Path& where, NodeId id);

    const JsonTree& tree_;
    ProblemList& problems_;
};

// One object whose keys are known; what nobody knows is reported, with what may have been meant.
class Members {
public:
    // `where` must outlive this. `of_what` is for messages: "a circle".
    Members(ValueReader& reader, const Path& where, NodeId object,
            std::span<const std::string_view> known, std::string_view of_what);

    NodeId find(std::string_view key) const { return reader_.tree().child(object_, key); }
    // As find(), reported when missing.
    NodeId require(std::string_view key) const;

    // Reads a member into `to` when it is there.
    void number(std::string_view key, double& to) const;
    void colour(std::string_view key, Colour& to) const;
    void boolean(std::string_view key, bool& to) const;
    void integer(std::string_view key, int& to, std::string_view allowed) const;
    void string(std::string_view key, std::string& to) const;

    // As above, reported when missing; then the value is NaN.
    void need_number(std::string_view key, double& to) const;
    void need_colour(std::string_view key, Colour& to) const;
    void need_pair(std::string_view key, std::string_view form, glm::dvec2& to) const;
    void need_points(std::string_view key, std::vector<Point>& to) const;
    void need_integer(std::string_view key, int& to, std::string_view allowed) const;

private:
    ValueReader& reader_;
    const Path& where_;
    NodeId object_;
    std::string_view of_what_;
};

// Reports a key that may not stand where it does.
void refuse(ValueReader& reader, const Members& members, const Path& where, std::string_view key, std::string_view message);

}  // namespace penumbra
