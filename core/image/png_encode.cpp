// SPDX-License-Identifier: MIT
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#include "core/image/codec.h"
#include "core/image/png_layout.h"
#include "core/image/run_deflate.h"

namespace penumbra {

namespace {

constexpr int kCompressionLevel = 1;  // of indices; the higher levels cost more time than they save bytes
constexpr std::uint8_t kFilterNone = 0, kFilterSub = 1, kFilterUp = 2;
constexpr std::uint8_t kPerceptual = 0;  // the sRGB chunk's rendering intent

constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kMostHeadBytes = 128;  // of what comes before the pixels

// Rows are compressed so many bytes at a time: within a core's cache, and few enough for codes that fit them.
constexpr std::size_t kBlockBytes = 48u << 10;

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

// How much a row's bytes, less those `before` them, differ from 0, by a quarter of them: 64 in 256.
template <class Before>
std::size_t unrest(const std::uint8_t* row, std::size_t size, const Before& before) {
    constexpr std::size_t kPart = 64, kStep = 256;
    std::size_t sum = 0;
    for (std::size_t i = 0; i < size; i += kStep) {
        const std::size_t end = std::min(size, i + kPart);
        unsigned part = 0;
        for (std::size_t k = i; k < end; ++k) {
            const std::uint8_t difference = std::uint8_t(row[k] - before(k));
            const std::uint8_t negative = std::uint8_t(-difference);
            part += difference < negative ? difference : negative;
        }
        sum += part;
    }
    return sum;
}

// One row with the filter in front. Of none, SUB and UP the one with the smallest remainder: what the specification
// advises (12.8), by a sample.
void filter_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t size, std::size_t pixel,
                std::uint8_t* to) {
    // From the second pixel on, so that every byte has a neighbour.
    const std::size_t sub = unrest(row + pixel, size - pixel, [&](std::size_t k) { return row[k]; });
    const std::size_t up = unrest(row + pixel, size - pixel, [&](std::size_t k) { return above[k + pixel]; });
    const std::size_t none = unrest(row + pixel, size - pixel, [](std::size_t) { return std::uint8_t(0); });
    std::uint8_t* const out = to + 1;
    if (none <= sub && none <= up) {
        *to = kFilterNone;
        std::memcpy(out, row, size);
    } else if (up < sub) {
        *to = kFilterUp;
        for (std::size_t i = 0; i < size; ++i) out[i] = std::uint8_t(row[i] - above[i]);
    } else {
        *to = kFilterSub;
        std::memcpy(out, row, pixel);
        for (std::size_t i = pixel; i < size; ++i) out[i] = std::uint8_t(row[i] - row[i - pixel]);
    }
}

// Values: filtered, then runs of pixels.
void put_values(Bytes& file, const Image8& image, const PngLayout& layout) {
    const std::size_t pixel = layout.bits_per_pixel() / 8;
    const std::size_t size = std::size_t(image.width) * pixel;
    const std::size_t rows = std::size_t(image.height);
    const std::size_t block_rows = std::clamp<std::size_t>(kBlockBytes / (size + 1), 1, rows);
    const bool as_it_is = std::size_t(image.channels) == pixel;
    Bytes filtered(block_rows * (size + 1)), packed(as_it_is ? 0 : 2 * size), zero(size);
    const std::uint8_t* above = zero.data();
    RunDeflate deflate(file, pixel);
    for (std::size_t y = 0; y < rows;) {
        const std::size_t end = std::min(rows, y + block_rows);
        std::uint8_t* to = filtered.data();
        for (; y < end; ++y, to += size + 1) {
            const std::uint8_t* row = image.at(0, int(y));
            if (!as_it_is) {
                std::uint8_t* const place = packed.data() + y % 2 * size;
                pack_png_row(image, layout, int(y), place);
                row = place;
            }
            filter_row(row, above, size, pixel, to);
            above = row;
        }
        deflate.add({filtered.data(), std::size_t(to - filtered.data())}, end == rows);
    }
}

// Indices and values of less than a byte: no filter makes them simpler, but they repeat.
void put_indices(Bytes& file, const Image8& image, const PngLayout& layout) {
    const std::size_t size = (std::size_t(image.width) * layout.bits_per_pixel() + 7) / 8;
    Bytes rows((size + 1) * std::size_t(image.height));
    for (int y = 0; y < image.height; ++y) {
        std::uint8_t* const to = rows.data() + std::size_t(y) * (size + 1);
        *to = kFilterNone;
        pack_png_row(image, layout, y, to + 1);
    }
    const std::unique_ptr<libdeflate_compressor, CompressorDeleter> compressor(
        libdeflate_alloc_compressor(kCompressionLevel));
    if (!compressor) {
        throw std::bad_alloc();
    }
    const std::size_t start = file.size();
    file.resize(start + libdeflate_zlib_compress_bound(compressor.get(), rows.size()));
    const std::size_t written = libdeflate_zlib_compress(compressor.get(), rows.data(), rows.size(),
                                                         file.data() + start, file.size() - start);
    assert(written > 0);  // the bound is enough by libdeflate's word
    file.resize(start + written);
}

void put_palette(Bytes& file, const std::vector<std::uint32_t>& palette) {
    const std::size_t colours = begin_chunk(file, "PLTE");
    Bytes alphas;
    for (const std::uint32_t entry : palette) {
        for (const int shift : {0, 8, 16}) file.push_back(std::uint8_t(entry >> shift));
        if (entry >> 24 != 255) alphas.push_back(std::uint8_t(entry >> 24));
    }
    finish_chunk(file, colours);
    if (alphas.empty()) return;
    const std::size_t transparency = begin_chunk(file, "tRNS");
    file.insert(file.end(), alphas.begin(), alphas.end());
    finish_chunk(file, transparency);
}

}  // namespace

