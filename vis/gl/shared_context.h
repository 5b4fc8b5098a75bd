#pragma once

#include <memory>

namespace tessera::vis {

/// A second context that shares textures, buffers and programs with the one that was current when it was made, for a
/// worker thread: shaders compile there while the first one draws.
class SharedContext {
public:
    /// Null if the current context is not an EGL context or the driver refuses: then everything runs in one context.
    static std::unique_ptr<SharedContext> make();
    ~SharedContext();
    SharedContext(const SharedContext&) = delete;
    SharedContext& operator=(const SharedContext&) = delete;

    /// Current on the calling thread while it lives.
    class Use {
    public:
        explicit Use(const SharedContext& context);
        ~Use();
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;

    private:
        const SharedContext& context_;
    };

private:
    SharedContext(void* display, void* context) : display_(display), context_(context) {}
    void *display_ = nullptr, *context_ = nullptr; ///< EGLDisplay, EGLContext
};

} // namespace tessera::vis
