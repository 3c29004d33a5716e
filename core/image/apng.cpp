// SPDX-License-Identifier: MIT
#include "core/image/apng.h"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <string_view>

namespace penumbra {
namespace {

struct Free {
    void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

void put16(Bytes& out, std::uint32_t value) {
    out.push_back(std::uint8_t(value >> 8));
    out.push_back(std::uint8_t(value));
}
void put32(Bytes& out, std::uint32_t value) {
    put16(out, value >> 16);
    put16(out, value & 0xffff);
}

void chunk(Bytes& out, std::string_view type, const Bytes& data) {
    put32(out, std::uint32_t(data.size()));
    const std::size_t start = out.size();
    out.insert(out.end(), type.begin(), type.end());
    out.insert(out.end(), data.begin(), data.end());
    put32(out, libdeflate_crc32(0, out.data() + start, out.size() - start));
}

// Each row by the filter Sub or Up, whichever leaves less.
Bytes filtered(const Texels& pixels) {
    const std::size_t row_bytes = 3 * std::size_t(pixels.width);
    Bytes out, above(row_bytes, 0), row(row_bytes), sub(row_bytes), up(row_bytes);
    out.reserve((row_bytes + 1) * std::size_t(pixels.height));
    for (int y = 0; y < pixels.height; ++y) {
        const std::uint8_t* from = pixels.rgba.data() + 4 * std::size_t(y) * std::size_t(pixels.width);
        for (std::size_t x = 0; x < row_bytes; ++x) row[x] = from[x / 3 * 4 + x % 3];
        unsigned long of_sub = 0, of_up = 0;
        for (std::size_t x = 0; x < row_bytes; ++x) {
            sub[x] = std::uint8_t(row[x] - (x < 3 ? 0 : row[x - 3]));
            up[x] = std::uint8_t(row[x] - above[x]);
            of_sub += unsigned(std::abs(int(std::int8_t(sub[x]))));
            of_up += unsigned(std::abs(int(std::int8_t(up[x]))));
        }
        const bool take_up = of_up < of_sub;
        out.push_back(take_up ? 2 : 1);
        const Bytes& best = take_up ? up : sub;
        out.insert(out.end(), best.begin(), best.end());
        above = row;
    }
    return out;
}

}  // namespace

ApngWriter::ApngWriter(int width, int height, std::uint32_t frames, std::uint32_t plays, double fps)
    : width_(width), height_(height), frames_(frames), plays_(plays), fps_(fps) {}

Bytes ApngWriter::head() const {
    Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    Bytes data;
    put32(data, std::uint32_t(width_));
    put32(data, std::uint32_t(height_));
    data.insert(data.end(), {8, 2, 0, 0, 0});  // 8 bits, RGB, not interlaced
    chunk(out, "IHDR", data);
    chunk(out, "sRGB", {0});
    data.clear();
    put32(data, frames_);
    put32(data, plays_);
    chunk(out, "acTL", data);
    return out;
}

Bytes ApngWriter::frame(const Texels& pixels) {
    Bytes out, control;
    put32(control, sequence_++);
    put32(control, std::uint32_t(width_));
    put32(control, std::uint32_t(height_));
    put32(control, 0);
    put32(control, 0);
    // In thousandths of a second, of which a frame has at most 65.
    put16(control, std::uint32_t(std::clamp(std::round(1000 / fps_), 1.0, 65535.0)));
    put16(control, 1000);
    control.insert(control.end(), {0, 0});  // kept, and drawn over what was before
    chunk(out, "fcTL", control);

    constexpr int kLevel = 1;
    const std::unique_ptr<libdeflate_compressor, Free> compressor(libdeflate_alloc_compressor(kLevel));
    if (!compressor) throw std::bad_alloc();
    const Bytes rows = filtered(pixels);
    Bytes data;
    if (!first_) put32(data, sequence_++);
    const std::size_t before = data.size();
    data.resize(before + libdeflate_zlib_compress_bound(compressor.get(), rows.size()));
    data.resize(before + libdeflate_zlib_compress(compressor.get(), rows.data(), rows.size(), data.data() + before, data.size() - before));
    chunk(out, first_ ? "IDAT" : "fdAT", data);
    first_ = false;
    return out;
}

Bytes ApngWriter::end() const {
    Bytes out;
    chunk(out, "IEND", {});
    return out;
}

}  // namespace penumbra
