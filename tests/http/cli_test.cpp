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

TEST(Cli, MistakesAreToldInPlainWordsAndPointToTheRightHelp) {
    struct Case {
        std::vector<std::string> line;
        std::string text, help;
        Environment environment;
    };
    const std::vector<Case> cases = {
        {{}, "a command is missing; there are render, serve,", "penumbra --help", {}},
        {{"rendr"}, "\"rendr\" is no command (did you mean \"render\"?); there are render, serve,", "penumbra --help", {}},
        {{"serve", "--log", "xml"}, "--log: must be text or json, is \"xml\"", "penumbra serve --help", {}},
        {{"serve", "--port", "abc"}, "--port: must be a whole number from 0 to 65535, is \"abc\"", "penumbra serve --help", {}},
        {{"serve", "--port", "70000"}, "--port: must be a whole number from 0 to 65535, is \"70000\"", "penumbra serve --help", {}},
        {{"serve", "--port"}, "--port: needs a value", "penumbra serve --help", {}},
        {{"serve", "--prot", "1"}, "\"--prot\" is not an option of penumbra serve (did you mean \"--port\"?)", "penumbra serve --help", {}},
        {{"serve", "--max-body-mb", "1.5"}, "--max-body-mb: must be a whole number from 1 to 1024, is \"1.5\"", "penumbra serve --help", {}},
        {{"serve"}, "PENUMBRA_QUEUE: must be a whole number from 1 to 10000, is \"many\"", "penumbra serve --help", {{"PENUMBRA_QUEUE", "many"}}},
        {{"serve"}, "PENUMBRA_LOG: must be text or json, is \"xml\"", "penumbra serve --help", {{"PENUMBRA_LOG", "xml"}}},
        {{"serve", "--queue", "0"}, "--queue: must be", "penumbra serve --help", {{"PENUMBRA_QUEUE", "many"}}},
        {{"render", "a.json"}, "--output is required", "penumbra render --help", {}},
        {{"render", "a.json", "b.json", "-o", "c.png"}, "\"b.json\" is one argument too many for penumbra render", "penumbra render --help", {}},
        {{"reference", "a.json", "-o", "b.pfm", "--element-length", "x"}, "--element-length: must be a number from 0.01 to 1000, is \"x\"", "penumbra reference --help", {}},
        {{"compare", "a", "b", "--max-nrmse", "-1"}, "--max-nrmse: must be a number of at least 0, is \"-1\"", "penumbra compare --help", {}},
        {{"compare", "a", "b", "--pixels-per-degree", "0"}, "--pixels-per-degree: must be a number of more than 0, is \"0\"", "penumbra compare --help", {}},
        {{"bench", "/no/such.json"}, "scenes: cannot read /no/such.json: No such file", "penumbra bench --help", {}},
        {{"bench", "a.json", "--most-seconds", "x"}, "", "penumbra bench --help", {}},
    };
    for (const Case& one : cases) {
        const Finished finished = penumbra(one.line, "", one.environment);
        const std::string what = testing::PrintToString(one.line) + "\n" + finished.err;
        EXPECT_EQ(finished.exit_code, 2) << what;
        EXPECT_THAT(finished.err, StartsWith("penumbra: " + one.text)) << what;
        EXPECT_TRUE(finished.err.ends_with("penumbra: try: " + one.help + "\n")) << what;
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
    EXPECT_THAT(wrong.err, StartsWith("<stdin>: /canvas/width (--set /canvas/width): must be from 1"));
    const Finished added = penumbra({"render", "-", "-o", "-", "--set", "/output/tonemap=acse", "--set", "/sky/colour=1"}, kScene);
    EXPECT_THAT(added.err, HasSubstr("<stdin>: /output/tonemap (--set /output/tonemap): must be "));
    EXPECT_THAT(added.err, HasSubstr("<stdin>: /sky/colour (--set /sky/colour): "));
    // What this build does not render yet, over a value of the text and beside it.
    const std::string bounces = R"({"version": 1, "canvas": {"width": 4, "height": 3}, "output": {"tonemap": "none"}})";
    for (const std::string& scene : {kScene, bounces}) {
        const Finished unsupported = penumbra({"render", "-", "-o", "-", "--set", "/output/tonemap=aces"}, scene);
        EXPECT_EQ(unsupported.exit_code, 2);
        EXPECT_THAT(unsupported.err, StartsWith("<stdin>: /output/tonemap (--set /output/tonemap): "));
    }
    const Finished reference = penumbra({"reference", "-", "-o", "-", "--set", "/canvas/width=0"}, kScene);
    EXPECT_THAT(reference.err, StartsWith("<stdin>: /canvas/width (--set /canvas/width): "));
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

TEST(Cli, ValidateTakesManyFiles) {
    const TemporaryFolder folder;
    const std::string good = folder.write("good.json", kScene), wrong = folder.write("wrong.json", kWrong);
    const std::string none = folder.path("none.json"), last = folder.write("last.json", kScene);
    const Finished both = penumbra({"validate", good, last});
    EXPECT_EQ(both.exit_code, 0) << both.err;
    EXPECT_EQ(both.out, good + ": valid\n" + last + ": valid\n");
    // Each is reported, whatever the ones before it are.
    const Finished all = penumbra({"validate", wrong, none, good, "-"}, "{");
    EXPECT_EQ(all.exit_code, 1);
    EXPECT_EQ(all.out, good + ": valid\n");
    EXPECT_THAT(all.err, HasSubstr(wrong + ": /canvas/widht (line 2"));
    EXPECT_THAT(all.err, HasSubstr("cannot read " + none + ": No such file"));
    EXPECT_THAT(all.err, HasSubstr("<stdin>: line 1, column 2"));
    EXPECT_EQ(penumbra({"validate", good, none}).exit_code, 1);

    const Finished said = penumbra({"validate", "--json", good, wrong, none});
    EXPECT_EQ(said.exit_code, 1);
    const auto json = nlohmann::json::parse(said.out);
    ASSERT_EQ(json.size(), 3u);
    EXPECT_EQ(json[0]["file"], good);
    EXPECT_EQ(json[0]["valid"], true);
    EXPECT_EQ(json[1]["valid"], false);
    EXPECT_GE(json[1]["problems"].size(), 2u);
    EXPECT_EQ(json[2]["file"], none);
    EXPECT_EQ(json[2]["valid"], false);
    EXPECT_EQ(json[2]["problems"][0]["code"], "unreadable");
}

TEST(Cli, EveryOptionIsDescribed) {
    const std::string text = read_file(PENUMBRA_SOURCE_DIR "/docs/operations.md");
    for (const char* command : {"render", "serve", "validate", "info", "health", "reference", "compare", "bench"}) {
        const std::size_t start = text.find("penumbra " + std::string(command));
        ASSERT_NE(start, std::string::npos) << command;
        const std::string help = penumbra({command, "--help"}).out;
        int options = 0;
        for (std::size_t at = help.find("--"); at != std::string::npos; at = help.find("--", at + 2)) {
            const std::size_t end = help.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-", at);
            const std::string option = help.substr(at, end - at);
            if (option == "--help" || option.size() < 4) continue;
            ++options;
            EXPECT_NE(text.find('`' + option + '`'), std::string::npos) << command << " " << option;
        }
        EXPECT_GE(options, 1) << command;
    }
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
