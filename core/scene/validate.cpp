// SPDX-License-Identifier: MIT
#include "core/scene/validate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "core/scene/path.h"
#include "core/scene/range_checks.h"
#include "core/scene/validate_shapes.h"
#include "core/scene/wording.h"
#include "core/scene/words.h"

namespace penumbra {

namespace {

// Pixels may be this much off square, relative: what decimal text and one division lose.
constexpr double kSquareTolerance = 1e-6;

bool validate_view(RangeChecks& checks, const Path& where, const ViewRect& view) {
    const double high = checks.limits().max_coordinate;
    const double low = checks.limits().min_view_side;
    const bool x = checks.between(where.index(0), view.x, -high, high);
    const bool y = checks.between(where.index(1), view.y, -high, high);
    const bool w = checks.between(where.index(2), view.w, low, high);
    const bool h = checks.between(where.index(3), view.h, low, high);
    return x && y && w && h;
}

void validate_domain(RangeChecks& checks, const Path& where, const Canvas& canvas) {
    const Limits& limits = checks.limits();
    const double margin_px = canvas.margin / canvas.pixel_size();
    const double width = canvas.width + 2 * margin_px;
    const double height = canvas.height + 2 * margin_px;
    if (std::max(width, height) <= limits.max_domain_side_px &&
        width * height <= limits.max_domain_pixels) {
        return;
    }
    checks.add(canvas.margin > 0 ? where.key("margin") : where, "too_large",
               "makes a domain of " + number_text(std::ceil(width)) + " x " +
                   number_text(std::ceil(height)) +
                   " pixels (canvas and margin on both sides); at most " +
                   number_text(limits.max_domain_side_px) + " on a side and " +
                   number_text(limits.max_domain_pixels) + " in all are allowed");
}

void validate_region(RangeChecks& checks, const Path& where, const Canvas& canvas) {
    const PixelRect& region = *canvas.region;
    if (checks.between(where.index(0), region.x, 0, canvas.width - 1)) {
        checks.between(where.index(2), region.w, 1, canvas.width - region.x);
    }
    if (checks.between(where.index(1), region.y, 0, canvas.height - 1)) {
        checks.between(where.index(3), region.h, 1, canvas.height - region.y);
    }
}

void validate_canvas(RangeChecks& checks, const Path& where, const Canvas& canvas) {
    const Limits& limits = checks.limits();
    const bool width =
        checks.between(where.key("width"), canvas.width, 1, limits.max_canvas_side_px);
    const bool height =
        checks.between(where.key("height"), canvas.height, 1, limits.max_canvas_side_px);
    const bool view = !canvas.view || validate_view(checks, where.key("view"), *canvas.view);
    const bool margin =
        checks.between(where.key("margin"), canvas.margin, 0, limits.max_coordinate);
    const Path floor = where.key("floor");
    checks.colour(floor.key("albedo"), canvas.floor_albedo, 1);
    if (canvas.floor.tile) {
        validate_view(checks, floor.key("tile"), *canvas.floor.tile);
    }
    if (canvas.floor.gloss) {
        checks.between(floor.key("roughness"), canvas.floor.gloss->roughness, 0, 1);
        checks.between(floor.key("metallic"), canvas.floor.gloss->metallic, 0, 1);
        checks.between(floor.key("reflectance"), canvas.floor.gloss->reflectance, 0, 1);
    }
    if (width && height && canvas.region) {
        validate_region(checks, where.key("region"), canvas);
    }
    if (!width || !height || !view) {
        return;
    }
    const double pixels = double(canvas.width) * double(canvas.height);
    if (pixels > limits.max_canvas_pixels) {
        checks.add(where, "too_large",
                   "must have at most " + number_text(limits.max_canvas_pixels) + " pixels, has " +
                       number_text(pixels));
        return;
    }
    const ViewRect shown = canvas.view_or_default();
    const double pixel_w = shown.w / canvas.width;
    const double pixel_h = shown.h / canvas.height;
    if (std::abs(pixel_w - pixel_h) > kSquareTolerance * std::max(pixel_w, pixel_h)) {
        checks.add(where.key("view"), "not_square",
                   "must make square pixels: for " + std::to_string(canvas.width) + " x " +
                       std::to_string(canvas.height) + " pixels a view " + number_text(shown.w) +
                       " wide must be " + number_text(pixel_w * canvas.height) + " high, is " +
                       number_text(shown.h));
        return;
    }
    if (margin) {
        validate_domain(checks, where, canvas);
    }
}

// Angles go up from 0 to 360. Two stops at one angle are a step, and 0 and 360 are one angle; a
// third stop there could never be seen.
void validate_gradient(RangeChecks& checks, const Path& where, const std::vector<SkyStop>& stops) {
    if (!checks.count(where, stops.size(), checks.limits().max_sky_stops, "stops")) {
        return;
    }
    const auto at_seam = [](const SkyStop& s) { return s.angle_deg == 0 || s.angle_deg == 360; };
    const auto seam_stops = std::count_if(stops.begin(), stops.end(), at_seam);
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const Path stop = where.index(i);
        const Path angle = stop.key("angle");
        const double here = stops[i].angle_deg;
        const bool good = checks.between(angle, here, 0, 360);
        checks.colour(stop.key("radiance"), stops[i].radiance, checks.limits().max_radiance);
        if (!good || i == 0) {
            continue;
        }
        if (here < stops[i - 1].angle_deg) {
            checks.add(angle, "not_in_order",
                       "must not be less than the angle before it, " +
                           number_text(stops[i - 1].angle_deg) + ", is " + number_text(here));
            continue;
        }
        const bool third =
            i >= 2 && here == stops[i - 1].angle_deg && here == stops[i - 2].angle_deg;
        const bool third_at_seam = at_seam(stops[i]) && seam_stops > 2 && i + 1 == stops.size();
        if (third || third_at_seam) {
            checks.add(angle, "too_many",
                       "must not be the third stop at one angle (two make a step" +
                           std::string(at_seam(stops[i]) ? "; 0 and 360 are one angle" : "") +
                           "), is " + number_text(here));
        }
    }
}

void validate_sky(RangeChecks& checks, const Path& where, const Sky& sky) {
    checks.colour(where.key("radiance"), sky.radiance, checks.limits().max_radiance);
    validate_gradient(checks, where.key("gradient"), sky.gradient);
}

class LightChecks {
public:
    LightChecks(RangeChecks& checks, const Path& where) : checks_(checks), where_(where) {}

