// SPDX-License-Identifier: MIT
#include "core/passes/exact_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <numeric>

#include <glm/common.hpp>

#include "core/device_error.h"
#include "core/passes/exact_band.h"
#include "glsl/exact.h"

namespace penumbra {
namespace {

gl::BufferTexture sector_table(const ExactPlan& plan) {
    std::vector<glm::vec4> table;
    for (int s = 0; s < plan.sectors; ++s) {
        const double angle = plan.first_axis + 2 * std::numbers::pi * s / plan.sectors;
        table.push_back(glm::vec4(std::cos(angle), std::sin(angle), angle, 0));
    }
    return gl::BufferTexture(GL_RGBA32F, table.data(), table.size() * sizeof(glm::vec4));
}

constexpr std::size_t kMostListTexels = (std::size_t(1) << 27) / 16;

void check_lists(std::size_t texels, std::uint32_t work) {
    if (work == glsl::kExactTooLong)
        throw TooDense("The scene is too dense for the method 'exact': from one tile, a sector of directions holds more pieces of "
                       "outline than can be counted.");
    if (texels > kMostListTexels)
        throw TooDense("The scene is too dense for the method 'exact': its lists of what may be seen need " + std::to_string(texels >> 16) + " MiB.");
}

// No pixel's mean radiance is above that of the brightest source, colour by colour. Where pieces shine differently from place to place
// no such bound is kept.
glm::vec4 most_light(const PackedOutline& outline, const Sky& sky, double radiance_scale, bool surfaces) {
    if (surfaces) return glm::vec4(std::numeric_limits<float>::max());
    Colour brightest = sky.radiance;
    for (const SkyStop& stop : sky.gradient) brightest = glm::max(brightest, stop.radiance);
    glm::vec4 most(glm::vec3(brightest / radiance_scale), 0.0f);
    for (const glm::vec4& light : outline.lights_of) most = glm::max(most, light);
    return most;
}

}  // namespace

ExactPass::ExactPass(const std::string& shader_dir)
    : shader_dir_(shader_dir),
      split_("exact_split.comp", sizeof(glsl::ExactParams), shader_dir),
      gather_("exact_jobs.comp", sizeof(glsl::ExactParams), shader_dir),
      mean_("exact_mean.comp", sizeof(glsl::ExactParams), shader_dir),
      fill_("exact_fill.comp", sizeof(glsl::ExactParams), shader_dir),
      reflect_("exact_reflect.comp", sizeof(glsl::ExactParams), shader_dir),
      counters_(GL_R32UI, 4 * glsl::kExactCountTiles),
      told_(GL_R32UI, 4 * glsl::kExactToldCount),
      change_(GL_R32UI, 8) {}

std::size_t ExactPass::bytes() const {
    return coarse_heads_.bytes() + coarse_entries_.bytes() + coarse_lights_.bytes() + heads_.bytes() + entries_.bytes() +
           lights_.bytes() + points_.bytes() + asks_.bytes() + cells_[0].bytes() + cells_[1].bytes() + counters_.bytes() + means_.bytes() + elements_.bytes() + elements_before_.bytes();
}

int ExactPass::list_lanes(std::size_t lists) const {
    if (lanes_ == 1) return 1;
    return lists > 300'000 ? 1 : lists > 50'000 ? 4 : 16;
}

gl::ComputeProgram& ExactPass::lists_for(const ExactPlan& exact, int lanes) {
    const std::tuple key(exact.outline.counts[2] > 0, exact.outline.counts[3] > 0, lanes);
    const auto found = lists_.find(key);
    if (found != lists_.end()) return found->second;
    const gl::ShaderConstants constants = {{"kArcs", std::get<0>(key) ? 1 : 0}, {"kEllipses", std::get<1>(key) ? 1 : 0}, {"kListLanes", lanes}};
    return lists_.emplace(key, gl::ComputeProgram("exact_lists.comp", sizeof(glsl::ExactParams), shader_dir_, constants)).first->second;
}

gl::ComputeProgram& ExactPass::solver_for(const Needs& needs) {
    const auto found = solvers_.find(needs);
    if (found != solvers_.end()) return found->second;
    const gl::ShaderConstants constants = {{"kArcs", needs.arcs ? 1 : 0},
                                           {"kEllipses", needs.ellipses ? 1 : 0},
                                           {"kSky", needs.sky},
                                           {"kSlopes", needs.slopes ? 1 : 0},
                                           {"kSurfaces", needs.surfaces ? 1 : 0},
                                           {"kNodes", needs.nodes ? 1 : 0},
                                           {"kMoment", needs.moment},
                                           {"kExactSolveGroupX", group_jobs()},
                                           {"kExactSolveThreads", group_threads()},
                                           {"kExactLanes", lanes_},
                                           {"EXACT_WIDTH", lanes_ > 1 ? 1 : 4},
                                           {"kBudget", static_cast<int>(long_loops_ ? kMostWorkOfLongLoops : kMostWork)}};
    return solvers_.emplace(needs, gl::ComputeProgram("exact_solve.comp", sizeof(glsl::ExactParams), shader_dir_, constants)).first->second;
}

PassWork ExactPass::make_lists(const Plan& plan, Band& band) {
    const ExactPlan& exact = plan.exact;
    PassWork work;
    const auto lists_of = [&](glm::ivec2 tiles) {
        return static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y) * static_cast<std::size_t>(exact.sectors);
    };
    // One level of lists: from a parent's, or from the list of all pieces. Lists claim room as they are made; when it was
    // too little, all is made again with more.
    const auto make = [&](glm::ivec2 tiles, int tile_px, int ratio, bool wide, gl::StorageBuffer& heads,
                          gl::StorageBuffer& entries, gl::StorageBuffer& lights) {
        heads = at_least(std::move(heads), GL_RGBA32UI, lists_of(tiles) * (wide ? 32 : 16));
        // Where lanes share sectors nothing waits for what lists took: they get ample room, and at the end of the frame it is seen
        // whether it was enough (lists_fit).
        const bool ask_later = lanes_ > 1;
        const std::size_t first_room = ask_later ? std::min(12 * lists_of(tiles) + 1024, kMostListTexels) : 4 * lists_of(tiles) + 1024;
        std::size_t capacity = std::max({entries.bytes() / 16, first_room, ask_later ? list_texels_[wide ? 1 : 0] : 0});
        const std::size_t told = wide ? 2 : 0;
        const int lanes = list_lanes(lists_of(tiles));
        gl::ComputeProgram& program = lists_for(exact, lanes);
        for (;;) {
            entries = at_least(std::move(entries), GL_RGBA32F, capacity * 16);
            lights = at_least(std::move(lights), GL_RGBA32F, capacity * 16);
            const std::uint32_t zero[2] = {};
            told_.write(4 * told, zero, sizeof(zero));
            glsl::ExactParams params = band.params;
            params.tiles = tiles;
            params.tile_px = tile_px;
            params.parent_ratio = ratio;
            params.parent_tiles = band.coarse_tiles;
            params.capacity = static_cast<int>(capacity);
            params.wide = wide ? 1 : 0;
            params.told = static_cast<int>(told);
            params.extent = {tiles.x, tiles.y * exact.sectors};
            if (ratio == 0) {
                band.root_entries.bind_texture(glsl::kExactEntriesUnit);
                band.root_lights.bind_texture(glsl::kExactLightsUnit);
            } else {
                coarse_heads_.bind_texture(glsl::kExactHeadsUnit);
                coarse_entries_.bind_texture(glsl::kExactEntriesUnit);
                coarse_lights_.bind_texture(glsl::kExactLightsUnit);
            }
            band.sectors.bind_texture(glsl::kExactSectorsUnit);
            told_.bind_storage(glsl::kExactToldStorage);
            heads.bind_storage(glsl::kExactHeadsStorage);
            entries.bind_storage(glsl::kExactEntriesStorage);
            lights.bind_storage(glsl::kExactLightsStorage);
            work.dispatches += program.dispatch(params, {params.extent.x * lanes, params.extent.y});
            if (ask_later) {
                work.bytes += list_texels_[wide ? 1 : 0] * std::size_t(32) + heads.bytes();
                return std::uint32_t(0);
            }
            std::uint32_t used[2] = {};
            told_.read(4 * told, used, sizeof(used));
            if (used[0] <= capacity) {
                check_lists(used[0], used[1]);
                work.bytes += used[0] * std::size_t(32) + heads.bytes();
                return used[1];
            }
            capacity = used[0] + std::size_t(used[0]) / 4;
            check_lists(capacity, used[1]);
        }
    };
    int ratio = 0;
    if (exact.coarse_tile > 0) {
        band.coarse_tiles = {divided_up(band.area.x, exact.coarse_tile), divided_up(band.area.y, exact.coarse_tile)};
        make(band.coarse_tiles, exact.coarse_tile, 0, true, coarse_heads_, coarse_entries_, coarse_lights_);
        ratio = exact.coarse_tile / glsl::kExactTile;
    }
    const std::uint32_t list_work = make(band.params.tiles, glsl::kExactTile, ratio, false, heads_, entries_, lights_);
    band.point_work = std::int64_t(list_work) * exact.sectors;
    // An open sector, and one that is looked through for lights, takes a little more than its list says.
    band.most_dispatches = solver_dispatches(list_work + std::int64_t(list_work) / 8 + 40, exact.sectors, long_loops_ ? kMostWorkOfLongLoops : kMostWork);
    // Lanes share the sectors: none has so much to do that a dispatch would not end it.
    if (lanes_ > 1) band.most_dispatches = 1;
    return work;
}

