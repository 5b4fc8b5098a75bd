#pragma once

#include "vis/demand/hidden_bricks.h"
#include "vis/demand/termination_reader.h"
#include "vis/view/picture.h"
#include "vis/view/render_tools.h"

namespace tessera::vis {

/// The stage that finds occluded bricks by reading back the termination depths of a view's pictures. `scene`: a scene
/// number; pictures of the same scene differ only in what is resident.
class ViewHidden {
public:
    void resize(glm::ivec2 size) { termination_.resize(size); }
    /// The full buffer has changed, so its occlusion is unknown.
    void forgetPicture() { known_ = final_ = false; }
    /// The data set has changed.
    void forgetData();

    /// A reduced picture was drawn in this frame.
    void drewReduced() { reducedDrawn_ = true; }
    /// Starts reading back the termination depths of the picture just drawn.
    void start(RenderTools& tools, const RenderCall& call, const PictureBuffers& buffers, const PictureState& state,
               std::uint64_t scene);
    /// Collects a result; `wait`: blocks for it. `grid`: of the data drawn; null: these are no longer shown.
    void take(bool wait, const volume::BrickGrid* grid);

    /// Whether the occlusion of the current full buffer is known.
    bool known() const { return known_; }
    /// Whether a picture of these data has been read back.
    bool any() const { return scene_ != 0; }
    const HiddenInView& bricks() const { return hidden_; }

private:
    HiddenInView hidden_;
    std::uint64_t scene_ = 0; ///< scene of `hidden_`
    bool known_ = false;
    TerminationReader termination_;
    std::uint64_t terminationScene_ = 0; ///< scene of the pending result
    bool final_ = false;                 ///< the pending result is of the current full buffer
    bool reducedDrawn_ = false;
};

} // namespace tessera::vis
