// SPDX-License-Identifier: MIT
// Where a value stands in a scene document, kept as a chain on the stack: the text of a JSON
// pointer is only made when there is a problem to report.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra {

class Path {
public:
    Path() = default;  // the whole document

    Path key(std::string_view name) const { return Path(this, name, 0, false); }
    Path index(std::size_t i) const { return Path(this, {}, i, true); }

    std::string pointer() const {
        std::string text;
        append_to(text);
        return text;
    }

    // One reference token as RFC 6901 writes it.
    static void append_token(std::string& text, std::string_view token) {
        text += '/';
        for (const char c : token) {
            if (c == '~') {
                text += "~0";
            } else if (c == '/') {
                text += "~1";
            } else {
                text += c;
            }
        }
    }

private:
    Path(const Path* parent, std::string_view key, std::size_t index, bool is_index)
        : parent_(parent), key_(key), index_(index), is_index_(is_index) {}

    void append_to(std::string& text) const {
        if (!parent_) {
            return;
        }
        parent_->append_to(text);
        if (is_index_) {
            text += '/';
            text += std::to_string(index_);
        } else {
            append_token(text, key_);
        }
    }

    const Path* parent_ = nullptr;  // outlives this: paths only go down the stack
    std::string_view key_;
    std::size_t index_ = 0;
    bool is_index_ = false;
};

}  // namespace penumbra
