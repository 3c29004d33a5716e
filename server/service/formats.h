// SPDX-License-Identifier: MIT
// The picture formats that this build writes: one row each, and nothing else knows their names.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/codec.h"
#include "core/renderer.h"

namespace penumbra {

struct PictureFormat {
    std::string_view name;        // as output.format
    std::string_view media_type;  // as Accept and Content-Type
    std::string_view extension;   // of a file, with its dot
};

std::span<const PictureFormat> picture_formats();
const PictureFormat* find_format(std::string_view name);
const PictureFormat* find_format_of_file(std::string_view path);  // by extension, in any case
std::string format_names();                                       // "png, pfm, ..."

// Which formats a client takes, and how gladly (q of RFC 9110, 0 is never).
struct FormatWishes {
    struct Wish {
        std::string format;
        double q = 0;
    };
    std::vector<Wish> wishes;  // of every format there is
    double any_q = 1;          // of a format that is not in the list: what "*/*" says

    bool nothing_fits() const;
    // The scene's own format where the client likes none better.
    std::string choose(const std::string& scene_format) const;
};

FormatWishes any_format();
FormatWishes only_format(std::string_view name);

// One that differs tells other wishes apart: "png;q=1.000, pfm;q=0.500, *;q=1.000".
std::string to_string(const FormatWishes& wishes);

// The renderer gives pixels for display or linear ones as the scene's output.format asks; `bit_depth` tells an EXR's halves.
Bytes encode_picture(const RenderResult& result, std::string_view format, int bit_depth);
Bytes encode_linear(const ImageF& image, std::string_view format, int bit_depth = 0);

}  // namespace penumbra
