#pragma once

#include "vis/formulas/colors.h"
#include "vis/scene/ray_segment.h"
#include "vis/scene/scene.h"
#include "volume/base/numbers.h"
#include "volume/field/lattice.h"

#include <optional>

/// Specification of one ray of the picture, shared by the shader (float) and the reference ray caster (double).
///
/// Colours: transfer functions, layers and backgrounds are given in sRGB and first converted to linear light. Samples
/// are shaded and composited in linear light, and the picture over its background is encoded to sRGB at the very end.
///
/// Along a ray, front to back, for sample k = 0 .. count - 1 at t_k = enter + (k + 1/2) step:
///   1. all slices intersected at t in (t_{k-1}, t_k] (t_{-1} = enter) and all iso-surfaces crossed between t_{k-1} and
///      t_k, nearest first; at equal t slices first, then in layer order. An iso-surface is crossed if the values at
///      t_{k-1} and t_k are both present and lie on different sides (v >= value against v < value). The crossing is
///      refined by kBisections bisections of [t_{k-1}, t_k]; the midpoint of the last interval is shaded and
///      composited with the layer's opacity;
///   2. all composite layers, in order: colour and opacity (below), correctedOpacity(), shading if enabled
///      (vis/optics/shade.h).
/// Slices between the last sample and the exit follow at the end. A ray is terminated early when the accumulated
/// opacity reaches kOpaque. Absent samples contribute nothing. Finally the projections, which evaluate all samples of
/// the ray up to there, are composited behind the rest, in layer order. With x = transfer function position of a
/// sample, clamped to 0..1, and f = opacity factor of its degree of interest:
///   maximum: the first sample with the largest x * f; colour of its position, opacity min(1, density * opacity of the
///            curve) * f;
///   minimum: the same with the largest (1 - x) * f;
///   local maximum: the same with the first x * f that is at least that of the threshold and is followed by a smaller
///            or an absent one; if there is none, as maximum (Y. Sato et al.: Local maximum intensity projection,
///            1998);
///   average: the mean of the unclamped positions weighted by f; colour of that position, opacity as for maximum with
///            f replaced by its unweighted mean;
///   x-ray:   absorption A = 1 - prod(1 - a) over all samples, a = correctedOpacity(opacity of the curve * f)
///            (Beer-Lambert law); colour of the position A, opacity A.
///
/// Gradients are those of volume/reconstruct/gradient.h with the scene's span; at coarser levels a cell is that of the
/// level. Categorical channels have none.
///
/// The position of a sample is that of its value in the transfer function's range or, for layers that show the
/// gradient, its magnitude over gradientTop: the change over one worldCell edge per axis (length of that vector), in
/// ranges.
///
/// A composite layer's colour and opacity are classified
///   post:           by evaluate() at the sample's value (and gradient magnitude, for 2D transfer functions);
///   pre:            by the mean of the premultiplied colours of the (unfiltered) present samples around it, with the
///                   weights of trilinear interpolation, on BCC over both sublattices; nothing if the present samples
///                   have less than half of the weight;
///   pre-integrated: by preintegrated() (vis/optics/preintegration.h) between the values at t_k - step / 2 and
///                   t_k + step / 2; if one of them is absent, the other is used for both, over half the length.
/// Pre-classification and pre-integration apply to values and 1D transfer functions: layers that show the gradient, 2D
/// transfer functions and categorical channels are classified after interpolation.
///
/// With `colorBy` only the colours of a layer change: they come from the transfer function of the other channel at its
/// (always post-classified) value at the sample, at the intersection with an iso-surface, or at the sample that a
/// projection shows; for averages and x-rays at its mean over the samples, weighted by f or by the light that each
/// sample absorbs. Where that channel is absent the colour is kNoValueColor, for an iso-surface its own.
///
/// The degree of interest d of a position multiplies the opacity (of the curve before correctedOpacity(), of an
/// iso-surface or a slice) by f = mix(contextOpacity, 1, d) and desaturates the colour: mix(luminance, colour,
/// mix(contextSaturation, 1, d)), in linear light before shading. Colours of averages and x-rays are not desaturated.
namespace tessera::vis {

inline constexpr double kOpaque = 0.995; ///< accumulated opacity at which a ray ends
inline constexpr int kBisections = 6;    ///< number of bisections of a step to locate an iso-surface
inline constexpr double kFlatGradient =
    0.005; ///< gradient in transfer-function ranges per cell from which on shading has full weight

/// The segment of a ray inside the box |p| <= halfSize, as distances from its origin. A perspective ray starts at the
/// eye at the earliest; a parallel one may begin behind it.
std::optional<RaySegment> clipToBox(const Ray& ray, glm::dvec3 halfSize, bool perspective);
/// The same from `begin` on at the earliest; empty (enter >= exit) if there is none.
template <class N> SegmentOf<N> segmentInBox(const RayOf<N>& ray, const glm::dvec3& halfSize, N begin) {
    SegmentOf<N> segment{begin, N(1e30)};
    for (int axis = 0; axis < 3; ++axis) {
        const N origin = ray.origin[axis], direction = ray.direction[axis], half(halfSize[axis]);
        const auto along = magnitude(direction) < N(1e-12);
        const N slope = choose(along, N(1), direction);
        const N a = (-half - origin) / slope, b = (half - origin) / slope;
        const auto misses = along & (magnitude(origin) > half);
        segment.enter = larger(segment.enter, choose(along, choose(misses, N(1e30), N(-1e30)), smaller(a, b)));
        segment.exit = smaller(segment.exit, choose(along, choose(misses, N(-1e30), N(1e30)), larger(a, b)));
    }
    return segment;
}

/// World edges of the cell that steps and gradients are measured in: a cell of the CC grid, or of the CC grid with the
/// same sample density as a BCC lattice (its spacing / sqrt 2).
glm::dvec3 worldCell(const volume::Lattice& lattice, const WorldFrame& frame);

/// Sample positions of a ray. The wanted step advances stepVoxels cells, h = stepVoxels / |direction / cell|; the
/// segment is divided into count = max(1, ceil(length / h - 1e-4)) equal parts, sampled at their centres or offset by
/// startJitter(). Clips that keep their inside shorten the segment first; holes of the other clips hide what lies in
/// them.
struct RaySamples {
    int count = 0;
    double step = 0; ///< world units
    double enter = 0;
    double phase = 0.5; ///< offset by startJitter() if ray starts are jittered
    double at(int k) const { return enter + (k + phase) * step; }
};
/// count, for a segment of some length and the wanted step.
template <class N> N sampleCount(N length, N wanted) {
    return larger(N(1), roundUp(length / wanted - N(1e-4)));
}
RaySamples raySamples(const RaySegment& segment, glm::dvec3 direction, glm::dvec3 cell, double stepVoxels);

/// Opacity correction of a sample for a segment of `step` world units: 1 - (1 - opacity)^(density * step /
/// kReferenceLength).
template <class N> N correctedOpacity(N opacity, N step, N density) {
    return N(1) - power(N(1) - clamped(opacity, N(0), N(1)), density * step * N(1 / kReferenceLength));
}
inline double correctedOpacity(double opacity, double step, double density) {
    return correctedOpacity<double>(opacity, step, density);
}
/// The same, of the extinction -log2(1 - opacity).
template <class N> N correctedOpacityOf(N extinction, N step, N density) {
    return N(1) - powerOfTwo(-(extinction * (density * step * N(1 / kReferenceLength))));
}

/// A direction (length 1) quantised to `bits` per coordinate on the unfolded octahedron (Q. Meyer et al.: On
/// floating-point normal vectors, 2010): used for shading with quantised gradients. Zero stays zero.
glm::dvec3 quantizedDirection(glm::dvec3 v, int bits);

/// The plane of a slice layer in world space: dot(normal, p) = offset, unit normal. `position` 0..1 runs between the
/// two supporting planes of the box. The colour is that of the transfer function, the opacity that of the layer.
struct Plane {
    glm::dvec3 normal{0, 0, 1};
    double offset = 0;
};
Plane slicePlane(const SliceLayer& layer, const WorldFrame& frame, glm::dvec3 cursor);
/// Rays with a smaller cosine to a plane's normal do not meet it.
inline constexpr double kParallel = 1e-6;
/// Distance along a ray at which it meets a plane; anything where it does not.
template <class N> N planeDistance(const Plane& plane, const glm::vec<3, N>& origin, const glm::vec<3, N>& direction) {
    const glm::vec<3, N> normal = spreadOut<N>(plane.normal);
    const N slope = inner(normal, direction);
    return (N(plane.offset) - inner(normal, origin)) / choose(magnitude(slope) < N(1e-9), N(1e-9), slope);
}

template <class N> N linearFromSrgb(N encoded) {
    return choose(encoded <= N(0.04045), encoded * N(1 / 12.92),
                  power(larger((encoded + N(0.055)) * N(1 / 1.055), N(0)), N(2.4)));
}
inline double linearFromSrgb(double encoded) {
    return linearFromSrgb<double>(encoded);
}
template <class N> N srgbFromLinear(N linear) {
    return choose(linear <= N(0.0031308), linear * N(12.92),
                  N(1.055) * power(larger(linear, N(0)), N(1 / 2.4)) - N(0.055));
}
inline double srgbFromLinear(double linear) {
    return srgbFromLinear<double>(linear);
}
glm::dvec3 linearFromSrgb(glm::dvec3 encoded);

} // namespace tessera::vis
