// SPDX-License-Identifier: MIT
#include "core/plan/look.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <variant>

#include "core/plan/hrc.h"
#include "core/plan/plan.h"
#include "core/scene/words.h"

namespace penumbra {
namespace {

void darken(Light& light) {
    std::visit(
        [](auto& one) {
            if constexpr (std::is_same_v<std::decay_t<decltype(one)>, DirectionalLight>)
                one.irradiance = Colour(0);
            else
                one.intensity = Colour(0);
        },
        light);
}

// How many cascades or levels a method has for this scene.
int level_count(const Scene& scene, const std::string& method) {
    const glm::ivec2 canvas(scene.canvas.width, scene.canvas.height);
    if (method == "hrc") {
        const HrcPlan hrc = plan_hrc(canvas, scene.canvas.margin / scene.canvas.pixel_size(), hrc_settings(scene.render.quality));
        // The longest pieces have no fluence of their own, and each quadrant must have the level.
        int count = 1000;
        for (const HrcQuadrant& q : hrc.quadrants) count = std::min(count, q.top());
        return count;
    }
    const CascadeSettings settings = method == "rc_fix" ? rc_fix_settings(scene.render.quality) : cascade_settings(scene.render.quality);
    return static_cast<int>(plan_cascades(canvas, plan_grid(scene.canvas).diagonal_px, settings).size());
}

std::string holds(std::size_t count, const std::string& what) {
    if (count == 0) return "the scene has no " + what + "s";
    return "the scene has " + what + "0" + (count > 1 ? " to " + what + std::to_string(count - 1) : " only");
}

}  // namespace

void darken(Shape& shape) {
    shape.emission = Colour(0);
    shape.gradient.clear();
    if (shape.medium) shape.medium->emission = Colour(0);
    auto* bitmap = std::get_if<Bitmap>(&shape.geometry);
    if (bitmap != nullptr && !bitmap->as_albedo) bitmap->emission_scale = 0;
}

Look look_of(std::string_view view) {
    if (view == "final") return {};
    if (const std::optional<int> number = view_number(view, "cascade")) return {LookAt::cascade, *number};
    if (view == "probes") return {LookAt::probes, 0};
    if (view == "steps") return {LookAt::steps, 0};
    if (view == "skipped") return {LookAt::skipped, 0};
    if (view == "error") return {LookAt::error, 0};
    if (view == "sky" || view_number(view, "light") || view_number(view, "shape")) return {LookAt::contribution, 0};
    return {LookAt::field, 0};
}

Scene contribution(const Scene& scene) {
    Scene result = scene;
    result.render.view = "final";
    const std::optional<int> light = view_number(scene.render.view, "light"), shape = view_number(scene.render.view, "shape");
    for (std::size_t i = 0; i < result.shapes.size(); ++i)
        if (!shape || static_cast<std::size_t>(*shape) != i) darken(result.shapes[i]);
    for (std::size_t i = 0; i < result.lights.size(); ++i)
        if (!light || static_cast<std::size_t>(*light) != i) darken(result.lights[i]);
    if (scene.render.view != "sky") result.sky = {};
    return result;
}

std::string view_refused(const Scene& scene) {
    const std::string& view = scene.render.view;
    const std::string& method = scene.render.method;
    // `auto` takes rc for views of cascades.
    const std::string by = method == "auto" ? "rc" : method;
    const auto has = [&](std::initializer_list<const char*> methods) { return std::find(methods.begin(), methods.end(), by) != methods.end(); };
    const Look look = look_of(view);
    switch (look.at) {
        case LookAt::cascade:
            if (!has({"rc", "rc_fix", "hrc"})) return "the method '" + method + "' has no cascades: rc, rc_fix and hrc have";
            if (look.number >= level_count(scene, by))
                return "the method '" + by + "' has cascade0 to cascade" + std::to_string(level_count(scene, by) - 1) + " for this canvas";
            return {};
        case LookAt::probes:
            return has({"rc", "rc_fix"}) ? "" : "the method '" + method + "' has no probes: rc and rc_fix have";
        case LookAt::steps:
            return has({"rc", "rc_fix"}) ? "" : "the method '" + method + "' does not tell its steps: rc and rc_fix do";
        case LookAt::skipped:
            return method == "auto" || has({"exact", "rc", "rc_fix"}) ? "" : "the method '" + method + "' leaves out no pixels: exact, rc and rc_fix do";
        case LookAt::contribution: {
            const std::optional<int> light = view_number(view, "light"), shape = view_number(view, "shape");
            if (light && static_cast<std::size_t>(*light) >= scene.lights.size()) return holds(scene.lights.size(), "light");
            if (shape && static_cast<std::size_t>(*shape) >= scene.shapes.size()) return holds(scene.shapes.size(), "shape");
            return {};
        }
        default: return {};
    }
}

}  // namespace penumbra
