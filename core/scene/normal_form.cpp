// SPDX-License-Identifier: MIT
#include "core/scene/normal_form.h"

#include "core/scene/archive.h"

namespace penumbra {

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
    auto& [points] = shape;
    archive(points);
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
void fields(A& archive, Like<A, Shape>& shape) {
    auto& [geometry, emission, albedo] = shape;
    archive(geometry, emission, albedo);
}
template <class A>
void fields(A& archive, Like<A, PointLight>& light) {
    auto& [position, intensity] = light;
    archive(position, intensity);
}
template <class A>
void fields(A& archive, Like<A, SpotLight>& light) {
    auto& [position, direction, inner, outer, intensity] = light;
    archive(position, direction, inner, outer, intensity);
}
template <class A>
void fields(A& archive, Like<A, DirectionalLight>& light) {
    auto& [direction, irradiance] = light;
    archive(direction, irradiance);
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
void fields(A& archive, Like<A, Canvas>& canvas) {
    auto& [width, height, view, margin, floor] = canvas;
    archive(width, height);
    // One that is left out is the same as one that says the default.
    if constexpr (A::kReads) {
        archive(view.emplace());
    } else {
        archive(canvas.view_or_default());
        (void)view;
    }
    archive(margin, floor);
}
template <class A>
void fields(A& archive, Like<A, RenderSettings>& render) {
    auto& [method, quality, bounces, skip, view] = render;
    archive(method, quality, bounces, skip, view);
}
template <class A>
void fields(A& archive, Like<A, OutputSettings>& output) {
    auto& [format, depth, antialias, solids, exposure, tonemap] = output;
    archive(format, depth, antialias, solids, exposure, tonemap);
}
template <class A>
void fields(A& archive, Like<A, Scene>& scene) {
    auto& [canvas, sky, shapes, lights, render, output] = scene;
    archive(canvas, sky, shapes, lights, render, output);
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
