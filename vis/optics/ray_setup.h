#pragma once

#include "vis/scene/ray_segment.h"
#include "vis/scene/scene.h"
#include "volume/field/lattice.h"

#include <optional>

/// What one ray of the picture does, shared by the shader (float) and the reference ray caster (double).
///
/// Colours: transfer functions, layers and backgrounds are sRGB; they become linear light first, samples are composited
/// and shaded in linear light, and the picture is encoded to sRGB at the very end, over the background.
///
/// Along a ray, front to back, for sample k = 0 .. count - 1 at t_k = enter + (k + 1/2) step:
///   1. every slice whose plane is met at t in (t_{k-1}, t_k] (t_{-1} = enter) and every iso-surface crossed between
///      t_{k-1} and t_k, nearest first; of equal ones slices first, then in layer order. An iso-surface is crossed
///      where the values at t_{k-1} and t_k are both present and lie on different sides (v >= value against v < value);
///      the place is refined by kBisections halvings of [t_{k-1}, t_k], the middle of the last interval is shaded and
///      composited with the layer's opacity;
///   2. every composite layer, in order: colour and opacity (below), correctedOpacity, shaded where wanted
///   (vis/optics/shade.h).
/// At the end come the slices between the last sample and the exit. A ray ends when the accumulated opacity reaches
/// kOpaque. An absent sample contributes nothing. Then the projections, which look at all samples of the ray up to
/// there, go behind what was accumulated, in layer order; x = place of a sample, clamped to 0..1, f = DOI opacity
/// factor:
///   maximum: the first sample with the largest x * f, colour of its place, opacity min(1, density * opacity of the
///            curve) * f;
///   minimum: the same of the largest (1 - x) * f;
///   local maximum: the same of the first x * f which is at least that of the threshold and is followed by a smaller
///            or an absent one; where there is none, as maximum (Y. Sato et al.: Local maximum intensity projection,
///            1998);
///   average: the mean of the unclamped places weighted by f, colour of that place, opacity as of maximum with f its
///            plain mean;
///   x-ray:   absorption A = 1 - prod(1 - a) of all samples' a = correctedOpacity(opacity of the curve * f) (Beer and
///            Lambert), colour of the place A, opacity A.
///
/// Gradients are those of volume/reconstruct/gradient.h, by the scene's span; at coarser levels a cell is that of the
/// level. Categorical channels have none.
///
/// The place of a sample is that of its value in the transfer function's range or, for layers that show the gradient,
/// its magnitude over gradientTop: the change over one worldCell edge per axis (length of that vector), in ranges.
///
/// A composite layer's colour and opacity come
///   post:           from evaluate() at the sample's value (and gradient, if regions decide);
///   pre:            from the mean of the premultiplied colours of the samples (unfiltered) around it, weighted as in
///                   trilinear interpolation, on BCC over both sublattices, of present ones; where these carry less
///                   than half of the weight there is nothing;
///   pre-integrated: from preintegrated() (vis/optics/preintegration.h) between the values at t_k - step / 2 and
///                   t_k + step / 2; where one of the two is absent the other stands for both, over half the length.
/// Pre-classification and pre-integration are of values by the curve: layers that show the gradient, functions of
/// regions and categorical channels are classified after interpolation.
///
/// A layer with `colorBy` keeps all of that but its colours: these come from the curve of the other channel at its
/// value (interpolated, whatever the classification) at the sample, at an iso-surface's place, at the sample that a
/// projection shows; of averages and x-rays at its mean over the samples, weighted by f, or by what each takes of the
/// light. Where that channel is absent the colour is kNoValueColor, an iso-surface's its own.
///
/// The degree of interest d of a place multiplies the opacity (of the curve before correctedOpacity, of an iso-surface
/// or a slice) by f = mix(contextOpacity, 1, d) and pulls the colour towards its luminance: mix(luminance, colour,
/// mix(contextSaturation, 1, d)), in linear light before shading. The colours of averages and x-rays keep their
/// saturation.
namespace tessera::vis {

inline constexpr double kOpaque = 0.995; ///< accumulated opacity at which a ray ends
inline constexpr int kBisections = 6;    ///< halvings of a step to find an iso-surface
inline constexpr double kFlatGradient =
    0.005; ///< gradient, in transfer-function ranges per cell, from which shading is full

/// The part of a ray inside the box |p| <= halfSize, as distances from its origin. A perspective ray starts at the eye
/// at the earliest; a parallel one may begin behind it.
std::optional<RaySegment> clipToBox(const Ray& ray, glm::dvec3 halfSize, bool perspective);

/// World edges of the cell that steps and gradients are measured in: of the CC grid, or of the CC grid that a BCC
/// lattice replaces (its spacing / sqrt 2).
glm::dvec3 worldCell(const volume::Lattice& lattice, const WorldFrame& frame);

/// Sample positions of a ray: the wanted step advances stepVoxels cells, h = stepVoxels / |direction / cell|; the
/// segment is cut into count = max(1, ceil(length / h - 1e-4)) equal parts and sampled in the middle of each, or moved
/// by startJitter(). Clips to be kept inside shorten the segment first; holes of the others hide what lies in them.
struct RaySamples {
    int count = 0;
    double step = 0; ///< world units
    double enter = 0;
    double phase = 0.5; ///< moved by startJitter() where rays start at random
    double at(int k) const { return enter + (k + phase) * step; }
};
RaySamples raySamples(const RaySegment& segment, glm::dvec3 direction, glm::dvec3 cell, double stepVoxels);

/// Opacity of a sample that stands for `step` world units: 1 - (1 - opacity)^(density * step / kReferenceLength).
double correctedOpacity(double opacity, double step, double density);

/// A direction (length 1) stored in two coordinates of `bits` each on the unfolded octahedron (Q. Meyer et al.: On
/// floating-point normal vectors, 2010): what shading by quantised gradients sees. Zero stays zero.
glm::dvec3 quantizedDirection(glm::dvec3 v, int bits);

/// The plane of a slice layer in world space: dot(normal, p) = offset, normal of length 1. `position` 0..1 runs
/// between the two supporting planes of the box. Colour: of the transfer function; opacity: the layer's alone.
struct Plane {
    glm::dvec3 normal{0, 0, 1};
    double offset = 0;
};
Plane slicePlane(const SliceLayer& layer, const WorldFrame& frame, glm::dvec3 cursor);

double linearFromSrgb(double encoded);
double srgbFromLinear(double linear);
glm::dvec3 linearFromSrgb(glm::dvec3 encoded);
/// Rec. 709 luminance of linear light.
double luminance(glm::dvec3 linear);

} // namespace tessera::vis
