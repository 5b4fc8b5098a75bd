#pragma once

#include "vis/scene/camera.h"
#include "vis/scene/lens_shape.h"

#include <glm/mat3x3.hpp>
#include <string>
#include <vector>

/// Magic lenses: regions of space inside which the picture is made in another way (C. Tominski et al.: Interactive
/// lenses for visualization, 2017). A lens acts on the layers that belong to no lens and on those of the lenses before
/// it in the list; layers that belong to it are drawn inside it alone. Twins: vis/shaders/lib/lens.glsl, lenses.glsl.
namespace tessera::vis {

/// What happens inside to the layers below: they give way (to the lens's own layers, or to nothing), stay while all
/// else goes, become denser, fainter and greyer, larger, or show the brushes (outside all counts as focus then).
enum class LensEffect { Replace, Only, Enhance, Suppress, Magnify, Focus };
inline constexpr std::string_view kLensEffectNames[] = {"replace", "only", "enhance", "suppress", "magnify", "focus"};

struct Lens {
    std::string name = "lens";
    bool enabled = true;
    LensShape shape = LensShape::Sphere;
    LensEffect effect = LensEffect::Replace;
    glm::dvec3 center{0};        ///< physical
    bool followsCursor = false;  ///< lies at the linked cursor instead
    bool followsPointer = false; ///< 3D views move it to what lies under the mouse
    glm::vec3 size{0.2f};        ///< half of its edges, or its radii along its own axes, world; of a disc only x counts
    glm::vec3 rotation{0};       ///< degrees; around x, then y, then z of the world
    float rim = 0.15f;           ///< share of its radius over which it fades out
    bool inverted = false;       ///< acts outside
    float strength = 1;          ///< 0: nothing happens
    float magnification = 2.5f;  ///< in the middle; Magnify only
    float detail = 1;            ///< factor on RenderParams::detail of the bricks it meets
    bool marks = true;
    glm::vec3 color{0.55f, 0.85f, 1.0f}; ///< sRGB, of its outline

    bool operator==(const Lens&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{.key = "name", .unit = "", .doc = "Name by which layers refer to the lens"});
        visit(self.enabled, FieldInfo{.key = "enabled", .unit = "", .doc = "Apply and show this lens"});
        visit(self.shape, FieldInfo{.key = "shape",
                                    .unit = "",
                                    .doc = "Shape; a disc faces the viewer and extends through the whole depth",
                                    .names = kLensShapeNames});
        visit(self.effect,
              FieldInfo{.key = "effect",
                        .unit = "",
                        .doc =
                            "Effect inside the lens: its own layers replace the others, or cut them away if it has "
                            "none (replace); only what is inside is drawn (only); opacity is raised (enhance) or "
                            "lowered (suppress); the picture is magnified (magnify); brushes act inside only (focus)",
                        .names = kLensEffectNames});
        visit(self.center,
              FieldInfo{.key = "center", .unit = "m", .doc = "Centre of the lens", .applies = !self.followsCursor});
        visit(self.followsCursor, FieldInfo{.key = "followsCursor", .unit = "", .doc = "Follow the linked cross-hair"});
        visit(self.followsPointer,
              FieldInfo{.key = "followsPointer",
                        .unit = "",
                        .doc = "Follow the mouse over 3D views and slices (F pins and releases it)"});
        visit(self.size, FieldInfo{.key = "size",
                                   .unit = "",
                                   .doc = "Radii or half edge lengths along its axes; longest edge of the data = 1",
                                   .range = Range{0.005, 2},
                                   .logScale = true});
        visit(self.rotation, FieldInfo{.key = "rotation",
                                       .unit = "deg",
                                       .doc = "Rotation around x, then y, then z",
                                       .range = Range{-180, 180},
                                       .applies = self.shape != LensShape::Disc});
        visit(self.rim, FieldInfo{.key = "rim",
                                  .unit = "",
                                  .doc = "Width of the soft edge, as a share of the radius; 0 = a sharp edge",
                                  .range = Range{0, 1}});
        visit(self.inverted, FieldInfo{.key = "inverted", .unit = "", .doc = "Act outside instead of inside"});
        visit(self.strength,
              FieldInfo{.key = "strength", .unit = "", .doc = "Strength of the effect", .range = Range{0, 1}});
        visit(self.magnification, FieldInfo{.key = "magnification",
                                            .unit = "",
                                            .doc = "Magnify: magnification in the centre",
                                            .range = Range{1, 8},
                                            .logScale = true,
                                            .applies = self.effect == LensEffect::Magnify});
        visit(self.detail, FieldInfo{.key = "detail",
                                     .unit = "",
                                     .doc = "Factor on the setting `render.detail` for bricks that touch the lens, in "
                                            "data too large for one texture; 0 = full resolution",
                                     .range = Range{0, 8}});
        visit(self.marks,
              FieldInfo{.key = "marks", .unit = "", .doc = "Mark the samples inside the lens in plots and tables"});
        visit(self.color,
              FieldInfo{.key = "color", .unit = "", .doc = "Colour of its outline (sRGB)", .range = Range{0, 1}});
    }
};

