// SPDX-License-Identifier: MIT
// The same scene gives the same bytes: again, after others, in another renderer, with any number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/image/codec.h"
#include "server/json/scene_json.h"
#include "tests/http/process.h"
#include "tests/stability/judge.h"
#include "tests/stability/ledger.h"
#include "tests/stability/scene_text.h"
#include "tests/stability/scenes.h"
#include "tests/support/build_scene.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

Scene crowd() {
    Scene scene = canvas(150, 110);
    scene.sky.gradient = {{20, {0.1, 0.2, 0.3}}, {200, {0.3, 0.1, 0}}};
    Numbers numbers(8);
    for (int i = 0; i < 90; ++i)
        scene.shapes.push_back(shape(Circle{{numbers.between(0, 150), numbers.between(0, 110)}, numbers.between(0.3, 3)}, i % 4 == 0 ? Colour(1, 2, 3) : Colour(0)));
    for (const Shape& one : lamps_and_walls({75, 55}, 50)) scene.shapes.push_back(one);
    return scene;
}

TEST(Determinism, OrderRepetitionAndPooledTexturesChangeNoByte) {
    // Each way of each of three scenes of unlike size, alone first, then all in two other orders.
    const std::vector<Scene> scenes = {crowd(), mild_scene(41), wild_scene(7)};
    std::map<std::pair<std::size_t, std::size_t>, std::vector<float>> first;
    for (std::size_t s = 0; s < scenes.size(); ++s)
        for (std::size_t k = 0; k < all_ways().size(); ++k) {
            Scene scene = as(scenes[s], all_ways()[k]);
            scene.output.format = "pfm";
            first[{s, k}] = render_linear(scene).data;
        }
    for (std::size_t turn = 0; turn < 2; ++turn)
        for (std::size_t i = 0; i < scenes.size() * all_ways().size(); ++i) {
            const std::size_t at = turn == 0 ? scenes.size() * all_ways().size() - 1 - i : i * 7 % (scenes.size() * all_ways().size());
            const std::size_t s = at / all_ways().size(), k = at % all_ways().size();
            EXPECT_EQ(render_linear(as(scenes[s], all_ways()[k])).data, (first[{s, k}])) << to_string(all_ways()[k]) << ", scene " << s;
        }
    // In a renderer that has done nothing else.
    Renderer fresh(test_options());
    for (std::size_t k = 0; k < all_ways().size(); ++k) {
        Scene scene = as(scenes[0], all_ways()[k]);
        scene.output.format = "pfm";
        EXPECT_EQ(std::get<ImageF>(fresh.render(scene).picture).data, (first[{0, k}])) << to_string(all_ways()[k]);
    }
}

std::string rendered_by_program(const std::string& file, const Environment& environment) {
    const Finished run = run_program(PENUMBRA_PROGRAM, {"render", file, "-o", "-", "--format", "pfm"}, "", environment);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
}

TEST(Determinism, AnyNumberOfThreadsGivesTheSameBytes) {
    TemporaryFolder folder;
    for (const char* method : {"exact", "hrc", "hybrid", "rc_fix", "rc", "reference"}) {
        const std::string file = folder.write(std::string(method) + ".json", scene_text(as(crowd(), {method, Quality::draft})));
        const std::string two = rendered_by_program(file, {{"LP_NUM_THREADS", "2"}});
        ASSERT_GT(two.size(), 150u * 110 * 12) << method;
        for (const char* threads : {"0", "1", "2", "7"}) EXPECT_EQ(rendered_by_program(file, {{"LP_NUM_THREADS", threads}}), two) << method << ", " << threads << " threads";
    }
}

// Without fused multiply-add digits are others: docs/operations.md. They may not be far.
TEST(Determinism, WithoutFusedMultiplyAddsPicturesStayNear) {
    if (shared_renderer().device().kind != "cpu") GTEST_SKIP() << "of llvmpipe only";
    TemporaryFolder folder;
    for (const char* method : {"exact", "hrc", "rc_fix", "rc", "reference"}) {
        const Way way{method, Quality::draft};
        const std::string file = folder.write(std::string(method) + ".json", scene_text(as(crowd(), way)));
        const auto picture = [&](const Environment& environment) {
            const std::string bytes = rendered_by_program(file, environment);
            return std::get<ImageF>(decode_pfm({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}));
        };
        const Apart d = apart(picture({{"GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1"}}), picture({}));
        hold("no fused multiply-add", way, "rel", d.rel, "90 discs under a gradient");
        hold("no fused multiply-add", way, "max", d.max, "90 discs under a gradient");
    }
}

}  // namespace
}  // namespace penumbra::test
