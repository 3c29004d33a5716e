// SPDX-License-Identifier: MIT
// Jump flooding against brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/gl/program.h"
#include "glsl/jump.h"
#include "tests/gpu/shared_context.h"
#include "tests/support/build_scene.h"
#include "tests/support/sdf.h"

namespace penumbra::test {
namespace {

// A picture of one texel a pixel over the whole canvas.
Scene bitmap_scene(int width, int height, std::shared_ptr<const Texels> image) {
    return with(canvas(width, height), {shape(Bitmap{std::move(image), {0, 0}, glm::dvec2(width, height), 1, 0.5, false})});
}

struct Error {
    double worst = 0;
    double share = 0;  // of pixels that are wrong at all
};

// Distance to the nearest solid pixel, less half a pixel.
Error against_brute_force(const Scene& scene) {
    const Texels& image = *std::get<Bitmap>(scene.shapes[0].geometry).image;
    std::vector<Point> seeds;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.rgba[4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) + 3] != 0) seeds.push_back({x, y});
    const Field field = run_distance(scene);
    Error error;
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) {
            double squared = 1e300;
            for (const Point& s : seeds) squared = std::min(squared, (s.x - x) * (s.x - x) + (s.y - y) * (s.y - y));
            const double exact = seeds.empty() ? std::hypot(field.size.x, field.size.y) : std::sqrt(squared) - 0.5;
            const double off = std::abs(double(field.distance[field.index(x, y)]) - exact);
            error.worst = std::max(error.worst, off);
            if (off > 1e-4) error.share += 1.0 / double(field.distance.size());
            EXPECT_EQ(field.material[field.index(x, y)], squared == 0 ? 0 : -1);
        }
    return error;
}

TEST(JumpFlood, AsByBruteForceOnRandomPictures) {
    for (const auto& [width, height] : {std::pair(37, 29), std::pair(64, 64), std::pair(1, 41), std::pair(53, 7), std::pair(101, 83)})
        for (const double density : {0.002, 0.02, 0.3}) {
            Numbers numbers(static_cast<std::uint64_t>(width * 1000 + height));
            const Scene scene = bitmap_scene(width, height, picture(width, height, [&](int, int) { return numbers.next() < density; }));
            const Error error = against_brute_force(scene);
            const std::string what = std::to_string(width) + "x" + std::to_string(height) + " at " + std::to_string(density);
            // Jump flooding is not exact: JFA+2 leaves a pixel in thousands wrong, by a fraction of a pixel.
            EXPECT_LE(error.share, 2e-3) << what;
            EXPECT_LE(error.worst, 0.6) << what;
        }
}

TEST(JumpFlood, OneSeedReachesEveryCorner) {
    for (const Point seed : {Point(0, 0), Point(66, 0), Point(0, 44), Point(66, 44), Point(31, 20)}) {
        const Scene scene = bitmap_scene(67, 45, picture(67, 45, [&](int x, int y) { return Point(x, y) == seed; }));
        EXPECT_LE(against_brute_force(scene).worst, 1e-4) << seed.x << ", " << seed.y;
    }
}

TEST(JumpFlood, ATransparentPictureIsFarFromEverything) {
    const Scene scene = bitmap_scene(21, 13, picture(21, 13, [](int, int) { return false; }));
    EXPECT_LE(against_brute_force(scene).worst, 1e-4);
}

TEST(JumpFlood, MergesWithShapesByTheSmallerDistance) {
    Scene scene = bitmap_scene(40, 30, picture(40, 30, [](int x, int y) { return x == 5 && y == 6; }));
    scene.shapes.push_back(shape(Circle{{30.2, 20.1}, 4}));
    const Field field = run_distance(scene);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const double bitmap = std::hypot(x - 5, y - 6) - 0.5;
            const double circle = exact_distance(scene.shapes[1], {x + 0.5, y + 0.5});
            EXPECT_NEAR(field.distance[field.index(x, y)], std::min(bitmap, circle), 1e-4) << x << ", " << y;
        }
}

TEST(JumpFlood, APictureOnTopAndBelow) {
    const auto image = picture(4, 4, [](int x, int) { return x < 2; });
    const Bitmap bitmap{image, {8, 8}, {16, 16}, 1, 0.5, false};  // solid from 8 to 16
    const Circle circle{{20.2, 16.1}, 9};
    const Field below = run_distance(with(canvas(32, 32), {shape(bitmap), shape(circle)}));
    const Field above = run_distance(with(canvas(32, 32), {shape(circle), shape(bitmap)}));
    EXPECT_EQ(below.material[below.index(14, 16)], 1);
    EXPECT_EQ(above.material[above.index(14, 16)], 1);
    EXPECT_EQ(below.material[below.index(9, 16)], 0);
    EXPECT_EQ(above.material[above.index(9, 16)], 1);
    EXPECT_EQ(above.material[above.index(20, 16)], 0) << "the transparent half hides nothing";
    // The union's distance does not depend on the order, as far as signs and free pixels go.
    for (std::size_t i = 0; i < below.distance.size(); ++i) {
        EXPECT_EQ(below.distance[i] <= 0, above.distance[i] <= 0);
        if (below.distance[i] > 0) {
            EXPECT_NEAR(below.distance[i], above.distance[i], 0.5);
        }
    }
}

