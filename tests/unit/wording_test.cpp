// SPDX-License-Identifier: MIT
#include "core/scene/wording.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/scene/path.h"
#include "core/scene/words.h"

namespace penumbra {
namespace {

TEST(Wording, NumbersAreShortAndExact) {
    EXPECT_EQ(number_text(0.1), "0.1");
    EXPECT_EQ(number_text(-3), "-3");
    EXPECT_EQ(number_text(1e10), "1e+10");
    EXPECT_EQ(number_text(8192), "8192");
    EXPECT_EQ(number_text(std::nan("")), "nan");
    EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "-inf");
}

TEST(Wording, LongTextsAreCutBetweenCharacters) {
    EXPECT_EQ(in_quotes("abc"), "\"abc\"");
    EXPECT_EQ(in_quotes(std::string(40, 'a')), '"' + std::string(40, 'a') + '"');
    EXPECT_EQ(in_quotes(std::string(41, 'a')), '"' + std::string(40, 'a') + "...\"");
    EXPECT_EQ(in_quotes(std::string(39, 'a') + "\xc3\xa4"
                                               "b"),
              '"' + std::string(39, 'a') + "...\"");
    EXPECT_EQ(in_quotes("a\n\x7f"), "\"a\\x0a\\x7f\"");
}

TEST(Wording, ListsEndInOr) {
    const std::string_view three[] = {"a", "b", "c"};
    EXPECT_EQ(join_words(three), "a, b or c");
    EXPECT_EQ(join_words(std::span(three, 1)), "a");
}

TEST(Wording, NearestWord) {
    const std::string_view known[] = {"radius", "center", "emission", "albedo", "position", "rc"};
    EXPECT_EQ(nearest_word("radus", known), "radius");
    EXPECT_EQ(nearest_word("raduis", known), "radius");
    EXPECT_EQ(nearest_word("RADIUS", known), "radius");
    EXPECT_EQ(nearest_word("centre", known), "center");
    EXPECT_EQ(nearest_word("emision", known), "emission");
    EXPECT_EQ(nearest_word("pos", known), "position");
    EXPECT_EQ(nearest_word("albedos", known), "albedo");
    EXPECT_EQ(nearest_word("cr", known), "rc");
    EXPECT_EQ(nearest_word("zzzzz", known), "");
    EXPECT_EQ(nearest_word("", known), "");
    EXPECT_EQ(nearest_word("x", known), "");
    EXPECT_EQ(nearest_word(std::string(100000, 'r'), known), "");
}

TEST(Words, CascadeViewsHaveOneSpelling) {
    for (const char* good : {"final", "distance", "probes", "steps", "normals", "cascade0",
                             "cascade9", "cascade10", "cascade15", "light0", "light999", "shape12", "sky", "error", "skipped"}) {
        EXPECT_TRUE(is_known_view(good)) << good;
    }
    for (const char* bad : {"", "cascade", "cascade16", "cascade00", "cascade-1", "cascade1x",
                            "cascade01", "cascade100", "Final", "light", "light1000", "light01", "shape20000", "shape-1"}) {
        EXPECT_FALSE(is_known_view(bad)) << bad;
    }
}

TEST(PathTest, PointersAreEscaped) {
    const Path root;
    EXPECT_EQ(root.pointer(), "");
    EXPECT_EQ(root.key("shapes").index(3).key("radius").pointer(), "/shapes/3/radius");
    EXPECT_EQ(root.key("a/b~c").pointer(), "/a~1b~0c");
    EXPECT_EQ(root.key("").pointer(), "/");
}

}  // namespace
}  // namespace penumbra
