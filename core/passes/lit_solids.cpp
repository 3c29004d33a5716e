// SPDX-License-Identifier: MIT
#include "core/passes/lit_solids.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>

#include "core/film/encode.h"
#include "core/plan/nearest_free.h"
#include "core/plan/skip.h"

namespace penumbra {
namespace {

Colour albedo_at(const Shape& shape, Point p) {
    const auto* bitmap = std::get_if<Bitmap>(&shape.geometry);
    if (bitmap == nullptr) return shape.albedo;
    if (!bitmap->as_albedo) return Colour(0);
    const Texels& image = *bitmap->image;
    const glm::dvec2 place = (p - bitmap->position) / bitmap->size * glm::dvec2(image.width, image.height);
    const int x = std::clamp(int(place.x), 0, image.width - 1), y = std::clamp(int(place.y), 0, image.height - 1);
    const std::uint8_t* texel = &image.rgba[4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x))];
    return Colour(srgb_decoded(texel[0] / 255.0), srgb_decoded(texel[1] / 255.0), srgb_decoded(texel[2] / 255.0)) * bitmap->emission_scale;
}

template <class T>
std::vector<T> read(const gl::Texture2D& texture, GLenum format, GLenum type, std::size_t channels) {
    std::vector<T> values(std::size_t(texture.size().x) * std::size_t(texture.size().y) * channels);
    texture.read(format, type, values.data());
    return values;
}

}  // namespace

gl::Texture2D black_texel() {
    const float black[4] = {};
    gl::Texture2D texture(GL_RGBA32F, {1, 1});
    texture.fill(GL_RGBA, GL_FLOAT, black);
    return texture;
}

gl::Texture2D lit_solids(const Plan& plan, const Scene& scene, const FrameLight& light) {
    if (plan.shape_slices.empty() || std::none_of(scene.shapes.begin(), scene.shapes.end(), reflects)) return black_texel();
    const auto distances = read<float>(light.field.distance, GL_RED, GL_FLOAT, 1);
    const auto materials = read<std::int32_t>(light.field.material, GL_RED_INTEGER, GL_INT, 1);
    const auto radiance = read<float>(*light.radiance, GL_RGBA, GL_FLOAT, 4), lights = read<float>(*light.lights, GL_RGBA, GL_FLOAT, 4);
    const glm::ivec2 size = plan.canvas;
    // One texel stands for a light that is the same everywhere.
    const auto sample = [](const gl::Texture2D& texture, const std::vector<float>& values, glm::ivec2 at, std::size_t channel) {
        at = glm::min(at, texture.size() - 1);
        return double(values[4 * (std::size_t(at.y) * std::size_t(texture.size().x) + std::size_t(at.x)) + channel]);
    };
    const auto in_grid = [&](int x, int y) {
        return std::size_t(y + plan.grid.border.y) * std::size_t(plan.grid.size.x) + std::size_t(x + plan.grid.border.x);
    };
    std::vector<std::uint8_t> solid(std::size_t(size.x) * std::size_t(size.y));
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) solid[std::size_t(y) * std::size_t(size.x) + std::size_t(x)] = distances[in_grid(x, y)] <= 0 ? 1 : 0;
    const std::vector<glm::ivec2> nearest = nearest_free(solid, size);
    if (nearest.empty()) return black_texel();
    const ViewRect view = scene.canvas.view_or_default();
    const double pixel = scene.canvas.pixel_size();
    std::vector<float> lit(4 * solid.size(), 0.0f);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(size.x) + std::size_t(x);
            const std::int32_t shape = materials[in_grid(x, y)];
            if (shape < 0) continue;
            const Colour albedo = albedo_at(scene.shapes[std::size_t(shape)], {view.x + (x + 0.5) * pixel, view.y + (y + 0.5) * pixel});
            for (std::size_t c = 0; c < 3; ++c) {
                const double arriving = plan.radiance_scale * sample(*light.radiance, radiance, nearest[i], c) + sample(*light.lights, lights, nearest[i], c);
                lit[4 * i + c] = static_cast<float>(albedo[int(c)] * arriving);
            }
        }
    gl::Texture2D texture(GL_RGBA32F, size);
    texture.write(GL_RGBA, GL_FLOAT, lit.data());
    return texture;
}

}  // namespace penumbra
