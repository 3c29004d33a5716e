// SPDX-License-Identifier: MIT
// The forms in which a PNG stores a picture, and its deflate stream: whatever is chosen, the pixels come back.
#include <libdeflate.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "core/image/png_layout.h"
#include "core/image/run_deflate.h"
#include "test_scenes.h"

namespace penumbra {
namespace {

class Random {
public:
    explicit Random(std::uint32_t seed) : state_(seed * 2654435761u + 1) {}
    std::uint32_t below(std::uint32_t bound) {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 17;
        state_ ^= state_ << 5;
        return std::uint32_t(std::uint64_t(state_) * bound >> 32);
    }

private:
    std::uint32_t state_;
};

struct Form {
    int colour = 0, depth = 0;
    bool operator==(const Form&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Form& form) {
    return out << "colour type " << form.colour << ", " << form.depth << " bits";
}
Form form_of(const Bytes& file) { return {file.at(25), file.at(24)}; }

constexpr Form kGrey{0, 8}, kRgb{2, 8}, kPalette{3, 8}, kGreyAlpha{4, 8}, kRgba{6, 8};

// Encodes, decodes, compares; the form chosen.
Form round_trip(const Image8& image) {
    const Bytes file = encode_png(image);
    const auto decoded = decode_png(file);
    if (const auto* error = std::get_if<DecodeError>(&decoded)) {
        ADD_FAILURE() << error->message << " in " << form_of(file);
        return form_of(file);
    }
    const Texels& texels = std::get<Texels>(decoded);
    EXPECT_EQ(texels.width, image.width);
    EXPECT_EQ(texels.height, image.height);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < texels.rgba.size() / 4; ++i) {
        const std::uint8_t* in = image.data.data() + i * std::size_t(image.channels);
        const std::uint8_t* out = texels.rgba.data() + 4 * i;
        const bool grey = image.channels == 1;
        wrong += out[0] != in[0] || out[1] != in[grey ? 0 : 1] || out[2] != in[grey ? 0 : 2] ||
                 out[3] != (image.channels == 4 ? in[3] : 255);
    }
    EXPECT_EQ(wrong, 0u) << form_of(file) << " " << image.width << " x " << image.height;
    return form_of(file);
}

using Pixel = std::array<std::uint8_t, 4>;

template <class Paint>
Image8 paint(int width, int height, int channels, const Paint& colour) {
    Image8 image(width, height, channels);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Pixel pixel = colour(x, y);
            std::copy_n(pixel.begin(), channels, image.at(x, y));
        }
    }
    return image;
}

Image8 of_colours(int width, int height, int channels, const std::vector<Pixel>& colours) {
    return paint(width, height, channels, [&](int x, int y) { return colours[std::size_t(x * 7 + y * width) % colours.size()]; });
}

std::vector<Pixel> colours(std::size_t count, std::uint8_t alpha = 255) {
    std::vector<Pixel> list;
    for (std::size_t i = 0; i < count; ++i) list.push_back({std::uint8_t(i), std::uint8_t(i / 2 + 3), std::uint8_t(255 - i), alpha});
    return list;
}

TEST(PngForm, GreyPixelsTakeOneValue) {
    const auto ramp = [](int x, int y) {
        const std::uint8_t value = std::uint8_t(x * 3 + y);
        return Pixel{value, value, value, 255};
    };
    EXPECT_EQ(round_trip(paint(90, 20, 3, ramp)), kGrey);
    EXPECT_EQ(round_trip(paint(90, 20, 4, ramp)), kGrey);
    EXPECT_EQ(round_trip(paint(90, 20, 1, ramp)), kGrey);
    Image8 image = paint(90, 20, 3, ramp);
    ++image.at(89, 19)[1];  // one value of the last pixel
    EXPECT_EQ(round_trip(image), kRgb);
}

