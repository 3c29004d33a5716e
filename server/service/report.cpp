// SPDX-License-Identifier: MIT
#include "server/service/report.h"

#include <nlohmann/json.hpp>

#include "core/scene/words.h"
#include "server/service/identity.h"
#include "server/service/version.h"

namespace penumbra {
namespace {

using Json = nlohmann::ordered_json;

// Keys and values of clients come back in messages, and may be no UTF-8.
std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json to_json(const DeviceInfo& device) {
    return {{"kind", device.kind},
            {"platform", device.platform},
            {"vendor", device.vendor},
            {"renderer", device.renderer},
            {"gl_version", device.gl_version},
            {"glsl_version", device.glsl_version},
            {"max_texture_side", device.max_texture_side},
            {"max_texture_buffer_texels", device.max_texture_buffer_texels},
            {"max_group_invocations", device.max_group_invocations},
            {"max_loop_iterations", device.max_loop_iterations}};
}

Json to_json(const SceneLimits& limits) {
    const Limits& scene = limits.scene;
    const TextLimits& text = limits.text;
    return {{"max_body_bytes", text.max_bytes},
            {"max_json_depth", text.max_depth},
            {"max_json_values", text.max_nodes},
            {"max_problems", text.max_problems},
            {"max_canvas_side_px", scene.max_canvas_side_px},
            {"max_canvas_pixels", scene.max_canvas_pixels},
            {"max_domain_side_px", scene.max_domain_side_px},
            {"max_domain_pixels", scene.max_domain_pixels},
            {"max_shapes", scene.max_shapes},
            {"max_points_per_shape", scene.max_points_per_shape},
            {"max_points", scene.max_points},
            {"max_lights", scene.max_lights},
            {"max_sky_stops", scene.max_sky_stops},
            {"max_bitmap_side_px", scene.max_bitmap_side_px},
            {"max_bitmap_texels", scene.max_bitmap_texels},
            {"max_coordinate", scene.max_coordinate},
            {"min_view_side", scene.min_view_side},
            {"max_radiance", scene.max_radiance},
            {"max_exposure_ev", scene.max_exposure_ev},
            {"max_bounces", scene.max_bounces}};
}

Json to_json(const LocatedProblem& located) {
    Json json = {{"pointer", located.problem.pointer}};
    if (located.line > 0) {
        json["line"] = located.line;
        json["column"] = located.column;
    }
    json["code"] = located.problem.code;
    json["message"] = located.problem.message;
    if (!located.suggestion.empty()) json["suggestion"] = located.suggestion;
    return json;
}

Scene small_scene() {
    Scene scene;
    scene.canvas.width = scene.canvas.height = 16;
    // Some views look at one of these.
    Shape disc;
    disc.geometry = Circle{{8, 8}, 2};
    scene.shapes.push_back(disc);
    scene.lights.push_back(PointLight{{4, 4}, Colour(1)});
    return scene;
}

// The words of the format that this build takes.
Json supported(const UnsupportedFeatures& unsupported, std::span<const std::string_view> words,
               const std::function<void(Scene&, std::string_view)>& set) {
    Json list = Json::array();
    for (const std::string_view word : words) {
        Scene scene = small_scene();
        set(scene, word);
        if (unsupported(scene).empty()) list.push_back(word);
    }
    return list;
}

Json supported_formats(const UnsupportedFeatures& unsupported) {
    Json list = Json::array();
    for (const PictureFormat& format : picture_formats()) {
        Scene scene = small_scene();
        scene.output.format = format.name;
        if (!unsupported(scene).empty()) continue;
        list.push_back({{"name", format.name}, {"media_type", format.media_type}});
    }
    return list;
}

}  // namespace

std::string info_json(const DeviceInfo* device, const std::vector<DeviceListing>* listing,
                      const SceneLimits& limits, const UnsupportedFeatures& unsupported) {
    Json json = {{"name", "penumbra"}, {"version", version()}, {"build", build_id().substr(0, 16)}, {"scene_version", 1}};
    json["device"] = device ? to_json(*device) : Json(nullptr);
    if (listing) {
        json["devices"] = Json::array();
        for (const DeviceListing& entry : *listing) {
            json["devices"].push_back(
                {{"index", entry.index}, {"name", entry.name}, {"software", entry.software}});
        }
    }
    json["formats"] = supported_formats(unsupported);
    json["methods"] = supported(unsupported, known_methods(),
                                [](Scene& scene, std::string_view word) { scene.render.method = word; });
    json["tonemaps"] = supported(unsupported, known_tonemaps(),
                                 [](Scene& scene, std::string_view word) { scene.output.tonemap = word; });
    json["limits"] = to_json(limits);
    return text_of(json);
}

std::string stats_json(const RenderResponse& response) {
    const RenderStats& stats = response.answer->stats;
    Json json = {{"device", stats.device},
                 {"method", stats.method},
                 {"method_reason", stats.method_reason},
                 {"size", {stats.width, stats.height}},
                 {"format", response.answer->format},
                 {"total_ms", stats.total_ms},
                 {"parse_ms", response.parse_ms},
                 {"encode_ms", response.answer->encode_ms},
                 {"gpu_bytes", stats.gpu_bytes},
                 {"lost_rays", stats.lost_rays},
                 {"passes", Json::array()},
                 {"skipped", Json::array()}};
    for (const PassStats& pass : stats.passes) {
        json["passes"].push_back({{"name", pass.name},
                                  {"gpu_ms", pass.gpu_ms},
                                  {"wall_ms", pass.wall_ms},
                                  {"width", pass.width},
                                  {"height", pass.height},
                                  {"dispatches", pass.dispatches},
                                  {"rays", pass.rays},
                                  {"bytes", pass.bytes},
                                  {"points", pass.points}});
    }
    for (const SkippedWork& work : stats.skipped) {
        json["skipped"].push_back({{"what", work.what}, {"why", work.why}, {"saved", work.saved}});
    }
    return text_of(json);
}

std::string validation_json(const CheckedScene& checked) {
    Json json = {{"valid", checked.failure == RenderFailure::none}, {"problems", Json::array()}};
    for (const LocatedProblem& problem : checked.problems) json["problems"].push_back(to_json(problem));
    json["problems_left_out"] = checked.problems_left_out;
    return text_of(json);
}

std::string problem_json(const LocatedProblem& problem) {
    return to_json(problem).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace penumbra
