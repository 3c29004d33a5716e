// SPDX-License-Identifier: MIT
#include "core/renderer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <thread>
#include <type_traits>

#include "core/error_view.h"
#include "core/film/exposure.h"
#include "core/gl/checkpoint.h"
#include "core/gl/context.h"
#include "core/gl/loop_limit.h"
#include "core/gl/storage_buffer.h"
#include "core/gl/settle.h"
#include "core/gl/timer.h"
#include "core/passes/cascade_pass.h"
#include "core/passes/compose_pass.h"
#include "core/passes/delta_pass.h"
#include "core/passes/distance_pass.h"
#include "core/passes/exact_pass.h"
#include "core/passes/floor_pass.h"
#include "core/passes/field_view.h"
#include "core/passes/frame_look.h"
#include "core/passes/hrc_pass.h"
#include "core/passes/jump_flood_pass.h"
#include "core/passes/rc_fix_pass.h"
#include "core/passes/recorder.h"
#include "core/passes/lit_solids.h"
#include "core/passes/picture_reader.h"
#include "core/passes/closed_pass.h"
#include "core/passes/lone_pass.h"
#include "core/passes/near_bitmaps_pass.h"
#include "core/passes/reference_pass.h"
#include "core/passes/resolve_pass.h"
#include "core/passes/scene_buffers.h"
#include "core/passes/sum_pass.h"
#include "core/passes/surface_light.h"
#include "core/plan/plan.h"
#include "core/plan/shape_lists.h"
#include "core/plan/skip.h"
#include "core/plan/split_lights.h"
#include "core/scene/lower.h"
#include "core/scene/words.h"
#include "glsl/cascade.h"
#include "glsl/distance.h"
#include "glsl/exact.h"

