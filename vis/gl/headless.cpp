#include "vis/gl/headless.h"

#include "vis/gl/egl_displays.h"
#include "volume/base/error.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <string>

namespace tessera::vis {

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
    std::string tried;
    for (const EglDisplay& each : eglDisplays()) {
        const EglContext made = makeEglContext(each.display, debug);
        if (made.context != EGL_NO_CONTEXT) {
            impl_->display = each.display;
            impl_->context = made.context;
            if (debug) glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
            return;
        }
        tried += (tried.empty() ? "" : "; ") + each.name + ": " + made.reason;
    }
    throw MachineError("no OpenGL 4.5 context through EGL (tried " + tried + ")");
}

HeadlessContext::~HeadlessContext() = default;

} // namespace tessera::vis
