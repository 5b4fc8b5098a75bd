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
    glm::dvec4 grain{0.5}; ///< marksAt(); for charcoal only
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

/// The colour (linear) of ink that shows on something of that luminance (linear): mix(kLightInk, kDarkInk,
/// smoothstep(0.03, 0.12, luminance)).
glm::dvec3 inkOn(double luminance);
/// Whether a stick draws what is light: chalk, or without its own colour any stick on dark ground.
bool drawsLight(const CharcoalDrawing& charcoal, glm::dvec3 ground);

/// Share of a look at degree of interest d: 1, 1 - d or d.
double lookShare(LookPart part, double interest);

/// Opacity of a volume layer kReferenceLength thick that charcoal draws: mix(a, smoothstep(0.03, 0.4, a), share). What
/// is faint is left out and the rest is solid, else many half-transparent marks would add up to a pale haze.
double solidOpacity(const Look& look, double opacity, double share);

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

/// World distance over which curvature is measured: view.reach max(1, 1.5 smooth).
double bendReach(const Look& look, const LookView& view);

/// Tooth, strokes, crossing strokes and dots, 0..1, at a place of a surface (vis/optics/grain.h). `pixel`: world edge.
glm::dvec4 marksAt(const CharcoalDrawing& charcoal, glm::dvec3 place, glm::dvec3 normal, SurfaceBend bend,
                   double pixel);

/// The softness s in charcoalInk().
double grainSoftness(const CharcoalDrawing& charcoal);

/// Amount of ink, 0..1, of a lit sample. With e = sqrt(luminance), at most 1, as lightness, and d = 1 - e (`light`, of
/// drawsLight(): e):
///   x = (max(0, d - bare) / (1 - bare))^contrast
///   tone = (1 - (1 - x)^2) mix(1, sqrt(min(1, steepness)), steepness of the look): ink that covers so much of the
///   paper
///          leaves the lightness 1 - x (`light`: x^2, which has the lightness x)
///   line = outlineStrength weight outline mix(1, smoothstep(0.1, 0.6, 1 - e), closure)
///          (1 - 0.8 smoothstep(0.12, 0.45, T k)): less where lines would fill what is as small as they are wide
///   D = pressure tone, L = pressure line, both = 1 - (1 - D) (1 - L)
///   ink = mix(marks, both, smudge)
/// With dots, marks = m(both, t), t the dots' threshold and m(x, h) = smoothstep(h - s, h + s, x (1 + 2 s) - s), s =
/// mix(0.5, 0.05, hardness). With strokes, marks = 1 - (1 - n(D1)) (1 - n(D2)) (1 - m(L, mix(0.5, h, tooth))), h the
/// tooth of the paper, n(x) = m(mix(x, p, strokes), h), p = x^a smoothstep(1 - c - e, 1 - c + e, stroke), c = x^(1 -
/// a), a = tooth / 2, e = 0.06 + 0.18 a: strokes cover the share c and are filled to x^a. D1 = min(D, mix(crossing, D,
/// 0.4)) is what the first layer of strokes draws, and the crossing one the rest: 1 - D = (1 - D1) (1 - D2). Outlines
/// are lines of their own. Nothing is drawn where x or L is 0.
double charcoalInk(const CharcoalDrawing& charcoal, glm::dvec3 lit, const LookSample& sample, bool light);

/// The colour of a sample from its albedo and `lit`, the result of shade() for lookAlbedo(), in this order:
///   1. cartoon, by weight: albedo mix(shadow, 1, step of n.l)
///   2. tone, by weight: mix(cool, warm, (1 + l) / 2) mix(1, albedo, min(1, ownColor)); l = n.l, or its step in
///   cartoons
///   3. outlines of cartoons: their colour; without one, inkOn(albedo) and over it inkOn(ground) in the outer half of
///      the width
///      silhouettes, by ink weight (1 - |n.v|)^exponent: their colour, or inkOn(ground)
///   4. charcoal: mix(paper, stick, ink)
///   5. wire: mix(colour, mix(its own, colour, ownColor), wire)
///   6. distance: mix(colour, background, amount depth^exponent)
/// each by its amount and the share.
glm::dvec3 lookColor(const Look& look, glm::dvec3 albedo, glm::dvec3 lit, const LookSample& sample,
                     glm::dvec3 background);

} // namespace tessera::vis