namespace penumbra {
namespace {

// Two renders of 4096 x 4096.
constexpr std::size_t kPoolBytes = std::size_t(1) << 30;

// Threads of the solver that share a point.
constexpr int kSolverLanesOfGpu = 4;

}  // namespace

struct Renderer::Impl {
    explicit Impl(const RendererOptions& options)
        : context(options.device),
          samplers(options.shader_dir),
          distance(options.shader_dir),
          jump_flood(options.shader_dir),
          near_bitmaps(options.shader_dir),
          cascade(options.shader_dir),
          rc_fix(options.shader_dir),
          resolve(options.shader_dir),
          lone(options.shader_dir),
          closed(options.shader_dir),
          hrc(options.shader_dir),
          summing(options.shader_dir),
          reference(options.shader_dir),
          exact(options.shader_dir),
          delta(options.shader_dir),
          floor(options.shader_dir),
          compose(options.shader_dir) {
        if (options.tone_lut) compose.set_tone_lut(*options.tone_lut);
        const gl::ContextInfo& gl_info = context.info();
        info.kind = gl_info.software ? "cpu" : "gpu";
        info.platform = gl_info.platform;
        info.vendor = gl_info.vendor;
        info.renderer = gl_info.renderer;
        info.gl_version = gl_info.gl_version;
        info.glsl_version = gl_info.glsl_version;
        info.max_texture_side = gl_info.max_texture_side;
        info.max_texture_buffer_texels = gl_info.max_texture_buffer_texels;
        info.max_group_invocations = gl_info.max_group_invocations;
        info.max_loop_iterations = gl::measure_loop_limit(options.shader_dir);
        limits = device_limits(info.max_texture_side, info.max_texture_buffer_texels, info.max_loop_iterations, gl_info.software);
        const bool long_loops = !gl_info.software && info.max_loop_iterations == 0;
        if (long_loops) exact.allow_long_loops();
        exact.share_sectors(options.solver_lanes > 0 ? options.solver_lanes : long_loops ? kSolverLanesOfGpu : 1);
        // About 10 ms a dispatch on two cores of llvmpipe; a GPU takes a hundred times that.
        const std::size_t factor = gl_info.software ? 1 : 128;
        settings = {factor * 6'000'000, factor * 300'000, factor * 1'000'000, &textures, !gl_info.software};
    }

    RenderResult render(const Scene& scene, const std::string& not_exact = {});
    Pixels constant_picture(const Plan& plan, const Scene& scene, GLenum format, Recorder& record);
    double exposure_of(const Plan& plan, const Scene& scene, const FrameLight& light, Recorder& record);
    gl::Texture2D render_hrc(const Plan& plan, const DistanceField& field, FrameLook& look, Recorder& record);
    void check_thread() const {
        if (std::this_thread::get_id() != thread)
            throw DeviceError("The renderer was used on another thread than the one that made it.");
    }

    std::thread::id thread = std::this_thread::get_id();
    gl::Context context;
    gl::SamplerSettler samplers;
    gl::PassTimer timer;
    gl::StorageBuffer lost_rays{GL_R32UI, sizeof(std::uint32_t)};
    gl::TexturePool textures{kPoolBytes};
    DistancePass distance;
    JumpFloodPass jump_flood;
    NearBitmapsPass near_bitmaps;
    CascadePass cascade;
    RcFixPass rc_fix;
    ResolvePass resolve;
    LonePass lone;
    ClosedPass closed;
    HrcPass hrc;
    SumPass summing;
    ReferencePass reference;
    ExactPass exact;
    DeltaPass delta;
    FloorPass floor;
    ComposePass compose;
    DeviceInfo info;
    DeviceLimits limits;
    PassSettings settings;
};

// ---- hrc: one quadrant after another; its ray pieces are kept from the shortest up, then merged from the longest down.
gl::Texture2D Renderer::Impl::render_hrc(const Plan& plan, const DistanceField& field, FrameLook& look, Recorder& record) {
    constexpr const char* kNames[] = {"right", "down", "left", "up"};
    gl::Texture2D sum;
    if (!plan.hrc.aligned())
        record.pass("hrc clear", plan.hrc.points, [&] { return hrc.clear(plan, field, settings, sum); });
    for (std::size_t i = 0; i < plan.hrc.quadrants.size(); ++i) {
        const HrcQuadrant& q = plan.hrc.quadrants[i];
        const std::string side = std::string("hrc ") + kNames[i];
        std::vector<gl::Texture2D> pieces;
        for (int n = 0; n <= q.top(); ++n) {
            const HrcLevel& level = q.levels[static_cast<std::size_t>(n)];
            record.pass(side + (n < plan.hrc.settings.traced_levels ? " trace" : " extend"), {q.rows, level.planes * level.rays},
                        [&] { return hrc.pieces(plan, q, field, settings, pieces); });
        }
        gl::Texture2D fluence;
        for (int n = q.top() - 1; n >= 0; --n) {
            const HrcLevel& level = q.levels[static_cast<std::size_t>(n)];
            gl::Texture2D merged;
            record.pass(side + " merge", {q.rows, level.planes * level.cones}, [&] {
                return hrc.merge(plan, q, n, pieces, fluence ? &fluence : nullptr, settings, merged);
            });
            settings.give(std::move(fluence));
            fluence = std::move(merged);
            look.see_level(plan, q, n, fluence);
        }
        record.pass(side + " gather", plan.hrc.points, [&] { return hrc.gather(plan, q, fluence, settings, sum); });
        settings.give(std::move(fluence));
        for (gl::Texture2D& texture : pieces) settings.give(std::move(texture));
    }
    gl::Texture2D radiance;
    record.pass("hrc finish", plan.canvas, [&] { return hrc.finish(plan, field, sum, settings, radiance); });
    settings.give(std::move(sum));
    return radiance;
}
// ---- end of hrc

// One pixel as the device composes it, for all.
Pixels Renderer::Impl::constant_picture(const Plan& plan, const Scene& scene, GLenum format, Recorder& record) {
    gl::Texture2D pixel(format, {1, 1});
    record.pass("compose", {1, 1}, [&] {
        const glm::vec4 mean(glm::vec3(*plan.constant), 1.0f);
        gl::Texture2D radiance(GL_RGBA32F, {1, 1});
        radiance.fill(GL_RGBA, GL_FLOAT, &mean);
        Scene open;  // no shape shows
        open.canvas.floor_albedo = scene.canvas.floor_albedo;
        open.output = scene.output;
        const gl::Texture2D lights = black_texel();
        const DistanceField field = DistancePass::empty_field(plan);
        const FrameLight light{&radiance, &lights, field, false};
        compose.set_lit(black_texel());
        if (format == GL_RGBA32F) return compose.linear(plan, open, light, settings, plan.shown.first, pixel);
        LogAverage average;
        const double shown = luminance(*plan.constant * scene.canvas.floor_albedo);
        average.add_to_mean(shown);
        average.add(shown);
        return compose.display(plan, open, exposure_factor(scene.output, average.value()), light, settings, plan.shown.first, pixel);
    });
    Reader reader({1, 1}, format);
    record.host("read", {1, 1}, [&] { reader.read(pixel, 0); });
    Pixels result;
    record.host("fill", plan.shown.size, [&] {
        result = std::visit([&](const auto& one) -> Pixels { return filled(one, plan.shown.size); }, reader.take());
    });
    return result;
}

// The factor before the tone curve. Automatic exposure looks at every free pixel of the canvas, row by row: the same scene gives the
// same factor whatever the bands, and whatever part of it is shown.
double Renderer::Impl::exposure_of(const Plan& plan, const Scene& scene, const FrameLight& light, Recorder& record) {
    if (!scene.output.auto_key) return exposure_factor(scene.output);
    std::vector<float> luminances;  // of free pixels
    for (int row = 0; row < plan.canvas.y; row += plan.band_rows) {
        const int rows = std::min(plan.band_rows, plan.canvas.y - row);
        gl::Texture2D band = settings.take(GL_RGBA32F, {plan.canvas.x, rows});
        record.pass("exposure", {plan.canvas.x, rows}, [&] { return compose.linear(plan, scene, light, settings, {0, row}, band); });
        record.host("exposure read", {plan.canvas.x, rows}, [&] {
            ImageF rgba(plan.canvas.x, rows, 4);
            band.read(GL_RGBA, GL_FLOAT, rgba.data.data());
            for (std::size_t i = 0; i < rgba.data.size(); i += 4) {
                const float* pixel = &rgba.data[i];
                if (pixel[3] > 0) luminances.push_back(static_cast<float>(luminance({pixel[0], pixel[1], pixel[2]})));
            }
        });
        settings.give(std::move(band));
    }
    LogAverage average;
    for (const float y : luminances) average.add_to_mean(double(y));
    for (const float y : luminances) average.add(double(y));
    return exposure_factor(scene.output, average.value());
}

// The frame, in the order in which it happens.
RenderResult Renderer::Impl::render(const Scene& asked, const std::string& not_exact) {
    const Clock::time_point start = Clock::now();
    const bool linear = asked.output.format != "png";
    const GLenum format = linear ? GL_RGBA32F : bit_depth_of("png", asked.output.bit_depth) == 16 ? GL_RGBA16 : GL_RGBA8;
    RenderResult result;
    RenderStats& stats = result.stats;
    const std::optional<Scene> lean = without_unseen_shapes(asked, stats.skipped);
    const Scene& scene = lean ? *lean : asked;
    const Plan plan = make_plan(scene, limits, not_exact);
    stats.device = info.renderer;
    stats.method = plan.method;
    stats.method_reason = plan.method_reason;
    stats.width = plan.shown.size.x;
    stats.height = plan.shown.size.y;
    stats.skipped.insert(stats.skipped.end(), plan.skipped.begin(), plan.skipped.end());
    Recorder record(timer);
    if (plan.constant) {
        result.picture = constant_picture(plan, scene, format, record);
        context.check_reset();
        stats.passes = record.finish();
        stats.total_ms = ms_since(start);
        return result;
    }
    const PackedScene packed = pack_scene(scene, plan.radiance_scale);
    samplers.settle();
    const SceneBuffers buffers(packed, scene.sky, plan);
    buffers.bind();

    ShapeLists lists;
    if (plan.list_shapes) record.host("shape lists", plan.grid.size, [&] { lists = list_shapes(packed, plan); });

    DistanceField field;
    if (plan.shape_slices.empty())
        field = DistancePass::empty_field(plan);
    else
        record.pass("distance", {plan.grid.size.x, plan.end_distance_row - plan.first_distance_row}, [&] { return distance.run(plan, packed, lists, settings, field); });
    if (!plan.jump_steps.empty())
        record.pass("jump flood", plan.grid.size, [&] { return jump_flood.run(plan, settings, field); });
    if (plan.near_bitmaps)
        record.pass("near bitmaps", plan.grid.size, [&] { return near_bitmaps.run(plan, packed, settings, field); });

    if (!plan.closed_tiles.empty())
        record.pass("closed", {glsl::kExactTile * glsl::kExactTile, static_cast<int>(plan.closed_tiles.size())}, [&] { return closed.run(plan, settings, field); });

    if (plan.look.at == LookAt::field) {
        record.host("view", plan.shown.size, [&] { result.picture = draw_field(plan, scene, field, lists); });
        context.check_reset();
        settings.give(std::move(field.distance));
        settings.give(std::move(field.material));
        stats.passes = record.finish();
        stats.gpu_bytes = plan.gpu_bytes + buffers.bytes();
        stats.total_ms = ms_since(start);
        return result;
    }

    // What is sampled must not shine with what is solved.
    std::optional<SceneBuffers> sampled;
    if (plan.exact.used && plan.hrc.active()) {
        sampled.emplace(pack_scene(sampled_part(scene, plan.solved_shapes), plan.radiance_scale), scene.sky, plan);
        sampled->bind();
    }
    const SurfaceLight surfaces = plan.needs.surfaces ? SurfaceLight(plan, scene.sky, exact, delta, settings, record) : SurfaceLight();
    surfaces.bind();
    const bool marches = !plan.cascades.empty() || plan.hrc.active();
    if (marches) {
        const std::uint32_t none = 0;
        lost_rays.write(0, &none, sizeof(none));
        lost_rays.bind_storage(glsl::kLostRaysStorage);
    }
    FrameLook look(plan);
    gl::Texture2D radiance;
    for (std::size_t level = plan.cascades.size(); level-- > 0;) {
        gl::Texture2D merged;
        record.pass("cascade " + std::to_string(level), plan.cascades[level].texture, [&] {
            const gl::Texture2D* upper = radiance ? &radiance : nullptr;
            return plan.bilinear_fix ? rc_fix.run(plan, level, scene.sky, buffers, field, upper, settings, merged)
                                     : cascade.run(plan, level, scene.sky, buffers, field, upper, settings, merged);
        });
        settings.give(std::move(radiance));
        radiance = std::move(merged);
        look.see_cascade(plan, level, radiance);
        if (look.seen_all()) break;
    }
    if (plan.reference.rays > 0)
        record.pass("reference", plan.lit.size,
                    [&] { return reference.run(plan, scene.sky, buffers, field, settings, radiance); });
    gl::Texture2D moment_x, moment_y;
    if (plan.exact.used) {
        ExactPass::SeeCells see_cells;
        if (plan.look.at == LookAt::skipped) see_cells = [&](const gl::Texture2D& cells, int row, int rows) { look.see_cells(cells, row, rows); };
        ExactPass::Light found;
        exact.run(plan, plan.method == "exact" ? scene.sky : Sky{}, field, settings, delta,
                  [&](const char* name, glm::ivec2 extent, const auto& run) { record.pass(name, extent, run); }, found, see_cells);
        radiance = std::move(found.mean);
        moment_x = std::move(found.moment_x);
        moment_y = std::move(found.moment_y);
    }
    gl::Texture2D solved;
    if (sampled) solved = std::move(radiance);
    if (plan.hrc.active()) radiance = render_hrc(plan, field, look, record);
    if (plan.look.at != LookAt::picture) {
        record.host("view", plan.shown.size, [&] { result.picture = look.draw(plan); });
        context.check_reset();
        for (gl::Texture2D* texture : {&field.distance, &field.material, &radiance, &moment_x, &moment_y}) settings.give(std::move(*texture));
        stats.passes = record.finish();
        stats.gpu_bytes = plan.gpu_bytes + buffers.bytes() + surfaces.bytes();
        stats.total_ms = ms_since(start);
        return result;
    }
    if (plan.resolve)
        record.pass("resolve", plan.lit.size, [&] {
            gl::Texture2D resolved;
            const PassWork work = resolve.run(plan, radiance, settings, resolved);
            settings.give(std::move(radiance));
            radiance = std::move(resolved);
            return work;
        });
    if (plan.lone) record.pass("lone pixels", plan.lit.size, [&] { return lone.run(plan, scene.sky, field, settings, radiance); });
    if (sampled) {
        record.pass("sum", plan.canvas, [&] {
            gl::Texture2D both;
            const PassWork work = summing.run(plan, radiance, solved, settings, both);
            settings.give(std::move(radiance));
            settings.give(std::move(solved));
            radiance = std::move(both);
            return work;
        });
        buffers.bind();
    }
    gl::Texture2D lights;
    // On a floor with relief lights without a size are added to what it sends up.
    const bool lit_floor = plan.floor.relief && scene.output.solids != Solids::lit;
    if (plan.delta.used() && !lit_floor) record.pass("lights", plan.lit.size, [&] { return delta.pixels(plan, field, settings, lights); });
    // Where there is no light one black texel stands for every pixel.
    for (gl::Texture2D* texture : {&radiance, &lights, &moment_x, &moment_y}) {
        if (!*texture) *texture = black_texel();
    }
    const FrameLight arriving{&radiance, &lights, field, false};
    if (scene.output.solids == Solids::lit)
        record.host("lit solids", plan.canvas, [&] { compose.set_lit(lit_solids(plan, scene, arriving)); });
    else
        compose.set_lit(black_texel());
    gl::Texture2D sent_up, black;
    if (plan.floor.used) {
        record.host("floor pictures", plan.lit.size, [&] { floor.prepare(plan, scene, settings); });
        record.pass("floor", plan.lit.size, [&] { return floor.run(plan, {radiance, lights, moment_x, moment_y}, settings, sent_up); });
        if (plan.delta.used() && plan.floor.relief)
            record.pass("lights on floor", plan.lit.size, [&] {
                floor.bind();
                return delta.on_floor(plan, field, settings, sent_up);
            });
        floor.give_back(settings);
        black = black_texel();
    }
    const FrameLight light = plan.floor.used ? FrameLight{&sent_up, &black, field, true} : arriving;
    const double exposure = linear ? 1.0 : exposure_of(plan, scene, light, record);

    Reader reader(plan.shown.size, format);
    for (int row = 0; row < plan.shown.size.y; row += plan.band_rows) {
        const int rows = std::min(plan.band_rows, plan.shown.size.y - row);
        gl::Texture2D band = settings.take(format, {plan.shown.size.x, rows});
        const glm::ivec2 first = plan.shown.first + glm::ivec2(0, row);
        record.pass("compose", {plan.shown.size.x, rows}, [&] {
            return linear ? compose.linear(plan, scene, light, settings, first, band)
                          : compose.display(plan, scene, exposure, light, settings, first, band);
        });
        record.host("read", {plan.shown.size.x, rows}, [&] { reader.read(band, row); });
        settings.give(std::move(band));
    }
    result.picture = reader.take();
    context.check_reset();
    settings.give(std::move(field.distance));
    settings.give(std::move(field.material));
    settings.give(std::move(radiance));
    settings.give(std::move(lights));
    settings.give(std::move(moment_x));
    settings.give(std::move(moment_y));
    settings.give(std::move(sent_up));

    stats.passes = record.finish();
    stats.gpu_bytes = plan.gpu_bytes + buffers.bytes() + (sampled ? sampled->bytes() : 0);
    if (plan.exact.used && plan.exact.settings.largest_cell > 1) {
        double points = 0;
        for (const PassStats& pass : stats.passes) points += double(pass.points);
        const double pixels = double(plan.lit.size.x) * plan.lit.size.y;
        if (points < pixels) stats.skipped.push_back({"points", "the corners of a cell tell all of it", pixels - points});
    }
    stats.gpu_bytes += surfaces.bytes();
    if (marches) {
        std::uint32_t lost = 0;
        lost_rays.read(0, &lost, sizeof(lost));
        stats.lost_rays = lost;
    }
    if (lists.tiles.x > 0) stats.skipped.push_back(saved_by_lists(lists, packed, plan.grid, plan.distance_reach_px));
    stats.total_ms = ms_since(start);
    return result;
}

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Renderer::~Renderer() {
    // Its objects live in its own context, whichever is current.
    try {
        impl_->context.make_current();
    } catch (const DeviceError&) {
        // They go with the context.
    }
}

const DeviceInfo& Renderer::device() const { return impl_->info; }

RenderResult Renderer::render(const Scene& given, const StopCheck& stop) {
    const Look look = look_of(given.render.view);
    if (look.at == LookAt::contribution) {
        RenderResult result = render(contribution(given), stop);
        if (auto* picture = std::get_if<Image8>(&result.picture)) write_legend(*picture, {given.render.view + " alone"});
        return result;
    }
    if (look.at == LookAt::error) {
        RenderResult result = render(as_compared(given), stop);
        const Clock::time_point start = Clock::now();
        result.picture = draw_error(given, std::get<ImageF>(result.picture), result.stats.method, stop);
        result.stats.total_ms += ms_since(start);
        return result;
    }
    Scene made;
    if (needs_lowering(given)) made = lowered(given);
    const Scene& scene = needs_lowering(given) ? made : given;
    impl_->check_thread();
    impl_->context.make_current();
    const gl::CheckpointScope stopping([&] {
        if (stop && stop()) throw RenderStopped();
    });
    try {
        return impl_->render(scene);
    } catch (const TooDense& problem) {
        // The survey that `auto` chooses by looks from a few points only.
        if (scene.render.method != "auto") throw;
        return impl_->render(scene, problem.what());
    }
}

std::vector<DeviceListing> Renderer::list_devices() {
    std::vector<DeviceListing> result;
    for (const gl::EglDeviceListing& device : gl::Context::list_devices())
        result.push_back({device.index, device.name, device.software});
    return result;
}

}  // namespace penumbra
