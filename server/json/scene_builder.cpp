// SPDX-License-Identifier: MIT
#include "server/json/scene_builder.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/scene/wording.h"
#include "server/json/sky_picture.h"
#include "server/json/bitmap_reader.h"
#include "server/json/light_reader.h"
#include "server/json/material_reader.h"
#include "server/json/outline_reader.h"
#include "server/json/scene_keys.h"
#include "server/json/value_reader.h"

namespace penumbra {

namespace {

using Keys = std::span<const std::string_view>;

constexpr double kUnread = std::numeric_limits<double>::quiet_NaN();

class SceneBuilder {
public:
    SceneBuilder(const JsonTree& tree, const Limits& limits, const FontSource& fonts, ProblemList& problems)
        : reader_(tree, problems), limits_(limits), bitmaps_(reader_, limits), outlines_(reader_, limits, fonts) {}

    Scene build() {
        Scene scene;
        const Path root;
        if (!reader_.expect(root, 0, NodeKind::object, "a scene, an object in braces")) {
            return scene;
        }
        const Members members(reader_, root, 0, kSceneKeys, "a scene");
        read_version(root.key("version"), members.require("version"));
        read_canvas(root.key("canvas"), members.require("canvas"), scene.canvas);
        read_sky(root.key("sky"), members.find("sky"), scene.sky);
        outlines_.set_pixel_size(scene.canvas.width > 0 ? scene.canvas.pixel_size() : 1);
        read_shapes(root.key("shapes"), members.find("shapes"), scene.shapes);
        read_lights(root.key("lights"), members.find("lights"), scene.lights);
        read_render(root.key("render"), members.find("render"), scene.render);
        read_output(root.key("output"), members.find("output"), scene.output);
        return scene;
    }

private:
    bool is_object(const Path& where, NodeId id) {
        return id != kNoNode && reader_.expect(where, id, NodeKind::object, "an object");
    }

    void read_version(const Path& where, NodeId id) {
        if (id == kNoNode || !reader_.expect(where, id, NodeKind::number, "the number 1")) {
            return;
        }
        const double version = reader_.node(id).number;
        if (version != 1) {
            reader_.report(where, id, "unsupported_version", [&] {
                return "must be 1, the only version there is, is " + number_text(version);
            });
        }
    }

    void read_canvas(const Path& where, NodeId id, Canvas& canvas) {
        if (!is_object(where, id)) {
            return;
        }
        const Members members(reader_, where, id, kCanvasKeys, "a canvas");
        const std::string sides = "from 1 to " + std::to_string(limits_.max_canvas_side_px);
        members.need_integer("width", canvas.width, sides);
        members.need_integer("height", canvas.height, sides);
        if (const NodeId view = members.find("view"); view != kNoNode) {
            const auto v = reader_.numbers(where.key("view"), view, 4,
                                           "a rectangle of four numbers [x, y, width, height]");
            canvas.view = ViewRect{v[0], v[1], v[2], v[3]};
        }
        if (const NodeId region = members.find("region"); region != kNoNode) {
            const auto r = reader_.integers(where.key("region"), region, 4,
                                            "a part of the canvas in four whole numbers [x, y, width, height]");
            canvas.region = PixelRect{r[0], r[1], r[2], r[3]};
        }
        members.number("margin", canvas.margin);
        const Path floor = where.key("floor");
        if (const NodeId floor_id = members.find("floor"); is_object(floor, floor_id)) {
            const Members floor_members(reader_, floor, floor_id, kFloorKeys, "a floor");
            floor_members.colour("albedo", canvas.floor_albedo);
            read_floor_material(reader_, bitmaps_, floor, floor_members, canvas.floor);
        }
    }

    void read_sky(const Path& where, NodeId id, Sky& sky) {
        if (!is_object(where, id)) {
            return;
        }
        const Members members(reader_, where, id, kSkyKeys, "a sky");
        members.colour("radiance", sky.radiance);
        const NodeId gradient = members.find("gradient");
        read_sky_picture(where, members, sky);
        if (gradient == kNoNode) {
            return;
        }
        const Path list = where.key("gradient");
        if (members.find("radiance") != kNoNode) {
            reader_.report(list, gradient, "conflict",
                           [] { return "must not stand together with \"radiance\": keep one"; });
        }
        if (!reader_.expect(list, gradient, NodeKind::array, "a list of stops")) {
            return;
        }
        if (reader_.node(gradient).child_count == 0) {
            reader_.report(list, gradient, "too_few",
                           [] { return "must hold at least 1 stop, holds 0"; });
        }
        for (NodeId stop = reader_.node(gradient).first_child; stop != kNoNode;
             stop = reader_.node(stop).next_sibling) {
            sky.gradient.push_back(read_stop(list.index(sky.gradient.size()), stop));
        }
    }

