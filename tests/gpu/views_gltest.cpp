// SPDX-License-Identifier: MIT
// Debug views: what their colours say, where it can be said in closed form. Legends stand in the lower left corner.
#include <gtest/gtest.h>

#include <cmath>

#include "core/views/canvas.h"
#include "tests/support/build_scene.h"
#include "tests/support/pictures.h"
#include "tests/support/shared_renderer.h"

namespace penumbra::test {
namespace {

Image8 view_of(Scene scene, const char* view) {
    scene.render.view = view;
    return render_display(scene);
}

bool is_white(const std::uint8_t* p) { return p[0] == 255 && p[1] == 255 && p[2] == 255; }

TEST(Views, DistanceIsWhiteOnOutlinesWarmInsideColdOutside) {
    const Circle disc{{60.3, 40.2}, 20.4};
    const Image8 picture = view_of(with(canvas(120, 90), {shape(disc)}), "distance");
    for (int y = 0; y < 56; ++y)
        for (int x = 0; x < 120; ++x) {
            const double d = std::hypot(x + 0.5 - 60.3, y + 0.5 - 40.2) - 20.4;
            const std::uint8_t* p = picture.at(x, y);
            if (std::abs(std::abs(d) - 0.75) < 0.01) continue;
            EXPECT_EQ(is_white(p), std::abs(d) < 0.75) << x << " " << y;
            if (std::abs(d) < 0.75) continue;
            if (d < 0)
                EXPECT_GT(p[0], p[2]) << x << " " << y;
            else
                EXPECT_LT(p[0], p[2]) << x << " " << y;
        }
}

TEST(Views, ContoursStandWhereTheLegendSays) {
    // A disc in the corner: the farthest pixel is 158 from it, so that contours are 20 apart. They are darker than both sides.
    const Image8 picture = view_of(with(canvas(120, 120), {shape(Circle{{0.5, 0.5}, 10})}), "distance");
    const auto sum = [&](int x) { return picture.at(x, 0)[0] + picture.at(x, 0)[1] + picture.at(x, 0)[2]; };
    for (const int contour : {20, 40, 60, 100}) {
        const int x = 10 + contour;  // the centre of pixel x is x away from the disc's
        EXPECT_LT(sum(x), 0.7 * sum(x - 3)) << contour;
        EXPECT_LT(sum(x), 0.8 * sum(x + 3)) << contour;
    }
    EXPECT_GT(sum(10 + 30), 0.9 * sum(10 + 33)) << "none half way";
}

TEST(Views, NormalsAreHuesOfTheDirection) {
    const Image8 picture = view_of(with(canvas(120, 120), {shape(Circle{{60, 50}, 8})}), "normals");
    for (const double degrees : {0.0, 60.0, 200.0, 300.0}) {
        const double angle = degrees * 3.14159265358979 / 180;
        const int x = int(60 + 30 * std::cos(angle)), y = int(50 + 30 * std::sin(angle));
        const double exact = std::atan2(y + 0.5 - 50, x + 0.5 - 60) / 6.283185307179586;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.at(x, y)[c], 255 * hue(exact)[c], 6) << degrees;
    }
}

TEST(Views, TilesCountShapes) {
    // Two far apart: beside the one nobody asks for the other; half way between both may be nearest.
    const Scene scene = with(canvas(200, 48), {shape(Circle{{20, 12}, 5}), shape(Circle{{180, 12}, 5})});
    const Image8 picture = view_of(scene, "tiles");
    const auto near = [&](int x, int y, double count) {
        const glm::dvec3 colour = heat(count - 1);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.at(x, y)[c], 255 * colour[c], 1) << x << " " << y;
    };
    near(5, 3, 1);
    near(195, 3, 1);
    near(100, 3, 2);
}

TEST(Views, EmptyScenesAndLonelyShapesAreViewedToo) {
    for (const char* view : {"distance", "normals", "tiles"}) {
        EXPECT_EQ(view_of(canvas(30, 20), view).width, 30);
        Scene one = with(canvas(31, 20), {shape(Circle{{10, 10}, 4})});
        one.canvas.margin = 9;
        EXPECT_EQ(view_of(one, view).height, 20);
    }
}

// The legend: dark box, light letters, within the picture.
TEST(Views, HaveALegend) {
    for (const char* view : {"distance", "normals", "tiles"}) {
        const Image8 picture = view_of(with(canvas(260, 160), {shape(Circle{{130, 60}, 20}), shape(Circle{{200, 60}, 9})}), view);
        int dark = 0, light = 0;
        for (int y = 110; y < 160; ++y)
            for (int x = 0; x < 130; ++x) {
                const std::uint8_t* p = picture.at(x, y);
                dark += p[0] + p[1] + p[2] == 0;
                light += is_white(p);
            }
        EXPECT_GT(dark, 1000) << view;
        EXPECT_GT(light, 100) << view;
    }
}

}  // namespace
}  // namespace penumbra::test