TEST(PngForm, FewGreysTakeFewBits) {
    const auto greys = [](std::vector<int> values) {
        return paint(61, 9, 3, [&](int x, int y) {
            const std::uint8_t value = std::uint8_t(values[std::size_t(x + 2 * y) % values.size()]);
            return Pixel{value, value, value, 255};
        });
    };
    EXPECT_EQ(round_trip(greys({0, 255})), (Form{0, 1}));
    EXPECT_EQ(round_trip(greys({0})), (Form{0, 1}));
    EXPECT_EQ(round_trip(greys({85, 170, 255})), (Form{0, 2}));
    EXPECT_EQ(round_trip(greys({17, 0, 34, 255})), (Form{0, 4}));
    EXPECT_EQ(round_trip(greys({1, 254})), (Form{3, 1})) << "two values that need a palette";
    EXPECT_EQ(round_trip(greys({1, 2, 3, 4, 5, 6, 7, 8, 9})), (Form{3, 4}));
    std::vector<int> many(17);
    std::iota(many.begin(), many.end(), 1);
    EXPECT_EQ(round_trip(greys(many)), kGrey);
}

TEST(PngForm, APaletteUpTo256Colours) {
    EXPECT_EQ(round_trip(of_colours(64, 64, 3, colours(1))), (Form{3, 1}));
    EXPECT_EQ(round_trip(of_colours(64, 64, 3, colours(2))), (Form{3, 1}));
    EXPECT_EQ(round_trip(of_colours(65, 64, 3, colours(3))), (Form{3, 2}));
    EXPECT_EQ(round_trip(of_colours(63, 64, 3, colours(16))), (Form{3, 4}));
    EXPECT_EQ(round_trip(of_colours(63, 64, 4, colours(17))), kPalette);
    EXPECT_EQ(round_trip(of_colours(63, 64, 3, colours(256))), kPalette);
    std::vector<Pixel> more = colours(256);
    more.push_back({1, 2, 3, 255});
    EXPECT_EQ(round_trip(of_colours(63, 64, 3, more)), kRgb);
}

TEST(PngForm, NoPaletteWhereItWouldBeLongerThanThePixels) {
    EXPECT_EQ(round_trip(of_colours(5, 4, 3, colours(20))), kRgb);
}

TEST(PngForm, TransparencyStays) {
    auto half = colours(30, 255);
    for (std::size_t i = 0; i < half.size(); i += 3) half[i][3] = std::uint8_t(i * 8);
    EXPECT_EQ(round_trip(of_colours(64, 64, 4, half)), kPalette);
    EXPECT_EQ(round_trip(paint(40, 40, 4, [](int x, int y) {
                  return Pixel{std::uint8_t(x * 5), std::uint8_t(x * 5), std::uint8_t(x * 5), std::uint8_t(y * 6)};
              })), kGreyAlpha);
    EXPECT_EQ(round_trip(paint(40, 40, 4, [](int x, int y) {
                  return Pixel{std::uint8_t(x), std::uint8_t(y), 7, std::uint8_t(x == 39 && y == 39 ? 254 : 255)};
              })), kRgba);
}

// Every kind of picture in every width: what is smooth, flat, in runs, noise, or all of it.
TEST(PngForm, PixelsComeBackWhateverThePicture) {
    std::array<int, 7> forms{};
    for (std::uint32_t seed = 0; seed < 600; ++seed) {
        Random random(seed);
        const int width = 1 + int(random.below(seed % 7 == 0 ? 700 : 80)), height = 1 + int(random.below(30));
        const int channels = std::array{1, 3, 4}[random.below(3)];
        const std::uint32_t kind = random.below(6), palette = 1 + random.below(300);
        const std::uint32_t run = 1 + random.below(500);
        const bool grey = random.below(3) == 0, opaque = random.below(2) == 0;
        Pixel pixel{};
        std::uint32_t left = 0;
        const Image8 image = paint(width, height, channels, [&](int x, int y) {
            const bool part = kind == 5 && (x ^ y) & 8;
            if (kind == 0 || part) {
                for (std::uint8_t& v : pixel) v = std::uint8_t(random.below(256));
            } else if (kind == 1) {
                pixel = {std::uint8_t(x * 2 + y), std::uint8_t(x + y), std::uint8_t(y * 3), std::uint8_t(x)};
            } else if (kind == 2) {
                const std::uint32_t n = random.below(palette);
                pixel = {std::uint8_t(n), std::uint8_t(n * 7 >> 2), std::uint8_t(n >> 1), std::uint8_t(255 - n % 9)};
            } else if (left-- == 0) {
                left = random.below(run);
                for (std::uint8_t& v : pixel) v = std::uint8_t(random.below(kind == 3 ? 256 : 4) * (kind == 3 ? 1 : 85));
            }
            if (grey) pixel[1] = pixel[2] = pixel[0];
            if (opaque) pixel[3] = 255;
            return pixel;
        });
        ++forms[std::size_t(round_trip(image).colour)];
        if (HasFailure()) FAIL() << "seed " << seed;
    }
    for (const int colour : {0, 2, 3, 4, 6}) EXPECT_GT(forms[std::size_t(colour)], 10) << colour;
}

