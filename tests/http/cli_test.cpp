// SPDX-License-Identifier: MIT
// The command line as programs see it: exit codes, what goes where, files written whole or not at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/image/codec.h"
#include "process.h"

namespace penumbra::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kScene = R"({"version": 1, "canvas": {"width": 40, "height": 30}})";
const std::string kWrong = "{\"version\": 1,\n \"canvas\": {\"widht\": 4, \"width\": 0, \"height\": 3}}";

Finished penumbra(const std::vector<std::string>& arguments, const std::string& input = "",
                  const Environment& environment = {}) {
    return run_program(PENUMBRA_FAKE_PROGRAM, arguments, input, environment);
}

bool is_png(const std::string& text) { return text.starts_with("\x89PNG\r\n"); }

TEST(Cli, HelpAndVersionSucceed) {
    for (const char* flag : {"--help", "--version"}) {
        const Finished finished = penumbra({flag});
        EXPECT_EQ(finished.exit_code, 0);
        EXPECT_THAT(finished.out, HasSubstr("penumbra"));
        EXPECT_EQ(finished.err, "");
    }
    for (const char* command : {"render", "serve", "validate", "info", "health", "reference", "compare", "bench"}) {
        EXPECT_EQ(penumbra({command, "--help"}).exit_code, 0) << command;
    }
}

TEST(Cli, MistakesInTheCommandLineAreExitCode2) {
    const std::vector<std::vector<std::string>> lines = {
        {},
        {"rendr"},
        {"render"},
        {"render", "scene.json"},
        {"serve", "--port", "70000"},
        {"serve", "--queue", "0"},
        {"serve", "--log", "xml"},
        {"serve", "--device", "toaster"},
        {"health", "--url", "ftp://x"},
        {"render", "-", "-o", "x.jpeg"},
        {"render", "-", "-o", "x"},
        {"render", "-", "-o", "x.png", "--format", "jpeg"},
        {"render", "-", "-o", "-", "--stats", "-"},
        {"render", "-", "-o", "x.png", "--set", "canvas"},
        {"render", "/no/such/file.json", "-o", "x.png"},
    };
    for (const auto& line : lines) {
        const Finished finished = penumbra(line, kScene);
        EXPECT_EQ(finished.exit_code, 2) << testing::PrintToString(line) << finished.err;
        EXPECT_THAT(finished.err, StartsWith("penumbra: ")) << testing::PrintToString(line);
        EXPECT_EQ(finished.out, "");
    }
}

TEST(Cli, RendersAFileByItsExtension) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("scene.json", kScene);
    const Finished png = penumbra({"render", scene, "-o", folder.path("out.PNG")});
    EXPECT_EQ(png.exit_code, 0) << png.err;
    EXPECT_EQ(png.out + png.err, "");
    EXPECT_TRUE(is_png(read_file(folder.path("out.PNG"))));
    EXPECT_EQ(penumbra({"render", scene, "-o", folder.path("out.pfm")}).exit_code, 0);
    EXPECT_THAT(read_file(folder.path("out.pfm")), StartsWith("PF\n40 30\n"));
    EXPECT_EQ(penumbra({"render", scene, "-o", folder.path("out.bin"), "--format", "pfm"}).exit_code, 0);
    EXPECT_THAT(read_file(folder.path("out.bin")), StartsWith("PF\n"));
    // Nothing is left beside them.
    const auto entries = std::filesystem::directory_iterator(folder.path("."));
    EXPECT_EQ(std::distance(begin(entries), end(entries)), 4);
}

TEST(Cli, ReadsAndWritesTheStandardStreams) {
    const Finished png = penumbra({"render", "-", "-o", "-"}, kScene);
    EXPECT_EQ(png.exit_code, 0) << png.err;
    EXPECT_TRUE(is_png(png.out));
    const Finished pfm = penumbra({"render", "-", "-o", "-", "--set", "/output/format=pfm"},
                                  R"({"version": 1, "canvas": {"width": 4, "height": 3}, "output": {}})");
    EXPECT_THAT(pfm.out, StartsWith("PF\n4 3\n")) << pfm.err;
    EXPECT_THAT(penumbra({"render", "-", "-o", "-", "--format", "pfm"}, kScene).out, StartsWith("PF\n"));
}

TEST(Cli, SetReplacesValuesAndTheirMistakesAreTold) {
    const Finished wide = penumbra({"render", "-", "-o", "-", "--format", "pfm", "--set", "/canvas/width=7", "--set", "/canvas/height=5"}, kScene);
    EXPECT_THAT(wide.out, StartsWith("PF\n7 5\n")) << wide.err;
    const Finished wrong = penumbra({"render", "-", "-o", "-", "--set", "/canvas/width=-7"}, kScene);
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("/canvas/width"));
}

