// SPDX-License-Identifier: MIT
#include "core/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>
#include <optional>
#include <thread>
#include <type_traits>

#include "core/gl/checkpoint.h"
#include "core/gl/context.h"
#include "core/gl/loop_limit.h"
#include "core/gl/settle.h"
#include "core/gl/timer.h"
#include "core/passes/cascade_pass.h"
#include "core/passes/compose_pass.h"
#include "core/passes/distance_pass.h"
#include "core/passes/exact_pass.h"
#include "core/passes/hrc_pass.h"
#include "core/passes/jump_flood_pass.h"
#include "core/passes/rc_fix_pass.h"
#include "core/passes/reference_pass.h"
#include "core/passes/resolve_pass.h"
#include "core/passes/scene_buffers.h"
#include "core/plan/plan.h"
#include "core/plan/shape_lists.h"

namespace penumbra {
namespace {

// Two renders of 4096 x 4096.
constexpr std::size_t kPoolBytes = std::size_t(1) << 30;

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Processor time of all threads of this process.
double cpu_ms_now() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

// Records each pass's time and size while the frame runs. Bands of one pass add up in one record.
class Recorder {
public:
    explicit Recorder(gl::PassTimer& timer) : timer_(timer) { timer_.reset(); }

    template <class Run>
    void pass(const std::string& name, glm::ivec2 extent, Run&& run) {
        const Clock::time_point start = Clock::now();
        const double cpu_start = cpu_ms_now();
        timer_.mark();
        const PassWork work = run();
        timer_.mark();
        gl::check_errors(name.c_str());
        PassStats& stats = add(name, extent, ms_since(start), cpu_ms_now() - cpu_start);
        stats.dispatches += static_cast<std::uint64_t>(work.dispatches);
        stats.rays += work.rays;
        stats.bytes += work.bytes;
        marked_.push_back(static_cast<std::size_t>(&stats - passes_.data()));
    }

    template <class Run>
    void host(const std::string& name, glm::ivec2 extent, Run&& run) {
        const Clock::time_point start = Clock::now();
        const double cpu_start = cpu_ms_now();
        run();
        add(name, extent, ms_since(start), cpu_ms_now() - cpu_start);
    }

    std::vector<PassStats> finish() {
        const std::vector<double> device_ms = timer_.read();
        for (std::size_t i = 0; i < marked_.size() && i < device_ms.size(); ++i) passes_[marked_[i]].gpu_ms += device_ms[i];
        return std::move(passes_);
    }

private:
    PassStats& add(const std::string& name, glm::ivec2 extent, double wall_ms, double cpu_ms) {
        auto found = std::find_if(passes_.begin(), passes_.end(), [&](const PassStats& p) { return p.name == name; });
        if (found == passes_.end()) {
            passes_.emplace_back();
            passes_.back().name = name;
            passes_.back().width = extent.x;
            found = passes_.end() - 1;
        }
        found->height += extent.y;
        found->wall_ms += wall_ms;
        found->cpu_ms += cpu_ms;
        return *found;
    }

    gl::PassTimer& timer_;
    std::vector<PassStats> passes_;
    std::vector<std::size_t> marked_;  // the pass of each pair of marks
};

// Collects the bands of the picture, without their alpha.
class Reader {
public:
    Reader(glm::ivec2 canvas, bool linear) {
        if (linear)
            picture_ = ImageF(canvas.x, canvas.y, 3);
        else
            picture_ = Image8(canvas.x, canvas.y, 3);
    }

    void read(const gl::Texture2D& band, int first_row) {
        std::visit([&](auto& picture) { read_into(picture, band, first_row); }, picture_);
    }