Bytes encode_png(const Image8& image) {
    assert(image.width > 0 && image.height > 0);
    assert(image.channels == 1 || image.channels == 3 || image.channels == 4);
    assert(image.data.size() ==
           std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels));

    const PngLayout layout = choose_png_layout(image);
    Bytes file;
    file.reserve(kMostHeadBytes);
    file.assign(kSignature.begin(), kSignature.end());

    const std::size_t header = begin_chunk(file, "IHDR");
    file.resize(file.size() + 13);  // compression, filter method and interlace are 0
    std::uint8_t* const ihdr = file.data() + file.size() - 13;
    put_u32(ihdr, std::uint32_t(image.width));
    put_u32(ihdr + 4, std::uint32_t(image.height));
    ihdr[8] = std::uint8_t(layout.bit_depth);
    ihdr[9] = std::uint8_t(layout.colour);
    finish_chunk(file, header);

    const std::size_t srgb = begin_chunk(file, "sRGB");
    file.push_back(kPerceptual);
    finish_chunk(file, srgb);
    if (!layout.palette.empty()) put_palette(file, layout.palette);

    const std::size_t data = begin_chunk(file, "IDAT");
    const bool indices = layout.colour == PngLayout::Colour::palette || layout.bit_depth < 8;
    indices ? put_indices(file, image, layout) : put_values(file, image, layout);
    finish_chunk(file, data);

    finish_chunk(file, begin_chunk(file, "IEND"));
    return file;
}

// Of 16 bits: SUB on whole samples, the high byte first, libdeflate. What runs and palettes save of 8 bits, 16 do not have.
Bytes encode_png(const Image16& image) {
    assert(image.width > 0 && image.height > 0);
    assert(image.channels == 1 || image.channels == 3 || image.channels == 4);
    const std::size_t pixel = 2 * std::size_t(image.channels);
    const std::size_t size = std::size_t(image.width) * pixel;
    Bytes filtered((size + 1) * std::size_t(image.height)), row(size);
    for (int y = 0; y < image.height; ++y) {
        const std::uint16_t* from = image.at(0, y);
        for (std::size_t i = 0; i < size; i += 2) {
            row[i] = std::uint8_t(from[i / 2] >> 8);
            row[i + 1] = std::uint8_t(from[i / 2]);
        }
        std::uint8_t* const to = filtered.data() + std::size_t(y) * (size + 1);
        *to = kFilterSub;
        std::memcpy(to + 1, row.data(), pixel);
        for (std::size_t i = pixel; i < size; ++i) to[1 + i] = std::uint8_t(row[i] - row[i - pixel]);
    }
    Bytes file;
    file.reserve(kMostHeadBytes);
    file.assign(kSignature.begin(), kSignature.end());
    const std::size_t header = begin_chunk(file, "IHDR");
    file.resize(file.size() + 13);  // compression, filter method and interlace are 0
    std::uint8_t* const ihdr = file.data() + file.size() - 13;
    put_u32(ihdr, std::uint32_t(image.width));
    put_u32(ihdr + 4, std::uint32_t(image.height));
    ihdr[8] = 16;
    ihdr[9] = image.channels == 1 ? 0 : image.channels == 3 ? 2 : 6;
    finish_chunk(file, header);
    const std::size_t srgb = begin_chunk(file, "sRGB");
    file.push_back(kPerceptual);
    finish_chunk(file, srgb);
    const std::unique_ptr<libdeflate_compressor, CompressorDeleter> compressor(libdeflate_alloc_compressor(kCompressionLevel));
    if (!compressor) {
        throw std::bad_alloc();
    }
    const std::size_t data = begin_chunk(file, "IDAT");
    const std::size_t start = file.size();
    file.resize(start + libdeflate_zlib_compress_bound(compressor.get(), filtered.size()));
    file.resize(start + libdeflate_zlib_compress(compressor.get(), filtered.data(), filtered.size(), file.data() + start, file.size() - start));
    finish_chunk(file, data);
    finish_chunk(file, begin_chunk(file, "IEND"));
    return file;
}

}  // namespace penumbra
