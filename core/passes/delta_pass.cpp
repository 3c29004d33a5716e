// SPDX-License-Identifier: MIT
#include "core/passes/delta_pass.h"

#include <algorithm>
#include <cstdint>

#include "core/device_error.h"

namespace penumbra {
namespace {

// Loop iterations of one dispatch: half of what Mesa 22 allows an invocation.
constexpr int kMostIterations = 30'000;
constexpr int kCoarseTile = 4 * glsl::kDeltaTile;
// Lists of one band of the picture.
constexpr std::size_t kMostLists = std::size_t(1) << 21;
constexpr std::size_t kMostEntryBytes = std::size_t(1) << 28;

int divided_up(int a, int b) { return (a + b - 1) / b; }

gl::StorageBuffer at_least(gl::StorageBuffer buffer, GLenum format, std::size_t bytes) {
    if (buffer && buffer.bytes() >= bytes) return buffer;
    return gl::StorageBuffer(format, bytes);
}

const PackedOutline& outline_of(const Plan& plan) { return plan.exact.used ? plan.exact.outline : plan.delta.outline; }

}  // namespace

struct DeltaPass::Lists {
    glsl::DeltaParams params{};
    gl::BufferTexture lights;
    int most = 0;  // pieces in one list
};

DeltaPass::DeltaPass(const std::string& shader_dir)
    : lists_("delta_lists.comp", sizeof(glsl::DeltaParams), shader_dir),
      pixels_("delta.comp", sizeof(glsl::DeltaParams), shader_dir),
      nodes_("delta_nodes.comp", sizeof(glsl::DeltaParams), shader_dir),
      counters_(GL_R32UI, 8) {}

int DeltaPass::make_lists(const Plan& plan, glm::ivec2 origin, glm::ivec2 area, Lists& lists) {
    const PackedOutline& outline = outline_of(plan);
    const std::size_t count = static_cast<std::size_t>(plan.delta.size());
    lists.lights = gl::BufferTexture(GL_RGBA32F, plan.delta.lights.data(), plan.delta.lights.size() * 16);
    const gl::BufferTexture root(GL_RGBA32F, outline.entries.data(), outline.entries.size() * 16);
    glsl::DeltaParams& params = lists.params;
    params.border = plan.grid.border;
    params.list_origin = origin;
    params.lights = static_cast<int>(count);
    params.end_light = static_cast<int>(count);
    params.least_distance = 0.5f;
    params.root_counts = {outline.counts[0], outline.counts[1], outline.counts[2], outline.counts[3]};
    int dispatches = 0;
    const auto make = [&](int tile_px, int ratio, gl::StorageBuffer& heads, gl::StorageBuffer& entries) {
        const glm::ivec2 tiles{divided_up(area.x, tile_px), divided_up(area.y, tile_px)};
        const std::size_t all = static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y) * count;
        heads = at_least(std::move(heads), GL_RGBA32UI, all * 16);
        std::size_t capacity = std::max<std::size_t>(entries.bytes() / 16, 2 * all + 1024);
        for (;;) {
            entries = at_least(std::move(entries), GL_RGBA32F, capacity * 16);
            const std::uint32_t zero[2] = {};
            counters_.write(0, zero, sizeof(zero));
            params.parent_tiles = params.tiles;
            glsl::DeltaParams p = params;
            p.tiles = tiles;
            p.tile_px = tile_px;
            p.parent_ratio = ratio;
            p.capacity = static_cast<int>(capacity);
            p.extent = {tiles.x, tiles.y * static_cast<int>(count)};
            if (ratio == 0) {
                root.bind_texture(glsl::kDeltaEntriesUnit);
            } else {
                coarse_heads_.bind_texture(glsl::kDeltaHeadsUnit);
                coarse_entries_.bind_texture(glsl::kDeltaEntriesUnit);
            }
            lists.lights.bind_texture(glsl::kDeltaLightsUnit);
            heads.bind_storage(glsl::kDeltaHeadsStorage);
            entries.bind_storage(glsl::kDeltaEntriesStorage);
            counters_.bind_storage(glsl::kDeltaCountersStorage);
            dispatches += lists_.dispatch(p, p.extent);
            std::uint32_t used[2] = {};
            counters_.read(0, used, sizeof(used));
            const bool too_long = used[1] == glsl::kDeltaTooLong;
            if (!too_long && used[0] <= capacity) {
                params.tiles = tiles;
                lists.most = static_cast<int>(used[1]);
                return;
            }
            capacity = used[0] + std::size_t(used[0]) / 4;
            if (too_long || capacity * 16 > kMostEntryBytes)
                throw DeviceError("The scene is too dense for its point, spot and directional lights: the lists of what may stand "
                                  "between lights and tiles need " + std::to_string(capacity >> 16) + " MiB.");
        }
    };
    make(kCoarseTile, 0, coarse_heads_, coarse_entries_);
    make(glsl::kDeltaTile, kCoarseTile / glsl::kDeltaTile, heads_, entries_);
    return dispatches;
}