    std::variant<Image8, ImageF> take() { return std::move(picture_); }

private:
    template <class T>
    static void read_into(BasicImage<T>& picture, const gl::Texture2D& band, int first_row) {
        const glm::ivec2 size = band.size();
        BasicImage<T> rgba(size.x, size.y, 4);
        band.read(GL_RGBA, std::is_same_v<T, float> ? GL_FLOAT : GL_UNSIGNED_BYTE, rgba.data.data());
        const std::size_t count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
        const T* from = rgba.data.data();
        T* to = picture.at(0, first_row);
        for (std::size_t i = 0; i < count; ++i, from += 4, to += 3) {
            to[0] = from[0];
            to[1] = from[1];
            to[2] = from[2];
        }
    }

    std::variant<Image8, ImageF> picture_;
};

}  // namespace

struct Renderer::Impl {
    explicit Impl(const RendererOptions& options)
        : context(options.device),
          samplers(options.shader_dir),
          distance(options.shader_dir),
          jump_flood(options.shader_dir),
          cascade(options.shader_dir),
          rc_fix(options.shader_dir),
          resolve(options.shader_dir),
          hrc(options.shader_dir),
          reference(options.shader_dir),
          exact(options.shader_dir),
          compose(options.shader_dir) {
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
        limits.max_texture_side = gl_info.max_texture_side;
        limits.max_buffer_texels = static_cast<std::size_t>(gl_info.max_texture_buffer_texels);
        info.max_loop_iterations = gl::measure_loop_limit(options.shader_dir);
        limits.max_loop_iterations = info.max_loop_iterations;
        limits.software = gl_info.software;
        if (!gl_info.software) limits.max_texture_bytes = std::size_t(8) << 30;
        // About 10 ms a dispatch on two cores of llvmpipe; a GPU takes a hundred times that.
        const std::size_t factor = gl_info.software ? 1 : 128;
        settings = {factor * 6'000'000, factor * 300'000, factor * 1'000'000, &textures};
    }

    RenderResult render(const Scene& scene, const std::string& not_exact = {});
    gl::Texture2D render_hrc(const Plan& plan, const DistanceField& field, Recorder& record);
    void check_thread() const {
        if (std::this_thread::get_id() != thread)
            throw DeviceError("The renderer was used on another thread than the one that made it.");
    }

    std::thread::id thread = std::this_thread::get_id();
    gl::Context context;
    gl::SamplerSettler samplers;
    gl::PassTimer timer;
    gl::TexturePool textures{kPoolBytes};
    DistancePass distance;
    JumpFloodPass jump_flood;
    CascadePass cascade;
    RcFixPass rc_fix;
    ResolvePass resolve;
    HrcPass hrc;
    ReferencePass reference;
    ExactPass exact;
    ComposePass compose;
    DeviceInfo info;
    DeviceLimits limits;
    PassSettings settings;
};

// ---- hrc: one quadrant after another; its ray pieces are kept from the shortest up, then merged from the longest down.
gl::Texture2D Renderer::Impl::render_hrc(const Plan& plan, const DistanceField& field, Recorder& record) {
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

// The frame, in the order in which it happens.
RenderResult Renderer::Impl::render(const Scene& scene, const std::string& not_exact) {
    const Clock::time_point start = Clock::now();
    const bool linear = scene.output.format != "png";
    const Plan plan = make_plan(scene, limits, not_exact);
    const PackedScene packed = pack_scene(scene, plan.radiance_scale);
    samplers.settle();
    const SceneBuffers buffers(packed, scene.sky, plan);
    buffers.bind();
    Recorder record(timer);

    ShapeLists lists;
    if (plan.list_shapes) record.host("shape lists", plan.grid.size, [&] { lists = list_shapes(packed, plan.grid); });

    DistanceField field;
    if (plan.shape_slices.empty())
        field = DistancePass::empty_field(plan);
    else
        record.pass("distance", plan.grid.size, [&] { return distance.run(plan, lists, settings, field); });
    if (!plan.jump_steps.empty())
        record.pass("jump flood", plan.grid.size, [&] { return jump_flood.run(plan, settings, field); });

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
    }
    if (plan.reference.rays > 0)
        record.pass("reference", plan.canvas,
                    [&] { return reference.run(plan, scene.sky, buffers, field, settings, radiance); });
    if (plan.exact.used)
        exact.run(plan, scene.sky, field, settings,
                  [&](const char* name, glm::ivec2 extent, const auto& run) { record.pass(name, extent, run); }, radiance);
    if (plan.hrc.active()) radiance = render_hrc(plan, field, record);
    if (plan.resolve)
        record.pass("resolve", plan.canvas, [&] {
            gl::Texture2D resolved;
            const PassWork work = resolve.run(plan, radiance, settings, resolved);
            settings.give(std::move(radiance));
            radiance = std::move(resolved);
            return work;
        });
    if (!radiance) {
        // No light at all: one black texel stands for every pixel.
        const float black[4] = {};
        radiance = gl::Texture2D(GL_RGBA32F, {1, 1});
        radiance.fill(GL_RGBA, GL_FLOAT, black);
    }

    RenderResult result;
    Reader reader(plan.canvas, linear);
    for (int row = 0; row < plan.canvas.y; row += plan.band_rows) {
        const int rows = std::min(plan.band_rows, plan.canvas.y - row);
        gl::Texture2D band = settings.take(linear ? GL_RGBA32F : GL_RGBA8, {plan.canvas.x, rows});
        record.pass("compose", {plan.canvas.x, rows},
                    [&] { return compose.run(plan, scene, linear, radiance, field, settings, row, band); });
        record.host("read", {plan.canvas.x, rows}, [&] { reader.read(band, row); });
        settings.give(std::move(band));
    }
    result.picture = reader.take();
    context.check_reset();
    settings.give(std::move(field.distance));
    settings.give(std::move(field.material));
    settings.give(std::move(radiance));

    RenderStats& stats = result.stats;
    stats.passes = record.finish();
    stats.device = info.renderer;
    stats.method = plan.method;
    stats.method_reason = plan.method_reason;
    stats.width = plan.canvas.x;
    stats.height = plan.canvas.y;
    stats.gpu_bytes = plan.gpu_bytes + buffers.bytes();
    stats.skipped = plan.skipped;
    if (lists.tiles.x > 0) stats.skipped.push_back(saved_by_lists(lists, packed, plan.grid));
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

RenderResult Renderer::render(const Scene& scene, const StopCheck& stop) {
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

std::string Renderer::self_test() {
    // A lamp of radiance 1 under a grey sky: far from the lamp its share is asin(R / r) / pi.
    Scene scene;
    scene.canvas.width = 48;
    scene.canvas.height = 48;
    scene.sky.radiance = Colour(0.25);
    scene.output.format = "pfm";
    const ImageF open = std::get<ImageF>(render(scene).picture);
    for (const float value : open.data)
        if (!(std::abs(value - 0.25f) < 1e-4f))
            return "A uniform sky of radiance 0.25 rendered as " + std::to_string(value) + ".";
    Shape lamp;
    lamp.geometry = Circle{{24, 24}, 6};
    lamp.emission = Colour(1);
    scene.shapes.push_back(lamp);
    const ImageF lit = std::get<ImageF>(render(scene).picture);
    double mean = 0;
    double expected = 0;
    for (int x = 0; x < 48; ++x) {
        const double distance = std::hypot(x + 0.5 - 24.0, 0.5 - 24.0);
        const double share = std::asin(6.0 / distance) / std::numbers::pi;
        mean += double(*lit.at(x, 0)) / 48;
        expected += (share + 0.25 * (1 - share)) / 48;
    }
    if (!(std::abs(mean / expected - 1) < 0.05))
        return "A disc under a grey sky rendered as " + std::to_string(mean) + " instead of " + std::to_string(expected) + ".";
    return {};
}

std::vector<DeviceListing> Renderer::list_devices() {
    std::vector<DeviceListing> result;
    for (const gl::EglDeviceListing& device : gl::Context::list_devices())
        result.push_back({device.index, device.name, device.software});
    return result;
}

}  // namespace penumbra
