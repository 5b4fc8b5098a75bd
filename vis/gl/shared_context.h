#pragma once

#include <memory>

namespace tessera::vis {

/// A second context that shares textures, buffers and programs with the one current at its creation. A worker thread
/// compiles shaders in it while the first context draws.
class SharedContext {
public:
    /// Returns null if the current context is not an EGL context or the driver refuses; then everything runs in one
    /// context.
    static std::unique_ptr<SharedContext> make();
    ~SharedContext();
    SharedContext(const SharedContext&) = delete;
    SharedContext& operator=(const SharedContext&) = delete;

    /// Makes the context current on the calling thread for the lifetime of the object.
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
