#pragma once

#include "vis/raycast/ray_plan.h"

/// Lookup tables of the ray caster: transfer functions, and where nothing is visible.
namespace tessera::vis {

inline constexpr int kTableSize = 2048;
/// Transfer tables of layers, then slices, then what colours layers by another channel: kTableSize x rows, linear
/// light, not premultiplied; then one row per layer whose opacity at i is the greater one of entries i and i + 1 (of
/// regions: of any gradient).
std::vector<glm::vec4> transferTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

/// The places between which the layers of a plan have all their opacity, from its transfer tables: beyond every number
/// where it goes on at an end of the range; nullopt of a layer with a gap between.
std::vector<std::optional<glm::vec2>> opaqueIntervals(const RayPlan& plan, const std::vector<glm::vec4>& tables);

inline constexpr int kPlaneSize = 256;
/// The plane tables of a plan, page by page: kPlaneSize x kPlaneSize, linear light, premultiplied. Of regions: value
/// (x) and gradient magnitude up to gradientTop (y) from 0 to 1; of pre-integration: front (x) and back (y).
std::vector<glm::vec4> planeTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

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
