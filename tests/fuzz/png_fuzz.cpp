// SPDX-License-Identifier: MIT
// Any bytes as a PNG: refused with a sentence, or pixels within the limits that our own encoder keeps.
#include <algorithm>

#include "check.h"
#include "core/image/codec.h"

using namespace penumbra;
using fuzz::check;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> bytes(data, size);
    const DecodeLimits limits{.max_side_px = 512, .max_pixels = 256.0 * 256.0};
    const auto decoded = decode_png(bytes, limits);
    if (const auto* error = std::get_if<DecodeError>(&decoded)) {
        check(!error->message.empty(), "a refusal says why");
    } else {
        const Texels& texels = std::get<Texels>(decoded);
        check(texels.width >= 1 && texels.height >= 1, "a picture has pixels");
        check(std::max(texels.width, texels.height) <= limits.max_side_px &&
                  double(texels.width) * texels.height <= limits.max_pixels, "a picture is within the limits");
        check(texels.rgba.size() == 4 * std::size_t(texels.width) * std::size_t(texels.height), "four bytes a pixel");
        Image8 image(texels.width, texels.height, 4);
        std::copy(texels.rgba.begin(), texels.rgba.end(), image.data.begin());
        const auto again = decode_png(encode_png(image), limits);
        check(std::holds_alternative<Texels>(again), "what we write we read");
        check(std::get<Texels>(again).rgba == texels.rgba, "writing loses nothing");
    }
    const auto deep = decode_png16(bytes, limits);
    check(std::holds_alternative<DecodeError>(deep) == std::holds_alternative<DecodeError>(decoded), "both depths read the same files");
    if (const auto* picture = std::get_if<Image16>(&deep)) {
        const auto again = decode_png16(encode_png(*picture), limits);
        check(std::holds_alternative<Image16>(again) && std::get<Image16>(again).data == picture->data, "writing 16 bits loses nothing");
    }
    return 0;
}

#ifdef PENUMBRA_FUZZ
// Nearly all changes of a byte break a checksum or the deflate stream, behind which the decoder never looks: so the bytes are
// changed below these, and both are made good again.
#include <libdeflate.h>

#include <cstring>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

constexpr std::size_t kSignature = 8, kAround = 12;  // a chunk's length, kind and checksum
constexpr std::size_t kMostRows = 1u << 16;

std::uint32_t big(const std::uint8_t* at) { return std::uint32_t(at[0]) << 24 | std::uint32_t(at[1]) << 16 | std::uint32_t(at[2]) << 8 | at[3]; }
void put_big(std::uint8_t* at, std::uint32_t value) {
    for (int i = 0; i < 4; ++i) at[i] = std::uint8_t(value >> (24 - 8 * i));
}

// The chunk at `at`, to its end; 0 when there is none.
std::size_t chunk_bytes(const Bytes& png, std::size_t at) {
    if (at + kAround > png.size()) return 0;
    const std::size_t bytes = kAround + big(&png[at]);
    return at + bytes <= png.size() ? bytes : 0;
}

void mend_checksums(Bytes& png) {
    for (std::size_t at = kSignature, bytes; (bytes = chunk_bytes(png, at)) != 0; at += bytes) {
        put_big(&png[at + bytes - 4], libdeflate_crc32(0, &png[at + 4], bytes - 8));
    }
}

// The rows inside the first IDAT, changed and packed again.
void change_rows(Bytes& png) {
    for (std::size_t at = kSignature, bytes; (bytes = chunk_bytes(png, at)) != 0; at += bytes) {
        if (std::memcmp(&png[at + 4], "IDAT", 4) != 0) continue;
        Bytes rows(kMostRows);
        std::size_t count = 0;
        libdeflate_decompressor* const unpack = libdeflate_alloc_decompressor();
        const auto result = libdeflate_zlib_decompress(unpack, &png[at + 8], bytes - kAround, rows.data(), rows.size(), &count);
        libdeflate_free_decompressor(unpack);
        if (result != LIBDEFLATE_SUCCESS) return;
        count = LLVMFuzzerMutate(rows.data(), count, rows.size());
        libdeflate_compressor* const pack = libdeflate_alloc_compressor(1);
        Bytes chunk(8 + libdeflate_zlib_compress_bound(pack, count) + 4);
        const std::size_t packed = libdeflate_zlib_compress(pack, rows.data(), count, &chunk[8], chunk.size() - kAround);
        libdeflate_free_compressor(pack);
        put_big(chunk.data(), std::uint32_t(packed));
        std::memcpy(&chunk[4], "IDAT", 4);
        chunk.resize(packed + kAround);
        const auto begin = png.begin() + std::ptrdiff_t(at);
        png.insert(png.erase(begin, begin + std::ptrdiff_t(bytes)), chunk.begin(), chunk.end());
        return;
    }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
    Bytes png(data, data + size);
    if (seed % 4 == 0) {
        change_rows(png);
    } else {
        png.resize(max_size);
        png.resize(LLVMFuzzerMutate(png.data(), size, max_size));
    }
    if (seed % 8 != 1) mend_checksums(png);
    if (png.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::copy(png.begin(), png.end(), data);
    return png.size();
}
#endif
