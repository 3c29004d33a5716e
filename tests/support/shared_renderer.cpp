// SPDX-License-Identifier: MIT
#include "tests/support/shared_renderer.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "core/scene/validate.h"

namespace penumbra::test {
namespace {

std::unique_ptr<Renderer> renderer;

class DestroyRenderer : public testing::Environment {
public:
    void TearDown() override { renderer.reset(); }
};

const testing::Environment* const kDestroyRenderer = testing::AddGlobalTestEnvironment(new DestroyRenderer);

void check(const Scene& scene) {
    for (const Problems& problems : {validate(scene), unsupported(scene, {.tone_lut = true})})
        for (const Problem& problem : problems)
            throw std::logic_error("the test's scene is wrong: " + problem.pointer + " " + problem.message);
}

}  // namespace

RendererOptions test_options() {
    RendererOptions options;
    if (const char* device = std::getenv("PENUMBRA_TEST_DEVICE")) options.device = device;
    if (const char* folder = std::getenv("PENUMBRA_TEST_SHADERS")) options.shader_dir = folder;
    options.tone_lut = std::make_shared<const ToneLut>(table_of_places());
    return options;
}

ToneLut table_of_places() {
    constexpr int kSide = 5;
    ToneLut lut{kSide, {}};
    for (int b = 0; b < kSide; ++b)
        for (int g = 0; g < kSide; ++g)
            for (int r = 0; r < kSide; ++r) lut.texels.push_back(glm::vec3(r, g, b) / float(kSide - 1));
    return lut;
}

Renderer& shared_renderer() {
    if (!renderer) renderer = std::make_unique<Renderer>(test_options());
    return *renderer;
}

ImageF render_linear(Scene scene) {
    scene.output.format = "pfm";
    check(scene);
    return std::get<ImageF>(shared_renderer().render(scene).picture);
}

Image16 render_display16(Scene scene) {
    scene.output.format = "png";
    scene.output.bit_depth = 16;
    check(scene);
    return std::get<Image16>(shared_renderer().render(scene).picture);
}

Image8 render_display(Scene scene) {
    scene.output.format = "png";
    check(scene);
    return std::get<Image8>(shared_renderer().render(scene).picture);
}

}  // namespace penumbra::test
