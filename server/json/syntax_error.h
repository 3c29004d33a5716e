// SPDX-License-Identifier: MIT
// What is wrong with a text that is no JSON, in words, and exactly where.
//
// nlohmann's own position can be a line late and its words speak of its lexer; so the parser tells
// how far the text was good, and this looks at what comes next.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace penumbra {

// What the last good token was, as far as it decides what may follow.
enum class After {
    nothing,        // at the start of the text
    document,       // the whole value has been read
    key,            // a colon must follow
    open_array,     // "["
    open_object,    // "{"
    array_element,  // a value in an array
    object_member,  // a value in an object
};

struct SyntaxError {
    std::size_t offset = 0;
    std::string message;
};

SyntaxError describe_syntax_error(std::string_view text, std::size_t good_until, After after);

// The end of the longest JSON number that starts at `at`; `at` itself when there is none.
std::size_t number_end(std::string_view text, std::size_t at);

// The first byte at or after `at` that is not JSON's white space.
std::size_t skip_space(std::string_view text, std::size_t at);

}  // namespace penumbra