bool ExactPass::lists_fit() {
    if (lanes_ == 1) return true;
    std::uint32_t told[4] = {};
    told_.read(0, told, sizeof(told));
    bool fit = true;
    const gl::StorageBuffer* const entries[] = {&entries_, &coarse_entries_};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t texels = told[2 * i];
        list_texels_[i] = texels;
        check_lists(texels, told[2 * i + 1]);
        if (texels <= entries[i]->bytes() / 16) continue;
        fit = false;
        list_texels_[i] = std::min(texels + texels / 4, kMostListTexels);
    }
    return fit;
}

void ExactPass::check_spent(const char* points) const {
    std::uint32_t spent = 0;
    told_.read(4 * glsl::kExactToldSpent, &spent, sizeof(spent));
    if (spent != 0)
        throw TooDense("The scene is too dense for the method 'exact' on this device: at " + std::to_string(spent) + " " + points +
                       " its loops ran out of iterations.");
}

PassWork ExactPass::solve(const Plan& plan, const DistanceField& field, Band& band, int level, int moment) {
    PassWork work;
    glsl::ExactParams params = band.params;
    params.level = level;
    band.levels[static_cast<std::size_t>(level)].write_to(params);
    const PackedOutline& outline = plan.exact.outline;
    gl::ComputeProgram& program =
        solver_for({outline.counts[2] > 0, outline.counts[3] > 0, params.sky_kind, level < kLevels - 1, plan.exact.surfaces, false, moment});
    const int tiles = params.tiles.x * params.tiles.y;
    params.extent = {tiles, 1};
    asks_.bind_texture(glsl::kExactAsksUnit);
    points_.bind_storage(glsl::kExactPointsStorage);
    jobs_.bind_storage(glsl::kExactJobsStorage);
    counters_.bind_storage(glsl::kExactCountersStorage);
    work.dispatches += gather_.of({{"kExactSolveGroupX", group_jobs()}}).dispatch(params, params.extent);
    band.value.bind_image(glsl::kExactValueImage, GL_READ_WRITE);
    band.slope_x.bind_image(glsl::kExactSlopeXImage, GL_READ_WRITE);
    band.slope_y.bind_image(glsl::kExactSlopeYImage, GL_READ_WRITE);
    field.distance.bind_texture(glsl::kExactDistanceUnit);
    points_.bind_texture(glsl::kExactPointsUnit);
    const std::size_t group_count = 4 * static_cast<std::size_t>(glsl::kExactCountLevel + 4 * level + 1);
    std::uint32_t groups = 0;
    if (in_slices()) {
        counters_.read(group_count, &groups, sizeof(groups));
        params.extent = band.solver_rows(static_cast<int>(groups));
    }
    run_solver(params, band, work, moment, [&](const glsl::ExactParams& p) {
        if (in_slices()) return program.dispatch(p, p.extent, static_cast<std::size_t>(p.extent.x));
        program.dispatch_indirect(p, group_count);
        return 1;
    });
    return work;
}