// ---- the stream

Bytes inflated(const Bytes& stream, std::size_t size) {
    Bytes data(size + 1);
    std::size_t got = 0;
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflater(
        libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
    const auto result = libdeflate_zlib_decompress(inflater.get(), stream.data(), stream.size(), data.data(), data.size(), &got);
    EXPECT_EQ(result, LIBDEFLATE_SUCCESS);
    data.resize(result == LIBDEFLATE_SUCCESS ? got : 0);
    return data;
}

Bytes deflated(const Bytes& data, std::size_t pixel, std::size_t block) {
    Bytes stream;
    RunDeflate deflate(stream, pixel);
    for (std::size_t at = 0; at < data.size(); at += block) {
        const std::size_t size = std::min(block, data.size() - at);
        deflate.add({data.data() + at, size}, at + size == data.size());
    }
    return stream;
}

TEST(RunDeflate, RunsOfEveryLengthComeBack) {
    for (const std::size_t pixel : {1u, 2u, 3u, 4u}) {
        for (std::size_t run = 1; run < 800; ++run) {
            Bytes data{9, 8, 7, 6, 5, 4, 3, 2, 1};
            for (std::size_t i = 0; i < run; ++i) data.push_back(std::uint8_t(100 + i % pixel));
            data.insert(data.end(), {5, 6, 7});
            ASSERT_EQ(inflated(deflated(data, pixel, data.size()), data.size()), data) << run << " of " << pixel;
        }
    }
}

TEST(RunDeflate, EveryHistogramAndBlockSizeComesBack) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        Random random(seed);
        const std::size_t size = 1 + random.below(seed % 10 == 0 ? 70000 : 900);
        // Counts that fall geometrically make codes longer than the bound.
        const std::uint32_t symbols = 1 + random.below(256), fall = random.below(3);
        Bytes data;
        while (data.size() < size) {
            std::uint32_t value = random.below(symbols);
            if (fall > 0) {
                value = 0;
                while (value + 1 < symbols && random.below(fall + 1) == 0) ++value;
            }
            data.insert(data.end(), 1 + (random.below(20) == 0 ? random.below(600) : 0), std::uint8_t(value));
        }
        ASSERT_EQ(inflated(deflated(data, 1 + seed % 4, 1 + random.below(std::uint32_t(data.size()))), data.size()), data) << seed;
    }
}

TEST(CodeLengths, AreOptimalWhereTheBoundAllowsAndCompleteWhereNot) {
    std::array<std::uint8_t, 4> lengths{};
    code_lengths(std::array<std::uint32_t, 4>{5, 1, 1, 2}, 12, lengths);
    EXPECT_EQ(lengths, (std::array<std::uint8_t, 4>{1, 3, 3, 2}));
    code_lengths(std::array<std::uint32_t, 4>{5, 1, 1, 2}, 2, lengths);
    EXPECT_EQ(lengths, (std::array<std::uint8_t, 4>{2, 2, 2, 2}));
    code_lengths(std::array<std::uint32_t, 4>{0, 7, 0, 0}, 12, lengths);
    EXPECT_EQ(lengths, (std::array<std::uint8_t, 4>{0, 1, 0, 0}));
    // Fibonacci's numbers give the deepest tree there is.
    std::vector<std::uint32_t> counts{1, 1};
    while (counts.size() < 40) counts.push_back(counts[counts.size() - 1] + counts[counts.size() - 2]);
    for (const int most : {6, 7, 12, 15}) {
        std::vector<std::uint8_t> deep(counts.size());
        code_lengths(counts, most, deep);
        double sum = 0;
        for (const std::uint8_t length : deep) {
            EXPECT_GE(length, 1);
            EXPECT_LE(length, most);
            sum += std::ldexp(1.0, -length);
        }
        EXPECT_EQ(sum, 1.0) << most;
        EXPECT_LT(deep.back(), deep.front());
    }
}

}  // namespace
}  // namespace penumbra
