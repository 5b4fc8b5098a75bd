#pragma once

#include "volume/base/describe.h"

#include <glm/vec3.hpp>
#include <optional>

/// Looks: drawing styles of volume layers and iso-surfaces, whose elements can be combined. The formulas are in
/// vis/optics/look_shading.h.
namespace tessera::vis {

/// Ink whose colour is not set contrasts with what it lies on (sRGB).
inline constexpr glm::vec3 kDarkInk{0.07f, 0.067f, 0.065f}, kLightInk{0.96f, 0.95f, 0.92f};

/// Warm colours facing the light, cool colours facing away (Gooch et al.: A non-photorealistic lighting model, 1998),
/// as a tint of the material's own colour, so that it keeps its hue.
struct WarmCool {
    float amount = 1;
    glm::vec3 warmColor{1, 0.97f, 0.9f}, coolColor{0.4f, 0.45f, 0.62f}; ///< sRGB
    float ownColor = 0.9f;
    bool operator==(const WarmCool&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.amount, FieldInfo{.key = "amount", .doc = "Share of tone shading: 0 = plain", .range = Range{0, 1}});
        visit(self.warmColor,
              FieldInfo{.key = "warmColor", .doc = "Tint towards the first light (sRGB)", .range = Range{0, 1}});
        visit(self.coolColor,
              FieldInfo{.key = "coolColor", .doc = "Tint away from the first light (sRGB)", .range = Range{0, 1}});
        visit(self.ownColor, FieldInfo{.key = "ownColor",
                                       .doc = "Share of the material's own colour: 1 and above = tinted by the two "
                                              "colours, 0 = these colours alone",
                                       .range = Range{0, 2}});
    }
};

/// Opacity by gradient magnitude (Rheingans and Ebert: Volume illustration, 2001).
struct BoundaryEnhancement {
    float retained = 0.2f, strength = 2, exponent = 1;
    bool operator==(const BoundaryEnhancement&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.retained, FieldInfo{.key = "retained",
                                       .doc = "Share of opacity that stays where nothing changes",
                                       .range = Range{0, 2}});
        visit(self.strength,
              FieldInfo{.key = "strength", .doc = "Opacity added where values change most", .range = Range{0, 20}});
        visit(self.exponent, FieldInfo{.key = "exponent",
                                       .doc = "Exponent on the gradient magnitude; larger = only the steepest places",
                                       .range = Range{0.1, 8},
                                       .logScale = true});
    }
};

/// Opacity where the surface faces away from the viewer (Rheingans and Ebert 2001).
struct SilhouetteEnhancement {
    float retained = 0.15f, strength = 3, exponent = 2.5f;
    float ink = 0;
    std::optional<glm::vec3> inkColor = {};
    bool operator==(const SilhouetteEnhancement&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.retained, FieldInfo{.key = "retained",
                                       .doc = "Share of opacity that stays where the surface faces the viewer",
                                       .range = Range{0, 2}});
        visit(self.strength,
              FieldInfo{.key = "strength", .doc = "Opacity added where the surface turns away", .range = Range{0, 20}});
        visit(self.exponent, FieldInfo{.key = "exponent",
                                       .doc = "Exponent; larger = narrower silhouettes",
                                       .range = Range{0.25, 16},
                                       .logScale = true});
        visit(self.ink,
              FieldInfo{.key = "ink", .doc = "Share of ink where the surface turns away", .range = Range{0, 1}});
        visit(self.inkColor, FieldInfo{.key = "inkColor",
                                       .doc = "Own colour of the ink (sRGB); without one it is dark on a light ground "
                                              "and light on a dark one",
                                       .range = Range{0, 1},
                                       .applies = self.ink > 0});
    }
};

