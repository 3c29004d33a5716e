// SPDX-License-Identifier: MIT
// The commands that measure, as scripts see them: reference, compare, bench.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/image/codec.h"
#include "process.h"

namespace penumbra::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kLamp = R"({"version": 1, "canvas": {"width": 40, "height": 30}, "shapes": [
  {"type": "circle", "center": [20.2, 15.1], "radius": 3, "emission": 2}]})";

Finished penumbra(const std::vector<std::string>& arguments, const std::string& input = "") {
    return run_program(PENUMBRA_FAKE_PROGRAM, arguments, input);
}

std::string text_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

ImageF image_of(const std::string& text) {
    auto decoded = decode_pfm({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return std::get<ImageF>(decoded);
}

std::string linear(float value, float corner) {
    ImageF image(4, 3, 3, value);
    image.at(0, 0)[1] = corner;
    return text_of(encode_pfm(image));
}

std::string display(std::uint8_t value, std::uint8_t corner) {
    Image8 image(20, 20, 3, value);
    image.at(0, 0)[1] = corner;
    return text_of(encode_png(image));
}

TEST(ReferenceCommand, WritesTheExactSolution) {
    TemporaryFolder folder;
    const std::string scene = folder.write("lamp.json", kLamp);
    const Finished finished = penumbra({"reference", scene, "-o", folder.path("out.pfm")});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("solved in"));
    const ImageF image = image_of(read_file(folder.path("out.pfm")));
    ASSERT_EQ(image.width, 40);
    const double distance = std::hypot(0.5 - 20.2, 0.5 - 15.1);
    EXPECT_NEAR(image.at(0, 0)[0], 2 * std::asin(3 / distance) / std::numbers::pi, 1e-7);
    EXPECT_TRUE(std::isnan(image.at(20, 15)[0])) << "a solid pixel is left out";
}

TEST(ReferenceCommand, GoesToThePipeAndStrides) {
    const Finished finished = penumbra({"reference", "-", "-o", "-", "--stride", "8", "-q", "--set", "/canvas/width=48"}, kLamp);
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    const ImageF image = image_of(finished.out);
    EXPECT_EQ(image.width, 48);
    int solved = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 48; ++x) solved += std::isnan(image.at(x, y)[0]) ? 0 : 1;
    EXPECT_GT(solved, 10);
    EXPECT_LE(solved, 6 * 4);
}

TEST(ReferenceCommand, BadScenesAreExitCode2) {
    const Finished finished = penumbra({"reference", "-", "-o", "-"}, R"({"version": 1, "canvas": {"width": 0, "height": 3}})");
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_THAT(finished.err, HasSubstr("/canvas/width"));
    EXPECT_EQ(penumbra({"reference", "-", "-o", "-", "--stride", "0"}, kLamp).exit_code, 2);
    EXPECT_EQ(penumbra({"reference", "/no/such.json", "-o", "-"}).exit_code, 2);
}

TEST(ReferenceCommand, JudgesTheFilesNameBeforeItWorks) {
    TemporaryFolder folder;
    for (const char* name : {"out.png", "out", "out.pfm.hdr"}) {
        // The scene is not looked at: there is none.
        const Finished finished = penumbra({"reference", "/no/such.json", "-o", folder.path(name)});
        EXPECT_EQ(finished.exit_code, 2);
        EXPECT_EQ(finished.err, "penumbra: --output takes a name that ends in .pfm, .exr or .npy, or -, not " + folder.path(name) + "\n");
    }
    EXPECT_EQ(penumbra({"reference", "-", "-o", folder.path("out.PFM")}, kLamp).exit_code, 0);
}

// The same solution in every format that knows NaN, and compare reads them all.
TEST(CompareCommand, ReadsEveryFormat) {
    TemporaryFolder folder;
    for (const char* name : {"out.pfm", "out.exr", "out.npy"}) {
        ASSERT_EQ(penumbra({"reference", "-", "-o", folder.path(name)}, kLamp).exit_code, 0) << name;
        EXPECT_EQ(penumbra({"compare", folder.path(name), folder.path("out.pfm"), "--max-abs", "0"}).exit_code, 0) << name;
    }
    ImageF image(20, 10, 3, 0.5f);
    const std::string hdr = folder.write("a.hdr", text_of(encode_hdr(image)));
    image.data[7] = 0.75f;
    const std::string half = folder.write("a.exr", text_of(encode_exr(image, ExrSamples::half)));
    EXPECT_EQ(penumbra({"compare", half, hdr, "--max-abs", "0.25"}).exit_code, 0);
    EXPECT_EQ(penumbra({"compare", half, hdr, "--max-abs", "0.2499"}).exit_code, 1);
    const std::string wide = folder.write("a.png", text_of(encode_png(Image16(20, 10, 3, 257 * 3 + 100))));
    const std::string narrow = folder.write("b.png", text_of(encode_png(Image8(20, 10, 3, 3))));
    EXPECT_THAT(penumbra({"compare", wide, narrow}).out, HasSubstr("largest      0.389105"));  // 100 / 257
    EXPECT_EQ(penumbra({"compare", wide, hdr}).exit_code, 2);
}

