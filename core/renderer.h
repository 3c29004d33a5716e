// SPDX-License-Identifier: MIT
// Scene in, picture and statistics out. The one entry to the light.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/device_error.h"
#include "core/film/tone_lut.h"
#include "core/image/image.h"
#include "core/plan/support.h"
#include "core/render_stats.h"
#include "core/scene/limits.h"
#include "core/scene/scene.h"
#include "core/stop.h"

namespace penumbra {

struct RendererOptions {
    std::string device = "auto";  // "auto", "cpu", "gpu", or an index as `penumbra info` lists them
    std::string shader_dir;       // when set, shaders are read from here instead of the embedded ones
    int solver_lanes = 0;         // threads of the method `exact` that share a point, 1, or 2 to 32 of one point each; 0: as the device wants
    std::shared_ptr<const ToneLut> tone_lut{};  // of the tone map "tony"; without it, no scene may ask for that
};

struct DeviceInfo {
    std::string kind;      // "cpu" or "gpu"
    std::string platform;  // "surfaceless", "device 0"
    std::string vendor, renderer, gl_version, glsl_version;
    int max_texture_side = 0;
    int max_texture_buffer_texels = 0;
    int max_group_invocations = 0;
    int max_loop_iterations = 0;  // measured at start; 0: no limit found (see docs/operations.md)
};

// What a device listing shows; `index` is what --device takes.
struct DeviceListing {
    int index = 0;
    std::string name;
    bool software = false;
};

struct RenderResult {
    // sRGB of 8 or 16 bits for "png"; linear for all others; three channels.
    std::variant<Image8, Image16, ImageF> picture;
    RenderStats stats;
};

// Owns a GL context. Create, use and destroy it on the same thread (use is checked).
class Renderer {
public:
    explicit Renderer(const RendererOptions& options = {});  // throws DeviceError
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Precondition: validate(scene) and unsupported(scene, features) are empty. Throws DeviceError.
    // Throws RenderStopped when `stop` says so.
    RenderResult render(const Scene& scene, const StopCheck& stop = {});

    const DeviceInfo& device() const;

    // Renders a small scene with a known answer (a uniform sky, a disc) and compares.
    // Empty when right, else a sentence saying what was wrong. Used for readiness.
    std::string self_test();

    static std::vector<DeviceListing> list_devices();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace penumbra
