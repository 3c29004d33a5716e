// SPDX-License-Identifier: MIT
#include "core/scene/normal_form.h"

#include <bit>
#include <cstring>
#include <type_traits>

#include "core/scene/words.h"

namespace penumbra {
namespace {

// Every struct is taken apart whole: a member that is added to one makes its line here an error, instead of a picture that
// is given for a scene it was not rendered from.
class Writer {
public:
    void put(double value) { put_word(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value)); }  // -0 is 0
    void put(const std::string& text) {
        put_word(text.size());
        bytes_ += text;
    }
    template <class T>
        requires(std::is_integral_v<T> || std::is_enum_v<T>)
    void put(T value) {
        put_word(std::uint64_t(std::int64_t(value)));
    }
    void put(const glm::dvec2& v) { put_all(v.x, v.y); }
    void put(const glm::dvec3& v) { put_all(v.x, v.y, v.z); }
    template <class T>
    void put(const std::vector<T>& list) {
        put_word(list.size());
        for (const T& item : list) put(item);
    }
    template <class T>
    void put(const std::optional<T>& value) {
        put_word(value.has_value());
        if (value) put(*value);
    }
    template <class... T>
    void put(const std::variant<T...>& value) {
        put_word(value.index());
        std::visit([&](const auto& held) { put(held); }, value);
    }

    void put(const Circle& shape) {
        const auto& [center, radius] = shape;
        put_all(center, radius);
    }
    void put(const Ellipse& shape) {
        const auto& [center, radii, rotation] = shape;
        put_all(center, radii, rotation);
    }
    void put(const Rect& shape) {
        const auto& [center, size, rotation, corner] = shape;
        put_all(center, size, rotation, corner);
    }
    void put(const Line& shape) {
        const auto& [from, to, width] = shape;
        put_all(from, to, width);
    }
    void put(const Polyline& shape) {
        const auto& [points, width, closed] = shape;
        put_all(points, width, closed);
    }
    void put(const Polygon& shape) {
        const auto& [points, ring_starts, key] = shape;
        (void)key;  // how it was written is not what it is
        put_all(points, ring_starts);
    }
    void put(const Bitmap& shape) {
        const auto& [image, position, size, emission, above, albedo] = shape;
        put_word(image != nullptr);
        if (image) put(*image);
        put_all(position, size, emission, above, albedo);
    }
    void put(const Texels& texels) {
        const auto& [width, height, rgba] = texels;
        put_all(width, height);
        put_word(rgba.size());
        bytes_.append(reinterpret_cast<const char*>(rgba.data()), rgba.size());
    }
    void put(const Shape& shape) {
        const auto& [geometry, emission, albedo, medium] = shape;
        put_all(geometry, emission, albedo, medium);
    }
    void put(const Medium& medium) {
        const auto& [extinction, emission] = medium;
        put_all(extinction, emission);
    }
    void put(const PointLight& light) {
        const auto& [position, intensity, radius] = light;
        put_all(position, intensity, radius);
    }
    void put(const SpotLight& light) {
        const auto& [position, direction, inner, outer, intensity] = light;
        put_all(position, direction, inner, outer, intensity);
    }
    void put(const DirectionalLight& light) {
        const auto& [direction, irradiance] = light;
        put_all(direction, irradiance);
    }
    void put(const SkyStop& stop) {
        const auto& [angle, radiance] = stop;
        put_all(angle, radiance);
    }
    void put(const Sky& sky) {
        const auto& [radiance, gradient] = sky;
        put_all(radiance, gradient);
    }
    void put(const ViewRect& view) {
        const auto& [x, y, w, h] = view;
        put_all(x, y, w, h);
    }
    void put(const PixelRect& rect) {
        const auto& [x, y, w, h] = rect;
        put_all(x, y, w, h);
    }
    void put(const Canvas& canvas) {
        const auto& [width, height, region, view, margin, floor] = canvas;
        // What is left out is the same as what says the default.
        (void)region;
        (void)view;
        put_all(width, height, canvas.region_or_all(), canvas.view_or_default(), margin, floor);
    }
    void put(const RenderSettings& render) {
        const auto& [method, quality, bounces, converged, tolerance, skip, keep, view] = render;
        put_all(method, quality, bounces, converged, tolerance, skip, keep, view);
    }
    void put(const Camera& camera) {
        const auto& [aperture, shutter, iso] = camera;
        put_all(aperture, shutter, iso);
    }
    void put(const OutputSettings& output) {
        const auto& [format, depth, antialias, solids, exposure, camera, key, tonemap, look, white, dither] = output;
        // As for the canvas: what is left out is what says the default. A depth that the format has not is its own.
        (void)depth;
        put_all(format, bit_depth_of(format, output.bit_depth), antialias, solids, exposure, camera, key, tonemap, look.value_or("none"),
                white.value_or(kDefaultWhite), dither);
    }
    void put(const Scene& scene) {
        const auto& [canvas, sky, shapes, lights, render, output, media] = scene;
        put_all(canvas, sky, shapes, lights, render, output, media);
    }

    std::string take() { return std::move(bytes_); }

private:
    void put_word(std::uint64_t word) {
        char bytes[sizeof word];
        std::memcpy(bytes, &word, sizeof word);
        bytes_.append(bytes, sizeof word);
    }
    template <class... T>
    void put_all(const T&... values) {
        (put(values), ...);
    }

    std::string bytes_;
};

}  // namespace

std::string normal_form(const Scene& scene) {
    Writer writer;
    writer.put(scene);
    return writer.take();
}

}  // namespace penumbra
