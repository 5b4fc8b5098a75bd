#pragma once

#include "vis/bricks/channel_load.h"
#include "vis/demand/choose_bricks.h"
#include "vis/demand/covered_pixels.h"
#include "vis/demand/reach_reader.h"
#include "vis/passes/geometry_pass.h"
#include "vis/passes/renderer.h"
#include "vis/raycast/light_baker.h"
#include "vis/raycast/light_uniforms.h"

#include <vector>

namespace tessera::vis {

/// One buffer the ray caster draws into: linear premultiplied colour; distance of what a pixel shows and its interest;
/// distance up to which its ray went.
struct RayBuffer {
    Texture color, pick, reach;
    Framebuffer framebuffer;
    glm::ivec2 size{0};
    glm::ivec2 first{0}; ///< texel of the picture's lower left pixel
    /// Empty where the size is new.
    void resize(glm::ivec2 wanted, bool exact, const char* label);
    /// Nothing in any pixel.
    void clear() const;
};

class ViewTarget {
public:
    glm::ivec2 size{0};
    RayBuffer full;    ///< at the size of the picture, filled tile by tile
    RayBuffer reduced; ///< a quick picture, of which `reducedSize` pixels are used
    glm::ivec2 reducedSize{0};
    Texture output;
    Framebuffer outputFramebuffer;

    GeometryBuffer geometry;
    glm::ivec2 geometrySize{0}; ///< of the picture it shows; 0: none of `scene`
    Tile geometryTile;          ///< of it
    int geometryPass = 0;       ///< of a supersampled still

    // What the buffers show.
    Scene scene;
    std::uint64_t revision = 0; ///< of what was resident
    bool started = false;       ///< the buffers hold something of `scene`
    bool compiling = false;     ///< the program that the picture waits for is on the way
    bool shows = false;         ///< `output` holds a picture, of whatever scene
    Tile changed;               ///< what `output` does not show yet
    bool reducedValid = false;  ///< `reduced` shows `reducedTile` (pixels of the picture) of `scene`
    Tile reducedTile;
    Tile stale;        ///< what `full` holds nothing of, or something else
    int tilesDone = 0, ///< of all passes over it
        tileEdge = 256;
    const volume::BrickSource* source = nullptr;
    bool fullValid = false;  ///< `full` is done
    bool stillDone = false;  ///< and every pass of a supersampled still
    std::uint64_t frame = 0; ///< Residency::frame() in which it was drawn last
    double passMilliseconds = 0;
    std::optional<double> lastTime; ///< of the data shown
    std::vector<ChannelKey> shown;  ///< the frames of it
    double msPerPixel = 0;          ///< of a full pass; 0 = not measured
    double geometryMs = 0;          ///< of a reduced picture

    // Bricks wanted, and what they were wanted for.
    std::vector<std::shared_ptr<const BrickDemand>> demands; ///< per field of the plan
    double cell = 1; ///< edge of a cell of the finest level among them, in cells of full resolution
    std::optional<Scene> demandsFor;
    DemandSettings demandSettings;
    std::vector<ChannelKey> demandsKnown;
    std::uint64_t demandsHidden = 0;       ///< HiddenInView::revision()
    double share = 1;                      ///< DemandSettings::share: less while the picture is only probed
    int wantedTime = -1, timeStep = 0;     ///< which way the time runs, in stored times
    std::vector<BlockRanges> unitedBlocks; ///< of all parts and both times, per field, and what they were made for
    std::vector<ChannelKey> unitedKeys;
    std::uint64_t unitedRevision = 0;

    // Bricks behind what is opaque, and the picture that is asked for them.
    HiddenInView hidden;
    std::uint64_t hiddenScene = 0; ///< number of the scene that `hidden` is of
    bool hiddenKnown = false;      ///< from `full` as it is
    std::uint64_t sceneNumber = 0; ///< counts the scenes, and times of data, drawn
    ReachReader reach;
    std::uint64_t reachScene = 0;
    bool reachFinal = false;   ///< what is under way is of `full` as it is
    bool reducedDrawn = false; ///< in this frame

    // Transfer tables and block distances, and what they were made for.
    Texture table, planes, blocks;
    std::optional<Scene> tablesFor;
    std::uint64_t tablesRevision = 0;
    std::vector<ChannelKey> tablesKeys;
    int tableRows = 0, planePages = 0;
    glm::ivec3 blockCount{0};
    bool adaptive = false;                            ///< take longer steps through smooth ones
    bool skip = false;                                ///< leap over empty blocks
    std::vector<std::optional<glm::vec2>> opaque;     ///< RayLayer::opaque
    std::optional<std::vector<OccupiedBox>> occupied; ///< nullopt: not known

    // The part of a picture that they cover, and what it was found for.
    std::vector<Tile> covered;
    std::optional<Camera> coveredFor;
    glm::ivec2 coveredSize{0};

    LightMapTextures lightMaps;
    bool mapsPending = false; ///< the buffers show surroundings that are not read yet
    LightBaker light;
    std::uint64_t lightVersion = 0; ///< that the buffers show

    /// Throws MachineError, and is as it was, when the driver has no memory for it.
    void resize(glm::ivec2 wanted, bool exact);
    Tile everything() const { return {glm::ivec2(0), size}; }
    /// Pixels of `part` are out of date.
    void redraw(const Tile& part);
};

} // namespace tessera::vis
