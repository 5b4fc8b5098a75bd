#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/tile.h"

#include <optional>

namespace tessera::vis {

/// One buffer the ray caster draws into: linear premultiplied colour; distance of what a pixel shows and its interest;
/// distance up to which its ray went.
struct RayBuffer {
    Texture color, pick, reach;
    Framebuffer framebuffer;
    glm::ivec2 size{0};
    glm::ivec2 first{0}; ///< texel of the picture's lower left pixel
    /// Nothing in any pixel.
    void clear() const;
};

/// The buffers of a view.
struct PictureBuffers {
    glm::ivec2 size{0};
    RayBuffer full;    ///< at the size of the picture, filled tile by tile
    RayBuffer reduced; ///< a quick picture, of which `reducedSize` pixels are used
    glm::ivec2 reducedSize{0};
    Texture output; ///< what is presented
    Framebuffer outputFramebuffer;

    Tile everything() const { return {glm::ivec2(0), size}; }
    /// Buffers of that size. Throws MachineError when the driver has no memory for them.
    static PictureBuffers make(glm::ivec2 size, bool exact);
};

/// Which pixels of a view's buffers show its scene.
class PictureState {
public:
    enum class Done {
        Nothing,
        Full, ///< all of the full buffer shows the scene
        Still ///< and every pass of a supersampled still is in it
    };

    /// Pixels of `part` are out of date.
    void redraw(const Tile& part);

    /// What the full buffer holds nothing of, or something else, when a pass over it begins.
    const Tile& stale() const { return stale_; }
    Done done() const { return done_; }
    bool full() const { return done_ != Done::Nothing; }
    bool still() const { return done_ == Done::Still; }
    void setDone(Done done) { done_ = done; }
    /// Tiles drawn of all passes over what is stale.
    int tilesDone() const { return tilesDone_; }
    void drewTile() { ++tilesDone_; }
    /// The first pass over what is stale is done, and presented.
    void drewPass();

    /// Pixels of the picture that the reduced buffer shows of the scene.
    const std::optional<Tile>& reduced() const { return reduced_; }
    /// The reduced buffer shows what has changed, and that is presented.
    void drewReduced();
    void dropReduced() { reduced_.reset(); }

    /// What the presented picture does not show yet.
    const Tile& changed() const { return changed_; }
    /// A picture, of whatever scene, is presented.
    bool presented() const { return presented_; }
    void setPresented(bool presented) { presented_ = presented; }

private:
    Tile stale_, changed_;
    Done done_ = Done::Nothing;
    int tilesDone_ = 0;
    std::optional<Tile> reduced_;
    bool presented_ = false;
};

} // namespace tessera::vis
