// SPDX-License-Identifier: MIT
#include <spng.h>

#include <algorithm>
#include <memory>
#include <string>

#include "core/image/codec.h"

namespace penumbra {

namespace {

constexpr std::size_t kChunkCacheBytes = 1u << 20;  // texts and profiles, which we never read
constexpr double kMostInflation = 1032;             // deflate cannot do better
constexpr double kSlackBytes = 1024;

struct ContextDeleter {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

DecodeError failed(int code) {
    return DecodeError{std::string("cannot be decoded as PNG: ") + spng_strerror(code)};
}

double bits_per_pixel(const spng_ihdr& header) {
    switch (header.color_type) {
        case SPNG_COLOR_TYPE_TRUECOLOR:
            return 3.0 * header.bit_depth;
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
            return 2.0 * header.bit_depth;
        case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
            return 4.0 * header.bit_depth;
        default:
            return header.bit_depth;
    }
}

std::string size_text(const spng_ihdr& header) {
    return std::to_string(header.width) + " x " + std::to_string(header.height);
}

}  // namespace

std::variant<Texels, DecodeError> decode_png(std::span<const std::uint8_t> bytes,
                                             const DecodeLimits& limits) {
    const std::unique_ptr<spng_ctx, ContextDeleter> context(spng_ctx_new(0));
    if (!context) {
        return DecodeError{"cannot be decoded: out of memory"};
    }
    // No chunk is longer than the file, so that a lying length costs nothing. The size limits here
    // are those of the PNG format: ours are checked below, to say what was found and what is
    // allowed.
    constexpr std::uint32_t kFormatSide = 0x7fffffff;
    int code = spng_set_image_limits(context.get(), kFormatSide, kFormatSide);
    if (code == 0) {
        code = spng_set_chunk_limits(context.get(), bytes.size(),
                                     std::min(bytes.size(), kChunkCacheBytes));
    }
    if (code == 0) {
        code = spng_set_png_buffer(context.get(), bytes.data(), bytes.size());
    }
    spng_ihdr header{};
    if (code == 0) {
        code = spng_get_ihdr(context.get(), &header);
    }
    if (code != 0) {
        return failed(code);
    }
    const double pixels = double(header.width) * double(header.height);
    const auto side = std::uint32_t(std::max(limits.max_side_px, 0));
    if (header.width > side || header.height > side) {
        return DecodeError{"is " + size_text(header) + " pixels; at most " + std::to_string(side) +
                               " on a side are allowed",
                           true};
    }
    if (pixels > limits.max_pixels) {
        return DecodeError{"is " + size_text(header) + " pixels; at most " +
                               std::to_string((long long)limits.max_pixels) + " in all are allowed",
                           true};
    }
    // A header that promises more than the file can hold is refused before memory is taken for it.
    if (pixels * bits_per_pixel(header) / 8 > kMostInflation * double(bytes.size()) + kSlackBytes) {
        return DecodeError{"cannot be decoded as PNG: the header promises " + size_text(header) +
                           " pixels, more than " + std::to_string(bytes.size()) +
                           " bytes can hold"};
    }

    Texels texels;
    texels.width = int(header.width);
    texels.height = int(header.height);
    texels.rgba.resize(4 * std::size_t(header.width) * std::size_t(header.height));
    code = spng_decode_image(context.get(), texels.rgba.data(), texels.rgba.size(), SPNG_FMT_RGBA8,
                             SPNG_DECODE_TRNS);
    if (code == 0) {
        code = spng_decode_chunks(context.get());  // a file cut off after its pixels is cut off too
    }
    if (code != 0) {
        return failed(code);
    }
    return texels;
}

}  // namespace penumbra
