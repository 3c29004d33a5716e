// SPDX-License-Identifier: MIT
// Each case's picture against the one that was blessed. A failure leaves actual.png, expected.png and diff.png in
// the build folder. PENUMBRA_BLESS=1 writes the expected pictures of the cases that run: look at them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/image/codec.h"
#include "core/plan/support.h"
#include "server/json/scene_json.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

const fs::path kCases = PENUMBRA_SOURCE_DIR "/tests/golden";
constexpr std::size_t kMostBytes = 64 * 1024;

std::vector<std::string> case_names() {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(kCases))
        if (fs::exists(entry.path() / "case.json")) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_png(const fs::path& path, const Image8& image) {
    const Bytes png = encode_png(image);
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
}

// Without its alpha; empty when the file is no PNG.
Image8 read_png(const fs::path& path) {
    const std::string text = read_text(path);
    const auto* data = reinterpret_cast<const std::uint8_t*>(text.data());
    const auto decoded = decode_png({data, text.size()});
    const auto* texels = std::get_if<Texels>(&decoded);
    if (texels == nullptr) return {};
    Image8 image(texels->width, texels->height, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = texels->rgba[i / 3 * 4 + i % 3];
    return image;
}

// Differences, sixteen times as large.
Image8 difference_picture(const Image8& a, const Image8& b) {
    Image8 result(a.width, a.height, 3);
    if (a.data.size() != b.data.size()) return result;
    for (std::size_t i = 0; i < a.data.size(); ++i)
        result.data[i] = static_cast<std::uint8_t>(std::min(255, 16 * std::abs(int(a.data[i]) - int(b.data[i]))));
    return result;
}

class Golden : public testing::TestWithParam<std::string> {};

TEST_P(Golden, LooksAsItDid) {
    const std::string& name = GetParam();
    const fs::path folder = kCases / name;
    const std::string bless = "To bless this one case, having looked at it:\n  PENUMBRA_BLESS=1 " PENUMBRA_BINARY_DIR
                              "/tests/golden_tests --gtest_filter='*/" + name + "'";

    const nlohmann::json about = nlohmann::json::parse(read_text(folder / "case.json"));
    EXPECT_FALSE(about.at("title").get<std::string>().empty());
    EXPECT_FALSE(about.at("guards").get<std::string>().empty());
    const double max = about.at("tolerance").at("max").get<double>();
    const double mean = about.at("tolerance").at("mean").get<double>();
    if (max > 0 || mean > 0) {
        EXPECT_FALSE(about.at("tolerance").at("reason").get<std::string>().empty());
    }

    const std::string text = read_text(folder / "scene.json");
    const ParsedScene parsed = parse_scene(text);
    for (const LocatedProblem& problem : parsed.problems) ADD_FAILURE() << to_string(problem);
    ASSERT_TRUE(parsed.scene.has_value());
    const Image8 actual = render_display(*parsed.scene);

    const char* blessing = std::getenv("PENUMBRA_BLESS");
    if (blessing != nullptr && std::string(blessing) == "1") write_png(folder / "expected.png", actual);

    const Image8 expected = fs::exists(folder / "expected.png") ? read_png(folder / "expected.png") : Image8{};
    const Difference found = difference(actual, expected);
    if (found.max <= max && found.mean <= mean) {
        EXPECT_LE(fs::file_size(folder / "expected.png"), kMostBytes);
        return;
    }
    const fs::path out = fs::path(PENUMBRA_BINARY_DIR) / "golden" / name;
    fs::remove_all(out);
    fs::create_directories(out);
    write_png(out / "actual.png", actual);
    if (expected.data.empty()) {
        FAIL() << name << ": " << (folder / "expected.png").string() << " is missing or no PNG. See " << (out / "actual.png").string() << ".\n"
               << bless;
    }
    write_png(out / "expected.png", expected);
    write_png(out / "diff.png", difference_picture(actual, expected));
    FAIL() << name << ": differs by " << found.max << " at most (" << max << " allowed) and " << found.mean << " in the mean (" << mean
           << " allowed). See actual.png, expected.png, diff.png (times 16) in " << out.string() << ".\n"
           << bless;
}

INSTANTIATE_TEST_SUITE_P(Cases, Golden, testing::ValuesIn(case_names()), [](const auto& named) { return named.param; });

TEST(GoldenCases, AreManyAndNothingElseLiesAmongThem) {
    EXPECT_GE(case_names().size(), 14u);
    for (const fs::directory_entry& entry : fs::directory_iterator(kCases)) {
        if (!entry.is_directory()) continue;
        EXPECT_TRUE(fs::exists(entry.path() / "case.json")) << entry.path();
        for (const fs::directory_entry& file : fs::directory_iterator(entry.path())) {
            const std::string name = file.path().filename().string();
            EXPECT_TRUE(name == "case.json" || name == "scene.json" || name == "expected.png") << file.path();
        }
    }
}

}  // namespace
}  // namespace penumbra::test
