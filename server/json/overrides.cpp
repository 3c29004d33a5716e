// SPDX-License-Identifier: MIT
#include "server/json/overrides.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/scene/wording.h"
#include "server/json/tree_parser.h"

namespace penumbra {

namespace {

// Applies one override; what stops it is the returned sentence, "" when nothing does.
class Application {
public:
    Application(JsonTree& tree, const Override& override, TextOffset offset,
                const TextLimits& limits)
        : tree_(tree), override_(override), offset_(offset), limits_(limits) {}

    std::string run() {
        std::string_view rest = override_.pointer;
        if (rest.empty() || rest[0] != '/') {
            return "must start with / and name a value, like /canvas/width";
        }
        const NodeId value = parse_value();
        if (value == kNoNode) {
            return error_;
        }
        // The way to the place is made only once nothing stands in it: a bad override changes
        // nothing but empty objects that the first wrong step left out.
        NodeId at = 0;
        while (true) {
            const std::size_t end = rest.find('/', 1);
            const bool last = end == rest.npos;
            const std::string token = unescape_token(rest.substr(1, last ? end : end - 1));
            rest = last ? std::string_view() : rest.substr(end);
            NodeId next = kNoNode;
            if (tree_[at].kind == NodeKind::object) {
                next = tree_.child(at, std::string_view(token));
                if (next == kNoNode) {
                    next = append(at, token);
                }
            } else if (tree_[at].kind == NodeKind::array) {
                const std::size_t index = array_index(token);
                if (token == "-" || index == tree_[at].child_count) {
                    next = append(at, {});
                } else {
                    next = tree_.child(at, index);
                }
                if (next == kNoNode) {
                    return "has no place " + in_quotes(token) + ": the list holds " +
                           std::to_string(tree_[at].child_count) + " (\"-\" appends)";
                }
            } else {
                return "goes on inside " + std::string(kind_name(tree_[at].kind)) + " at " +
                       in_quotes(token);
            }
            if (last) {
                replace(next, value);
                return {};
            }
            if (next == made_) {
                const bool list = rest == "/-" || rest == "/0" || rest.starts_with("/-/") ||
                                  rest.starts_with("/0/");
                tree_.nodes[next].kind = list ? NodeKind::array : NodeKind::object;
            }
            at = next;
        }
    }

private:
    NodeId parse_value() {
        const std::size_t size = tree_.nodes.size();
        ParsedText parsed = parse_text(override_.value, limits_, tree_, offset_);
        if (!parsed.error) {
            return parsed.root;
        }
        tree_.nodes.resize(size);
        if (parsed.error->code != "syntax") {
            error_ = std::move(parsed.error->message);
            return kNoNode;
        }
        Node text;
        text.kind = NodeKind::string;
        text.string = override_.value;
        text.offset = offset_;
        tree_.nodes.push_back(text);
        return NodeId(size);
    }

    NodeId append(NodeId parent, const std::string& key) {
        const auto id = NodeId(tree_.nodes.size());
        const NodeId before = tree_.last_child(parent);
        Node node;
        node.key = tree_.decoded.emplace_back(key);
        node.offset = node.key_offset = offset_;
        tree_.nodes.push_back(node);
        NodeId& link =
            before == kNoNode ? tree_.nodes[parent].first_child : tree_.nodes[before].next_sibling;
        link = id;
        ++tree_.nodes[parent].child_count;
        made_ = id;
        return id;
    }

    // The value keeps its place among its siblings, and its key.
    void replace(NodeId to, NodeId value) {
        Node node = tree_[value];
        node.key = tree_[to].key;
        node.key_offset = tree_[to].key_offset;
        node.next_sibling = tree_[to].next_sibling;
        tree_.nodes[to] = node;
    }

    JsonTree& tree_;
    const Override& override_;
    TextOffset offset_;
    const TextLimits& limits_;
    NodeId made_ = kNoNode;  // the last node that append() made
    std::string error_;
};

}  // namespace

void apply_overrides(JsonTree& tree, const std::vector<Override>& overrides,
                     const TextLimits& limits, ProblemList& problems) {
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        const Override& override = overrides[i];
        const TextOffset offset = offset_of_override(i);
        std::string error = Application(tree, override, offset, limits).run();
        if (!error.empty()) {
            problems.add(
                {{override.pointer, "bad_override",
                  "the override of " + in_quotes(override.pointer) + " " + std::move(error)},
                 offset,
                 {}});
        }
    }
}

}  // namespace penumbra
