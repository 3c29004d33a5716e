// SPDX-License-Identifier: MIT
#include "server/json/syntax_error.h"

#include <algorithm>
#include <optional>

#include "core/scene/wording.h"

namespace penumbra {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

unsigned byte_at(std::string_view text, std::size_t at) {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u;
}

// The length of the UTF-8 sequence at `at`, 0 when it is none (RFC 3629: no overlong forms, no
// surrogates, nothing above U+10FFFF).
std::size_t utf8_length(std::string_view text, std::size_t at) {
    const unsigned a = byte_at(text, at);
    const unsigned b = byte_at(text, at + 1);
    const auto tail = [&](std::size_t i) { return (byte_at(text, at + i) & 0xc0u) == 0x80u; };
    if (a < 0x80) {
        return 1;
    }
    if (a >= 0xc2 && a <= 0xdf) {
        return tail(1) ? 2 : 0;
    }
    if (a >= 0xe0 && a <= 0xef) {
        const bool good = (a != 0xe0 || b >= 0xa0) && (a != 0xed || b <= 0x9f);
        return good && tail(1) && tail(2) ? 3 : 0;
    }
    if (a >= 0xf0 && a <= 0xf4) {
        const bool good = (a != 0xf0 || b >= 0x90) && (a != 0xf4 || b <= 0x8f);
        return good && tail(1) && tail(2) && tail(3) ? 4 : 0;
    }
    return 0;
}

std::optional<unsigned> unicode_escape(std::string_view text, std::size_t at) {
    if (at + 6 > text.size() || text[at] != '\\' || text[at + 1] != 'u') {
        return std::nullopt;
    }
    unsigned value = 0;
    for (std::size_t i = at + 2; i < at + 6; ++i) {
        const char c = text[i];
        if (!is_hex(c)) {
            return std::nullopt;
        }
        const unsigned digit = is_digit(c) ? unsigned(c - '0') : (unsigned(c) | 0x20u) - 'a' + 10u;
        value = value * 16 + digit;
    }
    return value;
}

// What is wrong inside the string that opens at `open`; nothing when it is a good string.
std::optional<SyntaxError> string_error(std::string_view text, std::size_t open) {
    std::size_t at = open + 1;
    while (at < text.size()) {
        const unsigned byte = byte_at(text, at);
        if (byte == '"') {
            return std::nullopt;
        }
        if (byte == '\n' || byte == '\r') {
            return SyntaxError{open, "this string is not closed on its line"};
        }
        if (byte < 0x20) {
            return SyntaxError{at, "a control character in a string must be written as an escape"};
        }
        if (byte != '\\') {
            const std::size_t length = utf8_length(text, at);
            if (length == 0) {
                return SyntaxError{at, "this is not valid UTF-8"};
            }
            at += length;
            continue;
        }
        const char kind = char(byte_at(text, at + 1));
        if (kind != 'u') {
            if (std::string_view("\"\\/bfnrt").find(kind) == std::string_view::npos || kind == 0) {
                return SyntaxError{
                    at, "unknown escape in a string; a backslash itself is written \\\\"};
            }
            at += 2;
            continue;
        }
        const auto unit = unicode_escape(text, at);
        if (!unit) {
            return SyntaxError{at, "\\u must be followed by four hexadecimal digits"};
        }
        const bool high = *unit >= 0xd800 && *unit <= 0xdbff;
        const auto second = high ? unicode_escape(text, at + 6) : std::nullopt;
        const bool paired = high && second && *second >= 0xdc00 && *second <= 0xdfff;
        if ((high && !paired) || (*unit >= 0xdc00 && *unit <= 0xdfff)) {
            return SyntaxError{at, "this half of a surrogate pair stands alone"};
        }
        at += paired ? 12 : 6;
    }
    return SyntaxError{open, "the text ends inside this string"};
}

// The run of characters that a reader would take for one word or number.
std::string_view word_at(std::string_view text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && (is_letter(text[end]) || is_digit(text[end]) || text[end] == '.' ||
                                 text[end] == '+' || text[end] == '-')) {
        ++end;
    }
    return text.substr(at, end - at);
}

bool is_json_number(std::string_view word) {
    return !word.empty() && number_end(word, 0) == word.size();
}

std::string lowered(std::string_view word) {
    std::string text(word);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    return text;
}

std::string what_stands_at(std::string_view text, std::size_t at) {
    const std::string_view word = word_at(text, at);
    if (!word.empty()) {
        return in_quotes(word);
    }
    if (text[at] == '"') {
        return "a string";
    }
    const std::size_t length = utf8_length(text, at);
    return length == 0 ? "a byte that is not UTF-8" : in_quotes(text.substr(at, length));
}

