#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

/// Paper grain and strokes of a stick, fixed to the object. A tile of 2D noise lies on the three coordinate planes of
/// the world, mixed by the surface's normal, so that it varies along the surface and not into it, where a ray through
/// translucent matter would average it away. Its scale is the power of two that matches the screen, faded into the next
/// one, so that no size pops in. Twin: vis/shaders/lib/grain.glsl.
namespace tessera::vis {

inline constexpr int kGrainEdge = 512;    ///< texels of the tile
inline constexpr double kGrainTexels = 3; ///< texels that one grain is wide

/// Per texel the tooth of the paper (x) and strokes along the tile's diagonal (y): periodic, each with all values 0..1
/// equally often. The same always.
struct GrainTile {
    std::vector<glm::vec2> texels; ///< x fastest
    /// Linear between texels; texel i at i + 1/2.
    glm::dvec2 at(glm::dvec2 texel) const;
};
std::shared_ptr<const GrainTile> grainTile();

/// Tooth and strokes at a world place on a surface. `size`: wanted world edge of a texel; `turn` (degrees) turns the
/// strokes. Mixtures keep the variance: 0.5 + sum w (t - 0.5) / sqrt(sum w^2), clamped to 0..1; w the product of
/// n_i^4 (of the planes, sum 1) and 1 - f, f (of the two scales), f the fraction of log2 size.
glm::dvec2 grainAt(const GrainTile& tile, glm::dvec3 place, glm::dvec3 normal, double size, double turn);

/// Factor of the paper's texture on linear light at a place in texels, with h the tooth linear between texels:
///   1 + tooth (0.1 (h(at) - h(at + (-1.5, 1.5))) + 0.05 (h(at / 7.3) - 0.5))
/// Twin: vis/shaders/lib/paper.glsl.
double paperShade(const GrainTile& tile, glm::dvec2 at, double tooth);

} // namespace tessera::vis
