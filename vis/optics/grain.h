#pragma once

#include "volume/base/numbers.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>
#include <vector>

/// Object-space paper grain, strokes and dots. A tile of 2D patterns is projected onto the three coordinate planes of
/// the world, blended by the surface normal: it varies along the surface, but not into it, where a ray through a
/// translucent volume would average it out. Its scale is the power of two that matches the screen, cross-faded with the
/// next one, so that sizes do not pop. Formulas are templates over the number (volume/base/numbers.h). Twin:
/// vis/shaders/lib/shading/grain.glsl.
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
const std::shared_ptr<const GrainTile>& grainTile();

/// A pattern at a whole texel, of which there is one for every number; packets have their own.
inline double patternOf(const GrainTile& tile, int pattern, double x, double y) {
    const int i = int(x) & (kGrainEdge - 1), j = int(y) & (kGrainEdge - 1);
    return double(tile.texels[std::size_t(j) * kGrainEdge + std::size_t(i)][pattern]);
}
/// The same, bilinear: GrainTile::at().
template <class N> N patternAt(const GrainTile& tile, int pattern, const glm::vec<2, N>& texel) {
    const N x = texel.x - N(0.5), y = texel.y - N(0.5), left = roundDown(x), low = roundDown(y);
    const auto row = [&](const N& of) {
        return blended(patternOf(tile, pattern, left, of), patternOf(tile, pattern, left + N(1), of), x - left);
    };
    return blended(row(low), row(low + N(1)), y - low);
}

/// The planes and scales that a surface shows the tile at.
template <class N> struct GrainPlaces {
    glm::vec<3, N> place, planes;
    N whole, part;

    GrainPlaces(const glm::vec<3, N>& at, const glm::vec<3, N>& normal, N size)
        : place(at), planes(normal * normal * normal * normal) {
        const N octave = logarithm(larger(size, N(1e-9)));
        whole = roundDown(octave);
        part = octave - whole;
        planes = planes * (N(1) / larger(planes.x + planes.y + planes.z, N(1e-12)));
    }
    /// Calls use(axis, weight, position in texels) for each.
    template <class Use> void each(const Use& use) const {
        for (int scale = 0; scale < 2; ++scale) {
            const glm::vec<3, N> texel = place * powerOfTwo(-whole - N(scale));
            for (int axis = 0; axis < 3; ++axis) {
                const N apart(17.3 * (axis + 1)); // so that no plane passes through the origin of another
                use(axis, planes[axis] * (scale == 0 ? N(1) - part : part),
                    glm::vec<2, N>(texel[(axis + 1) % 3] + apart, texel[(axis + 2) % 3] + apart));
            }
        }
    }
};

/// Tooth and dots at a world position on a surface. `size`: wanted world edge of a texel. w is the product of n_i^4 (of
/// the planes, sum 1) and 1 - f, f (of the two scales), f the fraction of log2 size. Blending keeps the variance of the
/// tooth: 0.5 + sum w (t - 0.5) / sqrt(sum w^2), clamped to 0..1. Dots stay whole: of those
/// of each plane and scale that darkness D asks for, 1 - (1 - D)^w show, and D of all: min 1 - (1 - t)^(1 / w).
template <class N>
glm::vec<2, N> grainAt(const GrainTile& tile, const glm::vec<3, N>& place, const glm::vec<3, N>& normal, N size) {
    N sum(0), squares(0), dots(1);
    GrainPlaces<N>(place, normal, size).each([&](int, N weight, const glm::vec<2, N>& on) {
        sum += weight * (patternAt(tile, 0, on) - N(0.5));
        squares += weight * weight;
        const N bare = larger(N(1) - patternAt(tile, 2, on), N(0));
        dots = smaller(dots, N(1) - power(bare, N(1) / larger(weight, N(1e-3))));
    });
    return {clamped(N(0.5) + sum / squareRoot(larger(squares, N(1e-12))), N(0), N(1)), dots};
}

/// Strokes at a world position on a surface, in the direction `along` (either way, length 1), blended like the tooth.
/// Each plane has strokes in kStrokeTurns directions, of which the two nearest are drawn: t = smoothstep(0.35, 0.65)
/// of the way from one to the other is the second's share. `shift` in texels: other strokes.
template <class N>
N strokesAt(const GrainTile& tile, const glm::vec<3, N>& place, const glm::vec<3, N>& normal,
            const glm::vec<3, N>& along, N size, double shift) {
    N sum(0), squares(0);
    GrainPlaces<N>(place, normal, size).each([&](int axis, N planeWeight, const glm::vec<2, N>& on) {
        const N turns =
            angleOf(along[(axis + 2) % 3], along[(axis + 1) % 3] + N(1e-9)) * N(kStrokeTurns / std::numbers::pi);
        const N first = roundDown(turns), share = smoothStep(N(0.35), N(0.65), turns - first);
        for (int next = 0; next < 2; ++next) {
            // Strokes lie along the tile's diagonal. Half a turn more is the same direction.
            const N turn = first + N(next), number = turn - N(kStrokeTurns) * roundDown(turn * N(1.0 / kStrokeTurns));
            const N angle = N(0.25 * std::numbers::pi) - number * N(std::numbers::pi / kStrokeTurns);
            const N c = cosine(angle), s = sine(angle);
            const N weight = planeWeight * (next == 0 ? N(1) - share : share);
            const glm::vec<2, N> turned(c * on.x - s * on.y + N(shift), s * on.x + c * on.y + N(shift));
            sum += weight * (patternAt(tile, 1, turned) - N(0.5));
            squares += weight * weight;
        }
    });
    return clamped(N(0.5) + sum / squareRoot(larger(squares, N(1e-12))), N(0), N(1));
}

