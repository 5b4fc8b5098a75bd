#pragma once

#include "vis/gl/handles.h"

#include <memory>
#include <span>
#include <type_traits>

namespace tessera::vis {

/// Reads back a float texture asynchronously, one request at a time.
class PixelReader {
public:
    /// Allocates room for that many floats and drops a pending request.
    void resize(std::size_t floats);
    /// Starts reading the lower left `size` texels of a 2D texture; `format`: GL_RED, GL_RGBA, ...
    void start(GLuint texture, glm::ivec2 size, GLenum format);
    bool pending() const { return fence_ != nullptr; }
    /// Copies the result and returns true once it is available; `wait`: blocks for it.
    bool take(std::span<float> into, bool wait);
    void forget() { fence_.reset(); }

private:
    struct DeleteFence {
        void operator()(GLsync fence) const { glDeleteSync(fence); }
    };
    Buffer buffer_;
    std::size_t bytes_ = 0;
    std::unique_ptr<std::remove_pointer_t<GLsync>, DeleteFence> fence_;
};

} // namespace tessera::vis