// Dispatches until every point is done: one whose loops have spent their iterations goes on in the next. Where loops may be long, as often
// as might be needed: it is seldom more than once, and what waits for nothing is quicker.
void ExactPass::run_solver(glsl::ExactParams params, Band& band, PassWork& work, int moment,
                           const std::function<int(const glsl::ExactParams&)>& dispatch) {
    heads_.bind_texture(glsl::kExactHeadsUnit);
    entries_.bind_texture(glsl::kExactEntriesUnit);
    lights_.bind_texture(glsl::kExactLightsUnit);
    jobs_.bind_texture(glsl::kExactJobsUnit);
    band.sectors.bind_texture(glsl::kExactSectorsUnit);
    band.sky[static_cast<std::size_t>(moment)].bind_texture(glsl::kExactSkyUnit);
    if (band.surfaces) {
        band.surfaces.bind_texture(glsl::kExactSurfacesUnit);
        elements_.bind_texture(glsl::kExactElementsUnit);
    }
    counters_.bind_storage(glsl::kExactCountersStorage);
    told_.bind_storage(glsl::kExactToldStorage);
    counters_.bind_indirect();
    for (int done = 0;;) {
        work.dispatches += dispatch(params);
        params.continues = 1;
        ++done;
        if (band.most_dispatches == 1 || (long_loops_ && done == band.most_dispatches)) break;
        if (long_loops_) continue;
        check_spent("points");
        std::uint32_t unfinished = 0;
        told_.read(4 * glsl::kExactToldUnfinished, &unfinished, sizeof(unfinished));
        if (unfinished == 0) break;
        unfinished = 0;
        told_.write(4 * glsl::kExactToldUnfinished, &unfinished, sizeof(unfinished));
    }
}

