// SPDX-License-Identifier: MIT
// Any scene that parses, up to the point where a device is needed: lowered, thinned out, surveyed, planned, packed.
#include <cmath>

#include "check.h"
#include "core/device_error.h"
#include "core/plan/choose.h"
#include "core/plan/pack.h"
#include "core/plan/pack_outline.h"
#include "core/plan/plan.h"
#include "core/plan/shape_lists.h"
#include "core/plan/skip.h"
#include "core/plan/support.h"
#include "core/scene/lower.h"
#include "server/json/scene_json.h"

using namespace penumbra;
using fuzz::check;

namespace {

// Small enough that an input takes milliseconds.
Limits limits() {
    Limits limits;
    limits.max_canvas_pixels = 256.0 * 256.0;
    limits.max_domain_pixels = 512.0 * 512.0;
    limits.max_shapes = 64;
    limits.max_lights = 64;
    limits.max_points_per_shape = 256;
    limits.max_points = 1024;
    limits.max_bitmap_side_px = 64;
    limits.max_bitmap_texels = 64.0 * 64.0;
    return limits;
}

void plan(const Scene& scene) {
    const Plan plan = make_plan(scene, {});
    check(plan.canvas == glm::ivec2(scene.canvas.width, scene.canvas.height), "a plan is of its canvas");
    if (plan.constant) return;
    const PackedScene packed = pack_scene(scene, plan.radiance_scale);
    for (const glm::vec4& texel : packed.edges) {
        for (int i = 0; i < 4; ++i) check(std::isfinite(texel[i]), "packed edges are finite");
    }
    if (!plan.list_shapes) return;
    const ShapeLists lists = list_shapes(packed, plan);
    for (const glm::ivec2 range : lists.ranges) {
        check(0 <= range.x && range.x <= range.y && std::size_t(range.y) <= lists.shapes.size(), "a list lies within the lists");
    }
    for (const int shape : lists.shapes) check(shape >= 0 && std::size_t(shape) < scene.shapes.size(), "a list names shapes");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Limits kLimits = limits();
    static const FontSource kFonts;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const ParsedScene parsed = parse_scene(text, kLimits, {}, {}, kFonts);
    if (!parsed.scene || !unsupported(*parsed.scene, {.tone_lut = true}).empty()) return 0;
    std::vector<SkippedWork> skipped;
    const Scene made = lowered(*parsed.scene);
    const std::optional<Scene> lean = without_unseen_shapes(made, skipped);
    const Scene& scene = lean ? *lean : made;
    const PackedOutline outline = pack_outline(scene, 1, true, most_surveyed_pieces());
    check(outline.entries.size() == outline.lights_of.size() || !outline.fits || outline.lights_of.empty(),
          "every piece has its light");
    for (const char* method : {"auto", "rc", "rc_fix", "hrc", "exact", "reference"}) {
        Scene one = scene;
        one.render.method = method;
        try {
            plan(one);
        } catch (const DeviceError&) {  // does not fit the device: told
        }
    }
    return 0;
}
