// SPDX-License-Identifier: MIT
// A GL 4.3 core context without any window system: EGL surfaceless, or an EGL device.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace penumbra::gl {

struct ContextInfo {
    bool software = false;
    std::string platform;
    std::string vendor, renderer, gl_version, glsl_version;
    int max_texture_side = 0;
    int max_texture_buffer_texels = 0;
    int max_group_invocations = 0;
};

struct EglDeviceListing {
    int index = 0;
    std::string name;
    bool software = false;
};

class Context {
public:
    // "auto": the first hardware device that works, else software. "cpu": software. "gpu": hardware only.
    // A number: that EGL device. "osmesa" when built with PENUMBRA_OSMESA. Becomes current on this thread.
    // Throws DeviceError that says what was tried and how each failed.
    explicit Context(const std::string& choice);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const ContextInfo& info() const { return info_; }

    // Another context may have been made current on this thread since.
    void make_current() { backend_->make_current(); }

    // Throws DeviceError when the driver has reset the context: everything in it is lost.
    void check_reset() const;

    static std::vector<EglDeviceListing> list_devices();

    // What made the context; destroyed with it.
    struct Backend {
        virtual ~Backend() = default;
        virtual void make_current() = 0;  // throws DeviceError
    };

private:
    std::unique_ptr<Backend> backend_;
    ContextInfo info_;
    void (*get_reset_status_)() = nullptr;  // where the driver can tell
};

}  // namespace penumbra::gl
