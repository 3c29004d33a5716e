// SPDX-License-Identifier: MIT
#include <libdeflate.h>
#include <spng.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "test_scenes.h"

namespace penumbra {
namespace {

Image8 noise(int width, int height, int channels) {
    Image8 image(width, height, channels);
    std::uint32_t state = 12345;
    for (std::uint8_t& byte : image.data) {
        state = state * 1664525u + 1013904223u;
        byte = std::uint8_t(state >> 24);
    }
    return image;
}

void put_chunk(Bytes& file, const char* type, const Bytes& data) {
    const auto put = [&](std::uint32_t v) {
        for (const int shift : {24, 16, 8, 0}) {
            file.push_back(std::uint8_t(v >> shift));
        }
    };
    put(std::uint32_t(data.size()));
    Bytes body(type, type + 4);
    body.insert(body.end(), data.begin(), data.end());
    file.insert(file.end(), body.begin(), body.end());
    put(libdeflate_crc32(0, body.data(), body.size()));
}

struct Header {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    std::uint8_t bit_depth = 8;
    std::uint8_t colour_type = 0;
    std::uint8_t interlace = 0;
};

// A file by hand: `chunks` come between IHDR and IDAT.
Bytes make_png(const Header& header, const Bytes& raw,
               const std::vector<std::pair<const char*, Bytes>>& chunks = {}) {
    Bytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    Bytes ihdr;
    for (const std::uint32_t v : {header.width, header.height}) {
        for (const int shift : {24, 16, 8, 0}) {
            ihdr.push_back(std::uint8_t(v >> shift));
        }
    }
    ihdr.insert(ihdr.end(), {header.bit_depth, header.colour_type, 0, 0, header.interlace});
    put_chunk(file, "IHDR", ihdr);
    for (const auto& [type, data] : chunks) {
        put_chunk(file, type, data);
    }
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(6), &libdeflate_free_compressor);
    Bytes packed(libdeflate_zlib_compress_bound(compressor.get(), raw.size()));
    packed.resize(libdeflate_zlib_compress(compressor.get(), raw.data(), raw.size(), packed.data(),
                                           packed.size()));
    put_chunk(file, "IDAT", packed);
    put_chunk(file, "IEND", {});
    return file;
}

Bytes pixels(const Bytes& file) {
    const auto decoded = decode_png(file);
    if (const auto* error = std::get_if<DecodeError>(&decoded)) {
        ADD_FAILURE() << error->message;
        return {};
    }
    return std::get<Texels>(decoded).rgba;
}

std::string error_of(const Bytes& file, const DecodeLimits& limits = {}) {
    const auto decoded = decode_png(file, limits);
    const auto* error = std::get_if<DecodeError>(&decoded);
    return error ? error->message : "";
}

TEST(Png, RoundTrip) {
    for (const int channels : {1, 3, 4}) {
        for (const auto& [w, h] : {std::pair{1, 1}, {7, 5}, {64, 33}, {1, 9}, {300, 2}}) {
            const Image8 image = noise(w, h, channels);
            const Bytes rgba = pixels(encode_png(image));
            ASSERT_EQ(rgba.size(), std::size_t(4 * w * h));
            for (int i = 0; i < w * h; ++i) {
                const std::uint8_t* in = image.data.data() + i * channels;
                const std::uint8_t* out = rgba.data() + 4 * i;
                EXPECT_EQ(out[0], in[0]);
                EXPECT_EQ(out[1], channels == 1 ? in[0] : in[1]);
                EXPECT_EQ(out[2], channels == 1 ? in[0] : in[2]);
                EXPECT_EQ(out[3], channels == 4 ? in[3] : 255);
            }
        }
    }
}

TEST(Png, HasItsChunksInOrderAndSaysThatItIsSrgb) {
    const Bytes file = encode_png(noise(5, 4, 3));
    std::string order;
    for (std::size_t at = 8; at + 8 <= file.size();) {
        const std::uint32_t length =
            std::uint32_t(file[at] << 24 | file[at + 1] << 16 | file[at + 2] << 8 | file[at + 3]);
        order += std::string(file.begin() + std::ptrdiff_t(at) + 4,
                             file.begin() + std::ptrdiff_t(at) + 8) +
                 " ";
        at += length + 12;
    }
    EXPECT_EQ(order, "IHDR sRGB IDAT IEND ");
}

TEST(Png, SmoothPicturesBecomeSmall) {
    Image8 image(256, 256, 3);
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            image.at(x, y)[0] = image.at(x, y)[1] = image.at(x, y)[2] = std::uint8_t(x);
        }
    }
    EXPECT_LT(encode_png(image).size(), 256u * 256u * 3u / 50u);
}

TEST(Png, DecodesEveryKind) {
    EXPECT_EQ(pixels(make_png({2, 1, 8, 0}, {0, 10, 200})),
              (Bytes{10, 10, 10, 255, 200, 200, 200, 255}));
    EXPECT_EQ(pixels(make_png({2, 1, 1, 0}, {0, 0x40})), (Bytes{0, 0, 0, 255, 255, 255, 255, 255}));
    EXPECT_EQ(pixels(make_png({1, 1, 8, 4}, {0, 10, 99})), (Bytes{10, 10, 10, 99}));
    EXPECT_EQ(pixels(make_png({1, 1, 8, 2}, {0, 1, 2, 3})), (Bytes{1, 2, 3, 255}));
    EXPECT_EQ(pixels(make_png({1, 1, 8, 6}, {0, 1, 2, 3, 4})), (Bytes{1, 2, 3, 4}));
    EXPECT_EQ(pixels(make_png({1, 1, 16, 6}, {0, 1, 0, 2, 0, 3, 0, 4, 0})), (Bytes{1, 2, 3, 4}));
    EXPECT_EQ(pixels(make_png({1, 1, 16, 0}, {0, 0xab, 0})), (Bytes{0xab, 0xab, 0xab, 255}));
}

