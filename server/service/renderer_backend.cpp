// SPDX-License-Identifier: MIT
// The one file of the front that needs the renderer's library.
#include "server/service/renderer_backend.h"

namespace penumbra {
namespace {

class RendererBackend final : public RenderBackend {
public:
    explicit RendererBackend(const RendererOptions& options) : renderer_(options) {}

    RenderResult render(const Scene& scene, const StopCheck& stop) override {
        slices_ = 0;
        return renderer_.render(scene, [&] {
            ++slices_;
            return stop && stop();
        });
    }
    std::uint64_t slices() const override { return slices_; }
    std::string self_test() override { return renderer_.self_test(); }
    const DeviceInfo& device() const override { return renderer_.device(); }

private:
    Renderer renderer_;
    std::uint64_t slices_ = 0;
};

}  // namespace

Engine real_engine() {
    Engine engine;
    engine.make_backend = [](const RendererOptions& options) -> std::unique_ptr<RenderBackend> {
        return std::make_unique<RendererBackend>(options);
    };
    engine.unsupported = [](const Scene& scene, const Features& features) { return unsupported(scene, features); };
    engine.list_devices = [] { return Renderer::list_devices(); };
    return engine;
}

}  // namespace penumbra
