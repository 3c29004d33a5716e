// SPDX-License-Identifier: MIT
#include "server/json/base64.h"

#include "test_scenes.h"

namespace penumbra {
namespace {

std::string decoded(std::string_view text) {
    const Base64 result = decode_base64(text);
    EXPECT_TRUE(result.good) << text;
    return {result.bytes.begin(), result.bytes.end()};
}

// RFC 4648, section 10.
TEST(Base64, DecodesTheVectorsOfTheStandard) {
    EXPECT_EQ(decoded(""), "");
    EXPECT_EQ(decoded("Zg=="), "f");
    EXPECT_EQ(decoded("Zm8="), "fo");
    EXPECT_EQ(decoded("Zm9v"), "foo");
    EXPECT_EQ(decoded("Zm9vYg=="), "foob");
    EXPECT_EQ(decoded("Zm9vYmE="), "fooba");
    EXPECT_EQ(decoded("Zm9vYmFy"), "foobar");
}

TEST(Base64, DecodesEveryByteAtEveryPlace) {
    for (std::size_t length = 1; length <= 4; ++length) {
        for (int value = 0; value < 256; ++value) {
            const Bytes bytes(length, std::uint8_t(value));
            const Base64 result = decode_base64(to_base64(bytes));
            ASSERT_TRUE(result.good);
            ASSERT_EQ(result.bytes, bytes);
        }
    }
}

struct Bad {
    const char* text;
    std::size_t at;
};

TEST(Base64, RefusesWhatIsNotStrict) {
    const Bad cases[] = {
        {"Z", 1},        {"Zg", 2},        {"Zg=", 2},    {"Zg===", 2},      {"Zh==", 1},
        {"Zm9=", 2},     {"Zm9v Zm9v", 4}, {"Zm9v\n", 4}, {"Zm9-", 3},       {"Zm9_", 3},
        {"Zg==Zg==", 2}, {"====", 0},      {"=", 0},      {"\xc3\xa4Zm", 0}, {"Zm9v=", 4},
    };
    for (const Bad& bad : cases) {
        const Base64 result = decode_base64(bad.text);
        EXPECT_FALSE(result.good) << bad.text;
        EXPECT_EQ(result.bad_at, bad.at) << bad.text;
    }
}

}  // namespace
}  // namespace penumbra
