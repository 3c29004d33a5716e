// SPDX-License-Identifier: MIT
// Thousands of small scenes of everything that the format holds, rendered by every method: nothing impossible, and as near to
// the truth as each method comes. A scene that fails is shrunk and kept under tests/stability/regressions, which is
// replayed first.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/device_error.h"
#include "core/scene/validate.h"
#include "server/json/scene_json.h"
#include "tests/stability/judge.h"
#include "tests/stability/ledger.h"
#include "tests/stability/scene_text.h"
#include "tests/stability/scenes.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

std::string folder() {
    const char* other = std::getenv("PENUMBRA_STABILITY_REGRESSIONS");
    return other != nullptr ? other : PENUMBRA_SOURCE_DIR "/tests/stability/regressions";
}

// How far from the truth one scene may be, mean |a - b| over the brightest source. What sampling makes of a lamp of a
// thousandth of a pixel has no bound but that; what is solved is solved.
struct Bound {
    double mean, most;
};
Bound bound_of(const Way& way, const Scene& scene) {
    if (way.method == "exact") return way.quality == Quality::draft ? Bound{4e-3, 0.25} : way.quality == Quality::standard ? Bound{1e-3, 0.06} : Bound{1e-4, 0.02};
    if (way.method == "reference") return {0.02, 0.5};
    // A canvas of a pixel or two is all edge.
    return {std::min(scene.canvas.width, scene.canvas.height) < 4 ? 0.5 : 0.15, 1.01};
}

// What is wrong with this scene's picture; empty: nothing, or the method refused it in words.
std::string fault(const Scene& scene, const Way& way, const ImageF& truth, bool note, const std::string& law, const std::string& name) {
    ImageF picture;
    try {
        picture = render_linear(as(scene, way));
    } catch (const DeviceError& refused) {
        if (note) hold(law, way, "share refused", 1, name);
        return way.method == "exact" ? std::string() : std::string("refused: ") + refused.what();
    }
    if (std::string wrong = impossible(scene, picture); !wrong.empty()) return wrong;
    const Off off = off_by(scene, picture, truth);
    if (note) {
        hold(law, way, "mean of peak", off.of_peak, name);
        hold(law, way, "max of peak", off.max_of_peak, name);
    }
    const Bound bound = bound_of(way, scene);
    std::ostringstream text;
    if (off.of_peak > bound.mean) text << "off by " << off.of_peak << " of the brightest source in the mean, may be " << bound.mean;
    else if (off.max_of_peak > bound.most) text << "off by " << off.max_of_peak << " of the brightest source, may be " << bound.most;
    return text.str();
}

std::string keep(const Scene& scene, const Way& way, const std::string& name) {
    std::string file = name + "_" + to_string(way);
    for (char& c : file)
        if (c == ' ') c = '_';
    fs::create_directories(folder());
    const std::string path = folder() + "/" + file + ".json";
    Scene named = as(scene, way);
    named.output.format = "pfm";
    std::ofstream(path) << scene_text(named);
    return path;
}

void hunt(const char* law, const std::function<Scene(std::uint64_t)>& make, std::uint64_t first, int count) {
    std::map<std::string, std::vector<double>> rels;
    int failures = 0;
    for (int i = 0; i < count && failures < 5; ++i) {
        const std::uint64_t seed = first + std::uint64_t(i);
        const Scene scene = make(seed);
        const std::string name = std::string(law) + " " + std::to_string(seed);
        const auto started = std::chrono::steady_clock::now();
        ASSERT_TRUE(validate(scene).empty()) << name;
        const ImageF truth = truth_of(scene);
        // Standard always; draft and high by turns.
        for (const char* method : {"exact", "hrc", "rc_fix", "rc", "reference"}) {
            const bool brute = std::string(method) == "reference";
            for (const Quality quality : {Quality::standard, i % 2 == 0 ? Quality::draft : Quality::high}) {
                if (brute && quality != Quality::draft) continue;
                const Way way{method, quality};
                const std::string wrong = fault(scene, way, truth, true, law, name);
                if (wrong.empty()) continue;
                ++failures;
                const Scene small = shrunk(scene, [&](const Scene& s) { return fault(s, way, truth_of(s), false, law, name); });
                std::string slug = name;
                const std::string path = keep(small, way, slug);
                ADD_FAILURE() << name << ", " << to_string(way) << ": " << wrong << "\nshrunk to " << path;
            }
        }
        // Long renders are worth knowing.
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        if (seconds > 5) std::fprintf(stderr, "%s took %.0f s, %zu shapes\n", name.c_str(), seconds, scene.shapes.size());
        // What `auto` takes, it takes whole.
        const RenderResult chosen = shared_renderer().render([&] {
            Scene s = as(scene, {"auto", Quality::standard});
            s.output.format = "pfm";
            return s;
        }());
        EXPECT_EQ(std::get<ImageF>(chosen.picture).data, render_linear(as(scene, {chosen.stats.method, Quality::standard})).data) << name;
    }
}