template <class Dispatch>
int DeltaPass::in_slices(const Lists& lists, int samples, glsl::DeltaParams params, const Dispatch& dispatch) {
    heads_.bind_texture(glsl::kDeltaHeadsUnit);
    entries_.bind_texture(glsl::kDeltaEntriesUnit);
    lists.lights.bind_texture(glsl::kDeltaLightsUnit);
    // Each loop of an untaken branch counts once.
    const int slice = std::max(kMostIterations / (samples * (lists.most + 6) + 1), 1);
    int dispatches = 0;
    for (int light = 0; light < params.lights; light += slice) {
        params.first_light = light;
        params.end_light = std::min(light + slice, params.lights);
        dispatches += dispatch(params);
        params.adds = 1;
    }
    return dispatches;
}

PassWork DeltaPass::pixels(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& out) {
    out = settings.take(GL_RGBA32F, plan.lit.size);
    return run(plan, field, settings, out, false);
}

PassWork DeltaPass::on_floor(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& sent) {
    return run(plan, field, settings, sent, true);
}

PassWork DeltaPass::run(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& out, bool on_floor) {
    PassWork work;
    work.bytes = out.bytes();
    gl::ShaderConstants constants = {{"kFloor", on_floor ? 1 : 0}, {"kGloss", on_floor && plan.floor.gloss ? 1 : 0}};
    if (plan.needs.media) {
        for (const auto& one : march_constants(plan.needs)) constants.push_back(one);
    }
    gl::ComputeProgram& program = pixels_.of(constants);
    const std::size_t of_row = static_cast<std::size_t>(divided_up(plan.lit.size.x, glsl::kDeltaTile)) * static_cast<std::size_t>(plan.delta.size());
    const int rows = kCoarseTile * static_cast<int>(std::clamp<std::size_t>(kMostLists / (4 * of_row), 1, 1 << 12));
    const int samples = plan.needs.media ? glsl::kDeltaMediaBudget / 8 : 1;
    for (int row = 0; row < plan.lit.size.y; row += rows) {
        Lists lists;
        const glm::ivec2 area{plan.lit.size.x, std::min(rows, plan.lit.size.y - row)};
        work.dispatches += make_lists(plan, plan.lit.first + glm::ivec2(0, row), area, lists);
        lists.params.first_row = row;
        lists.params.extent = area;
        lists.params.adds = on_floor ? 1 : 0;
        out.bind_image(glsl::kDeltaRadianceImage, GL_READ_WRITE);
        field.distance.bind_texture(glsl::kDeltaDistanceUnit);
        work.dispatches += in_slices(lists, samples, lists.params, [&](const glsl::DeltaParams& p) {
            return program.dispatch(p, p.extent, settings.pixels / static_cast<std::size_t>(1 + (p.end_light - p.first_light) / 4));
        });
    }
    work.rays = static_cast<std::size_t>(plan.lit.size.x) * static_cast<std::size_t>(plan.lit.size.y) * static_cast<std::size_t>(plan.delta.size());
    return work;
}

PassWork DeltaPass::surfaces(const Plan& plan, const SurfacePart& part, gl::Texture2D& out) {
    PassWork work;
    Lists lists;
    work.dispatches = make_lists(plan, part.origin, part.area, lists);
    lists.params.jobs = part.job_count;
    lists.params.extent = {4 * part.job_count, 1};
    part.jobs.bind_texture(glsl::kDeltaJobsUnit);
    part.nodes.bind_texture(glsl::kDeltaNodesUnit);
    out.bind_image(glsl::kDeltaRadianceImage, GL_READ_WRITE);
    work.dispatches += in_slices(lists, glsl::kDeltaSamples, lists.params, [&](const glsl::DeltaParams& p) { return nodes_.dispatch(p, p.extent); });
    work.rays = 4 * static_cast<std::size_t>(part.job_count) * static_cast<std::size_t>(plan.delta.size());
    return work;
}

}  // namespace penumbra
