// SPDX-License-Identifier: MIT
#include "core/passes/hrc_pass.h"

#include "glsl/cascade.h"
#include "glsl/hrc.h"

namespace penumbra {
namespace {

glsl::HrcParams common(const Plan& plan, const HrcQuadrant& q) {
    glsl::HrcParams params{};
    params.border = plan.grid.border;
    params.rows = q.rows;
    params.climb = plan.hrc.settings.climb;
    params.points = plan.hrc.points;
    params.first = glm::vec2(q.first);
    params.along = glm::vec2(q.along);
    params.across = glm::vec2(q.across);
    params.first_point = glm::vec2(plan.hrc.first_point);
    params.cell = static_cast<float>(plan.hrc.settings.cell_px);
    params.row_border = q.row_border;
    const PixelBox& domain = plan.grid.domain;
    params.domain = {float(domain.x0), float(domain.y0), float(domain.x1), float(domain.y1)};
    return params;
}

GLenum format(const Plan& plan) { return plan.half_floats ? GL_RGBA16F : GL_RGBA32F; }

const HrcLevel& level_of(const HrcQuadrant& q, int n) { return q.levels[static_cast<std::size_t>(n)]; }

// Room for every ray of the level that traces most of them: level 0.
glm::ivec2 hrc_list_size(const HrcQuadrant& q) {
    const std::size_t rays = level_of(q, 0).pieces(q.rows);
    return {glsl::kHrcListWidth, static_cast<int>((rays + glsl::kHrcListWidth - 1) / glsl::kHrcListWidth)};
}

void set_jobs(glsl::HrcParams& params, int jobs) {
    params.jobs = jobs;
    params.per_job = 1.0f / static_cast<float>(jobs);
}

}  // namespace

HrcPass::ByFormat::ByFormat(const std::string& name, const std::string& shader_dir)
    : full(name + ".comp", sizeof(glsl::HrcParams), shader_dir), half(name + "_half.comp", sizeof(glsl::HrcParams), shader_dir) {}

HrcPass::HrcPass(const std::string& shader_dir)
    : low_("hrc_low", shader_dir),
      trace_("hrc_trace.comp", sizeof(glsl::HrcParams), shader_dir),
      extend_("hrc_extend", shader_dir),
      merge_("hrc_merge", shader_dir),
      clear_("hrc_clear.comp", sizeof(glsl::HrcParams), shader_dir),
      gather_("hrc_gather.comp", sizeof(glsl::HrcParams), shader_dir),
      blur_("hrc_blur.comp", sizeof(glsl::HrcParams), shader_dir),
      spread_("hrc_spread.comp", sizeof(glsl::HrcParams), shader_dir) {}

PassWork HrcPass::pieces(const Plan& plan, const HrcQuadrant& q, const DistanceField& field, const PassSettings& settings,
                         std::vector<gl::Texture2D>& pieces) {
    const int n = static_cast<int>(pieces.size());
    const HrcLevel& level = level_of(q, n);
    const bool low = n < plan.hrc.settings.traced_levels;
    // Taken before anything is bound: making a texture binds it.
    gl::Texture2D out = settings.take(format(plan), {q.rows, plan.hrc.halves() * level.planes * level.rays});
    gl::Texture2D list;
    gl::Texture2D count;
    if (low) {
        list = settings.take(GL_R32UI, hrc_list_size(q));
        count = settings.take(GL_R32UI, {1, 1});
        const GLuint none = 0;
        count.fill(GL_RED_INTEGER, GL_UNSIGNED_INT, &none);
    }
    glsl::HrcParams params = common(plan, q);
    params.stride = 1 << n;
    params.rays = level.rays;
    set_jobs(params, level.rays);
    if (n > 0) {
        const HrcLevel& below = level_of(q, n - 1);
        params.lower_planes = below.planes;
        params.lower_rays = below.rays;
        params.compose = 1;
        set_jobs(params, below.rays);
        pieces.back().bind_image(glsl::kHrcPiecesBinding, GL_READ_ONLY);
    }
    out.bind_image(glsl::kHrcImageBinding, GL_WRITE_ONLY);
    params.extent = {q.rows, level.planes * params.jobs};
    PassWork work;
    work.bytes = out.bytes();
    if (low) {
        if (n == 0) out.bind_image(glsl::kHrcPiecesBinding, GL_READ_ONLY);  // not read
        field.distance.bind_texture(glsl::kHrcDistanceUnit);
        list.bind_image(glsl::kHrcListBinding, GL_WRITE_ONLY);
        count.bind_image(glsl::kHrcCountBinding, GL_READ_WRITE);
        work.dispatches = low_.of(plan).dispatch(params, params.extent, settings.pixels);
        work.rays = static_cast<std::size_t>(q.rows) * static_cast<std::size_t>(level.planes) *
                    static_cast<std::size_t>(n > 0 ? level.rays - params.jobs : level.rays);
        GLuint listed = 0;
        count.read(GL_RED_INTEGER, GL_UNSIGNED_INT, &listed);
        params.listed = static_cast<int>(listed);
        set_jobs(params, level.rays);
        params.extent = {glsl::kHrcListWidth, (params.listed + glsl::kHrcListWidth - 1) / glsl::kHrcListWidth};
        field.distance.bind_texture(glsl::kCascadeDistanceUnit);
        field.material.bind_texture(glsl::kCascadeMaterialUnit);
        list.bind_texture(glsl::kHrcListUnit);
        if (params.listed > 0) work.dispatches += trace_.of(march_constants(plan.needs)).dispatch(params, params.extent, settings.rays);
        settings.give(std::move(list));
        settings.give(std::move(count));
    } else {
        work.dispatches = extend_.of(plan).dispatch(params, params.extent, settings.pixels);
    }
    pieces.push_back(std::move(out));
    return work;
}

PassWork HrcPass::merge(const Plan& plan, const HrcQuadrant& q, int n, const std::vector<gl::Texture2D>& pieces,
                        const gl::Texture2D* upper, const PassSettings& settings, gl::Texture2D& out) {
    const HrcLevel& level = level_of(q, n);
    const HrcLevel& above = level_of(q, n + 1);
    out = settings.take(format(plan), {q.rows, level.planes * level.cones});
    glsl::HrcParams params = common(plan, q);
    params.stride = 1 << n;
    params.cones = level.cones;
    set_jobs(params, level.cones);
    params.upper_planes = upper != nullptr ? above.planes : 0;
    params.upper_cones = above.cones;
    params.upper_first = above.first_cone;
    (upper != nullptr ? *upper : pieces.back()).bind_image(glsl::kHrcUpperBinding, GL_READ_ONLY);  // bound even where not read
    out.bind_image(glsl::kHrcImageBinding, GL_WRITE_ONLY);
    PassWork work;
    work.bytes = out.bytes();
    for (const int parity : {0, 1}) {
        const int planes = (level.planes + 1 - parity) / 2;
        if (planes == 0) continue;
        params.first_plane = parity;
        params.leap = 2 - parity;
        params.piece_step = 1 + parity;
        params.ray_step = 2 - parity;
        params.lower_rays = parity == 0 ? above.rays : level.rays;
        params.own_terms = parity == 0 && upper != nullptr ? 2 : 0;
        pieces[static_cast<std::size_t>(n + 1 - parity)].bind_image(glsl::kHrcPiecesBinding, GL_READ_ONLY);
        params.extent = {q.rows, planes * level.cones};
        work.dispatches += merge_.of(plan).dispatch(params, params.extent, settings.pixels);
    }
    return work;
}

PassWork HrcPass::clear(const Plan& plan, const DistanceField& field, const PassSettings& settings, gl::Texture2D& sum) {
    sum = settings.take(GL_RGBA32F, plan.hrc.points);
    glsl::HrcParams params = common(plan, plan.hrc.quadrants.front());
    params.extent = plan.hrc.points;
    field.distance.bind_texture(glsl::kCascadeDistanceUnit);
    field.material.bind_texture(glsl::kCascadeMaterialUnit);
    sum.bind_image(glsl::kHrcImageBinding, GL_WRITE_ONLY);
    PassWork work;
    work.bytes = sum.bytes();
    work.dispatches = clear_.dispatch(params, params.extent, settings.pixels);
    return work;
}

PassWork HrcPass::gather(const Plan& plan, const HrcQuadrant& q, const gl::Texture2D& fluence, const PassSettings& settings,
                         gl::Texture2D& sum) {
    glsl::HrcParams params = common(plan, q);
    params.cones = level_of(q, 0).cones;
    params.is_first = sum ? 0 : 1;
    if (!sum) sum = settings.take(GL_RGBA32F, plan.hrc.points);
    const bool horizontal = q.along.x != 0;
    const bool backward = q.along.x + q.along.y < 0;
    params.row_step = horizontal ? glm::ivec2(0, 1) : glm::ivec2(1, 0);
    params.column_step = (backward ? -1 : 1) * (glm::ivec2(1) - params.row_step);
    if (backward) params.corner = (plan.hrc.points - 1) * (glm::ivec2(1) - params.row_step);
    params.extent = horizontal ? glm::ivec2(plan.hrc.points.y, plan.hrc.points.x) : plan.hrc.points;
    fluence.bind_texture(glsl::kHrcFluenceUnit);
    sum.bind_image(glsl::kHrcImageBinding, GL_READ_WRITE);
    PassWork work;
    work.bytes = sum.bytes();
    work.dispatches = gather_.dispatch(params, params.extent, settings.pixels);
    return work;
}

PassWork HrcPass::finish(const Plan& plan, const DistanceField& field, const gl::Texture2D& sum, const PassSettings& settings,
                         gl::Texture2D& out) {
    glsl::HrcParams params = common(plan, plan.hrc.quadrants.front());
    params.blur = static_cast<float>(plan.hrc.settings.blur);
    params.extent = plan.canvas;
    out = settings.take(format(plan), plan.canvas);
    field.distance.bind_texture(glsl::kHrcDistanceUnit);
    field.material.bind_texture(glsl::kCascadeMaterialUnit);
    sum.bind_texture(glsl::kHrcSumUnit);
    out.bind_image(glsl::kHrcImageBinding, GL_WRITE_ONLY);
    PassWork work;
    work.bytes = out.bytes();
    gl::ComputeProgram& program = plan.hrc.aligned() ? blur_ : spread_;
    work.dispatches = program.dispatch(params, plan.canvas, settings.pixels);
    return work;
}

}  // namespace penumbra
