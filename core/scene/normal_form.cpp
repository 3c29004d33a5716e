// SPDX-License-Identifier: MIT
#include "core/scene/normal_form.h"

#include "core/scene/archive.h"
#include "core/scene/words.h"

namespace penumbra {
namespace {

template <class R>
bool same(const R& a, const R& b) {
    return a.x == b.x && a.y == b.y && a.w == b.w && a.h == b.h;
}

}  // namespace

// Every struct is taken apart whole: a member that is added to one makes its line here an error, instead of a picture that
// is given for a scene it was not rendered from.

template <class A>
void fields(A& archive, Like<A, Circle>& shape) {
    auto& [center, radius] = shape;
    archive(center, radius);
}
template <class A>
void fields(A& archive, Like<A, Ellipse>& shape) {
    auto& [center, radii, rotation] = shape;
    archive(center, radii, rotation);
}
template <class A>
void fields(A& archive, Like<A, Rect>& shape) {
    auto& [center, size, rotation, corner] = shape;
    archive(center, size, rotation, corner);
}
template <class A>
void fields(A& archive, Like<A, Line>& shape) {
    auto& [from, to, width] = shape;
    archive(from, to, width);
}
template <class A>
void fields(A& archive, Like<A, Polyline>& shape) {
    auto& [points, width, closed] = shape;
    archive(points, width, closed);
}
template <class A>
void fields(A& archive, Like<A, Polygon>& shape) {
    auto& [points, ring_starts, key] = shape;
    (void)key;  // how it was written is not what it is
    archive(points, ring_starts);
}
template <class A>
void fields(A& archive, Like<A, Texels>& texels) {
    auto& [width, height, rgba] = texels;
    archive(width, height, rgba);
}
template <class A>
void fields(A& archive, Like<A, Bitmap>& shape) {
    auto& [image, position, size, emission, above, albedo] = shape;
    archive(image, position, size, emission, above, albedo);
}
template <class A>
void fields(A& archive, Like<A, EmissionStop>& stop) {
    auto& [at, emission] = stop;
    archive(at, emission);
}
template <class A>
void fields(A& archive, Like<A, Shape>& shape) {
    auto& [geometry, emission, albedo, gradient, medium] = shape;
    archive(geometry, emission, albedo, gradient, medium);
}
template <class A>
void fields(A& archive, Like<A, Medium>& medium) {
    auto& [extinction, emission] = medium;
    archive(extinction, emission);
}
template <class A>
void fields(A& archive, Like<A, PointLight>& light) {
    auto& [position, intensity, radius, unit, height] = light;
    archive(position, intensity, radius, unit, height);
}
template <class A>
void fields(A& archive, Like<A, SpotLight>& light) {
    auto& [position, direction, inner, outer, intensity, unit, height, tilt] = light;
    archive(position, direction, inner, outer, intensity, unit, height, tilt);
}
template <class A>
void fields(A& archive, Like<A, DirectionalLight>& light) {
    auto& [direction, irradiance, elevation] = light;
    archive(direction, irradiance, elevation);
}
template <class A>
void fields(A& archive, Like<A, SkyStop>& stop) {
    auto& [angle, radiance] = stop;
    archive(angle, radiance);
}
template <class A>
void fields(A& archive, Like<A, Sky>& sky) {
    auto& [radiance, gradient] = sky;
    archive(radiance, gradient);
}
template <class A>
void fields(A& archive, Like<A, ViewRect>& view) {
    auto& [x, y, w, h] = view;
    archive(x, y, w, h);
}
template <class A>
void fields(A& archive, Like<A, PixelRect>& rect) {
    auto& [x, y, w, h] = rect;
    archive(x, y, w, h);
}

template <class A>
void fields(A& archive, Like<A, Gloss>& gloss) {
    auto& [roughness, metallic, reflectance] = gloss;
    archive(roughness, metallic, reflectance);
}
template <class A>
void fields(A& archive, Like<A, FloorMaterial>& material) {
    auto& [image, normals, tile, gloss] = material;
    archive(image, normals, tile, gloss);
}

// What is left out is the same as what says the default: it is written out, and left out again when it is read.
template <class A, class T>
void with_default(A& archive, Like<A, std::optional<T>>& value, const T& standard) {
    if constexpr (A::kReads) {
        archive(value.emplace());
        if (*value == standard) value.reset();
    } else {
        archive(value.value_or(standard));
    }
}

template <class A>
void fields(A& archive, Like<A, Canvas>& canvas) {
    auto& [width, height, region, view, margin, floor, material] = canvas;
    archive(width, height);
    const PixelRect all{0, 0, width, height};
    const ViewRect pixels{0, 0, double(width), double(height)};
    if constexpr (A::kReads) {
        archive(region.emplace(), view.emplace());
        if (same(*region, all)) region.reset();
        if (same(*view, pixels)) view.reset();
    } else {
        archive(region.value_or(all), view.value_or(pixels));
    }
    archive(margin, floor, material);
}
template <class A>
void fields(A& archive, Like<A, RenderSettings>& render) {
    auto& [method, quality, bounces, converged, tolerance, skip, keep, view] = render;
    archive(method, quality, bounces, converged, tolerance, skip, keep, view);
}
template <class A>
void fields(A& archive, Like<A, Camera>& camera) {
    auto& [aperture, shutter, iso] = camera;
    archive(aperture, shutter, iso);
}
template <class A>
void fields(A& archive, Like<A, OutputSettings>& output) {
    auto& [format, depth, antialias, solids, exposure, camera, key, tonemap, look, white, dither] = output;
    archive(format);
    // A depth that the format has not is its own.
    if constexpr (A::kReads) {
        archive(depth.emplace());
        if (bit_depths_of(format).empty()) depth.reset();
    } else {
        archive(bit_depth_of(format, depth));
    }
    archive(antialias, solids, exposure, camera, key, tonemap);
    with_default<A, std::string>(archive, look, "none");
    with_default<A, double>(archive, white, kDefaultWhite);
    archive(dither);
}
template <class A>
void fields(A& archive, Like<A, Scene>& scene) {
    auto& [canvas, sky, shapes, lights, render, output, media] = scene;
    archive(canvas, sky, shapes, lights, render, output, media);
}

std::string normal_form(const Scene& scene) {
    ByteWriter writer;
    writer(scene);
    return writer.take();
}

std::optional<Scene> read_normal_form(std::string_view bytes) {
    ByteReader reader(bytes);
    Scene scene;
    reader(scene);
    if (!reader.at_end()) return std::nullopt;
    return scene;
}

}  // namespace penumbra