TEST(Cli, StatsSayWhatRan) {
    const TemporaryFolder folder;
    const Finished finished = penumbra({"render", "-", "-o", folder.path("out.png"), "--stats", "-"}, kScene);
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    const auto json = nlohmann::json::parse(finished.out);
    for (const char* key : {"device", "method", "method_reason", "size", "total_ms", "parse_ms", "encode_ms", "gpu_bytes"}) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_EQ(json["size"], nlohmann::json::array({40, 30}));
    ASSERT_EQ(json["passes"].size(), 2u);
    EXPECT_EQ(json["passes"][1]["name"], "cascade 0");
    EXPECT_EQ(json["skipped"][0]["what"], "bounces");
}

TEST(Cli, AWrongSceneIsToldLineByLineAndWritesNothing) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("wrong.json", kWrong);
    const Finished finished = penumbra({"render", scene, "-o", folder.path("out.png")});
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_THAT(finished.err, HasSubstr(scene + ": /canvas/widht (line 2, column "));
    EXPECT_GE(std::count(finished.err.begin(), finished.err.end(), '\n'), 2);
    EXPECT_FALSE(std::filesystem::exists(folder.path("out.png")));
    EXPECT_THAT(penumbra({"render", "-", "-o", "-"}, "{").err, StartsWith("<stdin>: "));
}

TEST(Cli, AFailingWorldIsExitCode1) {
    const TemporaryFolder folder;
    const Finished device = penumbra({"render", "-", "-o", folder.path("out.png")}, kScene, {{"FAKE_START_ERROR", "There is no device."}});
    EXPECT_EQ(device.exit_code, 1);
    EXPECT_EQ(device.err, "penumbra: There is no device.\n");
    const Finished disk = penumbra({"render", "-", "-o", "/no/such/folder/out.png"}, kScene);
    EXPECT_EQ(disk.exit_code, 1);
    EXPECT_THAT(disk.err, HasSubstr("/no/such/folder/out.png"));
    const Finished full = penumbra({"render", "-", "-o", "/dev/full", "--format", "png"}, kScene);
    EXPECT_EQ(full.exit_code, 1);
    EXPECT_EQ(penumbra({"info"}, "", {{"FAKE_START_ERROR", "There is no device."}}).exit_code, 1);
    EXPECT_EQ(penumbra({"health", "--url", "http://127.0.0.1:9"}).exit_code, 1);
}

TEST(Cli, ValidateNeedsNoDevice) {
    const Environment broken = {{"FAKE_START_ERROR", "There is no device."}};
    const Finished valid = penumbra({"validate", "-"}, kScene, broken);
    EXPECT_EQ(valid.exit_code, 0) << valid.err;
    EXPECT_EQ(valid.out, "<stdin>: valid\n");
    const Finished wrong = penumbra({"validate", "-"}, kWrong, broken);
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_EQ(wrong.out, "");
    EXPECT_THAT(wrong.err, HasSubstr("/canvas/widht"));
    const Finished json = penumbra({"validate", "-", "--json"}, kWrong, broken);
    EXPECT_EQ(json.exit_code, 2);
    const auto parsed = nlohmann::json::parse(json.out);
    EXPECT_EQ(parsed["valid"], false);
    EXPECT_GE(parsed["problems"].size(), 2u);
    EXPECT_EQ(nlohmann::json::parse(penumbra({"validate", "-", "--json"}, kScene).out)["valid"], true);
    const std::string tonemap = R"({"version": 1, "canvas": {"width": 4, "height": 3}, "output": {"tonemap": "aces"}})";
    EXPECT_THAT(penumbra({"validate", "-"}, tonemap).err, HasSubstr("/output/tonemap (line 1"));
    EXPECT_EQ(penumbra({"validate", "-"}, std::string(500000, '[')).exit_code, 2);
}

TEST(Cli, InfoShowsTheDevice) {
    EXPECT_THAT(penumbra({"info"}).out, HasSubstr("fake renderer"));
    const auto json = nlohmann::json::parse(penumbra({"info", "--json"}).out);
    EXPECT_EQ(json["device"]["renderer"], "fake renderer");
    EXPECT_EQ(json["devices"][0]["index"], 0);
    EXPECT_EQ(penumbra({"info"}, "", {{"PENUMBRA_DEVICE", "toaster"}}).exit_code, 2);
}

}  // namespace
}  // namespace penumbra::test
