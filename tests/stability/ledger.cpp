// SPDX-License-Identifier: MIT
#include "tests/stability/ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace penumbra::test {
namespace {

using nlohmann::json;

struct Worst {
    double value = 0;
    double bound = 0;
    std::string scene;
    int cases = 0;
};

// Law, who, figure.
using Key = std::tuple<std::string, std::string, std::string>;
std::map<Key, Worst> figures;
std::vector<json> points;

// Of the quick form on llvmpipe; with ten times the scenes, or on a GPU, some figures go beyond.
const json& bounds() {
    static const json kBounds = [] {
        const std::string start = PENUMBRA_SOURCE_DIR "/tests/stability/bounds";
        std::ifstream quick(start + ".json");
        json all = json::parse(quick);
        const char* device = std::getenv("PENUMBRA_TEST_DEVICE");
        std::vector<std::string> beyond;
        if (scale() > 1) beyond.push_back("-nightly");
        if (device != nullptr && std::string(device) == "gpu") beyond.push_back("-gpu");
        for (const std::string& name : beyond) {
            std::ifstream file(start + name + ".json");
            const json more = json::parse(file);  // kept: items() only refers to it
            for (const auto& [key, bound] : more.items()) all[key] = std::max(all.value(key, 0.0), bound.get<double>());
        }
        return all;
    }();
    return kBounds;
}

// Measured without bounds, to make bounds from (scripts/stability --learn).
bool learning() { return std::getenv("PENUMBRA_STABILITY_LEARN") != nullptr; }

// Written when all tests have run: one line a figure, one a point.
class Report : public testing::Environment {
public:
    void TearDown() override {
        const char* path = std::getenv("PENUMBRA_STABILITY_OUT");
        if (path == nullptr) return;
        std::ofstream file(path, std::ios::app);
        for (const auto& [key, worst] : figures)
            file << json{{"law", std::get<0>(key)}, {"who", std::get<1>(key)}, {"figure", std::get<2>(key)}, {"worst", worst.value},
                         {"bound", worst.bound}, {"scene", worst.scene}, {"cases", worst.cases}}.dump() << "\n";
        for (const json& point : points) file << point.dump() << "\n";
    }
};
const testing::Environment* const kReport = testing::AddGlobalTestEnvironment(new Report);

}  // namespace

std::string to_string(const Way& way) {
    constexpr const char* kNames[] = {"draft", "standard", "high"};
    return way.method + " " + kNames[static_cast<int>(way.quality)];
}

Scene as(Scene scene, const Way& way) {
    scene.render.method = way.method;
    scene.render.quality = way.quality;
    return scene;
}

const std::vector<Way>& all_ways() {
    static const std::vector<Way> kWays = [] {
        std::vector<Way> ways;
        for (const char* method : {"exact", "hrc", "rc_fix", "rc"})
            for (const Quality quality : {Quality::draft, Quality::standard, Quality::high}) ways.push_back({method, quality});
        ways.push_back({"reference", Quality::draft});
        return ways;
    }();
    return kWays;
}

const std::vector<Way>& main_ways() {
    static const std::vector<Way> kWays = {{"exact", Quality::draft}, {"exact", Quality::standard},  {"exact", Quality::high},
                                           {"hrc", Quality::standard}, {"rc_fix", Quality::standard}, {"rc", Quality::standard},
                                           {"reference", Quality::draft}};
    return kWays;
}

void hold(const std::string& law, const std::string& who, const std::string& figure, double value, const std::string& scene) {
    Worst& worst = figures[{law, who, figure}];
    ++worst.cases;
    const std::string key = law + "/" + who + "/" + figure;
    const auto bound = bounds().find(key);
    const bool known = bound != bounds().end();
    worst.bound = known ? bound->get<double>() : 0.0;
    // Also when it is no number.
    if (worst.cases == 1 || !(value <= worst.value)) {
        worst.value = value;
        worst.scene = scene;
    }
    if (learning()) return;
    EXPECT_TRUE(known) << "bounds.json has no " << key;
    EXPECT_TRUE(value <= worst.bound) << key << " is " << value << ", may be " << worst.bound << ", in: " << scene;
}

void hold(const std::string& law, const Way& way, const std::string& figure, double value, const std::string& scene) {
    hold(law, to_string(way), figure, value, scene);
}

void plot(const std::string& name, const std::string& line, double x, double y) {
    points.push_back({{"plot", name}, {"line", line}, {"x", x}, {"y", y}});
}

int scale() {
    static const int kScale = [] {
        const char* text = std::getenv("PENUMBRA_STABILITY_SCALE");
        return text != nullptr ? std::max(std::atoi(text), 1) : 1;
    }();
    return kScale;
}

}  // namespace penumbra::test