ExactPass::Band ExactPass::prepare(const Plan& plan, const Sky& sky) const {
    const ExactPlan& exact = plan.exact;
    const PackedOutline& outline = exact.outline;
    Band band;
    band.root_entries = gl::BufferTexture(GL_RGBA32F, outline.entries.data(), outline.entries.size() * 16);
    band.root_lights = gl::BufferTexture(GL_RGBA32F, outline.lights_of.data(), outline.lights_of.size() * 16);
    band.sectors = sector_table(exact);
    const int moments = exact.moments ? 3 : 1;
    for (int moment = 0; moment < moments; ++moment) {
        const std::vector<glm::vec4> nodes =
            exact.sky_nodes > 0 ? sky_nodes(sky, exact.sky_nodes, plan.radiance_scale, moment) : std::vector<glm::vec4>();
        band.sky[static_cast<std::size_t>(moment)] = gl::BufferTexture(GL_RGBA32F, nodes.data(), nodes.size() * 16);
    }

    glsl::ExactParams& params = band.params;
    params.canvas = plan.canvas;
    params.border = plan.grid.border;
    params.sectors = exact.sectors;
    params.tan_half = static_cast<float>(std::tan(std::numbers::pi / exact.sectors));
    params.sky = glm::vec4(glm::vec3(sky.radiance / plan.radiance_scale), 0.0f);
    params.sky_kind = exact.sky_nodes > 0 ? 2 : sky.radiance != Colour(0) ? 1 : 0;
    params.sky_nodes = exact.sky_nodes;
    params.tolerance = static_cast<float>(exact.settings.tolerance);
    params.kink_cell = exact.settings.kink_cell;
    params.largest_cell = exact.settings.largest_cell;
    params.strict_dark = exact.settings.strict_dark ? 1 : 0;
    params.floor_share = 0.05f;
    params.root_counts = {outline.counts[0], outline.counts[1], outline.counts[2], outline.counts[3]};
    params.root_lights = {outline.lights[0], outline.lights[1], outline.lights[2], outline.lights[3]};
    return band;
}

