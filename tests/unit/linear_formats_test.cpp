// SPDX-License-Identifier: MIT
// The linear formats and PNG of 16 bits: there and back, what a file looks like byte for byte where that is short, and that no
// damaged file does harm.
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "core/image/half.h"
#include "test_scenes.h"

namespace penumbra {
namespace {

using Decode = std::function<std::variant<ImageF, DecodeError>(std::span<const std::uint8_t>)>;

std::uint32_t next(std::uint32_t& state) { return state = state * 1664525u + 1013904223u; }

// Values over many magnitudes, with runs of equal ones.
ImageF values(int width, int height, int channels = 3) {
    ImageF image(width, height, channels);
    std::uint32_t state = 7;
    float held = 0;
    for (float& value : image.data) {
        const std::uint32_t bits = next(state) >> 8;
        if (bits % 3 != 0) held = std::ldexp(float(bits % 4096), int(bits >> 12) % 24 - 16);
        value = held;
    }
    return image;
}

ImageF good(const std::variant<ImageF, DecodeError>& decoded) {
    if (const auto* error = std::get_if<DecodeError>(&decoded)) {
        ADD_FAILURE() << error->message;
        return {};
    }
    return std::get<ImageF>(decoded);
}

void expect_equal(const ImageF& a, const ImageF& b) {
    ASSERT_EQ(a.width, b.width);
    ASSERT_EQ(a.height, b.height);
    ASSERT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.data, b.data);
}

constexpr std::pair<int, int> kSizes[] = {{1, 1}, {7, 5}, {8, 16}, {33, 17}, {300, 2}, {129, 40}};

TEST(Exr, FloatsComeBackAsTheyWere) {
    for (const auto& [w, h] : kSizes) {
        for (const int channels : {1, 3}) {
            ImageF image = values(w, h, channels);
            image.data[0] = -2.5f;
            expect_equal(good(decode_exr(encode_exr(image, ExrSamples::full))), image);
        }
    }
}

TEST(Exr, HalvesComeBackRoundedToTheNearest) {
    const ImageF image = values(65, 33);
    const ImageF back = good(decode_exr(encode_exr(image, ExrSamples::half)));
    ASSERT_EQ(back.data.size(), image.data.size());
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        const float value = std::min(image.data[i], kLargestHalf);
        EXPECT_NEAR(back.data[i], value, std::max(value / 2048, 3e-8f)) << i;
    }
}

TEST(Exr, NoiseThatDoesNotCompressIsKeptAsItIs) {
    ImageF image(64, 40, 3);
    std::uint32_t state = 1;
    for (float& value : image.data) value = std::bit_cast<float>((next(state) & 0x807fffffu) | (next(state) >> 2 & 0x3f000000u));
    expect_equal(good(decode_exr(encode_exr(image, ExrSamples::full))), image);
}

TEST(Exr, StartsAsTheFormatSays) {
    const Bytes file = encode_exr(ImageF(5, 4, 3), ExrSamples::half);
    const Bytes start{0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0, 'c', 'h', 'a', 'n', 'n', 'e', 'l', 's', 0,
                      'c',  'h',  'l',  'i',  's', 't', 0, 55, 0, 0, 0, 'B', 0, 1, 0, 0, 0};
    ASSERT_GE(file.size(), start.size());
    EXPECT_EQ(Bytes(file.begin(), file.begin() + std::ptrdiff_t(start.size())), start);
}

// The tables of IEEE 754: every half there is.
TEST(Half, EveryHalfComesBack) {
    for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
        const float value = from_half(std::uint16_t(bits));
        const bool special = (bits & 0x7c00) == 0x7c00;
        if (!special) {
            EXPECT_EQ(to_half(value), bits) << value;
        }
    }
    EXPECT_EQ(from_half(0x3c00), 1.0f);
    EXPECT_EQ(from_half(0x7bff), kLargestHalf);
    EXPECT_EQ(from_half(0x0001), std::ldexp(1.0f, -24));
    EXPECT_EQ(from_half(0xc500), -5.0f);
    EXPECT_TRUE(std::isinf(from_half(0x7c00)));
    EXPECT_TRUE(std::isnan(from_half(0x7e01)));
}

TEST(Half, RoundsToTheNearestAndToEvenBetween) {
    const float step = std::ldexp(1.0f, -10);  // of halves from 1 to 2
    EXPECT_EQ(to_half(1 + step / 2), 0x3c00);            // in the middle, to even
    EXPECT_EQ(to_half(1 + 3 * step / 2), 0x3c02);        // in the middle, to even
    EXPECT_EQ(to_half(std::nextafter(1 + step / 2, 2.0f)), 0x3c01);
    EXPECT_EQ(to_half(2 - step / 4), 0x4000);            // a carry into the exponent
    EXPECT_EQ(to_half(std::ldexp(1.0f, -25)), 0);        // half of the smallest: to even
    EXPECT_EQ(to_half(std::ldexp(1.5f, -25)), 1);
    EXPECT_EQ(to_half(1e6f), 0x7bff);
    EXPECT_EQ(to_half(-1e6f), 0xfbff);
    EXPECT_EQ(to_half(std::numeric_limits<float>::quiet_NaN()) & 0x7e00, 0x7e00);
}

