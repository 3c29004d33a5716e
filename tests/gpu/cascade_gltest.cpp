// SPDX-License-Identifier: MIT
// The cascade and resolve passes against their twin on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/passes/cascade_pass.h"
#include "core/passes/resolve_pass.h"
#include "core/plan/pack.h"
#include "glsl/cascade.h"
#include "glsl/resolve.h"
#include "tests/gpu/cascade_twin.h"
#include "tests/gpu/shared_context.h"
#include "tests/support/build_scene.h"

namespace penumbra::test {
namespace {

struct Texels4 {
    glm::ivec2 size{0};
    std::vector<glm::vec4> data;
};

Texels4 read(const gl::Texture2D& texture) {
    Texels4 result{texture.size(), {}};
    result.data.resize(std::size_t(result.size.x) * std::size_t(result.size.y));
    texture.read(GL_RGBA, GL_FLOAT, result.data.data());
    return result;
}

struct Frame {
    std::vector<Texels4> cascades;
    Texels4 pixels;  // resolved, or cascade 0
};

Frame run_frame(const Scene& scene, const Plan& plan, const PassSettings& settings = kOneSlice) {
    shared_context();
    const SceneBuffers buffers(pack_scene(scene, 1), scene.sky, plan);
    buffers.bind();
    DistancePass distance(shader_dir());
    CascadePass cascade(shader_dir());
    ResolvePass resolve(shader_dir());
    DistanceField field;
    if (plan.shape_slices.empty()) field = DistancePass::empty_field(plan);
    else distance.run(plan, pack_scene(scene, 1), {}, settings, field);
    Frame frame;
    frame.cascades.resize(plan.cascades.size());
    gl::Texture2D above;
    for (std::size_t level = plan.cascades.size(); level-- > 0;) {
        gl::Texture2D out;
        cascade.run(plan, level, scene.sky, buffers, field, above ? &above : nullptr, settings, out);
        frame.cascades[level] = read(out);
        above = std::move(out);
    }
    frame.pixels = frame.cascades.front();
    if (plan.resolve) {
        gl::Texture2D out;
        resolve.run(plan, above, settings, out);
        frame.pixels = read(out);
    }
    return frame;
}

struct Agreement {
    double share_off = 0;  // samples that differ by more than 1e-3 of the largest
    double mean_off = 0;   // of the means, relative, signed
};

Agreement compare(const std::vector<glm::vec4>& device, const std::vector<Colour>& twin) {
    double peak = 0;
    double sum_device = 0;
    double sum_twin = 0;
    for (const Colour& c : twin) peak = std::max({peak, c.r, c.g, c.b});
    Agreement result;
    for (std::size_t i = 0; i < twin.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double a = double(device[i][c]);
            sum_device += a;
            sum_twin += twin[i][c];
            if (!(std::abs(a - twin[i][c]) <= 1e-3 * peak)) result.share_off += 1.0 / (3.0 * double(twin.size()));
        }
    result.mean_off = sum_twin == sum_device ? 0 : sum_device / sum_twin - 1;
    return result;
}

Scene lamp_and_walls(int width, int height, Quality quality) {
    Scene scene = with(rc_canvas(width, height),
                       {shape(Circle{{0.3 * width + 0.13, 0.4 * height + 0.21}, 0.1 * height}, {3, 2, 1}),
                        shape(Rect{{0.6 * width + 0.07, 0.55 * height + 0.11}, {2.3, 0.5 * height}, 17, 0}),
                        shape(Ellipse{{0.83 * width, 0.2 * height}, {0.09 * width, 0.06 * height}, 40}, {0, 0.5, 2})});
    scene.render.quality = quality;
    return scene;
}

void expect_as_twin(const Scene& scene, const std::string& what) {
    const Plan plan = pass_plan(scene);
    const Frame frame = run_frame(scene, plan);
    const std::vector<TwinCascade> twin = twin_cascades(scene, plan);
    for (std::size_t level = 0; level < twin.size(); ++level) {
        const std::string where = what + ", cascade " + std::to_string(level);
        ASSERT_EQ(frame.cascades[level].size, twin[level].size) << where;
        std::size_t solid_differs = 0;
        for (std::size_t i = 0; i < twin[level].weight.size(); ++i) {
            const float a = frame.cascades[level].data[i].a;
            ASSERT_TRUE(a == 0 || a == 1) << where;
            if (double(a) != twin[level].weight[i]) ++solid_differs;
        }
        // A probe that is not at a pixel's centre is judged by an interpolated distance.
        EXPECT_LE(double(solid_differs), 0.01 * double(twin[level].weight.size())) << where;
        const Agreement all = compare(frame.cascades[level].data, twin[level].radiance);
        std::printf("%s: %.2f %% of texels differ, the mean by %.3f %%\n", where.c_str(), 100 * all.share_off, 100 * all.mean_off);
        // The device steps by no less than a quarter pixel: rays that graze an outline may miss it. Those are few.
        EXPECT_LE(std::abs(all.mean_off), 0.02) << where;
    }
    const Agreement pixels = compare(frame.pixels.data, twin_resolve(plan, twin.front()));
    std::printf("%s: %.2f %% of samples differ, the mean by %.3f %%\n", what.c_str(), 100 * pixels.share_off, 100 * pixels.mean_off);
    EXPECT_LE(std::abs(pixels.mean_off), 0.01) << what;
    EXPECT_LE(pixels.share_off, 0.1) << what;
}

TEST(Cascade, AsItsTwinAtEveryQuality) {
    for (const auto& [quality, name] : {std::pair(Quality::draft, "draft"), std::pair(Quality::standard, "standard"), std::pair(Quality::high, "high")})
        expect_as_twin(lamp_and_walls(24, 17, quality), name);
}

TEST(Cascade, AsItsTwinUnderAGradientSkyWithAMargin) {
    Scene scene = lamp_and_walls(31, 23, Quality::standard);
    scene.sky.gradient = {{10, {0.5, 0, 0}}, {120, {0, 0.7, 0}}, {120, {0, 0, 0.9}}, {250, {0.3, 0.3, 0.3}}};
    scene.canvas.margin = 5.3;
    scene.shapes.push_back(shape(Circle{{-2.7, 11.1}, 1.4}, {0, 5, 0}));  // between view and domain
    expect_as_twin(scene, "gradient");
}

TEST(Cascade, AsItsTwinWithoutShapes) {
    Scene scene = rc_canvas(24, 17);
    scene.sky.gradient = {{10, {0.5, 0, 0}}, {120, {0, 0.7, 0}}, {250, {0.3, 0.3, 0.3}}};
    const Plan plan = pass_plan(scene);
    const Frame frame = run_frame(scene, plan);
    const std::vector<TwinCascade> twin = twin_cascades(scene, plan);
    for (std::size_t level = 0; level < twin.size(); ++level) {
        const Agreement all = compare(frame.cascades[level].data, twin[level].radiance);
        EXPECT_EQ(all.share_off, 0) << level;
        EXPECT_LE(std::abs(all.mean_off), 1e-6) << level;
    }
}

TEST(Cascade, OddAndEvenCountsGiveTheSamePicture) {
    // Errata E-4. One more cascade at the far end sees nothing that the domain holds.
    const Scene scene = lamp_and_walls(24, 17, Quality::standard);
    Plan plan = pass_plan(scene);
    const Frame fewer = run_frame(scene, plan);
    plan.cascades = plan_cascades(plan.canvas, plan.cascades.back().end * 1.01, cascade_settings(Quality::standard));
    ASSERT_EQ(plan.cascades.size(), fewer.cascades.size() + 1);
    const Frame more = run_frame(scene, plan);
    for (std::size_t i = 0; i < fewer.pixels.data.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(fewer.pixels.data[i][c], more.pixels.data[i][c], 1e-5f);
}

TEST(Cascade, BandsChangeNothing) {
    Scene scene = lamp_and_walls(61, 43, Quality::high);
    const Plan plan = pass_plan(scene);
    const Frame whole = run_frame(scene, plan);
    const Frame bands = run_frame(scene, plan, PassSettings{900, 1200, 300});
    ASSERT_EQ(whole.cascades.size(), bands.cascades.size());
    for (std::size_t level = 0; level < whole.cascades.size(); ++level)
        EXPECT_TRUE(whole.cascades[level].data == bands.cascades[level].data) << level;
    EXPECT_TRUE(whole.pixels.data == bands.pixels.data);
}

TEST(Cascade, WritesNothingOutsideItsExtent) {
    shared_context();
    const Scene scene = rc_canvas(13, 7);
    const Plan plan = pass_plan(scene);
    const SceneBuffers buffers(pack_scene(scene, 1), scene.sky, plan);
    buffers.bind();
    const DistanceField field = DistancePass::empty_field(plan);
    const glm::vec4 sentinel(-9);
    gl::Texture2D out(GL_RGBA32F, {90, 20});
    out.fill(GL_RGBA, GL_FLOAT, &sentinel);
    field.distance.bind_texture(glsl::kCascadeDistanceUnit);
    field.material.bind_texture(glsl::kCascadeMaterialUnit);
    out.bind_image(glsl::kCascadeImageBinding, GL_WRITE_ONLY);
    glsl::CascadeParams params{};
    params.extent = {66, 14};
    params.probes = params.upper_probes = {33, 7};
    params.tiles = params.upper_tiles = {2, 2};
    params.domain = {-1, -1, 13, 7};
    params.spacing = params.upper_spacing = 0.3f;
    params.end = 100;
    params.group_angle = 1.5707963f;
    params.offset_cos = glm::vec4(1);
    params.sky = glm::vec4(1);
    params.is_last = 1;
    params.sky_first = -1;
    gl::ComputeProgram("cascade.comp", sizeof params, shader_dir()).dispatch(params, params.extent, 66 * 3);
    const Texels4 written = read(out);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 90; ++x)
            EXPECT_EQ(written.data[std::size_t(y) * 90 + std::size_t(x)].r, x < 66 && y < 14 ? 1 : -9) << x << ", " << y;
}

TEST(Resolve, WritesNothingOutsideItsExtent) {
    shared_context();
    const glm::vec4 sentinel(-9);
    const glm::vec4 one(1);
    gl::Texture2D in(GL_RGBA32F, {8, 8}, gl::Filter::linear);
    in.fill(GL_RGBA, GL_FLOAT, &one);
    gl::Texture2D out(GL_RGBA32F, {90, 20});
    out.fill(GL_RGBA, GL_FLOAT, &sentinel);
    in.bind_texture(glsl::kResolveCascadeUnit);
    out.bind_image(glsl::kResolveImageBinding, GL_WRITE_ONLY);
    glsl::ResolveParams params{};
    params.extent = {67, 13};
    params.probes = {4, 4};
    params.tiles = {2, 2};
    params.texel = {0.125f, 0.125f};
    params.spacing = 4;
    gl::ComputeProgram("resolve.comp", sizeof params, shader_dir()).dispatch(params, params.extent, 67 * 5);
    const Texels4 written = read(out);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 90; ++x)
            EXPECT_EQ(written.data[std::size_t(y) * 90 + std::size_t(x)].r, x < 67 && y < 13 ? 1 : -9) << x << ", " << y;
}

}  // namespace
}  // namespace penumbra::test
