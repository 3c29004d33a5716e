// SPDX-License-Identifier: MIT
// Reading the request headers that decide what comes in and what goes out. Plain text functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/service/formats.h"

namespace penumbra {

// Accept (RFC 9110, 12.5.1) as wishes; an empty header accepts everything.
FormatWishes parse_accept(std::string_view accept);

// Which of these types Accept likes best; among equals, and without a word, the first. Nothing: it takes none of them.
std::optional<std::size_t> choose_media_type(std::string_view accept, const std::vector<std::string_view>& types);

// Why a body with this Content-Type is refused: a sentence; empty when it is JSON in UTF-8.
std::string refuse_content_type(std::string_view content_type);

// If-None-Match (RFC 9110, 13.1.2): the tags of what the client has.
struct EntityTags {
    bool any = false;               // "*": whatever there is
    std::vector<std::string> tags;  // without quotes and W/: the comparison is weak

    bool empty() const { return !any && tags.empty(); }
    bool has(std::string_view tag) const;
};
// What does not follow the grammar names nothing.
EntityTags parse_entity_tags(std::string_view list);

// Whether a header of comma-separated directives (Cache-Control) has this one, in any case.
bool has_directive(std::string_view list, std::string_view name);

// Seconds of `Prefer: wait=SECONDS` (RFC 7240, 4.3; a fraction is taken too), nothing when there is no such wish.
std::optional<double> parse_wait(std::string_view prefer);
// Whether Prefer has `name=value`, in any case.
bool has_preference(std::string_view prefer, std::string_view name, std::string_view value);

// Whether Accept-Encoding takes gzip.
bool accepts_gzip(std::string_view accept_encoding);

// Whether a client's request id may be used as it is: ^[A-Za-z0-9._-]{1,64}$.
bool is_request_id(std::string_view id);
std::string new_request_id();

// Why the framing of a body is refused: a sentence; empty when it is sound. What two programs could
// read differently is refused, so that no request hides in another one's body.
std::string refuse_framing(const std::vector<std::string>& content_lengths,
                           const std::vector<std::string>& transfer_encodings);

// A name that is a token of RFC 9110, for Server-Timing: "cascade 3" is "cascade-3".
std::string timing_name(std::string_view name);
// "queue;dur=0.12"
std::string timing_entry(std::string_view name, double ms);

}  // namespace penumbra
