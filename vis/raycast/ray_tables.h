#pragma once

#include "vis/raycast/ray_plan.h"

/// Lookup tables of the ray caster: transfer functions and empty-space skipping.
namespace tessera::vis {

inline constexpr int kTableSize = 2048;
/// Transfer tables of layers, then slices, then colour channels: kTableSize entries per row, linear light, not
/// premultiplied. Then one row per layer whose opacity at i is the maximum of entries i and i + 1 (2D functions: over
/// all gradient magnitudes).
std::vector<glm::vec4> transferTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

/// Per layer, the interval of positions that contains all its opacity, from its transfer table; extended to infinity if
/// an end of the range is opaque; nullopt for a layer with a gap.
std::vector<std::optional<glm::vec2>> opaqueIntervals(const RayPlan& plan, const std::vector<glm::vec4>& tables);

inline constexpr int kPlaneSize = 256;
/// The plane tables of a plan, page by page: kPlaneSize x kPlaneSize, linear light, premultiplied. For 2D transfer
/// functions: value (x) and gradient magnitude relative to gradientTop (y), 0 to 1; for pre-integration: front (x) and
/// back (y).
std::vector<glm::vec4> planeTables(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

/// Empty-space map: the Chebyshev distance in blocks, at most 255, to the nearest block in which a layer can be
/// visible; nullopt if the layers' fields have no common block grid.
struct BlockDistances {
    glm::ivec3 count{0};
    std::vector<std::uint8_t> distance;
    double occupied = 1;         ///< fraction of blocks at distance 0
    glm::ivec3 begin{0}, end{0}; ///< bounding box of the occupied blocks
};
std::optional<BlockDistances> blockDistances(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

} // namespace tessera::vis
