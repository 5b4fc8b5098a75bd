#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

/// Object-space paper grain, strokes and dots. A tile of 2D patterns is projected onto the three coordinate planes of
/// the world, blended by the surface normal: it varies along the surface, but not into it, where a ray through a
/// translucent volume would average it out. Its scale is the power of two that matches the screen, cross-faded with the
/// next one, so that sizes do not pop. Twin: vis/shaders/lib/grain.glsl.
namespace tessera::vis {

inline constexpr int kGrainEdge = 512;        ///< texels of the tile
inline constexpr double kGrainTexels = 3;     ///< width of a grain, and of a dot, in texels
inline constexpr int kStrokeGap = 8;          ///< distance of strokes along an axis of the tile, in texels
inline constexpr int kStrokeTurns = 8;        ///< directions of strokes in a plane
inline constexpr double kCrossingShift = 137; ///< of crossing strokes, in texels

/// Per texel the height of the paper's grain, called tooth (x), strokes along the tile's diagonal (y), and the darkness
/// from which on it is covered by a dot (z): periodic, each with uniformly distributed values 0..1. Dots are added one
/// by one, each where it is farthest from those before, so that they are even at any darkness. Deterministic.
struct GrainTile {
    std::vector<glm::vec3> texels; ///< x fastest
    /// Bilinear; the centre of texel i is at i + 1/2.
    glm::dvec3 at(glm::dvec2 texel) const;
};
std::shared_ptr<const GrainTile> grainTile();

/// Tooth and dots at a world position on a surface. `size`: wanted world edge of a texel. w is the product of n_i^4 (of
/// the planes, sum 1) and 1 - f, f (of the two scales), f the fraction of log2 size. Blending keeps the variance of the
/// tooth: 0.5 + sum w (t - 0.5) / sqrt(sum w^2), clamped to 0..1. Dots stay whole: of those
/// of each plane and scale that darkness D asks for, 1 - (1 - D)^w show, and D of all: min 1 - (1 - t)^(1 / w).
glm::dvec2 grainAt(const GrainTile& tile, glm::dvec3 place, glm::dvec3 normal, double size);

/// Strokes at a world position on a surface, in the direction `along` (either way, length 1), blended like the tooth.
/// Each plane has strokes in kStrokeTurns directions, of which the two nearest are drawn: t = smoothstep(0.35, 0.65)
/// of the way from one to the other is the second's share. `shift` in texels: other strokes.
double strokesAt(const GrainTile& tile, glm::dvec3 place, glm::dvec3 normal, glm::dvec3 along, double size,
                 double shift);

/// A unit vector across a normal, and with cross(normal, it) a basis of the tangent plane (T. Duff et al.: Building an
/// orthonormal basis, revisited, 2017).
glm::dvec3 acrossNormal(glm::dvec3 normal);

/// Curvature of a surface in four directions of its tangent plane, at angles of 0, 45, 90 and 135 degrees to
/// acrossNormal(): as (k1 + k2, k0 - k90, k45 - k135), times a length.
using SurfaceBend = glm::dvec3;
/// The curvature in a tangent direction of length 1, times that length: with (u, v) the direction, (s + c.x (u^2 - v^2)
/// + c.y 2 u v) / 2.
double bendAlong(SurfaceBend bend, glm::dvec3 normal, glm::dvec3 along);

/// Direction of strokes on a surface: that of the principal curvature of larger magnitude, as far as the two differ and
/// the surface is bent, else the fixed direction (1, 1, 1). With bend = (s, c) and K = max(|s|, |c|) the doubled angle
/// in the tangent plane is that of
///   follow smoothstep(0.04, 0.2, K) s c / K^2 + 0.25 (u^2 - v^2, 2 u v), (u, v) the fixed direction,
/// since |c| = |k1 - k2| (Kindlmann et al. 2003 for curvature in volumes). `turn`: radians added to the angle.
glm::dvec3 strokeDirection(glm::dvec3 normal, SurfaceBend bend, double follow, double turn);

/// Factor of the paper texture on linear light at a position in texels; h is the tooth, interpolated linearly:
///   1 + tooth (0.1 (h(at) - h(at + (-1.5, 1.5))) + 0.05 (h(at / 7.3) - 0.5))
/// Twin: vis/shaders/lib/paper.glsl.
double paperShade(const GrainTile& tile, glm::dvec2 at, double tooth);

} // namespace tessera::vis