TEST(CompareCommand, JudgesTheFilesNameBeforeItWorks) {
    TemporaryFolder folder;
    for (const char* name : {"d.pfm", "d"}) {
        const Finished finished = penumbra({"compare", "/no/a.pfm", "/no/b.pfm", "--diff", folder.path(name)});
        EXPECT_EQ(finished.exit_code, 2);
        EXPECT_EQ(finished.err, "penumbra: --diff takes a name that ends in .png, not " + folder.path(name) + "\n");
    }
}

TEST(CompareCommand, GivesTheFiguresOfLinearPictures) {
    TemporaryFolder folder;
    const std::string a = folder.write("a.pfm", linear(1.0f, 1.5f));
    const std::string b = folder.write("b.pfm", linear(1.0f, 1.0f));
    const Finished finished = penumbra({"compare", a, b, "--json", "--diff", folder.path("d.png")});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const json figures = json::parse(finished.out);
    EXPECT_EQ(figures["kind"], "linear");
    EXPECT_EQ(figures["count"], 36);
    EXPECT_NEAR(figures["max_abs"], 0.5, 1e-7);
    EXPECT_NEAR(figures["nrmse"], std::sqrt(0.25 / 36), 1e-7);
    EXPECT_NEAR(figures["bias"], 0.5 / 36, 1e-7);
    EXPECT_TRUE(figures["leak"].is_null());
    EXPECT_TRUE(read_file(folder.path("d.png")).starts_with("\x89PNG"));
}

TEST(CompareCommand, BoundsDecideTheExitCode) {
    TemporaryFolder folder;
    const std::string a = folder.write("a.pfm", linear(1.0f, 1.5f));
    const std::string b = folder.write("b.pfm", linear(1.0f, 1.0f));
    EXPECT_EQ(penumbra({"compare", a, b, "--max-abs", "0.6"}).exit_code, 0);
    const Finished over = penumbra({"compare", a, b, "--max-abs", "0.4", "--max-nrmse", "1"});
    EXPECT_EQ(over.exit_code, 1);
    EXPECT_THAT(over.err, HasSubstr("max_abs is 0.5, more than 0.4"));
    EXPECT_EQ(penumbra({"compare", b, b, "--max-abs", "0", "--max-bias", "0"}).exit_code, 0);
    EXPECT_EQ(penumbra({"compare", a, b, "--max-flip", "0.1"}).exit_code, 2) << "a bound of the other kind";
}

TEST(CompareCommand, MissingSamplesExceedAnyBound) {
    TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::string hole = folder.write("a.pfm", linear(1.0f, nan));
    const std::string whole = folder.write("b.pfm", linear(1.0f, 1.0f));
    EXPECT_EQ(penumbra({"compare", hole, whole, "--max-nrmse", "1"}).exit_code, 1);
    EXPECT_EQ(penumbra({"compare", whole, hole, "--max-nrmse", "1"}).exit_code, 0) << "the truth may leave samples out";
}

TEST(CompareCommand, GivesTheFiguresOfPngs) {
    TemporaryFolder folder;
    const std::string a = folder.write("a.png", display(100, 90));
    const std::string b = folder.write("b.png", display(100, 100));
    const json figures = json::parse(penumbra({"compare", a, b, "--json"}).out);
    EXPECT_EQ(figures["largest"], 10);
    EXPECT_EQ(figures["differing"], 1);
    EXPECT_GT(figures["flip"], 0);
    EXPECT_EQ(penumbra({"compare", a, b, "--max-difference", "10", "--max-differing", "1"}).exit_code, 0);
    EXPECT_EQ(penumbra({"compare", a, b, "--max-difference", "9"}).exit_code, 1);
    EXPECT_EQ(penumbra({"compare", a, b, "--min-psnr", "99"}).exit_code, 1);
    EXPECT_EQ(penumbra({"compare", b, b, "--min-psnr", "99", "--max-flip", "0"}).exit_code, 0) << "equal pictures have no PSNR";
}

TEST(CompareCommand, WhatCannotBeComparedIsExitCode2) {
    TemporaryFolder folder;
    const std::string pfm = folder.write("a.pfm", linear(1, 1));
    const std::string png = folder.write("a.png", display(1, 1));
    const std::string small = folder.write("s.png", text_of(encode_png(Image8(3, 3, 3))));
    const std::string junk = folder.write("junk.png", "not a picture");
    EXPECT_EQ(penumbra({"compare", pfm, png}).exit_code, 2);
    EXPECT_EQ(penumbra({"compare", png, small}).exit_code, 2);
    EXPECT_EQ(penumbra({"compare", png, junk}).exit_code, 2);
    EXPECT_EQ(penumbra({"compare", png, folder.path("none.png")}).exit_code, 2);
    EXPECT_EQ(penumbra({"compare", png}).exit_code, 2);
}

