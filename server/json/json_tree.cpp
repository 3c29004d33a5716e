// SPDX-License-Identifier: MIT
#include "server/json/json_tree.h"

#include <charconv>

namespace penumbra {

std::string_view kind_name(NodeKind kind) {
    switch (kind) {
        case NodeKind::null:
            return "null";
        case NodeKind::boolean:
            return "a boolean";
        case NodeKind::number:
            return "a number";
        case NodeKind::string:
            return "a string";
        case NodeKind::array:
            return "a list";
        case NodeKind::object:
            return "an object";
    }
    return "";
}

NodeId JsonTree::child(NodeId object, std::string_view key) const {
    if (nodes[object].kind != NodeKind::object) {
        return kNoNode;
    }
    NodeId id = nodes[object].first_child;
    while (id != kNoNode && nodes[id].key != key) {
        id = nodes[id].next_sibling;
    }
    return id;
}

NodeId JsonTree::child(NodeId array, std::size_t index) const {
    if (nodes[array].kind != NodeKind::array || index >= nodes[array].child_count) {
        return kNoNode;
    }
    NodeId id = nodes[array].first_child;
    for (; index > 0; --index) {
        id = nodes[id].next_sibling;
    }
    return id;
}

NodeId JsonTree::last_child(NodeId parent) const {
    NodeId last = kNoNode;
    for (NodeId id = nodes[parent].first_child; id != kNoNode; id = nodes[id].next_sibling) {
        last = id;
    }
    return last;
}

std::string unescape_token(std::string_view token) {
    std::string text;
    for (std::size_t i = 0; i < token.size(); ++i) {
        if (token[i] == '~' && i + 1 < token.size() &&
            (token[i + 1] == '0' || token[i + 1] == '1')) {
            text += token[++i] == '0' ? '~' : '/';
        } else {
            text += token[i];
        }
    }
    return text;
}

std::size_t array_index(std::string_view token) {
    constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    std::size_t index = 0;
    const auto end = std::from_chars(token.data(), token.data() + token.size(), index);
    const bool whole = end.ec == std::errc() && end.ptr == token.data() + token.size();
    const bool padded = token.size() > 1 && token[0] == '0';
    return whole && !padded ? index : kNone;
}

Resolved resolve(const JsonTree& tree, std::string_view pointer) {
    Resolved result;
    if (tree.empty()) {
        return result;
    }
    result.node = 0;
    while (!pointer.empty()) {
        const std::size_t end = pointer.find('/', 1);
        const std::string token =
            unescape_token(pointer.substr(1, end == pointer.npos ? end : end - 1));
        const NodeKind kind = tree[result.node].kind;
        const NodeId next = kind == NodeKind::array
                                ? tree.child(result.node, array_index(token))
                                : tree.child(result.node, std::string_view(token));
        if (next == kNoNode) {
            // An object with an index for a key: a colour's channel in a colour that is no list.
            const bool leaf = kind != NodeKind::array && kind != NodeKind::object;
            const bool channel = kind == NodeKind::object && array_index(token) <= 2;
            result.through_leaf = leaf || channel;
            return result;
        }
        result.existing += pointer.substr(0, end);
        result.node = next;
        pointer = end == pointer.npos ? std::string_view() : pointer.substr(end);
    }
    result.complete = true;
    return result;
}

}  // namespace penumbra
