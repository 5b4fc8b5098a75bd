#pragma once

#include <memory>

namespace tessera::vis {

/// A second context, in which a worker thread compiles shaders while the first context draws.
class WorkerContext {
public:
    /// With the context that is current: sharing its textures, buffers and programs; or `apart`, of the same driver on
    /// another display, sharing nothing. Contexts of one display of Mesa's software GL (22.3) are not safe beside each
    /// other: when one binds a texture, it walks without a lock through what each of them is rasterising. Returns null
    /// if the current context is not an EGL context or the driver refuses; then everything runs in one context.
    static std::unique_ptr<WorkerContext> make(bool apart);
    ~WorkerContext();
    WorkerContext(const WorkerContext&) = delete;
    WorkerContext& operator=(const WorkerContext&) = delete;

    /// Makes the context current on the calling thread for the lifetime of the object.
    class Use {
    public:
        explicit Use(const WorkerContext& context);
        ~Use();
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;

    private:
        const WorkerContext& context_;
    };

private:
    WorkerContext(void* display, void* context) : display_(display), context_(context) {}
    static std::unique_ptr<WorkerContext> makeApart();
    static std::unique_ptr<WorkerContext> makeSharing();
    void *display_ = nullptr, *context_ = nullptr; ///< EGLDisplay, EGLContext
};

} // namespace tessera::vis
