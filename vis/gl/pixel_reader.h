#pragma once

#include "vis/gl/handles.h"

#include <memory>
#include <span>
#include <type_traits>

namespace tessera::vis {

/// Reads a texture of floats back without waiting for the driver, one reading at a time.
class PixelReader {
public:
    /// Room for so many floats; a reading under way is forgotten.
    void resize(std::size_t floats);
    /// Begins to read the lower left `size` texels of a 2D texture; `format`: GL_RED, GL_RGBA, ...
    void start(GLuint texture, glm::ivec2 size, GLenum format);
    bool pending() const { return fence_ != nullptr; }
    /// Copies what was begun once it is here, and is true then; `wait`: until it is.
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
