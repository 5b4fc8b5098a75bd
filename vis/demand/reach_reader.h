#pragma once

#include "vis/demand/hidden_bricks.h"
#include "vis/gl/handles.h"
#include "vis/gl/program.h"

#include <memory>
#include <optional>

namespace tessera::vis {

/// Reads back the termination depths of a picture asynchronously, one picture at a time.
class ReachReader {
public:
    /// Room for pictures up to this size. Throws MachineError when the driver has no memory for it.
    void resize(glm::ivec2 size);
    /// Begins with a picture of `size` pixels, the lower left one of which is texel `first` of `reach`. Changes the
    /// framebuffer and viewport; the scissor must be off.
    void start(const Program& program, GLuint vertices, GLuint reach, glm::ivec2 first, glm::ivec2 size,
               const Camera& camera, const WorldFrame& frame);
    bool pending() const { return fence_ != nullptr; }
    /// The result of start(), once it is available; `wait`: block until then.
    std::optional<ReachMap> take(bool wait);

private:
    struct DeleteFence {
        void operator()(GLsync fence) const { glDeleteSync(fence); }
    };
    Texture tiles_;
    Framebuffer framebuffer_;
    Buffer read_;
    ReachMap map_; ///< under way
    std::unique_ptr<std::remove_pointer_t<GLsync>, DeleteFence> fence_;
};

} // namespace tessera::vis