TEST(Hdr, ComesBackWithinItsEightBits) {
    for (const auto& [w, h] : kSizes) {
        const ImageF image = values(w, h);
        const ImageF back = good(decode_hdr(encode_hdr(image)));
        ASSERT_EQ(back.data.size(), image.data.size()) << w << " x " << h;
        for (std::size_t i = 0; i < image.data.size(); i += 3) {
            const float largest = std::max({image.data[i], image.data[i + 1], image.data[i + 2]});
            for (std::size_t c = 0; c < 3; ++c) {
                // Half a step of the common exponent: the largest's mantissa is from 128 to 255.
                EXPECT_LE(std::abs(back.data[i + c] - image.data[i + c]), largest / 256 * 1.0001f) << i;
            }
        }
    }
}

TEST(Hdr, OnePixelByHand) {
    // 1 is 0.5 * 2^1: mantissa 128, exponent 129; a quarter has a quarter of the mantissa.
    ImageF image(1, 1, 3);
    image.data = {1.0f, 0.25f, 0.0f};
    const Bytes file = encode_hdr(image);
    const std::string text(file.begin(), file.end());
    EXPECT_EQ(text, std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n") + "\x80\x20" + std::string(1, '\0') + "\x81");
    // 255.9 / 256 would round to a mantissa of 256: the exponent goes up instead.
    image.data = {0.9999f, 0.5f, 0.0f};
    EXPECT_EQ(good(decode_hdr(encode_hdr(image))).data[0], 1.0f);
    image.data = {-1.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f};
    EXPECT_EQ(good(decode_hdr(encode_hdr(image))).data, (std::vector<float>{0, 0, 0}));
    image.data = {1e-45f, 0, 1e38f};
    EXPECT_NEAR(good(decode_hdr(encode_hdr(image))).data[2] / 1e38f, 1, 1.0 / 256);
}

TEST(Npy, ComesBackAsItWas) {
    for (const auto& [w, h] : kSizes) {
        for (const int channels : {1, 3}) {
            expect_equal(good(decode_npy(encode_npy(values(w, h, channels)))), values(w, h, channels));
        }
    }
}

TEST(Npy, HeaderIsNumPys) {
    const Bytes file = encode_npy(ImageF(5, 4, 3));
    const std::string text(file.begin(), file.end());
    EXPECT_EQ(text.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
    EXPECT_EQ(text.substr(10, 62), "{'descr': '<f4', 'fortran_order': False, 'shape': (4, 5, 3), }");
    EXPECT_EQ(text[127], '\n');
    EXPECT_EQ(file.size(), 128u + 4 * 60);
}

TEST(Npy, TakesDoublesAndPlanesRefusesTheRest) {
    const auto with_header = [](const std::string& header, std::size_t samples) {
        std::string text("\x93NUMPY\x01\x00", 8);
        text += char(header.size());
        text += '\0';
        text += header;
        Bytes file(text.begin(), text.end());
        file.resize(file.size() + samples);
        return file;
    };
    EXPECT_EQ(good(decode_npy(with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n", 48))).channels, 1);
    for (const char* header : {"{'descr': '>f4', 'fortran_order': False, 'shape': (2, 3), }\n",
                               "{'descr': '<i4', 'fortran_order': False, 'shape': (2, 3), }\n",
                               "{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }\n",
                               "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 2), }\n",
                               "{'descr': '<f4', 'fortran_order': False, 'shape': (24,), }\n",
                               "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999, 3), }\n"}) {
        EXPECT_TRUE(std::holds_alternative<DecodeError>(decode_npy(with_header(header, 24)))) << header;
    }
}

TEST(LinearFormats, TruncatedAndDamagedFilesDoNoHarm) {
    const ImageF image = values(20, 35);
    const std::pair<Bytes, Decode> files[] = {{encode_exr(image, ExrSamples::full), decode_exr},
                                              {encode_exr(image, ExrSamples::half), decode_exr},
                                              {encode_hdr(image), decode_hdr},
                                              {encode_npy(image), decode_npy}};
    for (const auto& [file, decode] : files) {
        for (std::size_t size = 0; size < file.size(); ++size) {
            const auto decoded = decode(std::span(file).first(size));
            ASSERT_TRUE(std::holds_alternative<DecodeError>(decoded)) << size;
            EXPECT_FALSE(std::get<DecodeError>(decoded).message.empty());
        }
        for (std::size_t at = 0; at < file.size(); ++at) {
            for (const int flip : {0x01, 0x80, 0xff}) {
                Bytes bad = file;
                bad[at] = std::uint8_t(bad[at] ^ flip);
                (void)decode(bad);  // whatever comes out, nothing may crash
            }
        }
    }
}

TEST(Png16, RoundTrip) {
    for (const int channels : {1, 3, 4}) {
        for (const auto& [w, h] : kSizes) {
            Image16 image(w, h, channels);
            std::uint32_t state = 3;
            for (std::uint16_t& value : image.data) value = std::uint16_t(next(state) >> 16);
            const Bytes file = encode_png(image);
            EXPECT_TRUE(is_png16(file));
            const auto decoded = decode_png16(file);
            ASSERT_TRUE(std::holds_alternative<Image16>(decoded));
            const Image16& back = std::get<Image16>(decoded);
            ASSERT_EQ(back.data.size(), std::size_t(4 * w * h));
            for (int i = 0; i < w * h; ++i) {
                const std::uint16_t* in = image.data.data() + i * channels;
                const std::uint16_t* out = back.data.data() + 4 * i;
                EXPECT_EQ(out[0], in[0]);
                EXPECT_EQ(out[2], channels == 1 ? in[0] : in[2]);
                EXPECT_EQ(out[3], channels == 4 ? in[3] : 65535);
            }
        }
    }
    EXPECT_FALSE(is_png16(encode_png(Image8(3, 3, 3))));
}

}  // namespace
}  // namespace penumbra
