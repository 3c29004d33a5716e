// SPDX-License-Identifier: MIT
// Shaders by name, flattened, and the way back from a driver's line to a file's. Needs no device.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "core/device_error.h"
#include "core/gl/shader_source.h"

namespace penumbra::gl {
namespace {

// The line of the flattened text (from 1) that came from this line of this file.
int flat_line(const FlatShader& shader, const std::string& file, int line) {
    for (std::size_t i = 0; i < shader.lines.size(); ++i)
        if (shader.files[static_cast<std::size_t>(shader.lines[i].file)] == file && shader.lines[i].line == line)
            return static_cast<int>(i) + 1;
    return 0;
}

TEST(FlattenShader, IncludesEachFileOnceAndKnowsEveryLine) {
    const FlatShader shader = flatten_shader("cascade.comp");
    EXPECT_EQ(shader.files.front(), "cascade.comp");
    for (const char* file : {"cascade.h", "types.h", "scene_records.h", "lib/march.glsl", "lib/scene.glsl"})
        EXPECT_EQ(std::count(shader.files.begin(), shader.files.end(), file), 1) << file;
    EXPECT_EQ(shader.text.find("#include \""), std::string::npos);
    EXPECT_EQ(static_cast<std::size_t>(std::count(shader.text.begin(), shader.text.end(), '\n')), shader.lines.size());
    EXPECT_GT(flat_line(shader, "lib/scene.glsl", 1), flat_line(shader, "cascade.comp", 1));
}

TEST(FlattenShader, TheFolderGivesWhatIsEmbedded) {
    for (const EmbeddedShader& shader : embedded_shaders()) {
        const FlatShader embedded = flatten_shader(shader.name);
        const FlatShader live = flatten_shader(shader.name, PENUMBRA_SOURCE_DIR "/glsl");
        EXPECT_EQ(embedded.text, live.text) << shader.name;
        EXPECT_EQ(embedded.files, live.files) << shader.name;
    }
    EXPECT_GE(embedded_shaders().size(), 15u);
}

TEST(FlattenShader, LayoutsHoldNumbers) {
    for (const EmbeddedShader& shader : embedded_shaders()) {
        if (!std::string_view(shader.name).ends_with(".comp")) continue;
        const FlatShader flat = flatten_shader(shader.name);
        for (std::size_t at = flat.text.find("layout("); at != std::string::npos; at = flat.text.find("layout(", at + 1)) {
            const std::string inside = flat.text.substr(at, flat.text.find(')', at) - at);
            EXPECT_EQ(inside.find("= k"), std::string::npos) << shader.name << ": " << inside;
        }
    }
}

TEST(FlattenShader, AMissingFileIsNamed) {
    for (const std::string folder : {"", PENUMBRA_SOURCE_DIR "/glsl"}) {
        try {
            flatten_shader("nowhere.comp", folder);
            FAIL();
        } catch (const DeviceError& error) {
            EXPECT_NE(std::string(error.what()).find("nowhere.comp"), std::string::npos) << error.what();
        }
    }
}

// A program for what a scene needs: the same text but for the constants that are given.
TEST(FlattenShader, GivenConstantsReplaceThoseOfTheirNames) {
    const FlatShader plain = flatten_shader("exact_solve.comp");
    const FlatShader lean = flatten_shader("exact_solve.comp", {}, {{"kArcs", 0}, {"kEllipses", 0}, {"kSky", 1}});
    const auto says = [](const FlatShader& shader, const char* what) { return shader.text.find(what) != std::string::npos; };
    for (const char* line : {"const int kArcs = 1;", "const int kEllipses = 1;", "const int kSky = 2;", "const int kSlopes = 1;"})
        EXPECT_TRUE(says(plain, line)) << line;
    for (const char* line : {"const int kArcs = 0;", "const int kEllipses = 0;", "const int kSky = 1;", "const int kSlopes = 1;"})
        EXPECT_TRUE(says(lean, line)) << line;
    for (const char* line : {"const int kArcs = 1;", "const int kEllipses = 1;", "const int kSky = 2;"}) EXPECT_FALSE(says(lean, line)) << line;
    EXPECT_EQ(lean.lines.size(), plain.lines.size()) << "logs are led back to the same lines";
    EXPECT_EQ(flatten_shader("exact_solve.comp", {}, {{"kArc", 0}, {"kArcs2", 0}}).text, plain.text) << "whole names only";
}

// In layouts too, which hold numbers instead of names, and in headers.
TEST(FlattenShader, GivenConstantsReachLayouts) {
    const FlatShader shader = flatten_shader("exact_fill.comp", {}, {{"kExactGroupX", 48}});
    EXPECT_NE(shader.text.find("local_size_x = 48"), std::string::npos);
    EXPECT_EQ(flatten_shader("exact_fill.comp").text.find("local_size_x = 48"), std::string::npos);
}

TEST(TranslateLog, MesaAndNvidia) {
    const FlatShader shader = flatten_shader("cascade.comp");
    const std::string scene = std::to_string(flat_line(shader, "lib/scene.glsl", 12));
    const std::string own = std::to_string(flat_line(shader, "cascade.comp", 20));
    EXPECT_EQ(translate_log(shader, "0:" + scene + "(7): error: `x' undeclared\n"), "glsl/lib/scene.glsl:12:7: error: `x' undeclared\n");
    EXPECT_EQ(translate_log(shader, "0(" + own + ") : error C1503: undefined variable \"x\"\n"),
              "glsl/cascade.comp:20: error C1503: undefined variable \"x\"\n");
    EXPECT_EQ(translate_log(shader, "0:" + scene + "(7): error: a\n0:" + own + "(1): warning: b\n"),
              "glsl/lib/scene.glsl:12:7: error: a\nglsl/cascade.comp:20:1: warning: b\n");
}

TEST(TranslateLog, WhatItDoesNotKnowStaysAsItIs) {
    const FlatShader shader = flatten_shader("cascade.comp");
    EXPECT_EQ(translate_log(shader, "error: linking failed\n\n"), "error: linking failed\n");
    EXPECT_EQ(translate_log(shader, "0:999999(1): error: beyond the end"), "0:999999(1): error: beyond the end\n");
    EXPECT_EQ(translate_log(shader, "0:0(1): error: before the start"), "0:0(1): error: before the start\n");
    EXPECT_EQ(translate_log(shader, ""), "");
}

}  // namespace
}  // namespace penumbra::gl