// A window finds what is near, exactly, and touches nothing else.
TEST(NearBitmaps, AsByBruteForce) {
    for (const auto& [width, height] : {std::pair(37, 29), std::pair(64, 64), std::pair(1, 41), std::pair(53, 7), std::pair(101, 83)})
        for (const double density : {0.002, 0.02, 0.3})
            for (const double margin : {0.0, 9.5}) {
                const std::string what = std::to_string(width) + "x" + std::to_string(height) + " at " + std::to_string(density);
                Numbers numbers(static_cast<std::uint64_t>(width * 1000 + height));
                Scene scene = bitmap_scene(width, height, picture(width, height, [&](int, int) { return numbers.next() < density; }));
                scene.canvas.margin = margin;
                scene.shapes.push_back(shape(Circle{{0.4 * width, 0.6 * height}, 3.2}));
                Plan plan = pass_plan(scene);
                plan.jump_steps.clear();
                const Field without = run_distance(scene, plan);
                plan.near_bitmaps = true;
                const Field field = run_distance(scene, plan);
                const auto is_seed = [&](int x, int y) { return without.distance[without.index(x, y)] <= 0 && without.material[without.index(x, y)] == 0; };
                for (int y = 0; y < field.size.y; ++y)
                    for (int x = 0; x < field.size.x; ++x) {
                        float expected = without.distance[without.index(x, y)];
                        for (int sy = std::max(y - glsl::kNearSeeds, 0); sy <= std::min(y + glsl::kNearSeeds, field.size.y - 1); ++sy)
                            for (int sx = std::max(x - glsl::kNearSeeds, 0); sx <= std::min(x + glsl::kNearSeeds, field.size.x - 1); ++sx)
                                if (is_seed(sx, sy)) expected = std::min(expected, std::sqrt(float((sx - x) * (sx - x) + (sy - y) * (sy - y))) - 0.5f);
                        ASSERT_NEAR(field.distance[field.index(x, y)], expected, 1e-6) << what << ": " << x << ", " << y;
                    }
                EXPECT_EQ(field.material, without.material) << what;
            }
}

TEST(NearBitmaps, OutsideTheGridThereIsNothing) {
    Scene scene = canvas(40, 30);
    const auto image = picture(2, 2, [](int, int) { return true; });
    for (const Point at : {Point(-300, 4), Point(70, 4), Point(4, -50), Point(4, 90), Point(-1e9, -1e9), Point(1e9, 1e9)})
        scene.shapes.push_back(shape(Bitmap{image, at, {9, 9}}));
    Plan plan = pass_plan(scene);
    plan.jump_steps.clear();
    plan.near_bitmaps = true;
    const Field field = run_distance(scene, plan);
    for (const float d : field.distance) EXPECT_EQ(d, static_cast<float>(plan.grid.diagonal_px));
}

TEST(JumpFlood, WritesNothingOutsideItsExtent) {
    shared_context();
    const glm::ivec2 size(48, 40);
    const glm::ivec2 extent(37, 29);
    gl::Texture2D from(GL_RG16I, size);
    gl::Texture2D to(GL_RG16I, size);
    gl::Texture2D distance(GL_R32F, size);
    const short seed[2] = {3, 4};
    const short sentinel[2] = {-5, -6};
    const float far_sentinel = 99;
    from.fill(GL_RG_INTEGER, GL_SHORT, seed);
    to.fill(GL_RG_INTEGER, GL_SHORT, sentinel);
    distance.fill(GL_RED, GL_FLOAT, &far_sentinel);
    glsl::JumpParams params{};
    params.extent = extent;
    params.step = 4;
    from.bind_texture(glsl::kJumpSeedsUnit);
    to.bind_image(glsl::kJumpImageBinding, GL_WRITE_ONLY);
    gl::ComputeProgram("jump_flood.comp", sizeof params, shader_dir()).dispatch(params, extent);
    distance.bind_image(glsl::kJumpDistanceBinding, GL_READ_WRITE);
    gl::ComputeProgram("jump_merge.comp", sizeof params, shader_dir()).dispatch(params, extent);
    std::vector<short> seeds(2 * std::size_t(size.x) * std::size_t(size.y));
    std::vector<float> merged(std::size_t(size.x) * std::size_t(size.y));
    to.read(GL_RG_INTEGER, GL_SHORT, seeds.data());
    distance.read(GL_RED, GL_FLOAT, merged.data());
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(size.x) + std::size_t(x);
            const bool inside = x < extent.x && y < extent.y;
            EXPECT_EQ(seeds[2 * i], inside ? 3 : -5) << x << ", " << y;
            EXPECT_EQ(merged[i] != far_sentinel, inside) << x << ", " << y;
        }
}

}  // namespace
}  // namespace penumbra::test
