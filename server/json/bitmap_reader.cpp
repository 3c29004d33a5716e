// SPDX-License-Identifier: MIT
#include "server/json/bitmap_reader.h"

#include <utility>
#include <variant>

#include "core/image/codec.h"
#include "core/scene/wording.h"
#include "server/json/base64.h"

namespace penumbra {

namespace {

constexpr std::string_view kPrefix = "data:image/png;base64,";

}  // namespace

std::shared_ptr<const Texels> BitmapReader::read(const Path& where, NodeId id) {
    const auto url = reader_.string(where, id);
    if (!url) {
        return nullptr;
    }
    if (reader_.problems().full()) {
        return nullptr;  // the scene is refused anyhow: no time is spent on its pictures
    }
    if (!url->starts_with(kPrefix)) {
        reader_.report(where, id, "bad_image", [&] {
            return "must be a PNG in a data URL that starts with " + in_quotes(kPrefix) +
                   " (files and addresses are never opened), is " + in_quotes(*url);
        });
        return nullptr;
    }
    const Base64 data = decode_base64(url->substr(kPrefix.size()));
    if (!data.good) {
        reader_.report(where, id, "bad_image", [&] {
            return "is not valid base64 at character " +
                   std::to_string(kPrefix.size() + data.bad_at + 1) +
                   " (padding is required, white space is not allowed)";
        });
        return nullptr;
    }
    DecodeLimits decode_limits;
    decode_limits.max_side_px = limits_.max_bitmap_side_px;
    decode_limits.max_pixels = texels_left_;
    auto decoded = decode_png(data.bytes, decode_limits);
    if (auto* error = std::get_if<DecodeError>(&decoded)) {
        const bool used = texels_left_ < limits_.max_bitmap_texels;
        reader_.report(where, id, error->too_large ? "too_large" : "bad_image", [&] {
            return error->message + (error->too_large && used
                                         ? " (what the bitmaps before it leave of " +
                                               number_text(limits_.max_bitmap_texels) + ")"
                                         : std::string());
        });
        return nullptr;
    }
    auto texels = std::make_shared<const Texels>(std::get<Texels>(std::move(decoded)));
    texels_left_ -= double(texels->width) * double(texels->height);
    return texels;
}

}  // namespace penumbra