    // One row of a picture, as the gradient that it is.
    void read_sky_picture(const Path& where, const Members& members, Sky& sky) {
        const NodeId image = members.find("image");
        for (const std::string_view key : {"row", "scale"}) {
            if (const NodeId id = members.find(key); id != kNoNode && image == kNoNode) {
                reader_.report(where.key(key), id, "conflict", [] { return "is for a sky with an \"image\" only"; });
            }
        }
        if (image == kNoNode) {
            return;
        }
        if (members.find("radiance") != kNoNode || members.find("gradient") != kNoNode) {
            reader_.report(where.key("image"), image, "conflict",
                           [] { return "must not stand together with \"radiance\" or \"gradient\": keep one"; });
        }
        const auto texels = bitmaps_.read(where.key("image"), image);
        double scale = 1;
        members.number("scale", scale);
        if (scale < 0 || scale > limits_.max_radiance) {
            reader_.report(where.key("scale"), members.find("scale"), "out_of_range", [&] {
                return "must be from 0 to " + number_text(limits_.max_radiance) + ", is " + number_text(scale);
            });
            scale = kUnread;
        }
        int row = texels ? texels->height / 2 : 0;
        const std::string rows = "from 0 to " + std::to_string(texels ? texels->height - 1 : 0);
        members.integer("row", row, rows);
        if (!texels || std::isnan(scale)) {
            return;
        }
        if (row < 0 || row >= texels->height) {
            reader_.report(where.key("row"), members.find("row"), "out_of_range",
                           [&] { return "must be " + rows + ", is " + std::to_string(row); });
            return;
        }
        sky.gradient = sky_of_row(*texels, row, scale, limits_.max_sky_stops);
    }

    SkyStop read_stop(const Path& where, NodeId id) {
        SkyStop stop{kUnread, Colour(kUnread)};
        if (is_object(where, id)) {
            const Members members(reader_, where, id, kStopKeys, "a stop of the sky");
            members.need_number("angle", stop.angle_deg);
            members.need_colour("radiance", stop.radiance);
        }
        return stop;
    }

    // The type of a shape or light; without one nothing else about it can be judged.
    std::optional<std::size_t> read_type(const Path& where, NodeId id, Keys types,
                                         std::string_view of_what) {
        std::optional<std::size_t> type;
        if (reader_.expect(where, id, NodeKind::object, of_what)) {
            const NodeId type_id = reader_.tree().child(id, "type");
            if (type_id != kNoNode) {
                type = reader_.choice(where.key("type"), type_id, types);
            } else {
                reader_.report_at(where.key("type"), reader_.node(id).offset, "missing_key",
                                  [&] { return "is missing: it must be " + join_words(types); });
            }
        }
        if (!type && !reader_.problems().full()) {
            reader_.problems().silence(where.pointer());
        }
        return type;
    }

    void read_shapes(const Path& where, NodeId id, std::vector<Shape>& shapes) {
        if (id == kNoNode || !reader_.expect(where, id, NodeKind::array, "a list of shapes")) {
            return;
        }
        shapes.reserve(reader_.node(id).child_count);
        for (NodeId shape = reader_.node(id).first_child; shape != kNoNode;
             shape = reader_.node(shape).next_sibling) {
            shapes.push_back(read_shape(where.index(shapes.size()), shape));
        }
    }

    Shape read_shape(const Path& where, NodeId id) {
        Shape shape;
        const auto type = read_type(where, id, kShapeTypes, "a shape, an object");
        if (!type) {
            return shape;
        }
        switch (*type) {
            case 0:
                shape.geometry = read_circle(where, id, shape);
                break;
            case 1:
                shape.geometry = read_ellipse(where, id, shape);
                break;
            case 2:
                shape.geometry = read_rect(where, id, shape);
                break;
            case 3:
                shape.geometry = read_line(where, id, shape);
                break;
            case 4:
                shape.geometry = read_polyline(where, id, shape);
                break;
            case 5:
                shape.geometry = read_polygon(where, id, shape);
                break;
            case 6:
                shape.geometry = read_bitmap(where, id);
                break;
            case 7:
                shape.geometry = outlines_.path(where, id, shape);
                break;
            default:
                shape.geometry = outlines_.text(where, id, shape);
                break;
        }
        return shape;
    }

