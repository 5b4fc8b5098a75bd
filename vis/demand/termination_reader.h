#pragma once

#include "vis/demand/hidden_bricks.h"
#include "vis/gl/pixel_reader.h"
#include "vis/gl/program.h"

#include <optional>

namespace tessera::vis {

/// Reads back the termination depths of a picture asynchronously, one picture at a time.
class TerminationReader {
public:
    /// Allocates buffers for pictures up to this size. Throws MachineError when the driver has no memory for them.
    void resize(glm::ivec2 size);
    /// Starts reading a picture of `size` pixels whose lower left pixel is texel `first` of `termination`. Changes the
    /// framebuffer and viewport; the scissor test must be off.
    void start(const Program& program, GLuint vertices, GLuint termination, glm::ivec2 first, glm::ivec2 size,
               const Camera& camera, const WorldFrame& frame);
    bool pending() const { return reader_.pending(); }
    /// Returns the result of start() once it is available; `wait`: blocks for it.
    std::optional<TerminationMap> take(bool wait);

private:
    Texture tiles_;
    Framebuffer framebuffer_;
    PixelReader reader_;
    TerminationMap map_; ///< being read
};

} // namespace tessera::vis
