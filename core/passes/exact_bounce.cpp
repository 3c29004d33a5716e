// SPDX-License-Identifier: MIT
// Light that bounces between surfaces, by the method `exact`.
#include <cstring>

#include "core/device_error.h"
#include "core/passes/exact_band.h"

namespace penumbra {

PassWork ExactPass::reflect(const Plan& plan, Band& band, bool first) {
    const Surfaces& surfaces = plan.exact.outline.surfaces;
    glsl::ExactParams params = band.params;
    params.level = first ? 0 : 1;
    params.extent = {static_cast<int>(surfaces.pieces.size()), 1};
    const std::uint32_t zero[2] = {};
    change_.write(0, zero, sizeof(zero));
    band.surfaces.bind_texture(glsl::kExactSurfacesUnit);
    band.materials.bind_texture(glsl::kExactMaterialsUnit);
    band.value.bind_texture(glsl::kExactNodeValuesUnit);
    if (band.lights) {
        band.lights.bind_texture(glsl::kExactNodeLightsUnit);
        params.light_scale = static_cast<float>(1.0 / plan.radiance_scale);
    }
    // The next elements are made from the last.
    std::swap(elements_, elements_before_);
    elements_before_.bind_texture(glsl::kExactElementsUnit);
    elements_.bind_storage(glsl::kExactElementsStorage);
    change_.bind_storage(glsl::kExactChangeStorage);
    PassWork work;
    work.dispatches = reflect_.dispatch(params, params.extent);
    work.bytes = surfaces.elements * glsl::kExactElementTexels * std::size_t(16);
    return work;
}

void ExactPass::bounce(const Plan& plan, const PassSettings& settings, DeltaPass& delta, const Record& record, Band& band) {
    const ExactPlan& exact = plan.exact;
    const Surfaces& surfaces = exact.outline.surfaces;
    for (gl::StorageBuffer* buffer : {&elements_, &elements_before_})
        *buffer = at_least(std::move(*buffer), GL_RGBA32F, surfaces.elements * glsl::kExactElementTexels * 16);
    band.surfaces = gl::BufferTexture(GL_RGBA32F, surfaces.pieces.data(), surfaces.pieces.size() * 16);
    band.materials = gl::BufferTexture(GL_RGBA32F, surfaces.materials.data(), surfaces.materials.size() * 16);
    const glm::ivec2 image{glsl::kExactNodeRow, divided_up(static_cast<int>(surfaces.elements), glsl::kExactNodeRow)};
    band.value = settings.take(GL_RGBA32F, image);
    band.slope_x = settings.take(GL_RGBA32F, image);
    band.slope_y = settings.take(GL_RGBA32F, image);
    if (plan.delta.used()) band.lights = settings.take(GL_RGBA32F, image);
    const int elements = static_cast<int>(surfaces.elements);
    record("reflect", {elements, 1}, [&] { return reflect(plan, band, true); });

    // Surfaces in the margin light others as well: lists are for the whole domain, in bands as the picture's.
    const glm::ivec2 origin = -plan.grid.border - 1;
    const glm::ivec2 domain = plan.grid.size + 2;
    struct Part {
        glm::ivec2 origin, area, tiles;
        SurfaceJobs jobs;
    };
    std::vector<Part> parts;
    for (int row = 0; exact.bounces > 0 && row < domain.y; row += exact.band_rows) {
        Part part;
        part.origin = origin + glm::ivec2(0, row);
        part.area = {domain.x, std::min(exact.band_rows, domain.y - row)};
        part.tiles = {divided_up(part.area.x, glsl::kExactTile), divided_up(part.area.y, glsl::kExactTile)};
        Surfaces inside;
        for (const Surfaces::Node& node : surfaces.nodes) {
            const double y = double(node.place.y) - 0.5 - part.origin.y;
            if ((row == 0 || y >= 0) && (row + exact.band_rows >= domain.y || y < part.area.y)) inside.nodes.push_back(node);
        }
        part.jobs = surface_jobs(inside, part.origin, part.tiles, glsl::kExactTile);
        if (!part.jobs.tiles.empty()) parts.push_back(std::move(part));
    }
    const PackedOutline& outline = exact.outline;
    told_.clear(told_.bytes());
    for (int i = 0; i < exact.bounces; ++i) {
        gl::ComputeProgram& program =
            solver_for({outline.counts[2] > 0, outline.counts[3] > 0, band.params.sky_kind, false, true, true, 0});
        for (const Part& part : parts) {
            band.area = part.area;
            band.params.tiles = part.tiles;
            band.params.list_origin = part.origin;
            // One part's lists serve all bounces.
            if (i == 0 || parts.size() > 1)
                do record("exact lists", {part.tiles.x, part.tiles.y * exact.sectors}, [&] { return make_lists(plan, band); });
                while (!lists_fit());
            const int jobs = static_cast<int>(part.jobs.tiles.size());
            const gl::BufferTexture nodes(GL_RGBA32F, part.jobs.nodes.data(), part.jobs.nodes.size() * 16);
            jobs_ = at_least(std::move(jobs_), GL_R32UI, part.jobs.tiles.size() * 4);
            jobs_.write(0, part.jobs.tiles.data(), part.jobs.tiles.size() * 4);
            if (i == 0 && band.lights)
                record("lights on surfaces", {4 * jobs, 1},
                       [&] { return delta.surfaces(plan, {part.origin, part.area, jobs_, nodes, jobs}, band.lights); });
            record("bounce", {4 * jobs, 1}, [&] {
                PassWork work;
                band.value.bind_image(glsl::kExactValueImage, GL_READ_WRITE);
                band.slope_x.bind_image(glsl::kExactSlopeXImage, GL_READ_WRITE);
                band.slope_y.bind_image(glsl::kExactSlopeYImage, GL_READ_WRITE);
                nodes.bind_texture(glsl::kExactNodesUnit);
                glsl::ExactParams params = band.params;
                params.jobs = jobs;
                params.extent = {divided_up(jobs, group_jobs()) * group_threads(), 1};
                if (in_slices()) params.extent = band.solver_rows(divided_up(jobs, glsl::kExactSolveGroupX));
                run_solver(params, band, work, 0, [&](const glsl::ExactParams& p) { return program.dispatch(p, p.extent, in_slices() ? static_cast<std::size_t>(p.extent.x) : 0); });
                if (in_slices()) check_spent("points of surfaces");
                return work;
            });
        }
        record("reflect", {elements, 1}, [&] { return reflect(plan, band, false); });
        if (exact.converged <= 0) continue;
        std::uint32_t bits[2] = {};
        change_.read(0, bits, sizeof(bits));
        float change = 0, brightest = 0;
        std::memcpy(&change, &bits[0], 4);
        std::memcpy(&brightest, &bits[1], 4);
        if (double(change) <= exact.converged * double(brightest)) break;
    }
    if (exact.bounces > 0) check_spent("points of surfaces");
    settings.give(std::move(band.value));
    settings.give(std::move(band.slope_x));
    settings.give(std::move(band.slope_y));
    settings.give(std::move(band.lights));
}

std::vector<glm::vec4> ExactPass::surfaces(const Plan& plan, const Sky& sky, const PassSettings& settings, DeltaPass& delta, const Record& record) {
    Band band = prepare(plan, sky);
    bounce(plan, settings, delta, record, band);
    std::vector<glm::vec4> elements(plan.exact.outline.surfaces.elements * glsl::kExactElementTexels);
    elements_.read(0, elements.data(), elements.size() * sizeof(glm::vec4));
    return elements;
}

}  // namespace penumbra