    Circle read_circle(const Path& where, NodeId id, Shape& shape) {
        const Members members(reader_, where, id, kCircleKeys, "a circle");
        Circle circle;
        members.need_pair("center", "a point [x, y]", circle.center);
        members.need_number("radius", circle.radius);
        read_material(reader_, limits_, where, members, shape);
        return circle;
    }

    Ellipse read_ellipse(const Path& where, NodeId id, Shape& shape) {
        const Members members(reader_, where, id, kEllipseKeys, "an ellipse");
        Ellipse ellipse;
        members.need_pair("center", "a point [x, y]", ellipse.center);
        members.need_pair("radii", "two radii [x, y]", ellipse.radii);
        members.number("rotation", ellipse.rotation_deg);
        read_material(reader_, limits_, where, members, shape);
        return ellipse;
    }

    Rect read_rect(const Path& where, NodeId id, Shape& shape) {
        const Members members(reader_, where, id, kRectKeys, "a rect");
        Rect rect;
        members.need_pair("center", "a point [x, y]", rect.center);
        members.need_pair("size", "a size [width, height]", rect.size);
        members.number("rotation", rect.rotation_deg);
        members.number("corner_radius", rect.corner_radius);
        read_material(reader_, limits_, where, members, shape);
        return rect;
    }

    Line read_line(const Path& where, NodeId id, Shape& shape) {
        const Members members(reader_, where, id, kLineKeys, "a line");
        Line line;
        members.need_pair("from", "a point [x, y]", line.from);
        members.need_pair("to", "a point [x, y]", line.to);
        members.number("width", line.width);
        read_stroke_material(reader_, limits_, where, members, shape);
        return line;
    }

    Polyline read_polyline(const Path& where, NodeId id, Shape& shape) {
        const Members members(reader_, where, id, kPolylineKeys, "a polyline");
        Polyline polyline;
        members.need_points("points", polyline.points);
        members.number("width", polyline.width);
        members.boolean("closed", polyline.closed);
        read_stroke_material(reader_, limits_, where, members, shape);
        return polyline;
    }

    Polygon read_polygon(const Path& where, NodeId id, Shape& shape) {
        const Members members(reader_, where, id, kPolygonKeys, "a polygon");
        Polygon polygon;
        members.need_points("points", polygon.points);
        read_material(reader_, limits_, where, members, shape);
        return polygon;
    }

    Bitmap read_bitmap(const Path& where, NodeId id) {
        const Members members(reader_, where, id, kBitmapKeys, "a bitmap");
        Bitmap bitmap;
        if (const NodeId image = members.require("image"); image != kNoNode) {
            bitmap.image = bitmaps_.read(where.key("image"), image);
        }
        members.need_pair("position", "a point [x, y]", bitmap.position);
        members.need_pair("size", "a size [width, height]", bitmap.size);
        members.number("emission_scale", bitmap.emission_scale);
        members.number("solid_above", bitmap.solid_above);
        bitmap.as_albedo = read_choice(members, where, "as", kUses).value_or(0) == 1;
        return bitmap;
    }

    void read_lights(const Path& where, NodeId id, std::vector<Light>& lights) {
        if (id == kNoNode || !reader_.expect(where, id, NodeKind::array, "a list of lights")) {
            return;
        }
        lights.reserve(reader_.node(id).child_count);
        for (NodeId light = reader_.node(id).first_child; light != kNoNode;
             light = reader_.node(light).next_sibling) {
            lights.push_back(read_light(where.index(lights.size()), light));
        }
    }

    Light read_light(const Path& where, NodeId id) {
        const auto type = read_type(where, id, kLightTypes, "a light, an object");
        return type ? light_of_type(reader_, where, id, *type) : PointLight{};
    }

    std::optional<std::size_t> read_choice(const Members& members, const Path& where,
                                           std::string_view key, Keys words) {
        const NodeId id = members.find(key);
        return id == kNoNode ? std::nullopt : reader_.choice(where.key(key), id, words);
    }

