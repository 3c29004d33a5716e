// SPDX-License-Identifier: MIT
#include "core/gl/osmesa_context.h"

#include <GL/osmesa.h>

#include <array>

#include "core/device_error.h"

namespace penumbra::gl {
namespace {

class OsmesaBackend final : public Context::Backend {
public:
    OsmesaBackend() {
        const int attributes[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_PROFILE, OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION, 4, OSMESA_CONTEXT_MINOR_VERSION, 3, 0};
        context_ = OSMesaCreateContextAttribs(attributes, nullptr);
        if (context_ == nullptr) throw DeviceError("OSMesa gives no OpenGL 4.3 core context.");
        if (OSMesaMakeCurrent(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE) {
            OSMesaDestroyContext(context_);
            throw DeviceError("The OSMesa context cannot be made current.");
        }
    }
    void make_current() override {
        if (OSMesaGetCurrentContext() == context_) return;
        if (OSMesaMakeCurrent(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE)
            throw DeviceError("The OSMesa context cannot be made current.");
    }

    ~OsmesaBackend() override { OSMesaDestroyContext(context_); }

private:
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4> pixel_{};  // OSMesa wants something to draw into
};

}  // namespace

std::unique_ptr<Context::Backend> make_osmesa_backend() { return std::make_unique<OsmesaBackend>(); }

GLADloadfunc osmesa_load_function() { return reinterpret_cast<GLADloadfunc>(OSMesaGetProcAddress); }

}  // namespace penumbra::gl