std::string expected_after(After after) {
    switch (after) {
        case After::nothing:
            return "a JSON object is expected";
        case After::document:
            return "nothing may follow the document";
        case After::key:
            return "a colon is expected after the key";
        case After::open_array:
            return "a value or ] is expected";
        case After::open_object:
            return "a key in double quotes or } is expected";
        case After::array_element:
            return "a comma or ] is expected";
        case After::object_member:
            return "a comma or } is expected";
    }
    return {};
}

// What is said about the token at `at`, where a value should stand.
SyntaxError value_error(std::string_view text, std::size_t at, std::string expected) {
    const std::string_view word = word_at(text, at);
    const std::string small = lowered(word);
    if (small == "nan" || small == "inf" || small == "infinity" || small == "-inf" ||
        small == "-infinity" || small == "-nan") {
        return {at, in_quotes(word) + " is not JSON: numbers must be finite"};
    }
    if (small == "true" || small == "false" || small == "null") {
        return {at, in_quotes(word) + " must be written in small letters: " + small};
    }
    if (is_json_number(word)) {
        return {at, "the number " + in_quotes(word) + " is too large to be represented"};
    }
    if (!word.empty() &&
        (is_digit(word[0]) || word[0] == '-' || word[0] == '+' || word[0] == '.')) {
        return {at, in_quotes(word) + " is not a number as JSON writes them"};
    }
    if (!word.empty()) {
        return {at, in_quotes(word) + " is not JSON: texts stand in double quotes"};
    }
    return {at, what_stands_at(text, at) + " is not expected here: " + expected};
}

}  // namespace

std::size_t number_end(std::string_view text, std::size_t at) {
    const std::size_t none = at;
    const auto next_is = [&](char c) { return at < text.size() && text[at] == c; };
    const auto skip_digits = [&] {
        const std::size_t start = at;
        while (at < text.size() && is_digit(text[at])) {
            ++at;
        }
        return at > start;
    };
    if (next_is('-')) {
        ++at;
    }
    if (next_is('0')) {
        ++at;  // nothing else of the whole part may follow
    } else if (!skip_digits()) {
        return none;
    }
    std::size_t end = at;
    if (next_is('.')) {
        ++at;
        if (!skip_digits()) {
            return end;
        }
        end = at;
    }
    if (next_is('e') || next_is('E')) {
        ++at;
        if (next_is('+') || next_is('-')) {
            ++at;
        }
        if (skip_digits()) {
            end = at;
        }
    }
    return end;
}

std::size_t skip_space(std::string_view text, std::size_t at) {
    while (at < text.size() &&
           (text[at] == ' ' || text[at] == '\n' || text[at] == '\t' || text[at] == '\r')) {
        ++at;
    }
    return at;
}

SyntaxError describe_syntax_error(std::string_view text, std::size_t good_until, After after) {
    std::size_t at = skip_space(text, good_until);
    std::string expected = expected_after(after);
    bool value_may_follow = after == After::nothing || after == After::open_array;
    bool key_may_follow = after == After::open_object;
    const auto next_is = [&](char c) { return at < text.size() && text[at] == c; };

    if (after == After::key && next_is(':')) {
        at = skip_space(text, at + 1);
        expected = "a value is expected after the colon";
        value_may_follow = true;
    } else if ((after == After::array_element || after == After::object_member) && next_is(',')) {
        at = skip_space(text, at + 1);
        const bool in_array = after == After::array_element;
        if (next_is(in_array ? ']' : '}')) {
            return {at, std::string("a comma must not stand before ") + (in_array ? "]" : "}")};
        }
        expected = in_array ? "a value is expected after the comma"
                            : "a key in double quotes is expected after the comma";
        value_may_follow = in_array;
        key_may_follow = !in_array;
    }

    if (at >= text.size()) {
        if (after == After::nothing) {
            return {at, "the text is empty: " + expected};
        }
        return {at, "the text ends too early: " + expected};
    }
    const char c = text[at];
    if (c == '/' && (byte_at(text, at + 1) == '/' || byte_at(text, at + 1) == '*')) {
        return {at, "JSON has no comments"};
    }
    if (after == After::document) {
        return {at, expected + ", here stands " + what_stands_at(text, at)};
    }
    if (c == '\'') {
        return {at, "texts and keys stand in double quotes, not in single ones"};
    }
    if (c == '"' && (value_may_follow || key_may_follow)) {
        if (auto error = string_error(text, at)) {
            return *error;
        }
    }
    if (value_may_follow) {
        return value_error(text, at, expected);
    }
    return {at, expected + ", here stands " + what_stands_at(text, at)};
}

}  // namespace penumbra