TEST(Regressions, StayMended) {
    if (!fs::exists(folder())) return;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder()))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& path : files) {
        std::ifstream file(path);
        std::stringstream text;
        text << file.rdbuf();
        const ParsedScene parsed = parse_scene(text.str());
        ASSERT_TRUE(parsed.scene) << path << ": " << to_string(parsed.problems.front());
        const Scene& scene = *parsed.scene;
        const ImageF truth = truth_of(scene);
        const Way own{scene.render.method, scene.render.quality};
        EXPECT_EQ(fault(scene, own, truth, false, "", ""), "") << path;
        for (const Way& way : main_ways()) EXPECT_EQ(fault(scene, way, truth, false, "", ""), "") << path << ", " << to_string(way);
    }
}

// PENUMBRA_STABILITY_FIRST_SEED=1000 looks at others.
std::uint64_t first_seed() {
    const char* text = std::getenv("PENUMBRA_STABILITY_FIRST_SEED");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 1;
}

TEST(Random, MildScenes) { hunt("mild", mild_scene, first_seed(), 30 * scale()); }
TEST(Random, WildScenes) { hunt("wild", wild_scene, first_seed(), 50 * scale()); }

// The suite's own tools: the text of a scene gives the scene back, and shrinking finds what it is about.
TEST(Tools, TheTextOfASceneGivesTheSamePicture) {
    for (std::uint64_t seed = 1; seed < 30; ++seed) {
        const Scene scene = as(wild_scene(seed), {"rc", Quality::draft});
        const ParsedScene parsed = parse_scene(scene_text(scene));
        ASSERT_TRUE(parsed.scene) << seed << ": " << to_string(parsed.problems.front());
        EXPECT_EQ(render_linear(*parsed.scene).data, render_linear(scene).data) << seed;
    }
}

// PENUMBRA_STABILITY_SCENE="wild 17" prints that scene, for `penumbra render -`.
TEST(Tools, PrintsAScene) {
    const char* wanted = std::getenv("PENUMBRA_STABILITY_SCENE");
    if (wanted == nullptr) GTEST_SKIP() << "PENUMBRA_STABILITY_SCENE names no scene";
    std::istringstream words(wanted);
    std::string kind;
    std::uint64_t seed = 0;
    ASSERT_TRUE(words >> kind >> seed);
    std::printf("%s", scene_text(kind == "wild" ? wild_scene(seed) : mild_scene(seed)).c_str());
}

TEST(Tools, ShrinkingLeavesWhatFails) {
    Scene scene = wild_scene(3);
    scene.canvas.view.reset();
    scene.shapes.clear();
    for (int i = 0; i < 40; ++i) scene.shapes.push_back(Shape{Circle{{double(i), 5.0}, 1.234}, Colour(i == 27 ? 5.0 : 0.1), Colour(0)});
    const Scene small = shrunk(scene, [](const Scene& s) {
        for (const Shape& one : s.shapes)
            if (one.emission.r > 0.5) return std::string("a bright one");
        return std::string();
    });
    ASSERT_EQ(small.shapes.size(), 1u);
    EXPECT_EQ(small.shapes[0].emission, Colour(1));
    EXPECT_EQ(std::get<Circle>(small.shapes[0].geometry).center.x, 27);
    EXPECT_EQ(std::get<Circle>(small.shapes[0].geometry).radius, 12 * 0.1) << "rounded to tenths";
}

}  // namespace
}  // namespace penumbra::test
