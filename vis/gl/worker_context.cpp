#include "vis/gl/worker_context.h"

#include "vis/gl/headless.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <string>

namespace tessera::vis {

std::unique_ptr<WorkerContext> WorkerContext::make(bool apart) {
    if (eglGetCurrentContext() == EGL_NO_CONTEXT || eglGetCurrentDisplay() == EGL_NO_DISPLAY) return nullptr;
    return apart ? makeApart() : makeSharing();
}

std::unique_ptr<WorkerContext> WorkerContext::makeApart() {
    const EGLContext first = eglGetCurrentContext();
    const EGLDisplay display = eglGetCurrentDisplay();
    const EGLSurface draw = eglGetCurrentSurface(EGL_DRAW), read = eglGetCurrentSurface(EGL_READ);
    const auto renderer = [] { return std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))); };
    const std::string wanted = renderer();
    for (const EglDisplay& each : eglDisplays()) {
        if (each.display == display) continue;
        const EglContext made = makeEglContext(each.display, false);
        const bool same = made.context != EGL_NO_CONTEXT && renderer() == wanted;
        eglMakeCurrent(display, draw, read, first);
        if (same) return std::unique_ptr<WorkerContext>(new WorkerContext(each.display, made.context));
        if (made.context != EGL_NO_CONTEXT) eglDestroyContext(each.display, made.context);
    }
    return nullptr;
}

std::unique_ptr<WorkerContext> WorkerContext::makeSharing() {
    const EGLContext first = eglGetCurrentContext();
    const EGLDisplay display = eglGetCurrentDisplay();
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
    return std::unique_ptr<WorkerContext>(new WorkerContext(display, context));
}

WorkerContext::~WorkerContext() {
    eglDestroyContext(display_, context_);
}

WorkerContext::Use::Use(const WorkerContext& context) : context_(context) {
    eglBindAPI(EGL_OPENGL_API); // per-thread state
    eglMakeCurrent(context.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_);
}

WorkerContext::Use::~Use() {
    eglMakeCurrent(context_.display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

} // namespace tessera::vis