TEST(BenchCommand, MeasuresResumesAndKeepsTruths) {
    TemporaryFolder folder;
    const std::string scene = folder.write("lamp.json", kLamp);
    const std::vector<std::string> line = {"bench", scene, "--sizes", "20,40", "--qualities", "draft,standard", "--methods", "rc",
                                           "--repeats", "3", "-o", folder.path("r.jsonl"), "--truths", folder.path("truths")};
    const Finished first = penumbra(line);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    std::istringstream rows(read_file(folder.path("r.jsonl")));
    std::string row_text;
    int rows_seen = 0;
    while (std::getline(rows, row_text)) {
        const json row = json::parse(row_text);
        ++rows_seen;
        EXPECT_EQ(row["scene"], "lamp");
        EXPECT_EQ(row["repeats"], 3);
        EXPECT_TRUE(row["wall_ms"]["median"].is_number());
        EXPECT_TRUE(row["cpu_ms"]["median"].is_number());
        EXPECT_TRUE(row["errors"]["nrmse"].is_number());
        EXPECT_EQ(row["height"], row["width"] == 20 ? 15 : 30);
    }
    EXPECT_EQ(rows_seen, 4);
    const Finished again = penumbra(line);
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_THAT(again.err, HasSubstr("4 cases were in"));
}

TEST(BenchCommand, JudgesItsWordsOnceBeforeItWorks) {
    TemporaryFolder folder;
    const std::string scene = folder.write("lamp.json", kLamp);
    const std::pair<std::vector<std::string>, std::string> lines[] = {
        {{"--methods", "rc,refrence"}, "penumbra: --methods: must be auto, rc, rc_fix, hrc, exact, hybrid or reference, is "
                                       "\"refrence\" (did you mean \"reference\"?)\n"},
        {{"--qualities", "draft,hi"}, "penumbra: --qualities: must be draft, standard or high, is \"hi\"\n"},
        {{"--devices", "toaster"}, "penumbra: --devices: must be auto, cpu, gpu or an index"},
    };
    for (const auto& [options, message] : lines) {
        std::vector<std::string> line{"bench", scene, "-o", folder.path("r.jsonl"), "--truths", folder.path("t"), "--fresh"};
        line.insert(line.end(), options.begin(), options.end());
        const Finished finished = penumbra(line);
        EXPECT_EQ(finished.exit_code, 2) << finished.err;
        EXPECT_TRUE(finished.err.starts_with(message)) << finished.err;
        EXPECT_FALSE(std::filesystem::exists(folder.path("r.jsonl")));
        EXPECT_FALSE(std::filesystem::exists(folder.path("t")));
    }
}

TEST(BenchCommand, MakesAFolderOfTruthsOnlyForATruth) {
    TemporaryFolder folder;
    const std::string scene = folder.write("lamp.json", kLamp);
    const std::vector<std::string> line = {"bench", scene, "--sizes", "20", "--qualities", "draft", "--repeats", "1",
                                           "--truth-dir", folder.path("a/b")};
    std::vector<std::string> time_only = line;
    time_only.push_back("--no-errors");
    EXPECT_EQ(penumbra(time_only).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path("a")));
    const Finished solved = penumbra(line);
    EXPECT_EQ(solved.exit_code, 0) << solved.err;
    EXPECT_TRUE(std::filesystem::exists(folder.path("a/b")));
    EXPECT_THAT(penumbra({"bench", "--help"}).out, HasSubstr("made when"));
}

TEST(BenchCommand, SaysWhatItCannotMeasure) {
    TemporaryFolder folder;
    const std::string wrong = folder.write("wrong.json", R"({"version": 1})");
    const Finished finished = penumbra({"bench", wrong, "--truths", folder.path("t"), "--sizes", "8"});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_THAT(finished.err, HasSubstr("canvas"));
    const std::string tall = folder.write("tall.json", R"({"version": 1, "canvas": {"width": 8, "height": 80}})");
    const Finished too_tall = penumbra({"bench", tall, "--truths", folder.path("t"), "--sizes", "8192"});
    EXPECT_THAT(too_tall.err, HasSubstr("/canvas/height: must be from 1 to 8192")) << "not --set, which was not used";
    EXPECT_EQ(penumbra({"bench", "/no/such.json"}).exit_code, 2);
    EXPECT_EQ(penumbra({"bench", wrong, "--sizes", "-5"}).exit_code, 2);
    EXPECT_EQ(penumbra({"compare", wrong, wrong, "--max-nrmse", "-1"}).exit_code, 2);
}

}  // namespace
}  // namespace penumbra::test
