// SPDX-License-Identifier: MIT
// Bearer tokens (RFC 6750): who may have pictures rendered.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

// Takes the same time wherever they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

// Tokens of a file: one a line, "NAME TOKEN" or "TOKEN"; # begins a comment. A client's name is what figures are kept under.
class Tokens {
public:
    Tokens() = default;  // none: everybody may ask
    // Throws std::runtime_error with a sentence when a line is no token, or there is none.
    static Tokens parse(std::string_view text);

    bool required() const { return !tokens_.empty(); }
    // The name of who sends this Authorization header; nothing when it is none of these. Takes the same time for every wrong one.
    std::optional<std::string> name_of(std::string_view authorization) const;

private:
    struct Token {
        std::string name;
        std::string digest;  // of equal length, whatever the token's
    };
    std::vector<Token> tokens_;
};

}  // namespace penumbra
