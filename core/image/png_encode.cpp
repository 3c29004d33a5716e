// SPDX-License-Identifier: MIT
#include <libdeflate.h>

#include <array>
#include <cassert>
#include <cstring>
#include <memory>
#include <new>

#include "core/image/codec.h"

namespace penumbra {

namespace {

constexpr int kCompressionLevel = 1;     // the higher levels cost more time than they save bytes
constexpr std::uint8_t kFilterSub = 1;   // each byte less the same channel of the pixel to its left
constexpr std::uint8_t kPerceptual = 0;  // the sRGB chunk's rendering intent

constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kMostHeadBytes = 128;  // of what comes before the pixels

struct CompressorDeleter {
    void operator()(libdeflate_compressor* compressor) const {
        libdeflate_free_compressor(compressor);
    }
};

void put_u32(std::uint8_t* to, std::uint32_t value) {
    to[0] = std::uint8_t(value >> 24);
    to[1] = std::uint8_t(value >> 16);
    to[2] = std::uint8_t(value >> 8);
    to[3] = std::uint8_t(value);
}

// Reserves a chunk's length and type at the end of the file; finish_chunk() fills in the rest.
std::size_t begin_chunk(Bytes& file, const char* type) {
    const std::size_t start = file.size();
    file.resize(start + 8);
    std::memcpy(file.data() + start + 4, type, 4);
    return start;
}

void finish_chunk(Bytes& file, std::size_t start) {
    const std::size_t length = file.size() - start - 8;
    put_u32(file.data() + start, std::uint32_t(length));
    const std::uint32_t crc = libdeflate_crc32(0, file.data() + start + 4, length + 4);
    file.resize(file.size() + 4);
    put_u32(file.data() + file.size() - 4, crc);
}

// The bytes of one row as the file has them: the high byte first.
void row_bytes(const Image8& image, int y, std::uint8_t* to) {
    std::memcpy(to, image.at(0, y), std::size_t(image.width) * std::size_t(image.channels));
}
void row_bytes(const Image16& image, int y, std::uint8_t* to) {
    const std::uint16_t* from = image.at(0, y);
    const std::size_t count = std::size_t(image.width) * std::size_t(image.channels);
    for (std::size_t i = 0; i < count; ++i) {
        to[2 * i] = std::uint8_t(from[i] >> 8);
        to[2 * i + 1] = std::uint8_t(from[i]);
    }
}

template <class T>
Bytes filter_rows(const BasicImage<T>& image) {
    const std::size_t pixel = std::size_t(image.channels) * sizeof(T);
    const std::size_t row = std::size_t(image.width) * pixel;
    Bytes filtered((row + 1) * std::size_t(image.height));
    Bytes bytes(row);
    for (int y = 0; y < image.height; ++y) {
        row_bytes(image, y, bytes.data());
        const std::uint8_t* from = bytes.data();
        std::uint8_t* to = filtered.data() + std::size_t(y) * (row + 1);
        *to++ = kFilterSub;
        std::memcpy(to, from, pixel);
        for (std::size_t i = pixel; i < row; ++i) {
            to[i] = std::uint8_t(from[i] - from[i - pixel]);
        }
    }
    return filtered;
}

std::uint8_t colour_type(int channels) {
    switch (channels) {
        case 1:
            return 0;
        case 3:
            return 2;
        default:
            return 6;
    }
}

template <class T>
Bytes encode(const BasicImage<T>& image) {
    assert(image.width > 0 && image.height > 0);
    assert(image.channels == 1 || image.channels == 3 || image.channels == 4);
    assert(image.data.size() ==
           std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels));

    const Bytes filtered = filter_rows(image);
    Bytes file;
    file.reserve(kMostHeadBytes);
    file.assign(kSignature.begin(), kSignature.end());

    const std::size_t header = begin_chunk(file, "IHDR");
    file.resize(file.size() + 13);  // compression, filter method and interlace are 0
    std::uint8_t* const ihdr = file.data() + file.size() - 13;
    put_u32(ihdr, std::uint32_t(image.width));
    put_u32(ihdr + 4, std::uint32_t(image.height));
    ihdr[8] = 8 * sizeof(T);
    ihdr[9] = colour_type(image.channels);
    finish_chunk(file, header);

    const std::size_t srgb = begin_chunk(file, "sRGB");
    file.push_back(kPerceptual);
    finish_chunk(file, srgb);

    const std::unique_ptr<libdeflate_compressor, CompressorDeleter> compressor(
        libdeflate_alloc_compressor(kCompressionLevel));
    if (!compressor) {
        throw std::bad_alloc();
    }
    const std::size_t data = begin_chunk(file, "IDAT");
    const std::size_t start = file.size();
    file.resize(start + libdeflate_zlib_compress_bound(compressor.get(), filtered.size()));
    const std::size_t size =
        libdeflate_zlib_compress(compressor.get(), filtered.data(), filtered.size(),
                                 file.data() + start, file.size() - start);
    assert(size > 0);  // the bound is enough by libdeflate's word
    file.resize(start + size);
    finish_chunk(file, data);

    finish_chunk(file, begin_chunk(file, "IEND"));
    return file;
}

}  // namespace

Bytes encode_png(const Image8& image) { return encode(image); }
Bytes encode_png(const Image16& image) { return encode(image); }

}  // namespace penumbra
