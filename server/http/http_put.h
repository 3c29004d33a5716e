// SPDX-License-Identifier: MIT
// One PUT of some bytes: how results of batches reach an object store.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <string_view>

namespace penumbra {

struct PutResult {
    bool good = false;
    bool final = false;  // not good, and will not be when it is tried again
    std::string why;     // a sentence unless good; without the query of the URL, which may be a signature
};

// `url` is http:// or https:// and is sent as it is, escapes and query included: a signed URL stays signed.
PutResult http_put(const std::string& url, std::span<const unsigned char> bytes, std::string_view media_type,
                   std::chrono::seconds patience);

// "https://host/path" of a URL: what may be told.
std::string without_query(const std::string& url);

}  // namespace penumbra
