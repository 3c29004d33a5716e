// SPDX-License-Identifier: MIT
#include "core/image/gzip.h"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <new>

namespace penumbra {
namespace {

// Some hundred KB of JSON take a millisecond; the next levels gain a few percent.
constexpr int kLevel = 5;

struct Free {
    void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
    void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

std::unique_ptr<libdeflate_compressor, Free> make_compressor() {
    std::unique_ptr<libdeflate_compressor, Free> compressor(libdeflate_alloc_compressor(kLevel));
    if (!compressor) throw std::bad_alloc();
    return compressor;
}

}  // namespace

std::string gzip(std::string_view text) {
    const auto compressor = make_compressor();
    std::string out(libdeflate_gzip_compress_bound(compressor.get(), text.size()), '\0');
    out.resize(libdeflate_gzip_compress(compressor.get(), text.data(), text.size(), out.data(), out.size()));
    return out;
}

std::string deflate_raw(std::string_view text) {
    const auto compressor = make_compressor();
    std::string out(libdeflate_deflate_compress_bound(compressor.get(), text.size()), '\0');
    out.resize(libdeflate_deflate_compress(compressor.get(), text.data(), text.size(), out.data(), out.size()));
    return out;
}

std::optional<std::string> inflate_raw(std::string_view bytes, std::size_t most_bytes) {
    const std::unique_ptr<libdeflate_decompressor, Free> decompressor(libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    // How much comes out is not said beforehand: no more is taken at once than what came in makes likely.
    for (std::size_t room = std::min(most_bytes, 8 * bytes.size() + 1024);; room = std::min(most_bytes, 4 * room)) {
        std::string out(room, '\0');
        std::size_t size = 0, used = 0;
        const auto result = libdeflate_deflate_decompress_ex(decompressor.get(), bytes.data(), bytes.size(), out.data(), room, &used, &size);
        if (result == LIBDEFLATE_SUCCESS) {
            if (used != bytes.size()) return std::nullopt;
            out.resize(size);
            return out;
        }
        if (result != LIBDEFLATE_INSUFFICIENT_SPACE || room == most_bytes) return std::nullopt;
    }
}

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) { return libdeflate_crc32(before, bytes.data(), bytes.size()); }

}  // namespace penumbra
