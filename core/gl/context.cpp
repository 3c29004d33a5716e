// SPDX-License-Identifier: MIT
#include "core/gl/context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "core/device_error.h"
#include "core/gl/gl.h"
#ifdef PENUMBRA_HAS_OSMESA
#include "core/gl/osmesa_context.h"
#endif

namespace penumbra::gl {
namespace {

bool has_word(const char* list, const char* word) {
    if (list == nullptr) return false;
    const std::size_t length = std::strlen(word);
    for (const char* at = std::strstr(list, word); at != nullptr; at = std::strstr(at + 1, word))
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
    return false;
}

template <class Function>
Function egl_function(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::string egl_error() {
    const EGLint error = eglGetError();
    char text[32];
    std::snprintf(text, sizeof text, "EGL error 0x%04x", static_cast<unsigned>(error));
    return text;
}

std::vector<EGLDeviceEXT> egl_devices() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!has_word(client, "EGL_EXT_device_enumeration") && !has_word(client, "EGL_EXT_device_base")) return {};
    const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLint count = 0;
    if (query == nullptr || query(0, nullptr, &count) != EGL_TRUE || count <= 0) return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (query(count, devices.data(), &count) != EGL_TRUE) return {};
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

const char* device_extensions(EGLDeviceEXT device) {
    const auto query = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    return query == nullptr ? nullptr : query(device, EGL_EXTENSIONS);
}

bool is_software(EGLDeviceEXT device) { return has_word(device_extensions(device), "EGL_MESA_device_software"); }

std::string device_name(EGLDeviceEXT device) {
    const auto query = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    const char* extensions = device_extensions(device);
    if (has_word(extensions, "EGL_MESA_device_software")) return "software (Mesa)";
    if (has_word(extensions, "EGL_EXT_device_drm"))
        if (const char* file = query(device, EGL_DRM_DEVICE_FILE_EXT)) return file;
    if (has_word(extensions, "EGL_NV_device_cuda")) return "NVIDIA device";
    return "device";
}

class EglBackend final : public Context::Backend {
public:
    // Throws DeviceError.
    EglBackend(EGLenum platform, void* native) {
        const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
        if (get_display == nullptr) throw DeviceError("EGL has no platform displays");
        display_ = get_display(platform, native, nullptr);
        if (display_ == EGL_NO_DISPLAY) throw DeviceError("no display (" + egl_error() + ")");
        if (eglInitialize(display_, nullptr, nullptr) != EGL_TRUE)
            throw DeviceError("the display does not initialize (" + egl_error() + ")");
        const char* extensions = eglQueryString(display_, EGL_EXTENSIONS);
        if (!has_word(extensions, "EGL_KHR_surfaceless_context"))
            throw DeviceError("the display needs a surface");
        if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) throw DeviceError("the display has no desktop OpenGL");
        EGLConfig config = EGL_NO_CONFIG_KHR;
        if (!has_word(extensions, "EGL_KHR_no_config_context")) {
            const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
            EGLint count = 0;
            if (eglChooseConfig(display_, wanted, &config, 1, &count) != EGL_TRUE || count == 0)
                throw DeviceError("the display has no OpenGL configuration");
        }
        // Told of resets where the driver can: without, a lost context answers every call with silence and garbage.
        const EGLint robust[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET, EGL_NONE};
        const EGLint plain[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 3,
                                EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, robust);
        if (context_ == EGL_NO_CONTEXT) context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, plain);
        if (context_ == EGL_NO_CONTEXT) throw DeviceError("no OpenGL 4.3 core context (" + egl_error() + ")");
        if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
            const std::string why = egl_error();
            eglDestroyContext(display_, context_);
            throw DeviceError("the context cannot be made current (" + why + ")");
        }
    }

    void make_current() override {
        if (eglGetCurrentContext() == context_) return;
        if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE)
            throw DeviceError("The context cannot be made current (" + egl_error() + ").");
    }

    ~EglBackend() override {
        if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
        // The display stays: it is the process's, and others may be creating on it (maplibre-native 4332).
        eglReleaseThread();
    }

private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

struct Candidate {
    std::string name;
    EGLenum platform;
    void* native;
};

