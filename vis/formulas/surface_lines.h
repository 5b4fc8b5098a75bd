#pragma once

#include "volume/base/numbers.h"

/// Lines that looks draw on surfaces: where these turn away, cross planes or are cut off.
namespace tessera::vis {

inline constexpr double kNoCut = 1e4; ///< a distance in pixels from a cut that is none

/// A coordinate along a surface.
template <class N> struct AcrossPictureOf {
    N change;  ///< across the picture, |e - (v_e / n.v) n| per world unit
    N crosses; ///< 0 where the surface is nearly parallel to planes of this coordinate (within 6 degrees), 1 from 20 on
};
template <class N>
AcrossPictureOf<N> acrossPicture(const glm::vec<3, N>& normal, const glm::vec<3, N>& toViewer, int axis) {
    const N facing = inner(normal, toViewer);
    const N along = choose(facing < N(0), smaller(facing, N(-0.02)), larger(facing, N(0.02)));
    glm::vec<3, N> change = normal * (-toViewer[axis] / along);
    change[axis] += N(1);
    AcrossPictureOf<N> across;
    across.change = lengthOf(change);
    across.crosses = smoothStep(N(0.1), N(0.35), squareRoot(larger(N(0), N(1) - normal[axis] * normal[axis])));
    return across;
}

/// Coverage of a pixel, 0..1, by the intersection lines of a surface with planes at multiples of `spacing` along x, y
/// and z; lines are `width` pixels wide. The distance of a coordinate to a multiple is divided by its change across the
/// picture. Lines closer than 4 pixels turn into their mean; where the surface does not cross the planes they fade out.
/// `pixel`: world edge of a pixel.
template <class N>
N wireCoverage(const glm::vec<3, N>& world, const glm::vec<3, N>& normal, const glm::vec<3, N>& toViewer,
               double spacing, double width, N pixel) {
    N covered = N(0);
    for (int axis = 0; axis < 3; ++axis) {
        const AcrossPictureOf<N> own = acrossPicture(normal, toViewer, axis);
        const N gap = N(spacing) / larger(own.change * pixel, N(1e-6)); // pixels
        const N x = world[axis] / N(spacing);
        const N away = magnitude(x - roundDown(x + N(0.5))) * gap;
        const N line = blended(clamped(N(0.5 * width + 0.5) - away, N(0), N(1)), smaller(N(width) / gap, N(1)),
                               clamped(N(2) - N(0.5) * gap, N(0), N(1)));
        covered = larger(covered, line * own.crosses);
    }
    return covered;
}

/// 1 on outlines of constant width, 0 elsewhere: |n.v| < sqrt(T k (2 - T k)) for curvature k and thickness T in world
/// units (Kindlmann et al. 2003, equation 10), softened over the outer half.
template <class N> N outline(N facing, N curvature, N thickness) {
    const N bent = smaller(N(1), thickness * curvature);
    const N limit = squareRoot(bent * (N(2) - bent));
    return N(1) - smoothStep(N(0.5), N(1), facing / larger(limit, N(1e-6)));
}

/// Distance in pixels from a place of a surface to where a face of the box cuts it off, at most kNoCut: that of each
/// coordinate to the face, divided by its change across the picture. Faces that the surface does not cross cut nothing.
template <class N>
N cutDistance(const glm::vec<3, N>& world, const glm::vec<3, N>& normal, const glm::vec<3, N>& toViewer,
              const glm::dvec3& halfSize, N pixel) {
    N nearest = N(kNoCut);
    for (int axis = 0; axis < 3; ++axis) {
        const AcrossPictureOf<N> own = acrossPicture(normal, toViewer, axis);
        const N left = larger(N(halfSize[axis]) - magnitude(world[axis]), N(0));
        nearest = smaller(nearest, left / larger(own.change * pixel, N(1e-6)) + N(kNoCut) * (N(1) - own.crosses));
    }
    return nearest;
}

/// Coverage of a pixel by the line along a cut.
template <class N> N cutLine(N cut, N width) {
    return clamped(width + N(0.5) - cut, N(0), N(1));
}

/// n.l quantised: min(n - 1, floor(n max(0, n.l))) / (n - 1).
template <class N> N lightStep(N light, int steps) {
    return smaller(N(steps - 1), roundDown(N(steps) * larger(N(0), light))) / N(steps - 1);
}

} // namespace tessera::vis
