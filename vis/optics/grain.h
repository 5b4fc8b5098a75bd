#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

/// Object-space paper grain and charcoal strokes. A tile of 2D noise is projected onto the three coordinate planes of
/// the world, blended by the surface normal: it varies along the surface, but not into it, where a ray through a
/// translucent volume would average it out. Its scale is the power of two that matches the screen, cross-faded with the
/// next one, so that sizes do not pop. Twin: vis/shaders/lib/grain.glsl.
namespace tessera::vis {

inline constexpr int kGrainEdge = 512;    ///< texels of the tile
inline constexpr double kGrainTexels = 3; ///< width of a grain in texels

/// Per texel the height of the paper's grain, called tooth (x), and strokes along the tile's diagonal (y): periodic,
/// each with uniformly distributed values 0..1. Deterministic.
struct GrainTile {
    std::vector<glm::vec2> texels; ///< x fastest
    /// Bilinear; the centre of texel i is at i + 1/2.
    glm::dvec2 at(glm::dvec2 texel) const;
};
std::shared_ptr<const GrainTile> grainTile();

/// Tooth and strokes at a world position on a surface. `size`: wanted world edge of a texel; `turn` rotates the
/// strokes, in degrees. Blending keeps the variance: 0.5 + sum w (t - 0.5) / sqrt(sum w^2), clamped to 0..1; w is the
/// product of n_i^4 (of the planes, sum 1) and 1 - f, f (of the two scales), f the fraction of log2 size.
glm::dvec2 grainAt(const GrainTile& tile, glm::dvec3 place, glm::dvec3 normal, double size, double turn);

/// Factor of the paper texture on linear light at a position in texels; h is the tooth, interpolated linearly:
///   1 + tooth (0.1 (h(at) - h(at + (-1.5, 1.5))) + 0.05 (h(at / 7.3) - 0.5))
/// Twin: vis/shaders/lib/paper.glsl.
double paperShade(const GrainTile& tile, glm::dvec2 at, double tooth);

} // namespace tessera::vis