    void operator()(const PointLight& light) {
        checks_.between(where_.key("radius"), light.radius, 0.0, checks_.limits().max_coordinate);
        checks_.coordinates(where_.key("position"), light.position);
        strength(light);
    }

    void operator()(const SpotLight& light) {
        checks_.coordinates(where_.key("position"), light.position);
        checks_.finite(where_.key("direction"), light.direction_deg);
        const Path inner = where_.key("inner_angle");
        const bool inner_good = checks_.between(inner, light.inner_angle_deg, 0, 180);
        const bool outer_good =
            checks_.between(where_.key("outer_angle"), light.outer_angle_deg, 0, 180);
        if (inner_good && outer_good && light.inner_angle_deg > light.outer_angle_deg) {
            checks_.add(inner, "out_of_range",
                        "must be at most outer_angle, " + number_text(light.outer_angle_deg) +
                            ", is " + number_text(light.inner_angle_deg));
        }
        strength(light);
        if (light.unit == LightUnit::radiant) return;
        checks_.between(where_.key("tilt"), light.tilt_deg, 0, 90);
        const double least = checks_.limits().min_lumens_angle_deg;
        if (light.unit == LightUnit::lumens && outer_good && light.outer_angle_deg < least) {
            checks_.add(where_.key("outer_angle"), "out_of_range",
                        "must be at least " + number_text(least) + " for a spot in lumens, is " +
                            number_text(light.outer_angle_deg));
        }
    }

    void operator()(const DirectionalLight& light) {
        checks_.finite(where_.key("direction"), light.direction_deg);
        colour(light.elevation_deg ? "lux" : "irradiance", light.irradiance);
        if (!light.elevation_deg) return;
        const Path elevation = where_.key("elevation");
        if (checks_.between(elevation, *light.elevation_deg, 0, 90) && *light.elevation_deg == 0) {
            checks_.add(elevation, "out_of_range", "must be more than 0: at 0 it does not reach the floor");
        }
    }

private:
    template <class PointOrSpot>
    void strength(const PointOrSpot& light) {
        const bool radiant = light.unit == LightUnit::radiant;
        colour(radiant ? "intensity" : light.unit == LightUnit::candela ? "candela" : "lumens", light.intensity);
        if (!radiant) checks_.between(where_.key("height"), light.height, checks_.limits().min_light_height, checks_.limits().max_coordinate);
    }

    void colour(std::string_view key, const Colour& value) {
        checks_.colour(where_.key(key), value, checks_.limits().max_radiance);
    }

