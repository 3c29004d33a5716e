// SPDX-License-Identifier: MIT
#include "server/service/tokens.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "server/service/digest.h"

namespace penumbra {
namespace {

constexpr std::string_view kBearer = "bearer ";
// What a header can hold, and long enough to be no password.
constexpr std::size_t kShortestToken = 16, kLongestToken = 512;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

// b64token of RFC 6750.
bool is_token(std::string_view token) {
    return token.size() >= kShortestToken && token.size() <= kLongestToken && std::all_of(token.begin(), token.end(), [](unsigned char c) {
               return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || std::string_view("-._~+/=").find(char(c)) != std::string_view::npos;
           });
}

}  // namespace

Tokens Tokens::parse(std::string_view text) {
    Tokens tokens;
    int line_number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++line_number;
        line = trimmed(line.substr(0, line.find('#')));
        if (line.empty()) continue;
        const std::size_t space = line.find_first_of(" \t");
        const std::string name(space == std::string_view::npos ? "token-" + std::to_string(tokens.tokens_.size() + 1) : std::string(line.substr(0, space)));
        const std::string_view token = space == std::string_view::npos ? line : trimmed(line.substr(space));
        if (!is_token(token)) {
            throw std::runtime_error("line " + std::to_string(line_number) + " has no token of " + std::to_string(kShortestToken) + " to " +
                                     std::to_string(kLongestToken) + " letters, digits and -._~+/=");
        }
        tokens.tokens_.push_back({name, sha256({token})});
    }
    if (tokens.tokens_.empty()) throw std::runtime_error("there is no token in it");
    return tokens;
}

std::optional<std::string> Tokens::name_of(std::string_view authorization) const {
    authorization = trimmed(authorization);
    std::string scheme(authorization.substr(0, kBearer.size()));
    std::transform(scheme.begin(), scheme.end(), scheme.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    const bool bearer = scheme == kBearer;
    // Digests, so that neither the length nor the first wrong character shows in the time; and no token ends the search.
    const std::string digest = sha256({bearer ? trimmed(authorization.substr(kBearer.size())) : std::string_view()});
    const Token* found = nullptr;
    for (const Token& token : tokens_) {
        if (equal_in_constant_time(token.digest, digest)) found = &token;
    }
    if (!bearer || !found) return std::nullopt;
    return found->name;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace penumbra
