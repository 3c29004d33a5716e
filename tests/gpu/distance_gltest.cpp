// SPDX-License-Identifier: MIT
// The distance pass against its twin in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/gl/program.h"
#include "core/plan/pack.h"
#include "glsl/distance.h"
#include "tests/gpu/shared_context.h"
#include "tests/support/build_scene.h"
#include "tests/support/sdf.h"

namespace penumbra::test {
namespace {

Point pixel_centre(const Scene& scene, const Plan& plan, int x, int y) {
    const ViewRect view = scene.canvas.view_or_default();
    const double side = scene.canvas.pixel_size();
    return {view.x + (x - plan.grid.border.x + 0.5) * side, view.y + (y - plan.grid.border.y + 0.5) * side};
}

// Every pixel of the grid within `bound` pixels of the exact distance (`inside_bound` inside), the material the exact
// one.
void expect_exact(const Scene& scene, double bound, const std::string& what, double inside_bound = 0) {
    const Plan plan = pass_plan(scene);
    const Field field = run_distance(scene, plan);
    ASSERT_EQ(field.size, plan.grid.size);
    const double side = scene.canvas.pixel_size();
    const double far = plan.grid.diagonal_px * side;
    double worst = 0;
    int wrong = 0;
    int ties = 0;
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) {
            const Point p = pixel_centre(scene, plan, x, y);
            const FieldValue exact = exact_field(scene.shapes, p, far);
            const std::size_t i = field.index(x, y);
            double error = std::abs(double(field.distance[i]) - exact.distance / side);
            if (exact.distance < 0 && inside_bound > 0) error *= bound / inside_bound;
            if (!(error <= bound) && wrong == 0)
                ADD_FAILURE() << what << ": distance " << field.distance[i] << " instead of " << exact.distance / side
                              << " at grid pixel " << x << ", " << y;
            worst = std::max(worst, error);
            if (field.material[i] != exact.shape) {
                if (is_tie(scene.shapes, p, 2 * bound * side)) ++ties;
                else if (++wrong == 1)
                    ADD_FAILURE() << what << ": shape " << field.material[i] << " instead of " << exact.shape
                                  << " at grid pixel " << x << ", " << y;
            }
        }
    EXPECT_LE(worst, bound) << what;
    EXPECT_LE(ties, field.size.x + field.size.y) << what << ": too much is called a tie";
}

Polygon pentagram() {
    Polygon star;
    for (int i = 0; i < 5; ++i) {
        const double a = 2 * std::numbers::pi * (2 * i) / 5 + 0.1;
        star.points.push_back({18.3 + 12 * std::cos(a), 14.1 + 12 * std::sin(a)});
    }
    return star;
}

TEST(Distance, EveryTypeAsInDoublePrecision) {
    const std::pair<const char*, Geometry> cases[] = {
        {"circle", Circle{{18.3, 14.1}, 6.2}},
        {"a circle smaller than a pixel", Circle{{18.3, 14.1}, 0.2}},
        {"ellipse", Ellipse{{18.3, 14.1}, {11, 4}, 33}},
        {"upright ellipse", Ellipse{{18.3, 14.1}, {3, 9}, 0}},
        {"round ellipse", Ellipse{{18.3, 14.1}, {7, 7}, 12}},
        {"ellipse on pixel centres", Ellipse{{18.5, 14.5}, {12, 5}, 0}},
        {"rect", Rect{{18.3, 14.1}, {17, 6}, -27, 0}},
        {"rect with corners", Rect{{18.3, 14.1}, {17, 8}, 64, 2.5}},
        {"rect as a stadium", Rect{{18.3, 14.1}, {17, 6}, 90, 3}},
        {"line", Line{{3.1, 4.2}, {30.7, 22.9}, 3}},
        {"line of no length", Line{{13.1, 14.2}, {13.1, 14.2}, 5}},
        {"hairline", Line{{3.1, 4.2}, {30.7, 22.9}, 0.05}},
        {"polyline", Polyline{{{3.1, 4.2}, {30.7, 6.9}, {12.2, 25.3}}, 2.2, false}},
        {"closed polyline", Polyline{{{3.1, 4.2}, {30.7, 6.9}, {12.2, 25.3}}, 2.2, true}},
        {"polygon", Polygon{{{3.1, 4.2}, {30.7, 6.9}, {20.2, 12.1}, {12.2, 25.3}}}},
        {"polygon that crosses itself", pentagram()},
        {"polygon with a hole and a piece apart",
         Polygon{{{3.1, 4.2}, {24.7, 3.9}, {22.2, 25.1}, {4.2, 24.3}, {8.1, 9.2}, {17.3, 8.8}, {15.2, 18.3}, {27.1, 20.2}, {34.2, 21.7}, {29.3, 27.1}}, {4, 7}}},
        {"outside the view", Circle{{-40, 70}, 9}},
    };
    // Numbers stay below 100, where a float's steps are 4e-6; a few operations each.
    for (const auto& [what, geometry] : cases) expect_exact(with(canvas(37, 29), {shape(geometry)}), 5e-5, what);
}

TEST(Distance, EllipseNeedles) {
    // Needles lose digits (the ratio of the axes squared); what matters is that steps by it stay safe.
    for (const double thin : {0.3, 0.05, 0.005})
        for (const double angle : {0.0, 31.0, 90.0})
            expect_exact(with(canvas(37, 29), {shape(Ellipse{{18.3, 14.1}, {16, thin}, angle})}), 2e-3,
                         "needle of " + std::to_string(thin) + " at " + std::to_string(angle));
}

TEST(Distance, EllipsesOfEveryShape) {
    Numbers numbers(7);
    for (int i = 0; i < 40; ++i) {
        const double longer = std::pow(10, numbers.between(-0.5, 2.3));
        const double shorter = longer * std::pow(10, numbers.between(-2, 0));
        const Ellipse e{{numbers.between(-5, 42), numbers.between(-5, 34)}, {longer, shorter}, numbers.between(0, 360)};
        // Relative to the ellipse: a float has 1e-7 of that, and the root is found to a few of those. Deep inside, on the
        // evolute, two roots meet and digits go; nothing is marched there.
        const double size = std::max(10.0, longer);
        expect_exact(with(canvas(37, 29), {shape(e)}), 2e-5 * size, "ellipse " + std::to_string(i), 5e-4 * size);
    }
}

TEST(Distance, TheTopmostShapeCounts) {
    const Circle circle{{16.3, 14.2}, 9};
    const Rect rect{{21.4, 15.1}, {14, 9}, 20, 0};
    const Line line{{2.2, 3.1}, {33.3, 25.4}, 4};
    expect_exact(with(canvas(37, 29), {shape(circle), shape(rect), shape(line)}), 5e-5, "circle below");
    expect_exact(with(canvas(37, 29), {shape(line), shape(rect), shape(circle)}), 5e-5, "circle on top");
    expect_exact(with(canvas(37, 29), {shape(circle), shape(circle)}), 5e-5, "the same twice");
    // A small shape deep in a large one, first below, then on top.
    expect_exact(with(canvas(37, 29), {shape(Circle{{16, 14}, 2}), shape(Circle{{16, 14}, 11})}), 5e-5, "hidden");
    expect_exact(with(canvas(37, 29), {shape(Circle{{16, 14}, 11}), shape(Circle{{16, 14}, 2})}), 5e-5, "inset");
}

TEST(Distance, ManyShapesNoneIgnored) {
    // Errata E-1: the seed ignored all shapes from the 65th on.
    Numbers numbers(3);
    Scene scene = canvas(53, 31);
    for (int i = 0; i < 300; ++i)
        scene.shapes.push_back(shape(Circle{{numbers.between(0, 53), numbers.between(0, 31)}, numbers.between(0.2, 1.5)}));
    expect_exact(scene, 5e-5, "300 circles");
}

TEST(Distance, ViewMarginAndScale) {
    Scene scene = with(canvas(33, 22), {shape(Circle{{1000.41, -499.13}, 0.35}), shape(Rect{{1000.9, -499.4}, {0.5, 0.2}, 15, 0})});
    scene.canvas.view = ViewRect{1000, -500, 1.5, 1};
    scene.canvas.margin = 0.31;
    expect_exact(scene, 5e-5, "a view a million pixels from the origin");
}

TEST(Distance, AnyExtent) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 70), std::pair(70, 1), std::pair(16, 4), std::pair(17, 5)})
        expect_exact(with(canvas(width, height), {shape(Circle{{3.3, 2.2}, 1.7})}), 5e-5,
                     std::to_string(width) + "x" + std::to_string(height));
}