    RangeChecks& checks_;
    const Path& where_;
};

void validate_lights(RangeChecks& checks, const Path& where, const std::vector<Light>& lights) {
    if (!checks.count(where, lights.size(), checks.limits().max_lights, "lights")) {
        return;
    }
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const Path light = where.index(i);
        std::visit(LightChecks(checks, light), lights[i]);
    }
}

void validate_word(RangeChecks& checks, const Path& where, std::string_view word, bool known,
                   std::span<const std::string_view> words) {
    if (!known) {
        checks.add(where, "unknown_value",
                   "must be " + join_words(words) + ", is " + in_quotes(word) +
                       did_you_mean(nearest_word(word, words)));
    }
}

void validate_render(RangeChecks& checks, const Path& where, const RenderSettings& render) {
    validate_word(checks, where.key("method"), render.method,
                  is_known_word(render.method, known_methods()), known_methods());
    if (!render.converged) checks.between(where.key("bounces"), render.bounces, 0, checks.limits().max_bounces);
    checks.between(where.key("tolerance"), render.tolerance, 1e-6, 1);
    validate_word(checks, where.key("view"), render.view, is_known_view(render.view),
                  known_views());
}

void validate_exposure(RangeChecks& checks, const Path& where, const OutputSettings& output) {
    const Limits& limits = checks.limits();
    if (output.auto_key) {
        checks.between(where.key("key"), *output.auto_key, limits.min_key, limits.max_key);
        return;
    }
    if (!output.camera) {
        checks.between(where, output.exposure_ev, -limits.max_exposure_ev, limits.max_exposure_ev);
        return;
    }
    checks.between(where.key("aperture"), output.camera->aperture, limits.min_aperture, limits.max_aperture);
    checks.between(where.key("shutter"), output.camera->shutter_s, limits.min_shutter_s, limits.max_shutter_s);
    checks.between(where.key("iso"), output.camera->iso, limits.min_iso, limits.max_iso);
    checks.between(where.key("compensation"), output.exposure_ev, -limits.max_compensation_ev,
                   limits.max_compensation_ev);
}

void validate_bit_depth(RangeChecks& checks, const Path& where, const OutputSettings& output) {
    if (!output.bit_depth || !is_known_word(output.format, known_formats())) {
        return;
    }
    const std::span<const int> depths = bit_depths_of(output.format);
    if (depths.empty()) {
        checks.add(where, "conflict", "must not stand with the format " + output.format + ", which has no choice of it");
    } else if (std::find(depths.begin(), depths.end(), *output.bit_depth) == depths.end()) {
        checks.add(where, "unknown_value",
                   "must be " + std::to_string(depths[0]) + " or " + std::to_string(depths[1]) + " for " +
                       output.format + ", is " + std::to_string(*output.bit_depth));
    }
}

void validate_output(RangeChecks& checks, const Path& where, const OutputSettings& output) {
    validate_word(checks, where.key("format"), output.format,
                  is_known_word(output.format, known_formats()), known_formats());
    validate_bit_depth(checks, where.key("bit_depth"), output);
    validate_exposure(checks, where.key("exposure"), output);
    validate_word(checks, where.key("tonemap"), output.tonemap,
                  is_known_word(output.tonemap, known_tonemaps()), known_tonemaps());
    // What a curve has no use for is not passed over.
    const auto only_for = [&](const char* key, const char* curve) {
        if (output.tonemap != curve && is_known_word(output.tonemap, known_tonemaps())) {
            checks.add(where.key(key), "conflict",
                       "is for the tone map " + std::string(curve) + ", not for " + output.tonemap);
        }
    };
    if (output.look) {
        validate_word(checks, where.key("look"), *output.look, is_known_word(*output.look, known_looks()),
                      known_looks());
        only_for("look", "agx");
    }
    if (output.white) {
        checks.between(where.key("white"), *output.white, checks.limits().min_white, checks.limits().max_white);
        only_for("white", "reinhard_extended");
    }
}

}  // namespace

Problems validate(const Scene& scene, const Limits& limits) {
    RangeChecks checks(limits);
    const Path root;
    validate_canvas(checks, root.key("canvas"), scene.canvas);
    validate_sky(checks, root.key("sky"), scene.sky);
    validate_shapes(checks, root.key("shapes"), scene.shapes);
    validate_lights(checks, root.key("lights"), scene.lights);
    validate_render(checks, root.key("render"), scene.render);
    validate_output(checks, root.key("output"), scene.output);
    return checks.take();
}

}  // namespace penumbra