/// A unit vector across a normal, and with cross(normal, it) a basis of the tangent plane (T. Duff et al.: Building an
/// orthonormal basis, revisited, 2017).
template <class N> glm::vec<3, N> acrossNormal(const glm::vec<3, N>& n) {
    const N sign = choose(n.z < N(0), N(-1), N(1)), a = N(-1) / (sign + n.z);
    return {N(1) + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

/// Curvature of a surface in four directions of its tangent plane, at angles of 0, 45, 90 and 135 degrees to
/// acrossNormal(): as (k1 + k2, k0 - k90, k45 - k135), times a length.
template <class N> using SurfaceBendOf = glm::vec<3, N>;
using SurfaceBend = SurfaceBendOf<double>;
/// The curvature in a tangent direction of length 1, times that length: with (u, v) the direction, (s + c.x (u^2 - v^2)
/// + c.y 2 u v) / 2.
template <class N>
N bendAlong(const SurfaceBendOf<N>& bend, const glm::vec<3, N>& normal, const glm::vec<3, N>& along) {
    const glm::vec<3, N> first = acrossNormal(normal), second = crossProduct(normal, first);
    const N u = inner(first, along), v = inner(second, along);
    return N(0.5) * (bend.x + bend.y * (u * u - v * v) + bend.z * N(2) * u * v);
}

/// The sum of what `value(offset) -> FoundValue` gives on both sides of a place, less twice the value there; absent
/// ones are like it.
template <class N, class Value, class Found>
N secondDifference(const Value& value, const Found& centre, const glm::vec<3, N>& offset) {
    const auto side = [&](const glm::vec<3, N>& to) {
        const auto found = value(to);
        return choose(found.present & centre.present, found.value - centre.value, N(0));
    };
    return side(-offset) + side(offset);
}
/// Curvature of the surface through a place by four of these in its tangent plane at `reach`, times the length of the
/// gradient per `reach`.
template <class N, class Value, class Found>
SurfaceBendOf<N> surfaceBend(const Value& value, const Found& centre, const glm::vec<3, N>& normal, double reach) {
    const glm::vec<3, N> first = acrossNormal(normal), second = crossProduct(normal, first);
    const N along(reach), aslant(reach / std::numbers::sqrt2);
    const N turned[4] = {secondDifference<N>(value, centre, first * along),
                         secondDifference<N>(value, centre, (first + second) * aslant),
                         secondDifference<N>(value, centre, second * along),
                         secondDifference<N>(value, centre, (second - first) * aslant)};
    return {N(0.5) * (turned[0] + turned[1] + turned[2] + turned[3]), turned[0] - turned[2], turned[1] - turned[3]};
}

/// Direction of strokes on a surface: that of the principal curvature of larger magnitude, as far as the two differ and
/// the surface is bent, else the fixed direction (1, 1, 1). With bend = (s, c) and K = max(|s|, |c|) the doubled angle
/// in the tangent plane is that of
///   follow smoothstep(0.04, 0.2, K) s c / K^2 + 0.25 (u^2 - v^2, 2 u v), (u, v) the fixed direction,
/// since |c| = |k1 - k2| (Kindlmann et al. 2003 for curvature in volumes). `turn`: radians added to the angle.
template <class N>
glm::vec<3, N> strokeDirection(const glm::vec<3, N>& normal, const SurfaceBendOf<N>& bend, double follow, double turn) {
    const glm::vec<3, N> first = acrossNormal(normal), second = crossProduct(normal, first);
    const N diagonal(std::numbers::inv_sqrt3);
    const N u = (first.x + first.y + first.z) * diagonal, v = (second.x + second.y + second.z) * diagonal;
    const N most = larger(magnitude(bend.x), squareRoot(bend.y * bend.y + bend.z * bend.z));
    const N bent = N(follow) * smoothStep(N(0.04), N(0.2), most) * bend.x / larger(most * most, N(1e-12));
    const N x = bent * bend.y + N(0.25) * (u * u - v * v), y = bent * bend.z + N(0.5) * u * v;
    const N angle = N(0.5) * angleOf(y, x + N(1e-9)) + N(turn);
    return first * cosine(angle) + second * sine(angle);
}

/// Factor of the paper texture on linear light at a position in texels; h is the tooth, interpolated linearly:
///   1 + tooth (0.1 (h(at) - h(at + (-1.5, 1.5))) + 0.05 (h(at / 7.3) - 0.5))
/// Twin: vis/shaders/lib/shading/paper.glsl.
double paperShade(const GrainTile& tile, glm::dvec2 at, double tooth);

} // namespace tessera::vis
