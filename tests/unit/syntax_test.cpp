// SPDX-License-Identifier: MIT
// Texts that are no JSON, and texts that are too much: refused at once, with the exact place.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "test_scenes.h"

namespace penumbra {
namespace {

struct Case {
    std::string text;
    int line;
    int column;
    std::string part;  // of the message
};

void expect_error(const Case& test, const std::string& code = "syntax") {
    const ParsedScene parsed = parse_scene(test.text);
    EXPECT_FALSE(parsed.scene);
    EXPECT_FALSE(parsed.is_json) << test.text;
    ASSERT_EQ(parsed.problems.size(), 1u) << test.text;
    const LocatedProblem& problem = parsed.problems[0];
    EXPECT_EQ(problem.problem.code, code) << test.text;
    EXPECT_EQ(problem.line, test.line) << test.text << "\n" << problem.problem.message;
    EXPECT_EQ(problem.column, test.column) << test.text << "\n" << problem.problem.message;
    EXPECT_NE(problem.problem.message.find(test.part), std::string::npos)
        << test.text << "\n"
        << problem.problem.message;
}

TEST(Syntax, ErrorsHaveTheirPlace) {
    const Case cases[] = {
        {"", 1, 1, "empty"},
        {" \n ", 2, 2, "empty"},
        {"\xef\xbb\xbf{}", 1, 1, "byte order mark"},
        {"{", 1, 2, "ends too early"},
        {"[1", 1, 3, "a comma or ] is expected"},
        {"{\"a\"", 1, 5, "colon"},
        {"{\"a\":", 1, 6, "a value is expected after the colon"},
        {"{\"a\": 1,\n", 2, 1, "ends too early"},
        {"{\"a\": \"b", 1, 7, "ends inside this string"},
        {"{\"a\": tru", 1, 7, "\"tru\""},
        {"{\"a\": 1,}", 1, 9, "comma must not stand before }"},
        {"[1,\n ]", 2, 2, "comma must not stand before ]"},
        {"[1,,2]", 1, 4, "\",\" is not expected here"},
        {"[,1]", 1, 2, "\",\""},
        {"{,}", 1, 2, "key in double quotes"},
        {"{\"a\" 1}", 1, 6, "colon"},
        {"{\"a\":: 1}", 1, 6, "\":\""},
        {"{\"a\": 1\n \"b\": 2}", 2, 2, "a comma or } is expected, here stands a string"},
        {"[1 2]", 1, 4, "here stands \"2\""},
        {"[1}", 1, 3, "here stands \"}\""},
        {"{a: 1}", 1, 2, "key in double quotes"},
        {"{'a': 1}", 1, 2, "double quotes, not in single"},
        {"['a']", 1, 2, "double quotes, not in single"},
        {"{} x", 1, 4, "nothing may follow"},
        {"{}\n{}", 2, 1, "nothing may follow"},
        {"1 2", 1, 3, "nothing may follow"},
        {"]", 1, 1, "\"]\""},
        {"// hi\n{}", 1, 1, "no comments"},
        {"{\n/* hi */}", 2, 1, "no comments"},
        {"[1 /* hi */]", 1, 4, "no comments"},
        {"{\"a\":\n  NaN}", 2, 3, "finite"},
        {"[-Infinity]", 1, 2, "finite"},
        {"[1,\r\n1e400\r\n]", 2, 1, "too large"},
        {"[-1e999]", 1, 2, "too large"},
        {"[01]", 1, 3, "a comma or ] is expected"},
        {"[+1]", 1, 2, "not a number as JSON writes them"},
        {"[.5]", 1, 2, "not a number as JSON writes them"},
        {"[1.]", 1, 2, "not a number as JSON writes them"},
        {"[-]", 1, 2, "not a number as JSON writes them"},
        {"[0x10]", 1, 3, "a comma or ]"},
        {"[True]", 1, 2, "small letters: true"},
        {"[\"a\xff\"]", 1, 4, "UTF-8"},
        {"[\"\xc0\xaf\"]", 1, 3, "UTF-8"},
        {"[\"\xed\xa0\x80\"]", 1, 3, "UTF-8"},
        {"[\"\xf4\x90\x80\x80\"]", 1, 3, "UTF-8"},
        {"[\"\xe2\x82\"]", 1, 3, "UTF-8"},
        {"[\xe9]", 1, 2, "UTF-8"},
        {"[\"\\q\"]", 1, 3, "unknown escape"},
        {"[\"ab\\u12g4\"]", 1, 5, "four hexadecimal digits"},
        {"[\"\\ud800\"]", 1, 3, "surrogate"},
        {"[\"\\ud800\\u0041\"]", 1, 3, "surrogate"},
        {"[\"\\udc00\"]", 1, 3, "surrogate"},
        {"[\"a\nb\"]", 1, 2, "not closed on its line"},
        {"[\"a\tb\"]", 1, 4, "control character"},
        {"{\"a\": 1, \"b\x01\": 2}", 1, 12, "control character"},
        {std::string("{}\0", 3), 1, 3, "nothing may follow"},
        {std::string("[1,\0", 4), 1, 4, "is not expected here"},
    };
    for (const Case& test : cases) {
        expect_error(test);
    }
}

// nlohmann alone says line 4, column 0 here.
TEST(Syntax, ABadTokenAtTheEndOfALineBelongsToThatLine) {
    expect_error({"{\n\"a\": 1,\n\"b\": nope\n}", 3, 6, "nope"});
}

// Whatever prefix of a document arrives, the answer is one problem at its end.
TEST(Syntax, EveryTruncationOfADocumentIsAnError) {
    const std::string text = with_shape(
        R"({"type": "circle", "center": [1, -2.5e1], "radius": 3, "emission": "#\u0066f0000"})");
    ASSERT_TRUE(parse_scene(text).scene) << all_text(parse_scene(text));
    for (std::size_t size = 0; size < text.size(); ++size) {
        const ParsedScene parsed = parse_scene(std::string_view(text).substr(0, size));
        EXPECT_FALSE(parsed.is_json) << size;
        ASSERT_EQ(parsed.problems.size(), 1u) << size;
        EXPECT_EQ(parsed.problems[0].line, 1);
        EXPECT_LE(parsed.problems[0].column, int(size) + 1);
    }
}

// One byte at a time is replaced by each of these; nothing may crash, and whatever is refused has
// its place in the text.
TEST(Syntax, NoDamagedByteIsWorseThanAProblem) {
    const std::string good = with_shape(R"({"type": "circle", "center": [1, 2], "radius": 3})");
    const std::string bytes("\0\"\\{}[],:9ex\xff\n", 15);
    for (std::size_t at = 0; at < good.size(); ++at) {
        for (const char byte : bytes) {
            std::string text = good;
            text[at] = byte;
            const ParsedScene parsed = parse_scene(text);
            EXPECT_EQ(parsed.scene.has_value(), parsed.problems.empty());
            for (const LocatedProblem& problem : parsed.problems) {
                EXPECT_GE(problem.line, 1) << text << "\n" << to_string(problem);
            }
        }
    }
}

TEST(TextLimit, Bytes) {
    const std::string text = document();
    TextLimits limits;
    limits.max_bytes = text.size();
    EXPECT_TRUE(parse_scene(text, {}, limits).scene);
    limits.max_bytes = text.size() - 1;
    const ParsedScene parsed = parse_scene(text, {}, limits);
    EXPECT_FALSE(parsed.is_json);
    EXPECT_EQ(parsed.problems[0].problem.code, "too_large");
}

TEST(TextLimit, Depth) {
    TextLimits limits;
    limits.max_depth = 5;
    const auto nested = [](int depth) {
        return document(", \"x\": " + std::string(std::size_t(depth), '[') +
                        std::string(std::size_t(depth), ']'));
    };
    EXPECT_TRUE(parse_scene(nested(4), {}, limits).is_json);
    const ParsedScene parsed = parse_scene(nested(5), {}, limits);
    EXPECT_FALSE(parsed.is_json);
    EXPECT_EQ(parsed.problems[0].problem.code, "too_deep");
    EXPECT_EQ(parsed.problems[0].problem.pointer, "/x/0/0/0");
    EXPECT_EQ(parsed.problems[0].column, int(nested(5).find("[[[[[")) + 5);
}

TEST(TextLimit, Nodes) {
    TextLimits limits;
    limits.max_nodes = 5;  // the root, version, canvas, width, height
    EXPECT_TRUE(parse_scene(document(), {}, limits).scene);
    limits.max_nodes = 4;
    const ParsedScene parsed = parse_scene(document(), {}, limits);
    EXPECT_FALSE(parsed.is_json);
    EXPECT_EQ(parsed.problems[0].problem.code, "too_many");
}

TEST(TextLimit, StringBytes) {
    TextLimits limits;
    limits.max_string_bytes = 7;
    EXPECT_TRUE(parse_scene(document(), {}, limits).scene);
    limits.max_string_bytes = 6;
    const ParsedScene parsed = parse_scene(document(), {}, limits);  // "version" has seven
    EXPECT_FALSE(parsed.is_json);
    EXPECT_EQ(parsed.problems[0].problem.code, "too_large");
    EXPECT_EQ(parsed.problems[0].column, 2);
}

TEST(TextLimit, HalfAMillionBrackets) {
    for (const std::string& open :
         {std::string("["), std::string("{\"a\":"), std::string("[{\"a\":")}) {
        std::string text;
        for (int i = 0; i < 500000; ++i) {
            text += open;
        }
        const ParsedScene parsed = parse_scene(text);
        EXPECT_FALSE(parsed.is_json);
        EXPECT_EQ(parsed.problems[0].problem.code, "too_deep");
        // Also without the limit nothing recurses.
        TextLimits deep;
        deep.max_depth = 2'000'000;
        EXPECT_FALSE(parse_scene(text, {}, deep).is_json);
    }
    TextLimits deep;
    deep.max_depth = 2'000'000;
    const std::string closed = std::string(500000, '[') + std::string(500000, ']');
    const ParsedScene parsed = parse_scene(closed, {}, deep);
    EXPECT_TRUE(parsed.is_json);
    EXPECT_EQ(parsed.problems[0].problem.code, "wrong_type");
}

// Twenty megabytes of whatever is worst for each part. The bound is loose, for busy machines: it is
// to catch what grows faster than the text. PENUMBRA_TEST_TIMES prints the times.
TEST(TextLimit, JunkIsAnsweredSoon) {
#ifdef NDEBUG
    constexpr std::size_t kSize = 20'000'000;
#else
    constexpr std::size_t kSize = 2'000'000;
#endif
    const auto repeated = [](const std::string& start, const std::string& part,
                             const std::string& end) {
        std::string text = start;
        while (text.size() < kSize) {
            text += part;
        }
        return text + end;
    };
    const std::string list = R"({"version": 1, "canvas": {"width": 9, "height": 9}, "shapes": [)";
    std::string many_keys = "{";
    for (int i = 0; many_keys.size() < kSize; ++i) {
        many_keys += "\"radius" + std::to_string(i) + "\":0,";
    }
    many_keys.back() = '}';
    std::string same_keys = repeated("{", "\"radius\":0,", "\"x\":0}");
    const std::string cases[] = {
        repeated("", "x", ""),
        repeated("", " ", ""),
        repeated("\"", "x", "\""),
        repeated("\"", "\\u0041", "\""),
        repeated("[", "0,", "0]"),
        repeated("[", "123456789.123456,", "0]"),
        repeated("[", "\"\",", "0]"),
        repeated(list, "{},", "{}]}"),
        repeated(list, "{\"type\": \"circle\", \"radus\": []},", "{}]}"),
        repeated(list, "{\"type\":\"circle\",\"center\":[0,0],\"radius\":0},", "{}]}"),
        repeated(list + "{\"type\":\"polygon\",\"points\":[", "[1,1],", "[1,1]]}]}"),
        list + many_keys + "]}",
        list + same_keys + "]}",
        list + R"({"type":"bitmap","image":")" + repeated("data:image/png;base64,", "AAAA", "") +
            "\"}]}",
    };
    for (const std::string& text : cases) {
        const auto start = std::chrono::steady_clock::now();
        const ParsedScene parsed = parse_scene(text);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        EXPECT_FALSE(parsed.scene);
        EXPECT_LT(seconds.count(), 10.0) << text.substr(0, 80);
        if (std::getenv("PENUMBRA_TEST_TIMES")) {
            std::printf("%.3f s  %s\n", seconds.count(), text.substr(0, 100).c_str());
        }
    }
}

}  // namespace
}  // namespace penumbra
