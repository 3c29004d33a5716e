// SPDX-License-Identifier: MIT
// What the front needs of the renderer, so that all of it is built and tested without a device.
// server/service/renderer_backend.cpp fills it with the real one; tests fill it with a fake.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/renderer.h"

namespace penumbra {

// Made, used and destroyed on one thread.
struct RenderBackend {
    RenderBackend() = default;
    RenderBackend(const RenderBackend&) = delete;
    RenderBackend& operator=(const RenderBackend&) = delete;
    virtual ~RenderBackend() = default;

    // Throws when the world fails; RenderStopped when `stop` said so; BackendLost when nothing more is to be expected of it.
    virtual RenderResult render(const Scene& scene, const StopCheck& stop) = 0;
    // Dispatches of the render under way; asked while `stop` is.
    virtual std::uint64_t slices() const { return 0; }
    virtual std::string self_test() = 0;  // empty when right
    virtual const DeviceInfo& device() const = 0;
    // Asked when there is nothing to do. Empty while all is well, else why another one should take its place.
    virtual std::string worn_out() { return ""; }
};

// It ended, or had to be ended, in the middle of its work. A full sentence.
class BackendLost : public DeviceError {
public:
    using DeviceError::DeviceError;
};

using BackendFactory = std::function<std::unique_ptr<RenderBackend>()>;

struct Engine {
    std::function<std::unique_ptr<RenderBackend>(const RendererOptions&)> make_backend;
    std::function<Problems(const Scene&, const Features&)> unsupported;
    // The same, bound to what there is.
    std::function<Problems(const Scene&)> unsupported_with(const Features& features) const {
        return [ask = unsupported, features](const Scene& scene) { return ask(scene, features); };
    }
    std::function<std::vector<DeviceListing>()> list_devices;
};

}  // namespace penumbra
