#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/tile.h"

#include <optional>

namespace tessera::vis {

/// Render targets of the ray caster: linear premultiplied colour; distance and degree of interest of the picked sample;
/// termination depth.
struct RayBuffer {
    Texture color, pick, termination;
    Framebuffer framebuffer;
    glm::ivec2 size{0};
    glm::ivec2 first{0}; ///< texel of the picture's lower left pixel
    glm::ivec2 used{0};  ///< size of the picture in it
    Tile drawn;          ///< texels that may show something: others are clear
    /// Clears all targets.
    void clear();
    /// Texels `seen` of `tile` show something now, the others of it nothing.
    void drew(const Tile& tile, const Tile& seen) { drawn = united(tile, drawn) == tile ? seen : united(drawn, seen); }
};

/// The buffers of a view.
struct PictureBuffers {
    glm::ivec2 size{0};
    RayBuffer full;    ///< at the size of the picture, filled tile by tile
    RayBuffer half;    ///< at half that size, filled tile by tile before it
    RayBuffer reduced; ///< a quick picture, smaller than the buffer
    Texture output;    ///< the presented picture
    Framebuffer outputFramebuffer;

    Tile everything() const { return {glm::ivec2(0), size}; }
    /// Allocates buffers of that size. Throws MachineError when the driver has no memory for them.
    static PictureBuffers make(glm::ivec2 size, bool exact);
};

/// Which pixels of a view's buffers are up to date.
class PictureState {
public:
    enum class Done {
        Nothing,
        Full,     ///< the full buffer shows the scene
        Converged ///< converged: it also contains all passes of the supersampled frame
    };

    /// Marks the pixels of `part` as out of date.
    void redraw(const Tile& part);

    /// The area of the full buffer that was out of date when the current pass began.
    const Tile& stale() const { return stale_; }
    Done done() const { return done_; }
    bool full() const { return done_ != Done::Nothing; }
    bool converged() const { return done_ == Done::Converged; }
    void setDone(Done done) { done_ = done; }
    /// Number of tiles drawn in all passes over the stale area.
    int tilesDone() const { return tilesDone_; }
    void drewTile() { ++tilesDone_; }
    /// Passes follow that were counted already.
    void repeatAfter(int tiles) { tilesDone_ = tiles; }
    /// The first pass over the stale area is drawn and presented.
    void drewPass();

    /// The area of the picture that the half buffer shows, once all its tiles are drawn and presented.
    const std::optional<Tile>& half() const { return half_; }
    int halfTilesDone() const { return halfTilesDone_; }
    void drewHalfTile() { ++halfTilesDone_; }
    void drewHalf() { half_ = stale_; }

    /// The area of the picture that the reduced buffer shows.
    const std::optional<Tile>& reduced() const { return reduced_; }
    /// The reduced picture of the changed area is drawn and presented.
    void drewReduced();
    void dropReduced() { reduced_.reset(); }

    /// The area that the presented picture does not show yet.
    const Tile& changed() const { return changed_; }
    /// Whether a picture, of any scene, is presented.
    bool presented() const { return presented_; }
    void setPresented(bool presented) { presented_ = presented; }

private:
    Tile stale_, changed_;
    Done done_ = Done::Nothing;
    int tilesDone_ = 0, halfTilesDone_ = 0;
    std::optional<Tile> reduced_, half_;
    bool presented_ = false;
};

} // namespace tessera::vis
