#include "vis/gl/shared_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace tessera::vis {

std::unique_ptr<SharedContext> SharedContext::make() {
    const EGLContext first = eglGetCurrentContext();
    const EGLDisplay display = eglGetCurrentDisplay();
    if (first == EGL_NO_CONTEXT || display == EGL_NO_DISPLAY) return nullptr;
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return nullptr;
    // A shared context needs the configuration of the first one; 0: it has none.
    EGLint id = 0, found = 0;
    EGLConfig config = EGL_NO_CONFIG_KHR;
    eglQueryContext(display, first, EGL_CONFIG_ID, &id);
    const EGLint same[] = {EGL_CONFIG_ID, id, EGL_NONE};
    if (id != 0 && (!eglChooseConfig(display, same, &config, 1, &found) || found == 0)) return nullptr;
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, first, attributes);
    if (context == EGL_NO_CONTEXT) return nullptr;
    return std::unique_ptr<SharedContext>(new SharedContext(display, context));
}

SharedContext::~SharedContext() {
    eglDestroyContext(display_, context_);
}

SharedContext::Use::Use(const SharedContext& context) : context_(context) {
    eglBindAPI(EGL_OPENGL_API); // per-thread state
    eglMakeCurrent(context.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_);
}

SharedContext::Use::~Use() {
    eglMakeCurrent(context_.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

} // namespace tessera::vis
