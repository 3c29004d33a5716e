// SPDX-License-Identifier: MIT
// Error figures of every method and quality against the exact solver, under the bounds of bounds.json. A change that
// makes a figure fall should lower its bound; none may raise one without a page in docs/decisions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/compare/error_figures.h"
#include "core/reference/solver.h"
#include "core/renderer.h"
#include "server/json/scene_json.h"

namespace penumbra {
namespace {

using nlohmann::json;

constexpr int kSide = 96;  // pixels: a scene of 512 world units, seen small

std::string read(const std::string& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

const json& bounds() {
    static const json kBounds = json::parse(read(PENUMBRA_SOURCE_DIR "/tests/accuracy/bounds.json"));
    return kBounds;
}

Scene load(const std::string& name, const std::string& method, const std::string& quality) {
    const std::string side = std::to_string(kSide);
    ParsedScene parsed = parse_scene(read(PENUMBRA_SOURCE_DIR "/examples/scenes/" + name + ".json"), {}, {},
                                     {{"/canvas/view", "[0, 0, 512, 512]"}, {"/canvas/width", side}, {"/canvas/height", side},
                                      {"/render/method", method}, {"/render/quality", quality}, {"/output/format", "pfm"}});
    if (!parsed.scene) throw std::runtime_error(to_string(parsed.problems.front()));
    return *parsed.scene;
}

const ImageF& truth(const std::string& name) {
    static std::map<std::string, ImageF> solved;
    auto found = solved.find(name);
    if (found == solved.end()) found = solved.emplace(name, reference::solve(load(name, "rc", "draft")).image).first;
    return found->second;
}

ErrorFigures measure(Renderer& renderer, const std::string& scene, const std::string& method, const std::string& quality) {
    const RenderResult result = renderer.render(load(scene, method, quality));
    return std::get<ErrorFigures>(error_figures(std::get<ImageF>(result.picture), truth(scene)));
}

Renderer& renderer() {
    static Renderer instance;
    return instance;
}

struct Case {
    std::string scene, method, quality;
    json bound;
};

std::vector<Case> cases() {
    std::vector<Case> result;
    for (const auto& [scene, methods] : bounds().items())
        for (const auto& [method, qualities] : methods.items())
            for (const auto& [quality, bound] : qualities.items()) result.push_back({scene, method, quality, bound});
    return result;
}

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.scene << " " << c.method << " " << c.quality; }

class Accuracy : public ::testing::TestWithParam<Case> {};

TEST_P(Accuracy, StaysUnderItsBound) {
    const Case& c = GetParam();
    const ErrorFigures e = measure(renderer(), c.scene, c.method, c.quality);
    std::printf("\"%s\" %s %s: {\"rel\": %.5f, \"nrmse\": %.5f, \"bias\": %.5f, \"leak\": %.6f}\n", c.scene.c_str(),
                c.method.c_str(), c.quality.c_str(), *e.rel, *e.nrmse, *e.bias, e.leak.value_or(0));
    EXPECT_EQ(e.nan_only_a, 0u);
    EXPECT_LE(*e.rel, c.bound.at("rel").get<double>());
    EXPECT_LE(*e.nrmse, c.bound.at("nrmse").get<double>());
    EXPECT_LE(std::abs(*e.bias), c.bound.at("bias").get<double>());
    EXPECT_LE(e.leak.value_or(0), c.bound.at("leak").get<double>());
}

INSTANTIATE_TEST_SUITE_P(Bounds, Accuracy, ::testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.scene + "_" + c.param.method + "_" + c.param.quality; });

// The bounds can fail: the seed's wrong divisor (errata E-8) and an upper cascade that is half a probe off are caught.
class BrokenShader : public ::testing::Test {
protected:
    // Some programs are built when a scene first needs them, so the folder stays until the test has ended.
    const std::string folder = ::testing::TempDir() + "/penumbra_broken_glsl_" + ::testing::UnitTest::GetInstance()->current_test_info()->name();
    void TearDown() override { std::filesystem::remove_all(folder); }

    // A renderer whose shader `file` says `to` instead of `from`.
    std::unique_ptr<Renderer> changed(const std::string& file, const std::string& from, const std::string& to) {
        std::filesystem::remove_all(folder);
        std::filesystem::copy(PENUMBRA_SOURCE_DIR "/glsl", folder, std::filesystem::copy_options::recursive);
        std::string text = read(folder + "/" + file);
        const auto at = text.find(from);
        if (at == std::string::npos) throw std::runtime_error(file + " no longer says " + from);
        std::ofstream(folder + "/" + file) << text.replace(at, from.size(), to);
        return std::make_unique<Renderer>(RendererOptions{.device = "auto", .shader_dir = folder});
    }

    void expect_caught(const std::string& method, const std::string& file, const std::string& from, const std::string& to) {
        const ErrorFigures e = measure(*changed(file, from, to), "penumbra", method, "standard");
        const json& bound = bounds().at("penumbra").at(method).at("standard");
        std::printf("broken %s: rel %.4f (bound %.4f), bias %.4f (bound %.4f)\n", file.c_str(), *e.rel, bound.at("rel").get<double>(),
                    *e.bias, bound.at("bias").get<double>());
        EXPECT_TRUE(*e.rel > bound.at("rel").get<double>() || std::abs(*e.bias) > bound.at("bias").get<double>());
    }
};

TEST_F(BrokenShader, WrongDivisorIsCaught) { expect_caught("rc", "cascade.comp", "vec4(0.25 * sum, 1.0)", "vec4(0.5 * sum, 1.0)"); }

TEST_F(BrokenShader, HalfAProbeOffIsCaught) {
    expect_caught("rc", "cascade.comp", "/ params.upper_spacing + 0.5;", "/ params.upper_spacing;");
}

TEST_F(BrokenShader, RaysThatEndElsewhereAreCaught) {
    expect_caught("rc_fix", "rc_fix.comp", "vec2 way = q + d * params.end - start;", "vec2 way = p + d * params.end - start;");
}

TEST_F(BrokenShader, SlopesTakenTwiceAreCaught) {
    expect_caught("exact", "exact_fill.comp", "+ 0.5 * (slopes_x", "+ 1.0 * (slopes_x");
}

TEST_F(BrokenShader, ShadowsThatNoCellIsSplitAtAreCaught) {
    expect_caught("exact", "exact_split.comp", "if (!same) {", "if (same && !same) {");
}

// Where no ray of `rc_fix` can meet anything none is traced: the same picture, but for the last digits of a sum.
TEST_F(BrokenShader, TheOpenShortcutChangesNothing) {
    const Scene scene = load("penumbra", "rc_fix", "standard");
    const ImageF with = std::get<ImageF>(renderer().render(scene).picture);
    const ImageF without = std::get<ImageF>(changed("rc_fix.comp", "bool open = !alone &&", "bool open = alone && !alone &&")->render(scene).picture);
    float peak = 0;
    for (const float value : with.data) peak = std::max(peak, value);
    for (std::size_t i = 0; i < with.data.size(); ++i) ASSERT_NEAR(with.data[i], without.data[i], 1e-5f * peak);
}

}  // namespace
}  // namespace penumbra
