#include "vis/gl/headless.h"

#include "vis/gl/requirements.h"
#include "volume/base/error.h"
#include "volume/system/shader_cache.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <string_view>

namespace tessera::vis {

namespace {

bool has(const char* list, std::string_view name) {
    return list && (" " + std::string(list) + " ").find(" " + std::string(name) + " ") != std::string::npos;
}

/// Explains what a driver without GL 4.5 lacks, from the best context it offers.
std::string whyNot(EGLDisplay display, EGLConfig config) {
    const EGLint any[] = {EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, any);
    if (context == EGL_NO_CONTEXT) return {};
    std::string text;
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) text = ": " + missingFeatures();
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return text;
}

} // namespace

// Avoids eglGetPlatformDisplay, on which libepoxy 1.5 aborts if only EGL 1.4 is advertised.
std::vector<EglDisplay> eglDisplays() {
    std::vector<EglDisplay> hardware, software;
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (has(client, "EGL_EXT_platform_device") &&
        (has(client, "EGL_EXT_device_enumeration") || has(client, "EGL_EXT_device_base"))) {
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (eglQueryDevicesEXT(16, devices, &count))
            for (EGLint i = 0; i < count; ++i) {
                const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
                auto& list = has(extensions, "EGL_MESA_device_software") ? software : hardware;
                list.push_back({"device " + std::to_string(i),
                                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
            }
    }
    std::vector<EglDisplay> all = hardware;
    if (has(client, "EGL_MESA_platform_surfaceless"))
        all.push_back(
            {"surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
    all.insert(all.end(), software.begin(), software.end());
    all.push_back({"default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
    return all;
}

EglContext makeEglContext(void* display, bool debug) {
    if (display == EGL_NO_DISPLAY) return {nullptr, "no display"};
    if (!eglInitialize(display, nullptr, nullptr)) return {nullptr, "cannot be initialised"};
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!has(extensions, "EGL_KHR_surfaceless_context")) return {nullptr, "no contexts without a surface"};
    if (!eglBindAPI(EGL_OPENGL_API)) return {nullptr, "no OpenGL"};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    if (!has(extensions, "EGL_KHR_no_config_context")) {
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return {nullptr, "no configuration"};
    }
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 debug ? EGL_TRUE : EGL_FALSE,
                                 EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) return {nullptr, "no OpenGL 4.5 core" + whyNot(display, config)};
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return {context, {}};
    eglDestroyContext(display, context);
    return {nullptr, "the context cannot be made current"};
}

struct HeadlessContext::Impl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    ~Impl() {
        if (context == EGL_NO_CONTEXT) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
        // The display is shared by all contexts of the process, so it is never terminated.
    }
};

HeadlessContext::HeadlessContext(bool debug) : impl_(std::make_unique<Impl>()) {
    guardShaderCache();
    if (!epoxy_has_egl()) throw MachineError("the library EGL is not installed");
    std::string tried;
    for (const EglDisplay& each : eglDisplays()) {
        const EglContext made = makeEglContext(each.display, debug);
        if (made.context != EGL_NO_CONTEXT) {
            impl_->display = each.display;
            impl_->context = made.context;
            if (debug) glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
            guardShaderCache();
            return;
        }
        tried += (tried.empty() ? "" : "; ") + each.name + ": " + made.reason;
    }
    throw MachineError("no OpenGL 4.5 context through EGL (tried " + tried + ")");
}

HeadlessContext::~HeadlessContext() = default;

} // namespace tessera::vis
