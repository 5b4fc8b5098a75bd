#pragma once

#include "vis/gl/program.h"
#include "vis/gl/texels.h"
#include "vis/model/ray_setup.h"
#include "vis/model/scene.h"

#include <optional>
#include <string>
#include <vector>

/// From a scene to one program of the ray caster: which channels it samples, which variant it needs, its uniforms.
namespace tessera::vis {

/// A channel as the program sees it now.
struct BoundField {
    int channel = 0;
    bool categorical = false;
    // Filled from what is resident:
    GLuint texture = 0;
    int level = 0;
    TexelEncoding encoding;
    glm::ivec3 textureSize{1}; ///< texels with halo
    const BlockRanges* blocks = nullptr;
    GLuint pages = 0, atlas = 0; ///< 0: the texture is all there is
    glm::ivec3 atlasSize{1};
    bool everyBrick = false; ///< no page is coarse
};

enum class RayStyle { Composite, Maximum, XRay, Iso }; ///< numbers known to raycast.frag.glsl

struct RayLayer {
    int layer = 0; ///< index into Scene::layers
    RayStyle style = RayStyle::Composite;
    int field = 0; ///< index into RayPlan::fields
    bool shaded = false;
};

struct SliceUse {
    int layer = 0, field = 0;
};

/// What a scene needs, independent of what is resident.
struct RayPlan {
    std::vector<BoundField> fields;
    std::vector<RayLayer> layers;
    std::vector<SliceUse> slices;
    std::vector<int> brushFields;
    bool empty() const { return layers.empty() && slices.empty(); }
};

/// Visible layers whose channel the data set has; layers of unknown channels are left out.
RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info);

/// The program variant of a plan whose fields are bound. `skip`: leap over empty blocks.
ProgramRecipe rayRecipe(const RayPlan& plan, const Scene& scene, const volume::BrickGrid& grid, bool skip);

inline constexpr int kTableSize = 2048;
/// Transfer tables of layers, then slices: kTableSize x rows, linear light, not premultiplied; then one row per layer
/// whose opacity at i is the greater one of entries i and i + 1.
std::vector<glm::vec4> transferTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

/// Texture units: channels from 0, then page tables, atlases, the transfer tables and the block distances.
struct RayUnits {
    int pages = 0, atlases = 0, table = 0, blocks = 0;
};
RayUnits rayUnits(const RayPlan& plan);

/// Sets every uniform except the samplers' textures (rayUnits) and
/// ndcScale and ndcOffset.
void setRayUniforms(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                    const volume::BrickGrid& grid, double aspect, double stepFactor);

/// Which blocks a layer of the plan can show something in, as Chebyshev distances (in blocks, at most 255) to the
/// nearest such block; nullopt when the layers' fields have no common block grid.
struct BlockDistances {
    glm::ivec3 count{0};
    std::vector<std::uint8_t> distance;
    double occupied = 1;         ///< share of blocks at distance 0
    glm::ivec3 begin{0}, end{0}; ///< box of the occupied blocks
};
std::optional<BlockDistances> blockDistances(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

} // namespace tessera::vis
