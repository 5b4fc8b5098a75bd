#pragma once

#include "vis/passes/renderer_state.h"

#include <span>

/// Casts the rays of a tile, by OpenGL or the processor, into the buffers of a view.
namespace tessera::vis {

/// What casts the rays of one picture: program variants, or packets.
struct RayPrograms {
    PacketView* packets = nullptr;            ///< instead of programs: the processor casts the rays
    const GeometryBuffer* geometry = nullptr; ///< for these: what they meet, rasterised; null: nothing
    const Program* program = nullptr;
    const Program* beyond = nullptr; ///< for pixels outside all lenses; null: same as `program`
    RayPlan beyondPlan;              ///< the plan of `beyond`
    Scene beyondScene;
};

/// The part of a picture to cast rays for.
struct RayTile {
    glm::ivec2 size{0}; ///< of the whole picture
    Tile tile;
    const std::vector<Tile>* parts = nullptr; ///< draw only what lies in one of these parts of the tile; null: all
    double stepFactor = 1;
    int pass = 0; ///< of a supersampled frame
};

/// The program variant for a bound plan.
ProgramRecipe rayVariant(const RendererState& shared, const ViewTarget& target, const Scene& scene,
                         const RayPlan& plan);

/// Rasterises the geometry for a tile of the picture of a buffer, unless the target already has it. The
/// reduced picture has the two nearest surfaces only.
void rasteriseGeometry(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayBuffer& rays,
                       const Tile& tile, int pass = 0);

/// Draws a tile with the rays of one pass.
void castRays(RendererState& shared, const RayPrograms& programs, const RenderCall& call, RayBuffer& buffer,
              const RayTile& what);

/// Puts the picture of packets into the buffer of the whole picture.
void storePackets(const packet::PacketPicture& picture, const RayBuffer& buffer);

/// Casts the rays of one pass by packets for boxes of a tile alone, into their picture, which is empty elsewhere.
void castBoxes(const RayPrograms& programs, const RenderCall& call, const RayBuffer& buffer, const RayTile& what,
               std::span<const packet::PixelBox> boxes);

/// Draws pass n > 0 of a supersampled frame into a second buffer and blends it into the first with weight 1 / (n + 1).
/// (Blending in the ray-casting program itself would make software GL compile it again. Picking keeps the pixel
/// centre's result.)
void accumulate(RendererState& shared, ViewTarget& target, const RenderCall& call, const RayPrograms& programs,
                const RayTile& what);

} // namespace tessera::vis
