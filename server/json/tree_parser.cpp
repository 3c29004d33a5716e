// SPDX-License-Identifier: MIT
#include "server/json/tree_parser.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/scene/path.h"
#include "server/json/syntax_error.h"

namespace penumbra {

namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// nlohmann's events do not carry positions. The handler keeps a cursor: at each event it skips what
// stands between tokens, which is then exactly at the event's token, and steps over it. nlohmann
// has checked the token by then, so that finding its end is easy.
class Handler final : public nlohmann::json_sax<nlohmann::json> {
public:
    Handler(std::string_view text, const TextLimits& limits, JsonTree& tree,
            std::optional<TextOffset> offset)
        : text_(text), limits_(limits), tree_(tree), offset_(offset), first_(tree.nodes.size()) {}

    bool null() override { return literal(NodeKind::null, 0, 4); }
    bool boolean(bool value) override {
        return literal(NodeKind::boolean, value ? 1 : 0, value ? 4 : 5);
    }
    bool number_integer(number_integer_t value) override { return number(double(value)); }
    bool number_unsigned(number_unsigned_t value) override { return number(double(value)); }
    bool number_float(number_float_t value, const string_t&) override { return number(value); }

    bool string(string_t& value) override {
        Node* node = add(NodeKind::string);
        return node && take_string(value, node->string);
    }

    bool binary(binary_t&) override { return false; }  // JSON text has none

    bool start_object(std::size_t) override { return open(NodeKind::object); }
    bool start_array(std::size_t) override { return open(NodeKind::array); }
    bool end_object() override {
        find_duplicates(open_.back().node);
        return close();
    }
    bool end_array() override { return close(); }

    bool key(string_t& value) override {
        to_token();
        key_offset_ = offset();
        has_key_ = true;
        return take_string(value, key_);
    }

    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
        return false;  // said better by describe_syntax_error()
    }

    std::size_t cursor() const { return cursor_; }
    std::optional<TextError> take_error() { return std::move(error_); }

    After after() const {
        if (has_key_) {
            return After::key;
        }
        if (open_.empty()) {
            return tree_.nodes.size() == first_ ? After::nothing : After::document;
        }
        const Node& parent = tree_[open_.back().node];
        const bool array = parent.kind == NodeKind::array;
        if (parent.child_count == 0) {
            return array ? After::open_array : After::open_object;
        }
        return array ? After::array_element : After::object_member;
    }

private:
    struct Open {
        NodeId node = kNoNode;
        NodeId last_child = kNoNode;
    };

    TextOffset offset() const { return offset_.value_or(TextOffset(cursor_)); }

    // To the token of the event at hand: between tokens stand only space, commas and colons.
    void to_token() {
        const auto between = [](char c) {
            return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == ',' || c == ':';
        };
        while (cursor_ < text_.size() && between(text_[cursor_])) {
            ++cursor_;
        }
    }

    bool fail(const char* code, std::string message) {
        error_ = TextError{code, std::move(message), cursor_, open_pointer()};
        return false;
    }

    // Of the innermost list or object that is still open.
    std::string open_pointer() const {
        std::string pointer;
        for (std::size_t i = 1; i < open_.size(); ++i) {
            append_place(pointer, open_[i - 1].node, open_[i].node);
        }
        return pointer;
    }

    void append_place(std::string& pointer, NodeId parent, NodeId child) const {
        if (tree_[parent].kind == NodeKind::object) {
            Path::append_token(pointer, tree_[child].key);
        } else {
            pointer += '/' + std::to_string(tree_[parent].child_count - 1);
        }
    }

    // The node of the event at hand, nullptr when that is one too many.
    Node* add(NodeKind kind) {
        to_token();
        if (tree_.nodes.size() >= limits_.max_nodes || tree_.nodes.size() >= kNoNode) {
            fail("too_many",
                 "the text must hold at most " + std::to_string(limits_.max_nodes) + " values");
            return nullptr;
        }
        const auto id = NodeId(tree_.nodes.size());
        Node& node = tree_.nodes.emplace_back();
        node.kind = kind;
        node.offset = offset();
        if (has_key_) {
            node.key = key_;
            node.key_offset = key_offset_;
            has_key_ = false;
        }
        if (!open_.empty()) {
            Open& parent = open_.back();
            NodeId& link = parent.last_child == kNoNode
                               ? tree_.nodes[parent.node].first_child
                               : tree_.nodes[parent.last_child].next_sibling;
            link = id;
            parent.last_child = id;
            ++tree_.nodes[parent.node].child_count;
        }
        return &node;
    }

    bool literal(NodeKind kind, double value, std::size_t length) {
        Node* node = add(kind);
        if (!node) {
            return false;
        }
        node->number = value;
        cursor_ += length;
        return true;
    }

