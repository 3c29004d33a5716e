// SPDX-License-Identifier: MIT
#include "server/http/access.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>

#include "core/image/gzip.h"
#include "server/json/base64.h"
#include "server/service/tokens.h"

namespace penumbra {
namespace {

bool is_lower_hex(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

}  // namespace

std::string sign(std::string_view key, std::string_view text) {
    unsigned char bytes[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    HMAC(EVP_sha256(), key.data(), int(key.size()), reinterpret_cast<const unsigned char*>(text.data()), text.size(), bytes, &size);
    return encode_base64url({reinterpret_cast<const char*>(bytes), size});
}

std::string encode_base64(std::string_view bytes) {
    std::string text = encode_base64url(bytes);
    std::replace(text.begin(), text.end(), '-', '+');
    std::replace(text.begin(), text.end(), '_', '/');
    while (text.size() % 4 != 0) text += '=';
    return text;
}

std::string encode_base64url(std::string_view bytes) {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
    std::string text;
    unsigned bits = 0;
    int count = 0;
    for (const unsigned char byte : bytes) {
        bits = (bits << 8 | byte) & 0xffff;
        for (count += 8; count >= 6; count -= 6) text += kLetters[bits >> (count - 6) & 63];
    }
    if (count > 0) text += kLetters[bits << (6 - count) & 63];
    return text;
}

std::optional<std::string> decode_base64url(std::string_view text) {
    std::string standard(text);
    // The standard alphabet's own two are none of this one.
    if (text.find_first_of("+/=") != std::string_view::npos) return std::nullopt;
    std::replace(standard.begin(), standard.end(), '-', '+');
    std::replace(standard.begin(), standard.end(), '_', '/');
    while (standard.size() % 4 != 0) standard += '=';
    const Base64 decoded = decode_base64(standard);
    if (!decoded.good) return std::nullopt;
    return std::string(decoded.bytes.begin(), decoded.bytes.end());
}

std::string signed_target(std::string_view key, std::string_view scene, std::int64_t expires) {
    std::string target = "/v1/render?scene=" + encode_base64url(deflate_raw(scene));
    if (expires > 0) target += "&expires=" + std::to_string(expires);
    return target + "&signature=" + sign(key, target);
}

SignedScene open_signed_target(std::string_view key, const std::vector<std::pair<std::string, std::string>>& parameters,
                               std::int64_t now, std::size_t most_bytes) {
    std::string scene, expires, signature;
    for (const auto& [name, value] : parameters) {
        std::string* place = name == "scene" ? &scene : name == "expires" ? &expires : name == "signature" ? &signature : nullptr;
        if (!place || !place->empty()) return {"", "The address has a parameter too many: " + name + "."};
        *place = value;
    }
    std::string signed_text = "/v1/render?scene=" + scene;
    if (!expires.empty()) signed_text += "&expires=" + expires;
    if (!equal_in_constant_time(sign(key, signed_text), signature)) return {"", "The address is not signed, or was changed since."};
    // From here on it is what was signed.
    const bool number = expires.size() <= 18 && std::all_of(expires.begin(), expires.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!expires.empty() && (!number || std::stoll(expires) < now)) return {"", "The address has expired."};
    const auto packed = decode_base64url(scene);
    auto text = packed ? inflate_raw(*packed, most_bytes) : std::nullopt;
    if (!text) return {"", "The address holds no scene of at most " + std::to_string(most_bytes) + " bytes."};
    return {std::move(*text), ""};
}

std::string trace_id_of(std::string_view traceparent) {
    const bool sound = traceparent.size() == 55 && traceparent.starts_with("00-") && traceparent[35] == '-' && traceparent[52] == '-' &&
                       is_lower_hex(traceparent.substr(3, 32)) && is_lower_hex(traceparent.substr(36, 16)) && is_lower_hex(traceparent.substr(53));
    if (!sound) return "";
    const std::string_view trace = traceparent.substr(3, 32), parent = traceparent.substr(36, 16);
    const auto is_zero = [](std::string_view text) { return text.find_first_not_of('0') == std::string_view::npos; };
    return is_zero(trace) || is_zero(parent) ? "" : std::string(trace);
}

}  // namespace penumbra
