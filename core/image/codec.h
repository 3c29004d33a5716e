// SPDX-License-Identifier: MIT
// Reading and writing picture files, in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/image/image.h"
#include "core/scene/scene.h"

namespace penumbra {

using Bytes = std::vector<std::uint8_t>;

// PNG of 1 (grey), 3 (RGB) or 4 (RGBA) channels, 8 bits, with an sRGB chunk, in the smallest form that loses nothing: grey where
// all pixels are, RGB where all are opaque, a palette of up to 256 colours, 1 to 4 bits where they do (docs/decisions/0045).
Bytes encode_png(const Image8& image);
// The same with 16 bits a channel.
Bytes encode_png(const Image16& image);

// PFM (http://www.pauldebevec.com/Research/HDR/PFM/): "PF" for 3 channels, "Pf" for 1, little endian,
// scale -1.0, rows bottom to top in the file.
Bytes encode_pfm(const ImageF& image);

enum class ExrSamples { half, full };

// OpenEXR with 3 channels (R, G, B) or 1 (Y), scan lines, ZIP. Halves end at 65,504: what is more is written as that.
Bytes encode_exr(const ImageF& image, ExrSamples samples);

// Radiance HDR, RGBE, 3 channels: mantissas of 8 bits, rounded, with the pixel's common exponent; nothing negative.
Bytes encode_hdr(const ImageF& image);

// NumPy: '<f4', (height, width, channels).
Bytes encode_npy(const ImageF& image);

// Why a picture could not be decoded: one sentence.
struct DecodeError {
    std::string message;
    bool too_large = false;  // a good file perhaps, but over the limits
};

struct DecodeLimits {
    int max_side_px = 8192;
    double max_pixels = 4096.0 * 4096.0;
};

// Any PNG to RGBA 8 bits, straight alpha. The header is checked against the limits before anything
// is inflated, and no more is inflated than the header promises.
std::variant<Texels, DecodeError> decode_png(std::span<const std::uint8_t> bytes, const DecodeLimits& limits = {});

// Any PNG to RGBA 16 bits, as decode_png().
std::variant<Image16, DecodeError> decode_png16(std::span<const std::uint8_t> bytes, const DecodeLimits& limits = {});
// Whether a PNG has 16 bits a channel.
bool is_png16(std::span<const std::uint8_t> bytes);

std::variant<ImageF, DecodeError> decode_pfm(std::span<const std::uint8_t> bytes);
std::variant<ImageF, DecodeError> decode_exr(std::span<const std::uint8_t> bytes);
std::variant<ImageF, DecodeError> decode_hdr(std::span<const std::uint8_t> bytes);
std::variant<ImageF, DecodeError> decode_npy(std::span<const std::uint8_t> bytes);

}  // namespace penumbra