/// Depth cueing: colours fade with distance.
struct DistanceColor {
    float amount = 0.7f, exponent = 1.3f;
    bool toBackground = true;
    glm::vec3 color{0.55f, 0.65f, 0.8f}; ///< sRGB
    bool operator==(const DistanceColor&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.amount,
              FieldInfo{.key = "amount", .doc = "Strength at the far end of the box", .range = Range{0, 1}});
        visit(self.exponent, FieldInfo{.key = "exponent",
                                       .doc = "Exponent; larger = the foreground keeps its colours further",
                                       .range = Range{0.1, 8},
                                       .logScale = true});
        visit(self.toBackground, FieldInfo{"toBackground", "Blend to the background colour"});
        visit(self.color, FieldInfo{.key = "color",
                                    .doc = "Colour to blend to instead of the background (sRGB)",
                                    .range = Range{0, 1},
                                    .applies = !self.toBackground});
    }
};

/// Quantised lighting and outlines of constant width (Kindlmann et al.: Curvature-based transfer functions, 2003).
struct Cartoon {
    float amount = 1;
    int steps = 3;
    float shadow = 0.35f;
    float outline = 2; ///< pixels
    std::optional<glm::vec3> outlineColor = {};
    bool operator==(const Cartoon&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.amount, FieldInfo{.key = "amount", .doc = "Share of flat shading: 0 = plain", .range = Range{0, 1}});
        visit(self.steps, FieldInfo{.key = "steps", .doc = "Number of bands of light", .range = Range{2, 12}});
        visit(self.shadow, FieldInfo{.key = "shadow", .doc = "Brightness of the darkest band", .range = Range{0, 1}});
        visit(self.outline,
              FieldInfo{.key = "outline", .doc = "Width of outlines", .unit = "pixel", .range = Range{0, 12}});
        visit(self.outlineColor, FieldInfo{.key = "outlineColor",
                                           .doc = "Own colour of outlines (sRGB); without one the inner half contrasts "
                                                  "with the surface and the outer half with the ground",
                                           .range = Range{0, 1},
                                           .applies = self.outline > 0});
    }
};

enum class Stick { Charcoal, Chalk };
inline constexpr std::string_view kStickNames[] = {"charcoal", "chalk"};
enum class Mark { Strokes, Dots };
inline constexpr std::string_view kMarkNames[] = {"strokes", "dots"};

