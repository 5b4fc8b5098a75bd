#pragma once

#include "vis/optics/grain.h"
#include "vis/optics/surface_light.h"
#include "vis/scene/look.h"
#include "vis/scene/scene.h"

/// Shading formulas of looks, in double; twin: vis/shaders/lib/look.glsl. Colours are linear. Where the field is nearly
/// constant a sample has no surface normal: `weight` fades out what needs one, as in shading.
namespace tessera::vis {

/// Inputs of a look at a sample.
struct LookSample {
    Facing at;             ///< normal and visible side
    double weight = 0;     ///< of the surface, 0..1, as in shade()
    double steepness = 0;  ///< gradient magnitude relative to gradientTop, 0..1 or above
    double curvature = 0;  ///< of the surface in the direction of the viewer, 1 / world; for outlines only
    double depth = 0;      ///< from the nearest (0) to the farthest (1) point of the box along the view
    double pixel = 0;      ///< world edge of a pixel at that distance
    glm::dvec3 toLight{0}; ///< unit vector
    double wire = 0;       ///< wireCoverage() times weight; for wire frames only
    glm::dvec2 grain{0.5}; ///< tooth and strokes, 0..1 (vis/optics/grain.h); for charcoal only
    double share = 1;      ///< fraction of the look that applies here

    double facing() const { return std::abs(glm::dot(at.normal, at.toViewer)); }
    /// n.l on the visible side, 0 where the surface is seen edge-on.
    double light() const { return (2 * at.front - 1) * glm::dot(at.normal, toLight); }
};

/// Inputs of looks that are constant in a picture.
struct LookView {
    PlacedLight light;                ///< the first enabled light, or a default
    double nearest = 0, farthest = 1; ///< distances along the view of the nearest and farthest points of the box
    glm::dvec2 pixel{0};              ///< world edge of a pixel: x + y * distance along the ray
    double reach = 1;                 ///< world distance over which curvature is measured: the shortest cell edge
    glm::dvec3 ground{0};             ///< linear colour of paper or background
};
/// `size`: of the picture in pixels; `cell`: worldCell().
LookView lookView(const Scene& scene, glm::dvec3 halfSize, glm::dvec3 cell, glm::ivec2 size);

/// Share of a look at degree of interest d: 1, 1 - d or d.
double lookShare(LookPart part, double interest);

/// Opacity (of a layer kReferenceLength thick, or of a surface) with boundary and silhouette enhancement (Rheingans and
/// Ebert 2001, equations 5 and 6):
///   a' = min(1, a mix(1, (kb + sb min(1, steepness)^eb) (ks + ss weight (1 - |n.v|)^es) mix(kw, 1, wire), share))
double lookOpacity(const Look& look, double opacity, const LookSample& sample);

/// The albedo used for lighting: for charcoal mix(white, albedo, localTone), since it draws the light.
glm::dvec3 lookAlbedo(const Look& look, glm::dvec3 albedo, double share);

/// Coverage of a pixel, 0..1, by the intersection lines of a surface with planes at multiples of `spacing` along x, y
/// and z; lines are `width` pixels wide. The distance of a coordinate to a multiple is divided by its change across the
/// picture, |e - (v_e / n.v) n| per world unit. Lines closer than 4 pixels turn into their mean; where the surface is
/// nearly parallel to the planes (within 6 to 20 degrees) they fade out. `pixel`: world edge of a pixel.
double wireCoverage(glm::dvec3 world, glm::dvec3 normal, glm::dvec3 toViewer, double spacing, double width,
                    double pixel);

/// 1 on outlines of constant width, 0 elsewhere: |n.v| < sqrt(T k (2 - T k)) for curvature k and thickness T in world
/// units (Kindlmann et al. 2003, equation 10), softened over the outer half.
double outline(double facing, double curvature, double thickness);

/// n.l quantised: min(n - 1, floor(n max(0, n.l))) / (n - 1).
double lightStep(double light, int steps);

/// The softness s in charcoalInk().
double grainSoftness(const CharcoalDrawing& charcoal);

/// Amount of ink, 0..1, of a lit sample. With e = sqrt(luminance), at most 1, and dark = 1 - e (chalk: e):
///   tone = dark^contrast mix(1, sqrt(min(1, steepness)), steepness of the look)
///   line = outlineStrength weight outline mix(1, smoothstep(0.1, 0.6, 1 - e), closure)
///   D = pressure (1 - (1 - tone) (1 - line)), with strokes D' = D (1 + strokes (2 stroke - 1)), at most 1
///   ink = mix(smoothstep(h - s, h + s, D' (1 + 2 s) - s), D, smudge), h the tooth, s = mix(0.5, 0.05, hardness)
double charcoalInk(const CharcoalDrawing& charcoal, glm::dvec3 lit, const LookSample& sample);

/// The colour of a sample from its albedo and `lit`, the result of shade() for lookAlbedo(), in this order:
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
