// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "test_scenes.h"

namespace penumbra {
namespace {

ImageF numbered(int width, int height, int channels) {
    ImageF image(width, height, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        image.data[i] = float(i) * 0.37f - 2.0f;
    }
    return image;
}

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST(Pfm, RoundTripIsExact) {
    for (const int channels : {1, 3}) {
        for (const auto& [w, h] : {std::pair{1, 1}, {5, 3}, {1, 7}, {16, 1}}) {
            ImageF image = numbered(w, h, channels);
            image.data[0] = std::numeric_limits<float>::denorm_min();
            const auto back = decode_pfm(encode_pfm(image));
            ASSERT_TRUE(std::holds_alternative<ImageF>(back));
            const ImageF& other = std::get<ImageF>(back);
            EXPECT_EQ(other.width, w);
            EXPECT_EQ(other.height, h);
            EXPECT_EQ(other.channels, channels);
            EXPECT_EQ(other.data, image.data);
        }
    }
}

TEST(Pfm, TheLastRowComesFirstInTheFileLittleEndian) {
    ImageF image(2, 2, 1);
    image.data = {1, 2, 3, 4};
    const Bytes file = encode_pfm(image);
    const std::string header = "Pf\n2 2\n-1.0\n";
    ASSERT_EQ(file.size(), header.size() + 16);
    EXPECT_EQ(std::string(file.begin(), file.begin() + std::ptrdiff_t(header.size())), header);
    const Bytes three{0x00, 0x00, 0x40, 0x40};  // 3.0f, the bottom row's first
    EXPECT_EQ(Bytes(file.begin() + std::ptrdiff_t(header.size()),
                    file.begin() + std::ptrdiff_t(header.size()) + 4),
              three);
}

TEST(Pfm, ReadsBigEndian) {
    Bytes file = bytes_of("Pf\n1 1\n1.0\n");
    for (const int byte : {0x40, 0x40, 0x00, 0x00}) {
        file.push_back(std::uint8_t(byte));
    }
    const auto image = decode_pfm(file);
    ASSERT_TRUE(std::holds_alternative<ImageF>(image));
    EXPECT_EQ(std::get<ImageF>(image).data[0], 3.0f);
}

TEST(Pfm, KeepsWhatIsNotFinite) {
    ImageF image(2, 1, 1);
    image.data = {std::numeric_limits<float>::infinity(), std::nanf("")};
    const auto back = decode_pfm(encode_pfm(image));
    EXPECT_TRUE(std::isinf(std::get<ImageF>(back).data[0]));
    EXPECT_TRUE(std::isnan(std::get<ImageF>(back).data[1]));
}

TEST(Pfm, RefusesBadFiles) {
    for (const char* text :
         {"", "P6\n1 1\n-1\nabcd", "PF", "PF\n1", "PF\n0 1\n-1.0\n", "PF\n-1 1\n-1.0\n",
          "PF\n1 1\n0\nabcdabcdabcd", "PF\n1 1\nnan\nabcdabcdabcd", "PF\n1 1\n-1.0\nabc",
          "Pf\n1 1\n-1.0\nabcde", "Pf\n1 1\n-1.0", "Pf\n99999999 99999999\n-1.0\nabcd",
          "Pf\n1x 1\n-1.0\nabcd"}) {
        EXPECT_TRUE(std::holds_alternative<DecodeError>(decode_pfm(bytes_of(text)))) << text;
    }
}

}  // namespace
}  // namespace penumbra