/// Strokes on paper grain (after Majumder and Gopi: Hardware accelerated real time charcoal rendering, 2002), along the
/// greatest curvature of the surface (Hertzmann and Zorin: Illustrating smooth surfaces, 2000), or stippling (Lu et
/// al.: Non-photorealistic volume rendering using stippling techniques, 2002). All marks are fixed to the object; the
/// paper belongs to the scene.
struct CharcoalDrawing {
    Stick stick = Stick::Charcoal;
    Mark mark = Mark::Strokes;
    std::optional<glm::vec3> color = {};
    float pressure = 0.95f, contrast = 0.9f, bare = 0.22f, localTone = 0.15f;
    float steepness = 0;
    float outline = 2.2f, outlineStrength = 0.9f, closure = 0.5f;
    float grain = 2.4f; ///< pixels
    float hardness = 0.6f, tooth = 1, strokes = 0.7f, follow = 1, crossing = 1, angle = 0, smudge = 0.15f;
    bool operator==(const CharcoalDrawing&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kTones = "Tones", kOutlines = "Outlines", kGrain = "Grain", kStrokes = "Strokes";
        visit(self.stick, FieldInfo{.key = "stick",
                                    .doc = "Charcoal draws what is dark and brings light paper, chalk what is light "
                                           "and dark paper",
                                    .names = kStickNames});
        visit(self.mark, FieldInfo{.key = "mark", .doc = "Strokes, or the dots of stippling", .names = kMarkNames});
        visit(self.color, FieldInfo{.key = "color",
                                    .doc = "Own colour of the stick (sRGB); without one it is dark and draws what is "
                                           "dark on a light ground, light and draws what is light on a dark one",
                                    .range = Range{0, 1}});
        visit(self.pressure, FieldInfo{.key = "pressure",
                                       .doc = "Largest share of the paper that a stroke covers",
                                       .range = Range{0, 1}});
        visit(self.contrast, FieldInfo{.key = "contrast",
                                       .doc = "Exponent on darkness: larger = lighter middle tones",
                                       .range = Range{0.25, 6},
                                       .logScale = true});
        visit(self.bare, FieldInfo{.key = "bare",
                                   .doc = "Share of the tones, from the lightest on, that leave the paper bare",
                                   .range = Range{0, 0.9},
                                   .group = kTones});
        visit(self.localTone,
              FieldInfo{.key = "localTone",
                        .doc = "Influence of the colour of the surface on darkness, beside light and shade",
                        .range = Range{0, 1},
                        .group = kTones});
        visit(self.steepness, FieldInfo{.key = "steepness",
                                        .doc = "Share of the tone that is drawn only where values change steeply",
                                        .range = Range{0, 1},
                                        .group = kTones});
        visit(self.outline, FieldInfo{.key = "outline",
                                      .doc = "Width of outlines",
                                      .unit = "pixel",
                                      .range = Range{0, 12},
                                      .group = kOutlines});
        visit(self.outlineStrength,
              FieldInfo{
                  .key = "outlineStrength", .doc = "Darkness of outlines", .range = Range{0, 1}, .group = kOutlines});
        visit(self.closure, FieldInfo{.key = "closure",
                                      .doc = "Share by which outlines are left open where light falls",
                                      .range = Range{0, 1},
                                      .group = kOutlines});
        visit(self.grain, FieldInfo{.key = "grain",
                                    .doc = "Size of the paper's grain, on the object",
                                    .unit = "pixel",
                                    .range = Range{0.5, 24},
                                    .logScale = true,
                                    .group = kGrain});
        visit(self.hardness, FieldInfo{.key = "hardness",
                                       .doc = "Hardness of the grain: 1 is only ink or paper, 0 is continuous tone",
                                       .range = Range{0, 1},
                                       .group = kGrain});
        const bool stroked = self.mark == Mark::Strokes;
        visit(self.tooth, FieldInfo{.key = "tooth",
                                    .doc = "How much the paper's grain breaks strokes: 0 = they are lines as wide as "
                                           "the tone is dark",
                                    .range = Range{0, 1},
                                    .applies = stroked,
                                    .group = kStrokes});
        visit(self.strokes, FieldInfo{.key = "strokes",
                                      .doc = "Visibility of single strokes",
                                      .range = Range{0, 1},
                                      .applies = stroked,
                                      .group = kStrokes});
        visit(self.follow, FieldInfo{.key = "follow",
                                     .doc = "How much the greatest curvature of the surface directs the strokes; where "
                                            "it is even, and with 0 everywhere, they keep one direction in space",
                                     .range = Range{0, 1},
                                     .applies = stroked,
                                     .group = kStrokes});
        visit(self.crossing, FieldInfo{.key = "crossing",
                                       .doc = "Darkness from which on a second layer of strokes crosses the first; 1 = "
                                              "none",
                                       .range = Range{0, 1},
                                       .applies = stroked,
                                       .group = kStrokes});
        visit(self.angle, FieldInfo{.key = "angle",
                                    .doc = "Turn of the strokes on the surface",
                                    .unit = "deg",
                                    .range = Range{-90, 90},
                                    .applies = stroked,
                                    .group = kStrokes});
        visit(self.smudge, FieldInfo{.key = "smudge",
                                     .doc = "Smudging: 0 = grain and strokes, 1 = even tone",
                                     .range = Range{0, 1},
                                     .group = kGrain});
    }
};