void ExactPass::run(const Plan& plan, const Sky& sky, const DistanceField& field, const PassSettings& settings,
                    DeltaPass& delta, const Record& record, Light& out, const SeeCells& see_cells) {
    const ExactPlan& exact = plan.exact;
    Band band = prepare(plan, sky);
    glsl::ExactParams& params = band.params;
    gl::Texture2D* const results[] = {&out.mean, &out.moment_x, &out.moment_y};
    const int moments = exact.moments ? 3 : 1;
    for (int i = 0; i < moments; ++i) *results[i] = settings.take(plan.half_floats ? GL_RGBA16F : GL_RGBA32F, plan.lit.size);
    params.most = most_light(exact.outline, sky, plan.radiance_scale, exact.surfaces);
    if (exact.surfaces) bounce(plan, settings, delta, record, band);
    for (int row = 0; row < plan.canvas.y; row += exact.band_rows) {
        band.area = {plan.canvas.x, std::min(exact.band_rows, plan.canvas.y - row)};
        params.first_row = row;
        params.list_origin = {0, row};
        // Of this band, the rows that are asked for, and the tiles that they are in.
        const int first_lit = std::max(plan.lit.first.y - row, 0);
        const int end_lit = std::min(plan.lit.end().y - row, band.area.y);
        if (first_lit >= end_lit) continue;
        params.window = {plan.lit.first.x / glsl::kExactTile, first_lit / glsl::kExactTile,
                         divided_up(plan.lit.end().x, glsl::kExactTile), divided_up(end_lit, glsl::kExactTile)};
        params.fill_first = {plan.lit.first.x, first_lit};
        params.fill_row = row + first_lit - plan.lit.first.y;
        params.tiles = {divided_up(band.area.x, glsl::kExactTile), divided_up(band.area.y, glsl::kExactTile)};
        const std::size_t tiles = static_cast<std::size_t>(params.tiles.x) * static_cast<std::size_t>(params.tiles.y);
        std::size_t room = 0;
        for (std::size_t level = 0; level < kLevels; ++level) {
            band.levels[level] = {room, exact_level_points(static_cast<int>(level)), glsl::kExactCountTiles + level * tiles,
                                  level * tiles * glsl::kExactTileRows};
            room += tiles * band.levels[level].of_tile;
        }
        points_ = at_least(std::move(points_), GL_R32UI, room * 4);
        asks_ = at_least(std::move(asks_), GL_R32UI, kLevels * tiles * glsl::kExactTileRows * 4);
        asks_.clear(kLevels * tiles * glsl::kExactTileRows * 4);
        const std::size_t halves = kLevels - 2;  // of the cells of the last level but one, at most all are split
        for (gl::StorageBuffer& cells : cells_) cells = at_least(std::move(cells), GL_R32UI, (tiles << (2 * halves)) * 4);
        jobs_ = at_least(std::move(jobs_), GL_R32UI, tiles * (1 + band.levels.back().of_tile / 4) * 4);
        std::vector<std::uint32_t> zero(glsl::kExactCountTiles + kLevels * tiles);
        for (std::size_t level = 0; level < kLevels; ++level)  // groups along y and z
            zero[glsl::kExactCountLevel + 4 * level + 2] = zero[glsl::kExactCountLevel + 4 * level + 3] = 1;
        counters_ = at_least(std::move(counters_), GL_R32UI, zero.size() * 4);
        counters_.write(0, zero.data(), zero.size() * 4);
        told_.clear(told_.bytes());
        means_ = at_least(std::move(means_), GL_R32F, (static_cast<std::size_t>(params.tiles.x) + 1) * 4);
        record("exact lists", {params.tiles.x, params.tiles.y * exact.sectors}, [&] { return make_lists(plan, band); });

        const glm::ivec2 grid = params.tiles * glsl::kExactTile + 1;  // of points
        band.value = settings.take(GL_RGBA32F, grid);
        band.slope_x = settings.take(GL_RGBA32F, grid);
        band.slope_y = settings.take(GL_RGBA32F, grid);
        band.leaf = settings.take(GL_R32UI, params.tiles * glsl::kExactTile);

        const auto split = [&](int level, bool ask_first) {
            PassWork work;
            field.distance.bind_texture(glsl::kExactDistanceUnit);
            band.value.bind_image(glsl::kExactValueImage, GL_READ_ONLY);
            band.slope_x.bind_image(glsl::kExactSlopeXImage, GL_READ_ONLY);
            band.slope_y.bind_image(glsl::kExactSlopeYImage, GL_READ_ONLY);
            band.leaf.bind_image(glsl::kExactLeafImage, GL_READ_WRITE);
            asks_.bind_storage(glsl::kExactAsksStorage);
            means_.bind_texture(glsl::kExactSkyUnit);
            heads_.bind_texture(glsl::kExactHeadsUnit);
            glsl::ExactParams p = params;
            p.ask_first = ask_first ? 1 : 0;
            p.level = level;
            p.cell = glsl::kExactCell >> level;
            p.extent = params.tiles * (glsl::kExactTile / p.cell) + (ask_first ? 1 : 0);
            cells_[level % 2].bind_storage(glsl::kExactCellsStorage);
            counters_.bind_storage(glsl::kExactCountersStorage);
            if (level > 0) {
                cells_[(level + 1) % 2].bind_texture(glsl::kExactCellsUnit);
                if (in_slices()) {
                    // Only the parts of what was split; where nothing waits for the host, all that might be.
                    std::uint32_t larger = 0;
                    counters_.read(std::size_t(4) * (glsl::kExactCountCells + level - 1), &larger, sizeof(larger));
                    p.extent = {std::min(4 * static_cast<int>(larger), 4096), divided_up(4 * static_cast<int>(larger), 4096)};
                }
            }
            band.levels[static_cast<std::size_t>(ask_first ? 0 : level + 1)].write_to(p);
            work.dispatches = split_.dispatch(p, p.extent);
            return work;
        };
        const auto points_name = [](int level) { return "exact points " + std::to_string(glsl::kExactCell >> level); };
        record("exact cells", params.tiles * 2, [&] { return split(0, true); });
        record(points_name(0).c_str(), params.tiles * 2, [&] { return solve(plan, field, band, 0); });
        record("exact mean", {params.tiles.x, 1}, [&] {
            PassWork work;
            band.value.bind_texture(glsl::kExactValueUnit);
            means_.bind_texture(glsl::kExactSkyUnit);
            means_.bind_storage(glsl::kExactPointsStorage);
            for (int phase = 0; phase < 2; ++phase) {
                glsl::ExactParams p = params;
                p.level = phase;
                p.extent = {phase == 0 ? params.tiles.x : 1, 1};
                work.dispatches += mean_.dispatch(p, p.extent);
            }
            return work;
        });
        for (int level = 0; level + 1 < kLevels; ++level) {
            const glm::ivec2 cells = params.tiles * (2 << level);
            record("exact cells", cells, [&] { return split(level, false); });
            record(points_name(level + 1).c_str(), cells * 2, [&] { return solve(plan, field, band, level + 1); });
        }
        std::vector<std::uint32_t> counted(zero.size());
        const auto fill = [&](int moment) {
            PassWork work;
            band.value.bind_image(glsl::kExactValueImage, GL_READ_ONLY);
            band.slope_x.bind_image(glsl::kExactSlopeXImage, GL_READ_ONLY);
            band.slope_y.bind_image(glsl::kExactSlopeYImage, GL_READ_ONLY);
            band.leaf.bind_image(glsl::kExactLeafImage, GL_READ_ONLY);
            results[moment]->bind_image(glsl::kExactRadianceImage, GL_WRITE_ONLY);
            glsl::ExactParams p = params;
            p.fill_size = {plan.lit.size.x, end_lit - first_lit};
            p.extent = (p.fill_first % 2 + p.fill_size + 1) / 2;  // blocks of two by two
            work.dispatches = fill_.of({{"kSigned", moment > 0 ? 1 : 0}}).dispatch(p, p.extent, settings.pixels / 4);
            return work;
        };
        record("exact fill", {plan.lit.size.x, end_lit - first_lit}, [&] { return fill(0); });
        counters_.read(0, counted.data(), counted.size() * 4);
        record("exact fill", {plan.lit.size.x, 0}, [&] {
            PassWork work;
            work.points = std::accumulate(counted.begin() + glsl::kExactCountTiles, counted.end(), std::size_t(0));
            return work;
        });
        const bool fits = lists_fit();
        if (fits) check_spent("points");
        if (fits && see_cells) see_cells(band.leaf, row, band.area.y);
        // Radiance times direction, at the same points and in the same cells: its edges are the same.
        for (int moment = 1; fits && moment < moments; ++moment) {
            record("exact moments", {plan.lit.size.x, end_lit - first_lit}, [&] {
                counters_.write(0, zero.data(), std::size_t(4) * glsl::kExactCountTiles);
                PassWork work;
                for (int level = 0; level < kLevels; ++level) work.dispatches += solve(plan, field, band, level, moment).dispatches;
                work.dispatches += fill(moment).dispatches;
                return work;
            });
        }
        settings.give(std::move(band.value));
        settings.give(std::move(band.slope_x));
        settings.give(std::move(band.slope_y));
        settings.give(std::move(band.leaf));
        if (!fits) row -= exact.band_rows;  // once more
    }
}

}  // namespace penumbra
