// SPDX-License-Identifier: MIT
#include <spng.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "core/image/codec.h"

namespace penumbra {

namespace {

constexpr std::size_t kChunkBytes = 1u << 20;  // for texts and profiles, which we never read
constexpr double kMostInflation = 1032;        // deflate cannot do better
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

std::string size_text(double width, double height) {
    return std::to_string((long long)width) + " x " + std::to_string((long long)height);
}

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
    return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
           std::uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

// The limits, against the size that the file's head tells: before libspng sees it, whose own limits
// would say neither what was found nor what is allowed. What is no PNG passes; libspng says why.
std::optional<DecodeError> over_limits(std::span<const std::uint8_t> bytes,
                                       const DecodeLimits& limits) {
    constexpr std::array<std::uint8_t, 16> kHead{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n',
                                                 0,    0,   0,   13,  'I',  'H',  'D',  'R'};
    if (bytes.size() < kHead.size() + 8 || !std::equal(kHead.begin(), kHead.end(), bytes.begin())) {
        return std::nullopt;
    }
    const double width = read_u32(bytes, 16);
    const double height = read_u32(bytes, 20);
    const std::string found = "is " + size_text(width, height) + " pixels; at most ";
    if (std::max(width, height) > limits.max_side_px) {
        return DecodeError{found + std::to_string(limits.max_side_px) + " on a side are allowed",
                           true};
    }
    if (width * height > limits.max_pixels) {
        return DecodeError{
            found + std::to_string((long long)limits.max_pixels) + " in all are allowed", true};
    }
    return std::nullopt;
}

// The samples of `format`, with the size; `pixel` is the bytes of one pixel.
struct Size {
    int width = 0;
    int height = 0;
};
std::optional<DecodeError> decode(std::span<const std::uint8_t> bytes, const DecodeLimits& limits, int format,
                                  std::size_t pixel, Size& size, std::vector<std::uint8_t>& samples) {
    if (auto error = over_limits(bytes, limits)) {
        return *error;
    }
    const std::unique_ptr<spng_ctx, ContextDeleter> context(spng_ctx_new(0));
    if (!context) {
        return DecodeError{"cannot be decoded: out of memory"};
    }
    // No chunk is longer than the file, so that a lying length costs nothing; texts and profiles
    // may inflate to a little more.
    const auto side = std::uint32_t(std::max(limits.max_side_px, 1));
    const std::size_t most_chunk = std::max(bytes.size(), kChunkBytes);
    int code = spng_set_image_limits(context.get(), side, side);
    if (code == 0) {
        code = spng_set_chunk_limits(context.get(), most_chunk, most_chunk);
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
    // A header that promises more than the file can hold is refused before memory is taken for it.
    if (pixels * bits_per_pixel(header) / 8 > kMostInflation * double(bytes.size()) + kSlackBytes) {
        return DecodeError{"cannot be decoded as PNG: the header promises " +
                           size_text(header.width, header.height) + " pixels, more than " +
                           std::to_string(bytes.size()) + " bytes can hold"};
    }

    size = {int(header.width), int(header.height)};
    samples.resize(pixel * std::size_t(header.width) * std::size_t(header.height));
    code = spng_decode_image(context.get(), samples.data(), samples.size(), format, SPNG_DECODE_TRNS);
    if (code == 0) {
        code = spng_decode_chunks(context.get());  // a file cut off after its pixels is cut off too
    }
    if (code != 0) {
        return failed(code);
    }
    return std::nullopt;
}

}  // namespace

std::variant<Texels, DecodeError> decode_png(std::span<const std::uint8_t> bytes,
                                             const DecodeLimits& limits) {
    Texels texels;
    Size size;
    if (auto error = decode(bytes, limits, SPNG_FMT_RGBA8, 4, size, texels.rgba)) {
        return *error;
    }
    texels.width = size.width;
    texels.height = size.height;
    return texels;
}

std::variant<Image16, DecodeError> decode_png16(std::span<const std::uint8_t> bytes,
                                                const DecodeLimits& limits) {
    Size size;
    std::vector<std::uint8_t> samples;
    if (auto error = decode(bytes, limits, SPNG_FMT_RGBA16, 8, size, samples)) {
        return *error;
    }
    Image16 image(size.width, size.height, 4);
    std::memcpy(image.data.data(), samples.data(), samples.size());  // in the order of this machine
    return image;
}

bool is_png16(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kBitDepth = 24;  // in the head of every PNG
    return bytes.size() > kBitDepth && bytes[0] == 0x89 && bytes[kBitDepth] == 16;
}

}  // namespace penumbra