// In the order in which they are tried.
std::vector<Candidate> candidates(const std::string& choice) {
    const std::vector<EGLDeviceEXT> devices = egl_devices();
    const auto device = [&](std::size_t i) {
        return Candidate{"device " + std::to_string(i) + " (" + device_name(devices[i]) + ")", EGL_PLATFORM_DEVICE_EXT,
                         devices[i]};
    };
    std::vector<Candidate> hardware;
    std::vector<Candidate> software;
    for (std::size_t i = 0; i < devices.size(); ++i) (is_software(devices[i]) ? software : hardware).push_back(device(i));
    // Mesa's surfaceless platform needs no device node, but takes a hardware driver where it finds one: for
    // "cpu" the software device comes first.
    const Candidate surfaceless{"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, nullptr};
    std::vector<Candidate> result;
    if (choice == "auto" || choice == "gpu") result = hardware;
    if (choice == "auto") result.push_back(surfaceless);
    if (choice == "auto" || choice == "cpu") result.insert(result.end(), software.begin(), software.end());
    if (choice == "cpu") {
        if (hardware.empty())
            result.insert(result.begin(), surfaceless);
        else
            result.push_back(surfaceless);
    }
    int index = -1;
    const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
    if (error == std::errc() && end == choice.data() + choice.size()) {
        if (index < 0 || static_cast<std::size_t>(index) >= devices.size())
            throw DeviceError("There is no device " + choice + ": EGL lists " + std::to_string(devices.size()) + ".");
        result = {device(static_cast<std::size_t>(index))};
    }
    return result;
}

std::string text(GLenum name) {
    const GLubyte* value = glGetString(name);
    return value == nullptr ? "" : reinterpret_cast<const char*>(value);
}

bool is_software_renderer(const std::string& renderer) {
    return renderer.find("llvmpipe") != std::string::npos || renderer.find("softpipe") != std::string::npos ||
           renderer.find("swrast") != std::string::npos || renderer.find("SWR") != std::string::npos;
}

}  // namespace

std::vector<EglDeviceListing> Context::list_devices() {
    std::vector<EglDeviceListing> result;
    const std::vector<EGLDeviceEXT> devices = egl_devices();
    for (std::size_t i = 0; i < devices.size(); ++i)
        result.push_back({static_cast<int>(i), device_name(devices[i]), is_software(devices[i])});
    return result;
}

Context::Context(const std::string& choice) {
    std::string tried;
    GLADloadfunc load = reinterpret_cast<GLADloadfunc>(eglGetProcAddress);
#ifdef PENUMBRA_HAS_OSMESA
    if (choice == "osmesa") {
        backend_ = make_osmesa_backend();
        load = osmesa_load_function();
        info_.platform = "osmesa";
    }
#endif
    const bool known = choice == "auto" || choice == "cpu" || choice == "gpu" ||
                       (!choice.empty() && choice.find_first_not_of("0123456789") == std::string::npos);
    if (!backend_ && !known)
        throw DeviceError("'" + choice + "' is no device: it may be auto, cpu, gpu or an index.");
    if (!backend_) {
        for (const Candidate& candidate : candidates(choice)) {
            try {
                backend_ = std::make_unique<EglBackend>(candidate.platform, candidate.native);
                if (choice == "cpu" && gladLoadGL(load) != 0 && !is_software_renderer(text(GL_RENDERER))) {
                    backend_.reset();
                    throw DeviceError("it is no software renderer");
                }
                info_.platform = candidate.name;
                break;
            } catch (const DeviceError& error) {
                tried += "; " + candidate.name + ": " + error.what();
            }
        }
    }
    if (!backend_)
        throw DeviceError("No " + (choice == "auto" ? std::string() : choice + " ") +
                          "device gives an OpenGL 4.3 context" + (tried.empty() ? ": EGL lists none" : tried) + ".");
    if (gladLoadGL(load) == 0) throw DeviceError("The OpenGL functions cannot be loaded.");
    info_.vendor = text(GL_VENDOR);
    info_.renderer = text(GL_RENDERER);
    info_.gl_version = text(GL_VERSION);
    info_.glsl_version = text(GL_SHADING_LANGUAGE_VERSION);
    info_.software = is_software_renderer(info_.renderer);
    GLint extensions = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &extensions);
    for (GLint i = 0; i < extensions; ++i) {
        const char* name = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i)));
        if (name == nullptr) continue;
        if (std::strcmp(name, "GL_KHR_robustness") == 0) {
            get_reset_status_ = load("glGetGraphicsResetStatus");
            break;
        }
        if (std::strcmp(name, "GL_ARB_robustness") == 0) get_reset_status_ = load("glGetGraphicsResetStatusARB");
    }
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info_.max_texture_side);
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &info_.max_texture_buffer_texels);
    glGetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &info_.max_group_invocations);
}

Context::~Context() = default;

void Context::check_reset() const {
    if (get_reset_status_ != nullptr && reinterpret_cast<GLenum (*)()>(get_reset_status_)() != GL_NO_ERROR)
        throw DeviceError("The device was reset while it rendered; its context is lost.");
}

}  // namespace penumbra::gl