inline constexpr int kMaxLenses = 8; ///< further ones are left out

/// A lens in world space. A point's place in it is u = toUnit (p - center); its radius there, 0 in the middle and 1 on
/// the outline, is |u| (sphere), max |u_i| (box), max(|u_xy|, |u_z|) (cylinder), |u_xy| / (1 + u_z) (disc: in the
/// picture |u_xy| at the depth of its middle).
struct PlacedLens {
    std::string name;
    LensShape shape = LensShape::Sphere;
    LensEffect effect = LensEffect::Replace;
    double rim = 0;
    bool inverted = false, marks = false;
    glm::dvec3 center{0};
    glm::dmat3 toUnit{1}, fromUnit{1}; ///< of a disc, fromUnit leaves u_z out
    double inside = 1, outside = 1;    ///< factors on the opacity of the layers below, where the weight is 1 and 0
    double saturation = 1;             ///< factor on their saturation at weight 1
    double focus = 0;                  ///< share of the brushes' effect that it confines to itself
    double magnification = 1;
    double detail = 1; ///< Lens::detail

    bool operator==(const PlacedLens&) const = default;
    double radius(glm::dvec3 world) const;
    /// 1 inside, 0 outside, smoothstep over the rim; the other way round if inverted.
    double weight(glm::dvec3 world) const;
    /// Where the data that are shown at a place come from: at radius r as far from the middle as 1 / (1 + d (1 - r))
    /// of r says, d = magnification - 1 (the graphical fisheye of M. Sarkar and M. Brown, 1992, backwards).
    glm::dvec3 bend(glm::dvec3 world) const;
    /// Changes opacity or saturation of the layers below.
    bool acts() const { return effect != LensEffect::Magnify && effect != LensEffect::Focus; }
};

/// The enabled lenses, at most kMaxLenses, in their order.
std::vector<PlacedLens> placeLenses(const std::vector<Lens>& lenses, const WorldFrame& frame, const Camera& camera,
                                    glm::dvec3 cursor);

/// Position of the lens of a name, -1 if none.
int findLens(const std::vector<PlacedLens>& lenses, const std::string& name);

/// What lenses do to a layer at a place: one that belongs to lens `own` (-1: to none).
struct LensAction {
    double opacity = 1, saturation = 1; ///< factors
};
LensAction lensAction(const std::vector<PlacedLens>& lenses, int own, glm::dvec3 world);

/// All magnifying lenses, the last one of the list looked through first. What lies in the box stays in it.
glm::dvec3 bend(const std::vector<PlacedLens>& lenses, glm::dvec3 world, glm::dvec3 halfSize);

/// A degree of interest as the lenses that confine the brushes leave it.
double confine(const std::vector<PlacedLens>& lenses, double doi, glm::dvec3 world);

/// Lenses for functions of physical positions.
struct LensSpace {
    std::vector<PlacedLens> lenses;
    WorldFrame frame;
    bool operator==(const LensSpace& other) const {
        return lenses == other.lenses && frame.scale == other.frame.scale && frame.offset == other.frame.offset;
    }
};

} // namespace tessera::vis
