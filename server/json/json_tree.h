// SPDX-License-Identifier: MIT
// A parsed JSON document that remembers where each value stands in the text.
//
// All nodes lie in one vector and refer to each other by index: nothing recurses, so that no depth
// of nesting can overflow a stack, and half a million brackets cost nothing to throw away.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

using NodeId = std::uint32_t;
constexpr NodeId kNoNode = std::numeric_limits<NodeId>::max();

using TextOffset = std::uint32_t;
constexpr TextOffset kNotInText = std::numeric_limits<TextOffset>::max();

// What an override wrote has no place in the text; the largest offsets, which no text reaches, say
// which override it was.
constexpr TextOffset kMaxOverrides = 1u << 20;
constexpr TextOffset kLongestText = kNotInText - kMaxOverrides - 1;
constexpr TextOffset offset_of_override(std::size_t index) {
    return index < kMaxOverrides ? kNotInText - 1 - TextOffset(index) : kNotInText;
}
constexpr bool is_override(TextOffset offset) {
    return offset > kLongestText && offset != kNotInText;
}
constexpr std::size_t override_index(TextOffset offset) { return kNotInText - 1 - offset; }

enum class NodeKind : std::uint8_t { null, boolean, number, string, array, object };

// "a number", "a list", ...: what messages call a kind.
std::string_view kind_name(NodeKind kind);

struct Node {
    std::string_view key;                // in its object; views the text, or JsonTree::decoded
    std::string_view string;             // likewise
    double number = 0;                   // also 0 and 1 of a boolean
    TextOffset offset = kNotInText;      // of the value's first byte, or of an override
    TextOffset key_offset = kNotInText;  // of the key's opening quote, or of an override
    NodeId first_child = kNoNode;
    NodeId next_sibling = kNoNode;
    std::uint32_t child_count = 0;
    NodeKind kind = NodeKind::null;
};

// A key that an object holds twice; the second place.
struct DuplicateKey {
    std::string pointer;
    std::string_view key;
    TextOffset offset = kNotInText;  // of the key
};

class JsonTree {
public:
    std::vector<Node> nodes;
    std::vector<DuplicateKey> duplicates;  // the first TextLimits::max_problems
    std::size_t duplicates_left_out = 0;
    std::deque<std::string> decoded;  // strings with escapes; the others view the text

    bool empty() const { return nodes.empty(); }
    const Node& root() const { return nodes.front(); }
    const Node& operator[](NodeId id) const { return nodes[id]; }

    NodeId child(NodeId object, std::string_view key) const;
    NodeId child(NodeId array, std::size_t index) const;
    NodeId last_child(NodeId parent) const;
};

// One step of a JSON pointer: "a~1b" is "a/b".
std::string unescape_token(std::string_view token);

// The number that an array index token stands for; SIZE_MAX when it is none ("01", "-", "x").
std::size_t array_index(std::string_view token);

// Where a pointer leads, as far as the document goes.
struct Resolved {
    NodeId node = kNoNode;  // the deepest value on the way that exists
    std::string existing;   // the pointer to it
    bool complete = false;  // whether it is the value pointed to
    bool through_leaf =
        false;  // whether the pointer goes on inside a value that has no such inside
};
Resolved resolve(const JsonTree& tree, std::string_view pointer);

}  // namespace penumbra
