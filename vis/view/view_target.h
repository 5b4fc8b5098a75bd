#pragma once

#include "vis/demand/added_rays.h"
#include "vis/demand/picture_contrast.h"
#include "vis/packet/packet_renderer.h"
#include "vis/processor/processor_picture.h"
#include "vis/raycast/stroke_uniforms.h"
#include "vis/view/pace.h"
#include "vis/view/picture.h"
#include "vis/view/view_demand.h"
#include "vis/view/view_hidden.h"
#include "vis/view/view_light.h"
#include "vis/view/view_tables.h"

namespace tessera::vis {

/// The scene whose picture is in a view's buffers.
struct ShownScene {
    Scene scene;
    const volume::BrickSource* source = nullptr;
    std::uint64_t resident = 0;                      ///< Residency::revision()
    bool started = false;                            ///< the buffers hold some of its picture
    bool compiling = false;                          ///< the program for the picture is being compiled
    std::optional<Clock::time_point> compilingSince; ///< without a picture of it
    std::uint64_t number = 0;                        ///< increases with each scene, or time of the data, drawn
    std::uint64_t frame = 0;                         ///< Residency::frame() of the last drawing
};

/// The rasterised geometry of a view.
class ViewGeometry {
public:
    /// Whether the buffer holds this tile of a picture of `size` pixels in this pass of a supersampled frame.
    bool shows(glm::ivec2 size, const Tile& tile, int pass) const {
        return shown_ && shown_->size == size && shown_->pass == pass && united(shown_->tile, tile) == shown_->tile;
    }
    void setShown(glm::ivec2 size, const Tile& tile, int pass) { shown_ = {size, tile, pass}; }
    void forget() { shown_.reset(); }
    GeometryBuffer& buffer() { return buffer_; }

private:
    struct Shown {
        glm::ivec2 size{0};
        Tile tile;
        int pass = 0;
    };
    GeometryBuffer buffer_;
    std::optional<Shown> shown_;
};

/// What the processor draws a view with.
struct PacketView {
    packet::PacketRenderer full, coarse; ///< of all samples, and of those of a coarse level until these are read
    bool isCoarse = false;               ///< the latter draws
    packet::PacketPicture picture;       ///< of the tile drawn last
    packet::PacketGeometry geometry;     ///< that its rays met
    PictureContrast contrast;            ///< of the picture at half resolution
    AddedRays added;                     ///< until the picture is refined
    Pace pace{false};                    ///< of rays cast by the processor, measured by the clock
    int time = -1, step = 0;             ///< index of the stored time drawn last, and the way from the one before
    std::uint64_t revision = 0;          ///< increases with each data set, and from coarse samples to all and back
    bool failed = false; ///< its samples could not be read: OpenGL draws these data, without what is damaged

    packet::PacketRenderer& renderer() { return isCoarse ? coarse : full; }
    void release() { full.release(), coarse.release(); }
};

/// The picture of one view: its buffers, and what it is made of, parts that each own their state.
class ViewTarget {
public:
    explicit ViewTarget(const Driver& driver) : glPace(driver.timerQueries) {}

    PictureBuffers buffers;
    PictureState state;
    ShownScene shown;
    Pace glPace; ///< of rays cast by OpenGL
    ViewDemand demand;
    ViewTables tables;
    StrokeTexture strokes;
    ViewGeometry geometry;
    ViewLight light;
    ViewHidden hidden;
    PacketView packets;
    bool byProcessor = false; ///< casts rays in this call
    bool meanwhile = false;   ///< cast rays of the current picture while a program was being compiled
    ProcessorPicture alone;   ///< instead of all others, without OpenGL

    Pace& pace() { return byProcessor ? packets.pace : glPace; }
    /// Throws MachineError, leaving the target unchanged, when the driver has no memory for it.
    void resize(glm::ivec2 wanted, bool exact);
    /// Marks the pixels of `part` as out of date.
    void redraw(const Tile& part);
};

} // namespace tessera::vis