    void read_render(const Path& where, NodeId id, RenderSettings& render) {
        if (!is_object(where, id)) {
            return;
        }
        const Members members(reader_, where, id, kRenderKeys, "the render settings");
        members.string("method", render.method);
        if (const auto quality = read_choice(members, where, "quality", kQualities)) {
            render.quality = std::array{Quality::draft, Quality::standard, Quality::high}[*quality];
        }
        read_bounces(members, where, render);
        members.number("tolerance", render.tolerance);
        if (const auto skip = read_choice(members, where, "skip", kSkips)) {
            render.skip = *skip == 0 ? Skip::all : Skip::none;
        }
        members.string("view", render.view);
    }

    void read_bounces(const Members& members, const Path& where, RenderSettings& render) {
        const NodeId id = members.find("bounces");
        if (id != kNoNode && reader_.node(id).kind == NodeKind::string) {
            constexpr std::string_view kWords[] = {"converged"};
            render.converged = reader_.choice(where.key("bounces"), id, kWords).has_value();
            render.bounces = limits_.max_converging_bounces;
            return;
        }
        members.integer("bounces", render.bounces,
                        "from 0 to " + std::to_string(limits_.max_bounces) + ", or \"converged\"");
    }

    void read_output(const Path& where, NodeId id, OutputSettings& output) {
        if (!is_object(where, id)) {
            return;
        }
        const Members members(reader_, where, id, kOutputKeys, "the output settings");
        members.string("format", output.format);
        if (const NodeId depth = members.find("bit_depth"); depth != kNoNode) {
            output.bit_depth = reader_.integer(where.key("bit_depth"), depth, "8, 16 or 32");
        }
        members.boolean("antialias", output.antialias);
        if (const auto solids = read_choice(members, where, "solids", kSolids)) {
            output.solids = *solids == 0 ? Solids::emission : Solids::lit;
        }
        if (const NodeId exposure = members.find("exposure"); exposure != kNoNode) {
            read_exposure(where.key("exposure"), exposure, output);
        }
        members.string("tonemap", output.tonemap);
        if (const NodeId look = members.find("look"); look != kNoNode) {
            if (const auto word = reader_.string(where.key("look"), look)) {
                output.look = std::string(*word);
            }
        }
        if (const NodeId white = members.find("white"); white != kNoNode) {
            output.white = reader_.number(where.key("white"), white);
        }
        if (const auto dither = read_choice(members, where, "dither", kDithers)) {
            output.dither = *dither == 0 ? Dither::none : Dither::triangular;
        }
    }

    // A number of stops, "auto", a camera's settings, or automatic with its key.
    void read_exposure(const Path& where, NodeId id, OutputSettings& output) {
        const NodeKind kind = reader_.node(id).kind;
        if (kind == NodeKind::string) {
            if (reader_.node(id).string == "auto") {
                output.auto_key = kDefaultKey;
            } else {
                reader_.report(where, id, "unknown_value", [&] {
                    return "must be a number of stops or \"auto\", is " + in_quotes(reader_.node(id).string);
                });
            }
        } else if (kind == NodeKind::object && reader_.tree().child(id, "key") != kNoNode) {
            const Members members(reader_, where, id, kAutoExposureKeys, "an automatic exposure");
            double key = kUnread;
            members.number("key", key);
            output.auto_key = key;
        } else if (kind == NodeKind::object) {
            const Members members(reader_, where, id, kCameraKeys, "a camera's exposure");
            Camera camera;
            members.need_number("aperture", camera.aperture);
            members.need_number("shutter", camera.shutter_s);
            members.number("iso", camera.iso);
            members.number("compensation", output.exposure_ev);
            output.camera = camera;
        } else if (reader_.expect(where, id, NodeKind::number,
                                  "a number of stops, \"auto\", a camera's {\"aperture\", \"shutter\", \"iso\"} or "
                                  "{\"key\"}")) {
            output.exposure_ev = reader_.number(where, id);
        }
    }

    ValueReader reader_;
    const Limits& limits_;
    BitmapReader bitmaps_;
    OutlineReader outlines_;
};

}  // namespace

Scene build_scene(const JsonTree& tree, const Limits& limits, const FontSource& fonts, ProblemList& problems) {
    return SceneBuilder(tree, limits, fonts, problems).build();
}

}  // namespace penumbra
