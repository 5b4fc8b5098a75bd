#pragma once

#include "vis/formulas/surface_lines.h"
#include "vis/optics/grain.h"
#include "vis/optics/ray_setup.h"
#include "vis/optics/surface_light.h"
#include "vis/scene/look.h"
#include "vis/scene/scene.h"

/// Shading formulas of looks, templates over the number (volume/base/numbers.h); twin:
/// vis/shaders/lib/shading/look.glsl. Colours are linear. Where the field is nearly constant a sample has no surface
/// normal: `weight` fades out what needs one, as in shading.
namespace tessera::vis {

/// marksAt().
template <class N> struct GrainMarks { N tooth{0.5}, stroke{0.5}, crossing{0.5}, dots{0.5}; };

/// Inputs of a look at a sample.
template <class N> struct LookSampleOf {
    FacingOf<N> at; ///< normal and visible side
    N weight{0};    ///< of the surface, 0..1, as in shade()
    N steepness{0}; ///< gradient magnitude relative to gradientTop, 0..1 or above
    N curvature{0}; ///< of the surface in the direction of the viewer, 1 / world; for outlines only
    N depth{0};     ///< from the nearest (0) to the farthest (1) point of the box along the view
    N pixel{0};     ///< world edge of a pixel at that distance
    glm::vec<3, N> toLight{N(0), N(0), N(0)}; ///< unit vector
    N wire{0};                                ///< wireCoverage() times weight; for wire frames only
    N cut{kNoCut};                            ///< cutDistance(); for surfaces only
    GrainMarks<N> grain;                      ///< for charcoal only
    N share{1};                               ///< fraction of the look that applies here

    N facing() const { return magnitude(inner(at.normal, at.toViewer)); }
    /// n.l on the visible side, 0 where the surface is seen edge-on.
    N light() const { return (N(2) * at.front - N(1)) * inner(at.normal, toLight); }
};
using LookSample = LookSampleOf<double>;

/// Inputs of looks that are constant in a picture.
struct LookView {
    PlacedLight light;                ///< the first enabled light, or a default
    double nearest = 0, farthest = 1; ///< distances along the view of the nearest and farthest points of the box
    glm::dvec2 pixel{0};              ///< world edge of a pixel: x + y * distance along the ray
    double reach = 1;                 ///< world distance over which curvature is measured: the shortest cell edge
    glm::dvec3 ground{0};             ///< linear colour of paper or background
    glm::dvec3 halfSize{0.5};         ///< of the box
};
/// `size`: of the picture in pixels; `cell`: worldCell().
LookView lookView(const Scene& scene, glm::dvec3 halfSize, glm::dvec3 cell, glm::ivec2 size);

/// kLightInk or kDarkInk, linear.
const glm::dvec3& linearInk(bool dark);
/// The colour (linear) of ink that shows on something of that luminance (linear): mix(kLightInk, kDarkInk,
/// smoothstep(0.03, 0.12, luminance)).
template <class N> glm::vec<3, N> inkOn(N luminance) {
    return blended(spreadOut<N>(linearInk(false)), spreadOut<N>(linearInk(true)),
                   smoothStep(N(0.03), N(0.12), luminance));
}
/// Whether a stick draws what is light: chalk, or without its own colour any stick on dark ground.
bool drawsLight(const CharcoalDrawing& charcoal, glm::dvec3 ground);

/// Share of a look at degree of interest d: 1, 1 - d or d.
template <class N> N lookShare(LookPart part, N interest) {
    return part == LookPart::Everything ? N(1) : part == LookPart::Context ? N(1) - interest : interest;
}

inline constexpr double kFaintest = 0.03; ///< opacity up to which charcoal draws nothing
/// Opacity of a volume layer kReferenceLength thick that charcoal draws: mix(a, smoothstep(0.03, 0.4, a), share). What
/// is faint is left out and the rest is solid, else many half-transparent marks would add up to a pale haze.
template <class N> N solidOpacity(const Look& look, N opacity, N share) {
    return look.charcoal ? blended(opacity, smoothStep(N(kFaintest), N(0.4), opacity), share) : opacity;
}

/// Opacity (of a layer kReferenceLength thick, or of a surface) with boundary and silhouette enhancement (Rheingans and
/// Ebert 2001, equations 5 and 6):
///   a' = min(1, a mix(1, (kb + sb min(1, steepness)^eb) (ks + ss weight (1 - |n.v|)^es) mix(kw, 1, wire), share))
template <class N> N lookOpacity(const Look& look, N opacity, const LookSampleOf<N>& sample) {
    N factor(1);
    if (const auto& own = look.boundary)
        factor = factor *
                 (N(own->retained) + N(own->strength) * power(clamped(sample.steepness, N(0), N(1)), N(own->exponent)));
    if (const auto& own = look.silhouette)
        factor = factor * (N(own->retained) + N(own->strength) * sample.weight *
                                                  power(N(1) - smaller(sample.facing(), N(1)), N(own->exponent)));
    if (const auto& own = look.wire) factor = factor * blended(N(own->retained), N(1), sample.wire);
    return smaller(N(1), opacity * blended(N(1), factor, sample.share));
}

/// The albedo used for lighting: for charcoal mix(white, albedo, localTone), since it draws the light.
template <class N> glm::vec<3, N> lookAlbedo(const Look& look, const glm::vec<3, N>& albedo, N share) {
    if (!look.charcoal) return albedo;
    const glm::vec<3, N> white(N(1), N(1), N(1));
    return blended(albedo, blended(white, albedo, N(look.charcoal->localTone)), share);
}

/// World distance over which curvature is measured: view.reach max(1, 1.5 smooth).
double bendReach(const Look& look, const LookView& view);

/// Tooth, strokes, crossing strokes and dots, 0..1, at a place of a surface (vis/optics/grain.h). `pixel`: world edge.
template <class N>
GrainMarks<N> marksAt(const CharcoalDrawing& charcoal, const glm::vec<3, N>& place, const glm::vec<3, N>& normal,
                      const SurfaceBendOf<N>& bend, N pixel) {
    const N size = pixel * N(double(charcoal.grain) / kGrainTexels);
    const GrainTile& tile = *grainTile();
    const glm::vec<2, N> grain = grainAt(tile, place, normal, size);
    GrainMarks<N> marks;
    marks.tooth = grain.x;
    marks.dots = grain.y;
    if (charcoal.mark == Mark::Dots) return marks;
    const glm::vec<3, N> along =
        strokeDirection(normal, bend, double(charcoal.follow), double(charcoal.angle) * (std::numbers::pi / 180));
    marks.stroke = strokesAt(tile, place, normal, along, size, 0);
    if (charcoal.crossing < 1)
        marks.crossing = strokesAt(tile, place, normal, crossProduct(normal, along), size, kCrossingShift);
    return marks;
}

/// The softness s in charcoalInk().
double grainSoftness(const CharcoalDrawing& charcoal);

/// Amount of ink, 0..1, of a lit sample. With e = sqrt(luminance), at most 1, as lightness, and d = 1 - e (`light`, of
/// drawsLight(): e):
///   x = (max(0, d - bare) / (1 - bare))^contrast
///   tone = (1 - (1 - x)^2) mix(1, sqrt(min(1, steepness)), steepness of the look): ink that covers so much of the
///   paper
///          leaves the lightness 1 - x (`light`: x^2, which has the lightness x)
///   line = outlineStrength weight outline mix(1, smoothstep(0.1, 0.6, 1 - e), closure)
///          (1 - 0.8 smoothstep(0.12, 0.45, T k)): less where lines would fill what is as small as they are wide;
///          at least outlineStrength weight cutLine(): the rim of a surface is never left open
///   D = pressure tone, L = pressure line, both = 1 - (1 - D) (1 - L)
///   ink = mix(marks, both, smudge)
/// With dots, marks = m(both, t), t the dots' threshold and m(x, h) = smoothstep(h - s, h + s, x (1 + 2 s) - s), s =
/// mix(0.5, 0.05, hardness). With strokes, marks = 1 - (1 - n(D1)) (1 - n(D2)) (1 - m(L, mix(0.5, h, tooth))), h the
/// tooth of the paper, n(x) = m(mix(x, p, strokes), h), p = x^a smoothstep(1 - c - e, 1 - c + e, stroke), c = x^(1 -
/// a), a = tooth / 2, e = 0.06 + 0.18 a: strokes cover the share c and are filled to x^a. D1 = min(D, mix(crossing, D,
/// 0.4)) is what the first layer of strokes draws, and the crossing one the rest: 1 - D = (1 - D1) (1 - D2). Outlines
/// are lines of their own. Nothing is drawn where x or L is 0.
template <class N>
N charcoalInk(const CharcoalDrawing& charcoal, const glm::vec<3, N>& lit, const LookSampleOf<N>& sample, bool light) {
    const N one(1), bare(charcoal.bare);
    const N bright = squareRoot(clamped(luminance(lit), N(0), one));
    const N drawn =
        power(larger((light ? bright : one - bright) - bare, N(0)) * (one / (one - bare)), N(charcoal.contrast));
    const N steep = blended(one, squareRoot(clamped(sample.steepness, N(0), one)), N(charcoal.steepness));
    const N tone = drawn * (light ? drawn : N(2) - drawn) * steep;
    const N open = blended(one, smoothStep(N(0.1), N(0.6), one - bright), N(charcoal.closure));
    const N width = N(charcoal.outline) * sample.pixel;
    const N thin = one - N(0.8) * smoothStep(N(0.12), N(0.45), width * sample.curvature);
    const N outlined = open * thin * outline(sample.facing(), sample.curvature, width);
    const N line =
        N(charcoal.outlineStrength) * sample.weight * larger(outlined, cutLine(sample.cut, N(charcoal.outline)));
    const N pressure(charcoal.pressure), drawnTone = pressure * tone, drawnLine = pressure * line;
    const N both = one - (one - drawnTone) * (one - drawnLine), soft(grainSoftness(charcoal));
    const auto mark = [&](N amount, N threshold) {
        return smoothStep(threshold - soft, threshold + soft, amount * (one + N(2) * soft) - soft);
    };
    if (charcoal.mark == Mark::Dots) return blended(mark(both, sample.grain.dots), both, N(charcoal.smudge));
    const auto layer = [&](N amount, N stroke) {
        const double a = 0.5 * double(charcoal.tooth);
        const N covered = power(amount, N(1 - a)), edge(0.06 + 0.18 * a), from = one - covered;
        const N stroked = power(amount, N(a)) * smoothStep(from - edge, from + edge, stroke);
        return choose(amount > N(0), mark(blended(amount, stroked, N(charcoal.strokes)), sample.grain.tooth), N(0));
    };
    const N first = smaller(drawnTone, blended(N(charcoal.crossing), drawnTone, N(0.4)));
    const N second = one - (one - drawnTone) / larger(one - first, N(1e-3));
    const N tooth = blended(N(0.5), sample.grain.tooth, N(charcoal.tooth));
    const N lines = choose(drawnLine > N(0), mark(drawnLine, tooth), N(0));
    const N ink =
        one - (one - layer(first, sample.grain.stroke)) * (one - layer(second, sample.grain.crossing)) * (one - lines);
    return blended(ink, both, N(charcoal.smudge));
}

/// The colour of a sample from its albedo and `lit`, the result of shade() for lookAlbedo(), in this order:
///   1. cartoon, by weight: albedo mix(shadow, 1, step of n.l)
///   2. tone, by weight: mix(cool, warm, (1 + l) / 2) mix(1, albedo, min(1, ownColor)); l = n.l, or its step in
///   cartoons
///   3. outlines of cartoons, and cutLine(): their colour; without one, inkOn(albedo) and over it inkOn(ground) in the
///   outer half of
///      the width
///      silhouettes, by ink weight (1 - |n.v|)^exponent: their colour, or inkOn(ground)
///   4. charcoal: mix(paper, stick, ink)
///   5. wire: mix(colour, mix(its own, colour, ownColor), wire)
///   6. distance: mix(colour, background, amount depth^exponent)
/// each by its amount and the share.
template <class N>
glm::vec<3, N> lookColor(const Look& look, const glm::vec<3, N>& albedo, const glm::vec<3, N>& lit,
                         const LookSampleOf<N>& sample, const glm::dvec3& background) {
    const auto linear = [](const glm::vec3& srgb) { return spreadOut<N>(linearFromSrgb(glm::dvec3(srgb))); };
    const auto inkOnGround = [&] { return inkOn(N(luminance(background))); };
    const glm::vec<3, N> ground = spreadOut<N>(background);
    glm::vec<3, N> color = lit;
    N light = sample.light();
    if (const auto& own = look.cartoon) {
        light = lightStep(light, own->steps);
        color = blended(color, albedo * blended(N(own->shadow), N(1), light),
                        N(own->amount) * sample.weight * sample.share);
    }
    if (const auto& own = look.tone) {
        const glm::vec<3, N> white(N(1), N(1), N(1));
        const glm::vec<3, N> toned = blended(linear(own->coolColor), linear(own->warmColor), N(0.5) + N(0.5) * light) *
                                     blended(white, albedo, smaller(N(own->ownColor), N(1)));
        color = blended(color, toned, N(own->amount) * sample.weight * sample.share);
    }
    if (const auto& own = look.cartoon) {
        const N width = N(own->outline) * sample.pixel, amount = N(own->amount) * sample.weight * sample.share;
        const glm::vec<3, N> within = own->outlineColor ? linear(*own->outlineColor) : inkOn(luminance(albedo));
        const auto line = [&](double share) {
            return amount * larger(outline(sample.facing(), sample.curvature, N(share) * width),
                                   cutLine(sample.cut, N(share * own->outline)));
        };
        color = blended(color, within, line(1));
        color = blended(color, own->outlineColor ? within : inkOnGround(), line(0.5));
    }
    if (const auto& own = look.silhouette) {
        const N turned = power(N(1) - smaller(sample.facing(), N(1)), N(own->exponent));
        color = blended(color, own->inkColor ? linear(*own->inkColor) : inkOnGround(),
                        N(own->ink) * turned * sample.weight * sample.share);
    }
    if (const auto& own = look.charcoal) {
        const glm::vec<3, N> stick = own->color ? linear(*own->color) : inkOnGround();
        const N ink = charcoalInk(*own, lit, sample, drawsLight(*own, background));
        color = blended(color, blended(ground, stick, ink), sample.share);
    }
    if (const auto& own = look.wire)
        color = blended(color, blended(linear(own->color), color, N(own->ownColor)), sample.wire * sample.share);
    if (const auto& own = look.distance)
        color = blended(color, own->toBackground ? ground : linear(own->color),
                        N(own->amount) * power(clamped(sample.depth, N(0), N(1)), N(own->exponent)) * sample.share);
    return color;
}

} // namespace tessera::vis
