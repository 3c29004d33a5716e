// SPDX-License-Identifier: MIT
// The scene as plain values: what docs/scene-format.md describes, after parsing, before validation.
//
// Units: lengths are world units, angles are degrees, clockwise on screen (x right, y down).
// Colours are linear RGB radiance (or reflectance for albedo), never negative once validated.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace penumbra {

using Point = glm::dvec2;   // world units
using Colour = glm::dvec3;  // linear RGB

struct Circle {
    Point center{0};
    double radius = 0;
};

struct Ellipse {
    Point center{0};
    glm::dvec2 radii{0};  // semi-axes before rotation
    double rotation_deg = 0;
};

struct Rect {
    Point center{0};
    glm::dvec2 size{0};  // full width and height before rotation
    double rotation_deg = 0;
    double corner_radius = 0;  // rounds inwards; at most half the shorter side
};

// A capsule: every point within width/2 of the segment. Zero length is a disc.
struct Line {
    Point from{0};
    Point to{0};
    double width = 1;
};

// The union of the capsules of its segments; `closed` joins the last point to the first.
struct Polyline {
    std::vector<Point> points;
    double width = 1;
    bool closed = false;
};

// Calls segment(from, to) for every straight part of a stroke, in order.
template <class Segment>
void for_each_segment(const Polyline& polyline, Segment segment) {
    const std::size_t n = polyline.points.size();
    for (std::size_t i = 0; i + 1 < n; ++i) segment(polyline.points[i], polyline.points[i + 1]);
    if (polyline.closed && n > 2) segment(polyline.points[n - 1], polyline.points[0]);
}
inline double stroke_length(const Polyline& polyline) {
    double sum = 0;
    for_each_segment(polyline, [&](Point a, Point b) { sum += std::hypot(b.x - a.x, b.y - a.y); });
    return sum;
}

// What an outline was written as; problems name its key.
enum class OutlineKey { points, d, text };

// Filled by the even-odd rule. Its rings stand one behind the other in `points`: holes, and pieces that lie apart. Each ring but
// the first begins at one of `ring_starts`, which grow; each is closed.
struct Polygon {
    std::vector<Point> points{};
    std::vector<std::size_t> ring_starts{};
    OutlineKey key = OutlineKey::points;
};

// Calls edge(from, to) for every edge of every ring, in order.
template <class Edge>
void for_each_edge(const Polygon& polygon, Edge edge) {
    std::size_t first = 0;
    for (std::size_t ring = 0; ring <= polygon.ring_starts.size(); ++ring) {
        const std::size_t end = ring < polygon.ring_starts.size() ? polygon.ring_starts[ring] : polygon.points.size();
        for (std::size_t i = first; i < end; ++i) edge(polygon.points[i], polygon.points[i + 1 < end ? i + 1 : first]);
        first = end;
    }
}

// Decoded picture: RGBA, 8 bits, straight alpha, colours sRGB encoded, rows top to bottom.
struct Texels {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  // 4 * width * height
};

struct Bitmap {
    std::shared_ptr<const Texels> image;
    Point position{0};     // world position of the top left corner
    glm::dvec2 size{0};    // world size of the whole picture
    double emission_scale = 1;
    double solid_above = 0.5;  // alpha/255 at or above this is solid
    bool as_albedo = false;    // colours are albedo instead of emission
};

using Geometry = std::variant<Circle, Ellipse, Rect, Line, Polyline, Polygon, Bitmap>;

// A stop of an emission that changes along a stroke. `at` is a share of its length, from 0 to 1.
struct EmissionStop {
    double at = 0;
    Colour emission{0};
};

// What a translucent shape is filled with, per world unit of a ray's way through it (docs/methods/media.md).
struct Medium {
    Colour extinction{0};
    Colour emission{0};
};

struct Shape {
    Geometry geometry;
    Colour emission{0};  // ignored for Bitmap
    Colour albedo{0};    // ignored for Bitmap
    std::vector<EmissionStop> gradient{};  // of Line and Polyline: emission along them, linear between stops, instead of `emission`
    std::optional<Medium> medium{};  // then it is translucent, and free space
};

// What a light's strength is given in. `radiant` is flatland's own; the others are of the world above the canvas, where a light
// stands at a height and its light falls with the square of the distance (docs/methods/delta-lights.md).
enum class LightUnit { radiant, candela, lumens };

struct PointLight {
    Point position{0};
    Colour intensity{0};  // in `unit`; radiant: intensity per radian
    double radius = 0;    // more than 0: a disc that shines, see core/scene/lower.h
    LightUnit unit = LightUnit::radiant;
    double height = 0;    // above the canvas, world units; not of radiant lights
};

