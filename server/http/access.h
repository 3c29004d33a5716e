// SPDX-License-Identifier: MIT
// Addresses of pictures that are signed, and identities of traces.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra {

// HMAC-SHA256 of `text`, as base64url without padding: 43 characters.
std::string sign(std::string_view key, std::string_view text);

std::string encode_base64(std::string_view bytes);  // RFC 4648, padded
std::string encode_base64url(std::string_view bytes);
std::optional<std::string> decode_base64url(std::string_view text);

// A scene as an address that works until `expires` (seconds since 1970; 0: for ever): "/v1/render?scene=...&expires=...&signature=...".
std::string signed_target(std::string_view key, std::string_view scene, std::int64_t expires);

struct SignedScene {
    std::string scene;
    std::string refusal;  // a sentence; empty: it may be rendered
};
// `parameters` in the order of the address: name and value.
SignedScene open_signed_target(std::string_view key, const std::vector<std::pair<std::string, std::string>>& parameters,
                               std::int64_t now, std::size_t most_bytes);

// traceparent (W3C Trace Context, version 00): the trace's id, "" when it is not sound.
std::string trace_id_of(std::string_view traceparent);

}  // namespace penumbra
