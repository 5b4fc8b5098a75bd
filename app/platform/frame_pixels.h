#pragma once

#include "app/platform/drawn_page.h"
#include "vis/gl/texture_name.h"
#include "vis/image/image_io.h"

#include <memory>
#include <vector>

/// Where the frames of ImGui become pixels.
namespace tessera::app {

class FramePixels {
public:
    FramePixels() = default;
    virtual ~FramePixels() = default;
    FramePixels(const FramePixels&) = delete;
    FramePixels& operator=(const FramePixels&) = delete;

    /// Makes the calls that draw the current frame, with next to no pixels.
    virtual void rehearse(Theme theme) = 0;
    /// Draws the current frame.
    virtual void show(Theme theme) = 0;
    /// Draws parts of the current frame on nothing.
    virtual void showParts(const std::vector<DrawnPart>& parts) = 0;
    /// The pixels from `lo` to before `hi` of what was drawn last, row 0 at the top.
    virtual vis::Image read(glm::ivec2 lo, glm::ivec2 hi) const = 0;
};

/// In a framebuffer of its own, or in memory. Throws MachineError when the size is too large.
std::unique_ptr<FramePixels> makeFramePixels(vis::TexturesIn where, glm::ivec2 size);

} // namespace tessera::app