struct SpotLight {
    Point position{0};
    double direction_deg = 0;
    double inner_angle_deg = 0;  // half angles, 0 <= inner <= outer <= 180
    double outer_angle_deg = 0;
    Colour intensity{0};  // in `unit`; radiant: intensity per radian on the axis
    LightUnit unit = LightUnit::radiant;
    double height = 0;    // as a point light's
    double tilt_deg = 0;  // of its axis below the horizon; not of radiant lights
};

struct DirectionalLight {
    double direction_deg = 0;  // the direction in which the light travels
    Colour irradiance{0};      // across the beam
    // Above the horizon: then the irradiance is lux, of the world above the canvas. Without one it is flatland's.
    std::optional<double> elevation_deg{};
};

using Light = std::variant<PointLight, SpotLight, DirectionalLight>;

// A stop of the sky gradient; `angle_deg` is the direction one looks in.
struct SkyStop {
    double angle_deg = 0;
    Colour radiance{0};
};

struct Sky {
    Colour radiance{0};            // used when `gradient` is empty
    std::vector<SkyStop> gradient;  // linear in angle round the circle; equal angles make a step
};

struct ViewRect {
    double x = 0, y = 0, w = 0, h = 0;  // world units
};

// A part of the canvas.
struct PixelRect {
    int x = 0, y = 0, w = 0, h = 0;  // pixels
};

// What makes a floor shine (core/floor): the microfacet terms.
struct Gloss {
    double roughness = 0.5;    // perceptual: its square is the width of the facets' distribution
    double metallic = 0;
    double reflectance = 0.5;  // of what is no metal: F0 = 0.16 reflectance^2
};

// What the floor is made of, beside its albedo.
struct FloorMaterial {
    std::shared_ptr<const Texels> image{};    // albedo, sRGB encoded
    std::shared_ptr<const Texels> normals{};  // directions: red right, green up, blue towards the eye; 128 is 0
    std::optional<ViewRect> tile{};           // where one copy of these lies; they repeat. Default: the view
    std::optional<Gloss> gloss{};

    // Whether it matters where light comes from.
    bool has_relief() const { return normals != nullptr || gloss.has_value(); }
    bool is_plain() const { return image == nullptr && !has_relief(); }
};

struct Canvas {
    int width = 0;   // pixels
    int height = 0;  // pixels
    std::optional<PixelRect> region;  // the part that becomes the picture; default: all of it
    std::optional<ViewRect> view;  // default: one world unit is one pixel
    double margin = 0;             // world units
    Colour floor_albedo{1};
    FloorMaterial floor;

    ViewRect view_or_default() const {
        return view ? *view : ViewRect{0, 0, double(width), double(height)};
    }
    PixelRect region_or_all() const { return region ? *region : PixelRect{0, 0, width, height}; }
    // Side of a pixel in world units. Pixels are square once the scene is validated.
    double pixel_size() const { return view_or_default().w / width; }
};

enum class Quality { draft, standard, high };
enum class Skip { all, none };
enum class Solids { emission, lit };
enum class Dither { none, triangular };

// A camera's settings, for an exposure (core/film/exposure.h).
struct Camera {
    double aperture = 1;  // f-number
    double shutter_s = 1;
    double iso = 100;
};

struct RenderSettings {
    std::string method = "auto";
    Quality quality = Quality::standard;
    int bounces = 0;             // at most, when `converged`
    bool converged = false;      // bounces end before, once nothing changes by more than `tolerance`
    double tolerance = 1e-3;     // share of the brightest surface's radiance
    Skip skip = Skip::all;
    std::uint32_t keep = 0;  // bits of core/plan/saving.h: work that is done all the same, to measure what it costs
    std::string view = "final";
};

// The radiance that Reinhard's extended curve maps to 1, unless the scene says another.
constexpr double kDefaultWhite = 4;
// What automatic exposure makes of the log-average: the reflectance of a photographer's grey card.
constexpr double kDefaultKey = 0.18;

struct OutputSettings {
    std::string format = "png";
    std::optional<int> bit_depth;  // else the format's own (core/scene/words.h)
    bool antialias = true;
    Solids solids = Solids::emission;
    double exposure_ev = 0;           // with a camera, its compensation
    std::optional<Camera> camera;
    std::optional<double> auto_key;   // automatic exposure: what the log-average of the free pixels becomes
    std::string tonemap = "none";
    std::optional<std::string> look;  // of "agx", else "none"
    std::optional<double> white;      // of "reinhard_extended", else kDefaultWhite
    Dither dither = Dither::none;
};

struct Scene {
    Canvas canvas;
    Sky sky;
    std::vector<Shape> shapes;
    std::vector<Light> lights;
    RenderSettings render;
    OutputSettings output;
    // Translucent shapes, once lowered (core/scene/lower.h) has taken them out of `shapes`; the later is on top.
    std::vector<Shape> media{};
};

}  // namespace penumbra
