#pragma once

#include "vis/optics/grain.h"
#include "vis/optics/surface_light.h"
#include "vis/scene/look.h"
#include "vis/scene/scene.h"

/// What looks compute, in double; twin: vis/shaders/lib/look.glsl. Colours are linear. A sample far from any change has
/// no surface: `weight` fades what asks for a normal, as it fades shading.
namespace tessera::vis {

/// A place as looks see it.
struct LookSample {
    Facing at;             ///< normal and side that is seen
    double weight = 0;     ///< of the surface, 0..1: that of shade()
    double steepness = 0;  ///< place of the gradient's magnitude, 0..1 and beyond
    double curvature = 0;  ///< of the surface towards the viewer, 1 / world; of outlines only
    double depth = 0;      ///< from the nearest (0) to the farthest (1) place of the box along the view
    double pixel = 0;      ///< world edge of a pixel there
    glm::dvec3 toLight{0}; ///< direction of length 1
    double wire = 0;       ///< wireCoverage() times weight; of wire frames only
    glm::dvec2 grain{0.5}; ///< tooth and strokes, 0..1 (vis/optics/grain.h); of charcoal only
    double share = 1;      ///< how much of the look applies here

    double facing() const { return std::abs(glm::dot(at.normal, at.toViewer)); }
    /// n.l of the side that is seen, fading through 0 where neither is.
    double light() const { return (2 * at.front - 1) * glm::dot(at.normal, toLight); }
};

/// What looks know of a picture.
struct LookView {
    PlacedLight light;                ///< the first one that is on; the default one where none is
    double nearest = 0, farthest = 1; ///< distances along the view of the box's nearest and farthest places
    glm::dvec2 pixel{0};              ///< world edge of a pixel: x + y * distance along the ray
    double reach = 1;                 ///< world distance over which curvature is measured: the shortest cell edge
    glm::dvec3 ground{0};             ///< linear colour of paper or background
};
/// `size`: of the picture in pixels; `cell`: worldCell().
LookView lookView(const Scene& scene, glm::dvec3 halfSize, glm::dvec3 cell, glm::ivec2 size);

/// Share of a look at a degree of interest: 1, 1 - d or d.
double lookShare(LookPart part, double interest);

/// Opacity (of a layer kReferenceLength thick, or of a surface) with boundaries and silhouettes enhanced (Rheingans and
/// Ebert 2001, equations 5 and 6):
///   a' = min(1, a mix(1, (kb + sb min(1, steepness)^eb) (ks + ss weight (1 - |n.v|)^es) mix(kw, 1, wire), share))
double lookOpacity(const Look& look, double opacity, const LookSample& sample);

/// What is lit in place of the albedo: charcoal draws from light on mix(white, albedo, localTone).
glm::dvec3 lookAlbedo(const Look& look, glm::dvec3 albedo, double share);

/// How much of a pixel, 0..1, lies on lines where a surface meets the planes at multiples of `spacing` along x, y and
/// z, `width` pixels wide: |x| in pixels is its distance to a multiple over its change across the picture, |e - (v_e /
/// n.v) n| per world unit. Where lines come closer than 4 pixels they turn into their mean, where the surface lies
/// along the planes (within 6 to 20 degrees) they fade. `pixel`: world edge of a pixel.
double wireCoverage(glm::dvec3 world, glm::dvec3 normal, glm::dvec3 toViewer, double spacing, double width,
                    double pixel);

/// 1 on outlines of even width, 0 off them: |n.v| < sqrt(T k (2 - T k)) for curvature k and thickness T, in world units
/// (Kindlmann et al. 2003, equation 10), softened over its outer half.
double outline(double facing, double curvature, double thickness);

/// n.l in steps: min(n - 1, floor(n max(0, n.l))) / (n - 1).
double lightStep(double light, int steps);

/// s of charcoalInk().
double grainSoftness(const CharcoalDrawing& charcoal);

/// Share of ink, 0..1, of a lit sample. With e = sqrt(luminance), at most 1, and dark = 1 - e (chalk: e):
///   tone = dark^contrast mix(1, sqrt(min(1, steepness)), steepness of the look)
///   line = outlineStrength weight outline mix(1, smoothstep(0.1, 0.6, 1 - e), closure)
///   D = pressure (1 - (1 - tone) (1 - line)), with strokes D' = D (1 + strokes (2 stroke - 1)), at most 1
///   ink = mix(smoothstep(h - s, h + s, D' (1 + 2 s) - s), D, smudge), h the tooth, s = mix(0.5, 0.05, hardness)
double charcoalInk(const CharcoalDrawing& charcoal, glm::dvec3 lit, const LookSample& sample);

/// The colour of a sample from its albedo and `lit`, what shade() made of lookAlbedo():
///   1. cartoon, by weight: albedo mix(shadow, 1, step of n.l)
///   2. tone, by weight: mix(cool, warm, (1 + l) / 2) + ownColor max(l, 0) albedo; l = n.l, or its step in cartoons
///   3. outlines of cartoons
///   4. charcoal: mix(paper, stick, ink)
///   5. wire: mix(colour, mix(its own, colour, ownColor), wire)
///   6. distance: mix(colour, background, amount depth^exponent)
/// each by its amount and the share.
glm::dvec3 lookColor(const Look& look, glm::dvec3 albedo, glm::dvec3 lit, const LookSample& sample,
                     glm::dvec3 background);

} // namespace tessera::vis