TEST(Png, AppliesPaletteAndTransparency) {
    const Bytes palette{255, 0, 0, 0, 255, 0};
    EXPECT_EQ(pixels(make_png({2, 1, 8, 3}, {0, 1, 0}, {{"PLTE", palette}, {"tRNS", {7}}})),
              (Bytes{0, 255, 0, 255, 255, 0, 0, 7}));
    // A colour that counts as transparent.
    EXPECT_EQ(pixels(make_png({2, 1, 8, 0}, {0, 10, 20}, {{"tRNS", {0, 20}}})),
              (Bytes{10, 10, 10, 255, 20, 20, 20, 0}));
    EXPECT_EQ(pixels(make_png({1, 1, 8, 2}, {0, 1, 2, 3}, {{"tRNS", {0, 1, 0, 2, 0, 3}}})),
              (Bytes{1, 2, 3, 0}));
}

TEST(Png, DecodesInterlaced) {
    // 2 x 1: the first pixel is pass 1, the second pass 6.
    EXPECT_EQ(pixels(make_png({2, 1, 8, 0, 1}, {0, 10, 0, 20})),
              (Bytes{10, 10, 10, 255, 20, 20, 20, 255}));
}

TEST(Png, LargePicturesInOneChunkPassTheChunkLimit) {
    const Image8 image = noise(1200, 900, 4);  // more than 4 MB that do not compress
    EXPECT_EQ(pixels(encode_png(image)), image.data);
}

TEST(Png, LimitsHoldOnBothSides) {
    const Bytes wide = make_png({16, 1, 8, 0}, Bytes(17));
    const Bytes high = make_png({1, 16, 8, 0}, Bytes(32));
    const Bytes square = make_png({8, 8, 8, 0}, Bytes(72));
    EXPECT_EQ(error_of(wide, {16, 1e9}), "");
    EXPECT_EQ(error_of(high, {16, 1e9}), "");
    EXPECT_NE(error_of(wide, {15, 1e9}), "");
    EXPECT_NE(error_of(high, {15, 1e9}), "");
    EXPECT_EQ(error_of(square, {8, 64}), "");
    EXPECT_NE(error_of(square, {8, 63}), "");
    EXPECT_EQ(error_of(square, {8, 63}), "is 8 x 8 pixels; at most 63 in all are allowed");
    const auto decoded = decode_png(square, {8, 63});
    EXPECT_TRUE(std::get<DecodeError>(decoded).too_large);
}

TEST(Png, EveryTruncationIsAnError) {
    const Bytes file = encode_png(noise(6, 5, 4));
    // The last four bytes are the checksum of an empty chunk: nothing is lost with them.
    for (std::size_t size = 0; size < file.size() - 4; ++size) {
        EXPECT_NE(error_of(Bytes(file.begin(), file.begin() + std::ptrdiff_t(size))), "") << size;
    }
}

TEST(Png, EveryDamagedBitOfAHeaderOrItsDataIsAnError) {
    const Bytes good = encode_png(noise(6, 5, 3));
    for (std::size_t at = 0; at < good.size(); ++at) {
        Bytes bad = good;
        bad[at] = std::uint8_t(bad[at] ^ 0x11u);
        // Whatever comes out, nothing may crash; a wrong checksum of what matters is an error.
        const std::string error = error_of(bad);
        const bool in_srgb = at >= 33 && at < 46;
        const bool in_end = at >= good.size() - 4;
        if (!in_srgb && !in_end) {
            EXPECT_NE(error, "") << at;
        }
    }
}

TEST(Png, BombsAreRefusedByTheirHeader) {
    // All sizes fit the file format; none fits the limits.
    EXPECT_NE(error_of(make_png({0x7fffffff, 0x7fffffff, 8, 6}, Bytes(10))), "");
    EXPECT_NE(error_of(make_png({8193, 1, 8, 0}, Bytes(8194))), "");
    EXPECT_NE(error_of(make_png({4096, 4097, 8, 0}, Bytes(10))), "");
    // Within the limits, yet more than so few bytes can hold.
    const std::string lie = error_of(make_png({4096, 4096, 8, 6}, Bytes(10)));
    EXPECT_NE(lie.find("more than"), std::string::npos) << lie;
    EXPECT_NE(error_of(make_png({0, 1, 8, 0}, Bytes(1))), "");
}

TEST(Png, MoreDataThanTheHeaderPromisesIsNotInflated) {
    // 50 MB of zeros for a picture of one pixel: either answer is good, but it must come at once.
    const auto decoded = decode_png(make_png({1, 1, 8, 0}, Bytes(50'000'000)));
    if (const auto* texels = std::get_if<Texels>(&decoded)) {
        EXPECT_EQ(texels->rgba.size(), 4u);
    }
}

TEST(Png, NoPngAtAll) {
    EXPECT_NE(error_of({}), "");
    EXPECT_NE(error_of({'G', 'I', 'F', '8', '9', 'a'}), "");
    EXPECT_NE(error_of(Bytes(100)), "");
}

}  // namespace
}  // namespace penumbra