    bool number(double value) {
        Node* node = add(NodeKind::number);
        if (!node) {
            return false;
        }
        node->number = value;
        cursor_ = number_end(text_, cursor_);
        return true;
    }

    // Steps over the string token. Without escapes the text itself is the string, so that a picture
    // of many megabytes is not copied.
    bool take_string(std::string& value, std::string_view& to) {
        if (value.size() > limits_.max_string_bytes) {
            return fail("too_large", "a string must have at most " +
                                         std::to_string(limits_.max_string_bytes) +
                                         " bytes, this has " + std::to_string(value.size()));
        }
        const std::size_t start = cursor_ + 1;
        if (start + value.size() < text_.size() && text_[start + value.size()] == '"' &&
            std::memcmp(text_.data() + start, value.data(), value.size()) == 0) {
            to = text_.substr(start, value.size());
            cursor_ = start + value.size() + 1;
            return true;
        }
        std::size_t end = text_.find_first_of("\"\\", start);
        while (end < text_.size() && text_[end] == '\\') {
            end = text_.find_first_of("\"\\", end + 2);
        }
        cursor_ = std::min(end, text_.size() - 1) + 1;
        to = tree_.decoded.emplace_back(std::move(value));
        return true;
    }

    bool open(NodeKind kind) {
        if (open_.size() >= std::size_t(std::max(limits_.max_depth, 0))) {
            to_token();
            return fail("too_deep", "lists and objects must not be nested more than " +
                                        std::to_string(limits_.max_depth) + " deep");
        }
        if (!add(kind)) {
            return false;
        }
        ++cursor_;
        open_.push_back({NodeId(tree_.nodes.size() - 1), kNoNode});
        return true;
    }

    bool close() {
        to_token();
        ++cursor_;
        open_.pop_back();
        return true;
    }

    void find_duplicates(NodeId object) {
        scratch_.clear();
        for (NodeId id = tree_[object].first_child; id != kNoNode; id = tree_[id].next_sibling) {
            scratch_.push_back(id);
        }
        // Sorted rather than hashed: no choice of keys makes this slow.
        std::sort(scratch_.begin(), scratch_.end(), [&](NodeId a, NodeId b) {
            const int order = tree_[a].key.compare(tree_[b].key);
            return order != 0 ? order < 0 : a < b;
        });
        for (std::size_t i = 1; i < scratch_.size(); ++i) {
            if (tree_[scratch_[i]].key != tree_[scratch_[i - 1]].key) {
                continue;
            }
            if (tree_.duplicates.size() < limits_.max_problems) {
                const Node& second = tree_[scratch_[i]];
                std::string pointer = open_pointer();
                Path::append_token(pointer, second.key);
                tree_.duplicates.push_back({std::move(pointer), second.key, second.key_offset});
            } else {
                ++tree_.duplicates_left_out;
            }
        }
    }

    std::string_view text_;
    const TextLimits& limits_;
    JsonTree& tree_;
    std::optional<TextOffset> offset_;
    std::size_t first_;       // nodes before this parse
    std::size_t cursor_ = 0;  // after the last token
    std::vector<Open> open_;
    std::string_view key_;
    TextOffset key_offset_ = kNotInText;
    bool has_key_ = false;
    std::vector<NodeId> scratch_;
    std::optional<TextError> error_;
};

ParsedText failed(TextError error) { return ParsedText{kNoNode, std::move(error)}; }

}  // namespace

ParsedText parse_text(std::string_view text, const TextLimits& limits, JsonTree& tree,
                      std::optional<TextOffset> offset) {
    const std::size_t most = std::min<std::size_t>(limits.max_bytes, kLongestText);
    if (text.size() > most) {
        return failed({"too_large",
                       "the text must have at most " + std::to_string(most) + " bytes, has " +
                           std::to_string(text.size()),
                       0,
                       {}});
    }
    if (text.starts_with(kByteOrderMark)) {
        // nlohmann would skip it in silence; RFC 8259 forbids it.
        return failed(
            {"syntax", "the text must not start with a byte order mark (EF BB BF)", 0, {}});
    }
    const std::size_t before = tree.nodes.size();
    Handler handler(text, limits, tree, offset);
    const bool good = nlohmann::json::sax_parse(text.begin(), text.end(), &handler);
    if (auto error = handler.take_error()) {
        return failed(std::move(*error));
    }
    // nlohmann takes a NUL byte for the end of the text; whatever follows it was not looked at.
    if (!good || skip_space(text, handler.cursor()) != text.size()) {
        SyntaxError error = describe_syntax_error(text, handler.cursor(), handler.after());
        return failed({"syntax", std::move(error.message), error.offset, {}});
    }
    return {NodeId(before), std::nullopt};
}

}  // namespace penumbra