/// Intersection lines of the surface with equidistant planes along x, y and z: a wire frame for any shape.
struct WireFrame {
    float spacing = 0.08f;
    float width = 1.2f; ///< pixels
    float retained = 0.05f;
    glm::vec3 color{0.75f, 0.8f, 0.88f}; ///< sRGB
    float ownColor = 0.3f;
    bool operator==(const WireFrame&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.spacing, FieldInfo{.key = "spacing",
                                      .doc = "Distance between lines; longest edge of the data = 1",
                                      .range = Range{0.002, 1},
                                      .logScale = true});
        visit(self.width,
              FieldInfo{.key = "width", .doc = "Width of the lines", .unit = "pixel", .range = Range{0.2, 8}});
        visit(
            self.retained,
            FieldInfo{.key = "retained", .doc = "Share of opacity that stays between the lines", .range = Range{0, 1}});
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour of the lines (sRGB)", .range = Range{0, 1}});
        visit(self.ownColor, FieldInfo{.key = "ownColor",
                                       .doc = "Blend from the line colour (0) to the colour of the surface (1)",
                                       .range = Range{0, 1}});
    }
};

/// Where a look applies, by degree of interest.
enum class LookPart { Everything, Context, Focus };
inline constexpr std::string_view kLookPartNames[] = {"everything", "context", "focus"};

struct Look {
    LookPart part = LookPart::Everything;
    float smooth = 0;
    std::optional<WarmCool> tone;
    std::optional<BoundaryEnhancement> boundary;
    std::optional<SilhouetteEnhancement> silhouette;
    std::optional<DistanceColor> distance;
    std::optional<Cartoon> cartoon;
    std::optional<CharcoalDrawing> charcoal;
    std::optional<WireFrame> wire;
    bool any() const { return tone || boundary || silhouette || distance || cartoon || charcoal || wire; }
    bool operator==(const Look&) const = default;

    static constexpr std::string_view kPresetNames[] = {
        "plain",    "tone",       "illustration", "boundaries", "glass",    "distance", "cartoon", "charcoal",
        "sanguine", "softpencil", "pencil",       "hardpencil", "hatching", "stipple",  "chalk",   "wire"};
    /// The look of a preset; nullopt for other names.
    static std::optional<Look> preset(std::string_view name);

    static void describe(auto& self, auto&& visit) {
        visit(self.part, FieldInfo{.key = "part",
                                   .doc = "What is drawn in this style while brushes are active: everything, what is "
                                          "not brushed (context), or what is brushed (focus)",
                                   .names = kLookPartNames});
        visit(self.smooth, FieldInfo{.key = "smooth",
                                     .doc = "Width over which the normals of a drawing are smoothed: noise and details "
                                            "smaller than that do not show; 0 = those of plain shading",
                                     .unit = "voxel",
                                     .range = Range{0, 8}});
        visit(self.tone, FieldInfo{"tone", "Tone shading: warm light, cool shade (Gooch)"});
        visit(self.boundary, FieldInfo{"boundary", "More opacity where values change steeply"});
        visit(self.silhouette, FieldInfo{"silhouette", "More opacity where surfaces turn away"});
        visit(self.distance, FieldInfo{"distance", "Colours fade with distance"});
        visit(self.cartoon, FieldInfo{"cartoon", "Light in steps, with outlines"});
        visit(self.charcoal, FieldInfo{"charcoal", "Strokes on paper grain"});
        visit(self.wire, FieldInfo{"wire", "Lines across the surface, little between them"});
    }
};

constexpr FieldInfo lookField(bool applies = true) {
    return {.key = "look", .doc = "Style of drawing", .applies = applies};
}

/// Paper as the ground of a picture.
struct Paper {
    glm::vec3 color{0.945f, 0.925f, 0.88f}; ///< sRGB
    float tooth = 0.5f, grain = 2;
    bool operator==(const Paper&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour of the paper (sRGB)", .range = Range{0, 1}});
        visit(self.tooth, FieldInfo{.key = "tooth",
                                    .doc = "Visibility of the paper texture; 0 = a plain background",
                                    .range = Range{0, 1}});
        visit(self.grain, FieldInfo{.key = "grain",
                                    .doc = "Size of the paper texture",
                                    .unit = "pixel",
                                    .range = Range{0.5, 16},
                                    .logScale = true});
    }
};

} // namespace tessera::vis
