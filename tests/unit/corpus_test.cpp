// SPDX-License-Identifier: MIT
// Replays tests/corpus: every good scene parses, every bad one gives the problem it is named for.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "test_scenes.h"

namespace penumbra {
namespace {

using testing::Contains;

const std::filesystem::path kRoot = PENUMBRA_SOURCE_DIR;

std::vector<std::filesystem::path> scenes_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    if (std::filesystem::exists(folder)) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().extension() == ".json" && entry.path().filename() != "expected.json") {
                files.push_back(entry.path());
            }
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

TEST(Corpus, GoodScenesParse) {
    const auto files = scenes_in(kRoot / "tests/corpus/good");
    EXPECT_GE(files.size(), 25u);
    for (const auto& file : files) {
        const ParsedScene parsed = parse_scene(read_file(file));
        EXPECT_TRUE(parsed.scene) << file << "\n" << all_text(parsed);
    }
}

TEST(Corpus, ExampleScenesParse) {
    for (const auto& file : scenes_in(kRoot / "examples/scenes")) {
        const ParsedScene parsed = parse_scene(read_file(file));
        EXPECT_TRUE(parsed.scene) << file << "\n" << all_text(parsed);
    }
}

TEST(Corpus, BadScenesGiveTheirProblem) {
    const auto folder = kRoot / "tests/corpus/bad";
    const auto expected = nlohmann::json::parse(read_file(folder / "expected.json"));
    const auto files = scenes_in(folder);
    EXPECT_GE(files.size(), 60u);
    EXPECT_EQ(files.size(), expected.size()) << "expected.json and the files must agree";
    for (const auto& file : files) {
        const auto& want = expected.at(file.filename().string());
        const ParsedScene parsed = parse_scene(read_file(file));
        EXPECT_FALSE(parsed.scene) << file;
        const std::string line =
            want.at("pointer").get<std::string>() + " " + want.at("code").get<std::string>();
        EXPECT_THAT(brief(parsed), Contains(line)) << file << "\n" << all_text(parsed);
        for (const LocatedProblem& problem : parsed.problems) {
            EXPECT_GE(problem.line, 1) << file << "\n" << to_string(problem);
            EXPECT_GE(problem.column, 1) << file << "\n" << to_string(problem);
            EXPECT_FALSE(problem.problem.message.empty()) << file;
            EXPECT_LT(problem.problem.message.size(), 300u) << file;
        }
    }
}

// Each file is wrong in one way; the list must not bury that under what follows from it.
TEST(Corpus, OneMistakeIsOneProblem) {
    for (const auto& file : scenes_in(kRoot / "tests/corpus/bad")) {
        const std::string name = file.stem();
        if (name == "circle_radius_misspelt" || name == "just_null") {
            continue;  // the first lacks the right key too, in one reading
        }
        EXPECT_EQ(parse_scene(read_file(file)).problems.size(), 1u)
            << file << "\n"
            << all_text(parse_scene(read_file(file)));
    }
}

}  // namespace
}  // namespace penumbra
