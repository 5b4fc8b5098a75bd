#pragma once

#include "vis/demand/hidden_bricks.h"
#include "vis/demand/reach_reader.h"
#include "vis/passes/picture.h"
#include "vis/passes/render_tools.h"

namespace tessera::vis {

/// The stage that finds which bricks lie behind what is opaque: it reads back how far the rays of a view's pictures
/// went. `scene`: the number of a scene, of which pictures differ by what has been loaded.
class ViewHidden {
public:
    void resize(glm::ivec2 size) { reach_.resize(size); }
    /// The full buffer changes: what it hides is not known.
    void forgetPicture() { known_ = final_ = false; }
    /// Other data are shown.
    void forgetData();

    /// A reduced picture was drawn in this frame.
    void drewReduced() { reducedDrawn_ = true; }
    /// Begins to read back what the picture just drawn hides.
    void start(RenderTools& tools, const RenderCall& call, const PictureBuffers& buffers, const PictureState& state,
               std::uint64_t scene);
    /// Takes what has come back; `wait`: until it has. `grid`: of the data it is of; null: these are shown no more.
    void take(bool wait, const volume::BrickGrid* grid);

    /// What the full buffer hides is known as it is.
    bool known() const { return known_; }
    /// Whether a picture of these data was read back.
    bool any() const { return scene_ != 0; }
    const HiddenInView& bricks() const { return hidden_; }

private:
    HiddenInView hidden_;
    std::uint64_t scene_ = 0; ///< that `hidden_` is of
    bool known_ = false;
    ReachReader reach_;
    std::uint64_t reachScene_ = 0; ///< that what is under way is of
    bool final_ = false;           ///< what is under way is of the full buffer as it is
    bool reducedDrawn_ = false;
};

} // namespace tessera::vis