TEST(Distance, SlicesAndBandsChangeNothing) {
    Numbers numbers(5);
    Scene scene = canvas(61, 43);
    for (int i = 0; i < 30; ++i) {
        const Point at{numbers.between(0, 61), numbers.between(0, 43)};
        scene.shapes.push_back(shape(Circle{at, numbers.between(0.5, 6)}));
        scene.shapes.push_back(shape(Polyline{{at, at + Point(4, 1), at + Point(1, 5)}, 0.7, true}));
    }
    Plan plan = pass_plan(scene);
    plan.list_shapes = false;
    ASSERT_EQ(plan.shape_slices.size(), 1u);
    const Field whole = run_distance(scene, plan);
    plan.shape_slices = {{0, 1}, {1, 22}, {22, 23}, {23, 60}};
    const Field sliced = run_distance(scene, plan, PassSettings{700, 0, 0});
    EXPECT_EQ(whole.distance, sliced.distance);
    EXPECT_EQ(whole.material, sliced.material);
}

// Every program of the device writes inside its extent only: see also the bands above.
TEST(Distance, WritesNothingOutsideItsExtent) {
    shared_context();
    const Scene scene = with(canvas(37, 29), {shape(Circle{{18.3, 14.1}, 6.2})});
    const Plan plan = pass_plan(scene);
    const SceneBuffers buffers(pack_scene(scene, 1), scene.sky, plan);
    buffers.bind();
    DistanceField field{gl::Texture2D(GL_R32F, {64, 48}), gl::Texture2D(GL_R32I, {64, 48})};
    const float sentinel = -1234.5f;
    const int sentinel_shape = -77;
    field.distance.fill(GL_RED, GL_FLOAT, &sentinel);
    field.material.fill(GL_RED_INTEGER, GL_INT, &sentinel_shape);
    field.distance.bind_image(glsl::kDistanceImageBinding, GL_READ_WRITE);
    field.material.bind_image(glsl::kMaterialImageBinding, GL_READ_WRITE);
    glsl::DistanceParams params{};
    params.extent = {37, 29};
    params.end_shape = 1;
    params.far_px = 47;
    gl::ComputeProgram program("distance.comp", sizeof params, shader_dir());
    program.dispatch(params, params.extent, 37 * 8);
    const Field written = read_field(field);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const std::size_t i = written.index(x, y);
            const bool inside = x < 37 && y < 29;
            EXPECT_EQ(written.distance[i] != sentinel, inside) << x << ", " << y;
            EXPECT_EQ(written.material[i] != sentinel_shape, inside) << x << ", " << y;
        }
}

TEST(Distance, EmptyFieldIsAsFarAsTheDiagonal) {
    shared_context();
    const Plan plan = pass_plan(canvas(4096, 300));
    const Field field = read_field(DistancePass::empty_field(plan));
    EXPECT_EQ(field.size, glm::ivec2(1));
    EXPECT_FLOAT_EQ(field.distance[0], std::hypot(4096.0f, 300.0f));
    EXPECT_EQ(field.material[0], -1);
}

}  // namespace
}  // namespace penumbra::test
