// SPDX-License-Identifier: MIT
#include "server/service/warm_up.h"

#include <array>
#include <memory>

namespace penumbra {
namespace {

// Sides that are powers of two make other textures than sides that are not.
struct Size {
    const char* name;
    int width, height;
};
constexpr std::array<Size, 4> kSizes{{{"64x64", 64, 64}, {"72x56", 72, 56}, {"64x56", 64, 56}, {"72x64", 72, 64}}};
constexpr std::size_t kCommonSizes = 2;

enum class Sky3 { none, constant, gradient };

// What `exact` compiles apart (core/passes/exact_pass.cpp): whether there are arcs and ellipses, and the kind of sky.
Scene scene_of(bool arcs, bool ellipses, Sky3 sky, const Size& size) {
    Scene scene;
    scene.canvas.width = size.width;
    scene.canvas.height = size.height;
    const auto add = [&](Geometry geometry, double emission) {
        scene.shapes.push_back({std::move(geometry), Colour(emission), Colour(0)});
    };
    add(Circle{{20.3, 21.7}, 5.1}, 2);
    add(Rect{{45.4, 33.6}, {4.2, 17.3}, 11, 0}, 0);
    add(Rect{{33.3, 12.2}, {3.1, 2.2}, 0, 0}, 0);
    // Two discs that overlap; one alone is solved whole.
    if (arcs) {
        add(Circle{{14.2, 44.1}, 5.2}, 0.5);
        add(Circle{{20.1, 46.4}, 4.4}, 0.5);
    }
    if (ellipses) add(Ellipse{{54.2, 14.6}, {6.3, 3.4}, 31}, 0.5);
    if (sky == Sky3::constant) scene.sky.radiance = Colour(0.1);
    if (sky == Sky3::gradient) scene.sky.gradient = {{0, Colour(0.1)}, {180, Colour(0.3)}};
    return scene;
}

// Beyond some fifty pieces of outline `exact` makes its lists in two steps.
Scene crowded(Scene scene) {
    for (int i = 0; i < 14; ++i) {
        scene.shapes.push_back({Rect{{3.2 + 4 * i, 53.4 - 3.1 * (i % 2)}, {1.7, 1.3}, 0, 0}, Colour(0), Colour(0)});
    }
    return scene;
}

Scene dark(Scene scene) {
    for (Shape& shape : scene.shapes) shape.emission = Colour(0);
    return scene;
}

std::shared_ptr<const Texels> texel(std::uint8_t r, std::uint8_t g, std::uint8_t b) { return std::make_shared<Texels>(Texels{1, 1, {r, g, b, 255}}); }

// One light of each kind, of flatland and above it.
Scene with_lights(Scene scene) {
    scene.lights.push_back(PointLight{{30, 20}, Colour(3)});
    SpotLight spot{{50, 20}, 90, 10, 20, Colour(30)};
    spot.unit = LightUnit::candela;
    spot.height = 5;
    scene.lights.push_back(spot);
    scene.lights.push_back(DirectionalLight{100, Colour(0.2)});
    return scene;
}

Scene with_bounces(Scene scene) {
    for (Shape& shape : scene.shapes) shape.albedo = Colour(0.5);
    scene.render.bounces = 1;
    return scene;
}

Scene with_floor(Scene scene, bool relief, bool gloss) {
    scene.canvas.floor.image = texel(200, 180, 160);
    if (relief) scene.canvas.floor.normals = texel(150, 128, 240);
    if (gloss) scene.canvas.floor.gloss = Gloss{};
    return scene;
}

Scene with_gradient(Scene scene) {
    Shape stroke;
    stroke.geometry = Line{{8, 30}, {40, 36}, 2};
    stroke.gradient = {{0, Colour(1)}, {1, Colour(3)}};
    scene.shapes.push_back(std::move(stroke));
    return scene;
}

Geometry bitmap() {
    auto texels = std::make_shared<Texels>(Texels{4, 4, {}});
    for (int i = 0; i < 16; ++i) {
        const std::uint8_t value = i % 3 == 0 ? 255 : 0;
        texels->rgba.insert(texels->rgba.end(), {value, value, value, value});
    }
    Bitmap geometry;
    geometry.image = std::move(texels);
    geometry.position = {44, 38};
    geometry.size = {11, 11};
    return geometry;
}

}  // namespace

std::vector<WarmUpScene> warm_up_scenes(WarmUp extent) {
    std::vector<WarmUpScene> scenes;
    if (extent == WarmUp::none) return scenes;
    const bool all = extent == WarmUp::all;
    constexpr std::array<const char*, 3> kSkies{"no sky", "sky", "gradient"};
    for (std::size_t s = 0; s < (all ? kSizes.size() : kCommonSizes); ++s) {
        const Size& size = kSizes[s];
        const auto add = [&](const std::string& name, Scene scene) { scenes.push_back({name + " " + size.name, std::move(scene)}); };
        for (const bool ellipses : {false, true}) {
            for (const bool arcs : {false, true}) {
                for (std::size_t sky = 0; sky < kSkies.size(); ++sky) {
                    // Gradients and ellipses are rarer, and rare together.
                    if (!all && ((arcs || ellipses) && sky == 2)) continue;
                    if (!all && ellipses && (arcs || sky > 0)) continue;
                    add(std::string(arcs ? "arcs, " : "") + (ellipses ? "ellipses, " : "") + kSkies[sky],
                        scene_of(arcs, ellipses, Sky3(sky), size));
                }
            }
        }
        add("dark", dark(scene_of(false, false, Sky3::none, size)));
        add("many pieces", crowded(scene_of(false, false, Sky3::none, size)));
        add("many pieces, arcs", crowded(scene_of(true, false, Sky3::none, size)));
        Scene picture = scene_of(false, false, Sky3::none, size);
        picture.shapes.push_back({bitmap(), Colour(0), Colour(0)});
        picture.output.format = "pfm";
        add("bitmap, linear", std::move(picture));
        // Programs for these are large: without arcs, and with a sky only where all is asked for.
        for (std::size_t sky = 0; sky < (all ? kSkies.size() : 1); ++sky) {
            const Scene scene = scene_of(false, false, Sky3(sky), size);
            const std::string kind = kSkies[sky];
            add("bounces, lights, " + kind, with_bounces(with_lights(scene)));
            add("relief, lights, " + kind, with_floor(with_lights(scene), true, false));
            if (all) add("gloss, lights, " + kind, with_floor(with_lights(scene), true, true));
            add("gradient of emission, " + kind, with_gradient(scene));
        }
        add("floor picture", with_floor(scene_of(false, false, Sky3::none, size), false, false));
        for (const Quality quality : {Quality::standard, Quality::draft, Quality::high}) {
            for (const char* method : {"hrc", "rc", "rc_fix"}) {
                // What `auto` takes for dense scenes.
                if (!all && (quality != Quality::standard || method != std::string_view("hrc"))) continue;
                Scene scene = scene_of(true, false, Sky3::constant, size);
                scene.render.method = method;
                scene.render.quality = quality;
                constexpr std::array<const char*, 3> kQualities{"draft", "standard", "high"};
                add(std::string(method) + " " + kQualities[std::size_t(quality)], std::move(scene));
            }
        }
    }
    return scenes;
}

}  // namespace penumbra
