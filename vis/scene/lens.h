#pragma once

#include "vis/formulas/lens_weight.h"
#include "vis/scene/camera.h"
#include "vis/scene/lens_shape.h"
#include "volume/base/data_units.h"

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

/// Magic lenses: regions of space with a different rendering (C. Tominski et al.: Interactive lenses for visualization,
/// 2017). A lens acts on layers without a lens and on those of the lenses before it in the list; layers of a lens are
/// drawn only inside it. Twins: vis/shaders/lib/sampling/lens.glsl, lenses.glsl.
namespace tessera::vis {

/// Effect on the layers below: Replace hides them inside, in favour of the lens's own layers or of nothing; Only hides
/// them outside; Enhance makes them denser, Suppress fainter and greyer, Magnify larger; Focus confines the effect of
/// brushes to the inside (everything outside counts as focus).
enum class LensEffect { Replace, Only, Enhance, Suppress, Magnify, Focus };
inline constexpr std::string_view kLensEffectNames[] = {"replace", "only", "enhance", "suppress", "magnify", "focus"};

struct Lens {
    std::string name = "lens";
    bool enabled = true;
    LensShape shape = LensShape::Sphere;
    LensEffect effect = LensEffect::Replace;
    glm::dvec3 center{0};        ///< physical
    bool followsCursor = false;  ///< its centre is the linked cursor
    bool followsPointer = false; ///< 3D views move it to the position under the mouse
    glm::vec3 size{0.2f};        ///< half edges, or radii along its own axes, world; a disc uses x only
    glm::vec3 rotation{0};       ///< degrees; about the world's x, then y, then z axis
    float rim = 0.15f;           ///< fraction of the radius over which it fades out
    bool inverted = false;       ///< acts outside
    float strength = 1;          ///< 0: no effect
    float magnification = 2.5f;  ///< at the centre; Magnify only
    float detail = 1;            ///< factor on RenderParams::detail for the bricks it intersects
    bool marks = true;
    glm::vec3 color{0.55f, 0.85f, 1.0f};                 ///< sRGB, outline
    std::optional<double> fromTime = {}, untilTime = {}; ///< first and last time at which it acts; nothing: no end

    bool operator==(const Lens&) const = default;
    /// Whether it has a place in space.
    bool inSpace() const { return shape != LensShape::Selection; }
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kPlace = "Place", kData = "Data inside", kList = "Name and colour";
        visit(self.shape, FieldInfo{.key = "shape",
                                    .doc = "Shape; a disc faces the viewer and extends through the whole depth; "
                                           "selection: what the brushes select, wherever it lies (volumes, slices and "
                                           "surfaces met by rays; flow, glyphs and polygons are as outside)",
                                    .names = kLensShapeNames});
        visit(self.effect,
              FieldInfo{.key = "effect",
                        .doc =
                            "Effect inside the lens: its own layers replace the others, or cut them away if it has "
                            "none (replace); only what is inside is drawn (only); opacity is raised (enhance) or "
                            "lowered (suppress); the picture is magnified (magnify); brushes act inside only (focus)",
                        .names = kLensEffectNames});
        visit(self.center, FieldInfo{.key = "center",
                                     .doc = "Centre of the lens",
                                     .unit = kUnitOfLengths,
                                     .applies = !self.followsCursor && self.inSpace()});
        visit(self.followsCursor, FieldInfo{.key = "followsCursor",
                                            .doc = "Follow the linked cross-hair",
                                            .applies = self.inSpace(),
                                            .group = kPlace});
        visit(self.followsPointer,
              FieldInfo{.key = "followsPointer",
                        .doc = "Follow the mouse over 3D views and slices (F pins and releases it)",
                        .applies = self.inSpace(),
                        .group = kPlace});
        visit(self.size, FieldInfo{.key = "size",
                                   .doc = "Radii or half edge lengths along its axes; longest edge of the data = 1",
                                   .range = Range{0.005, 2},
                                   .logScale = true,
                                   .applies = self.inSpace()});
        visit(self.rotation, FieldInfo{.key = "rotation",
                                       .doc = "Rotation around x, then y, then z",
                                       .unit = "deg",
                                       .range = Range{-180, 180},
                                       .applies = self.inSpace() && self.shape != LensShape::Disc,
                                       .group = kPlace});
        visit(self.rim, FieldInfo{.key = "rim",
                                  .doc = "Width of the soft edge, as a share of the radius; 0 = a sharp edge",
                                  .range = Range{0, 1},
                                  .applies = self.inSpace()});
        visit(self.fromTime, FieldInfo{.key = "fromTime",
                                       .doc = "First time at which it acts; none: from the first one on",
                                       .unit = kUnitOfTimes,
                                       .group = kPlace});
        visit(self.untilTime, FieldInfo{.key = "untilTime",
                                        .doc = "Last time at which it acts; none: until the last one",
                                        .unit = kUnitOfTimes,
                                        .group = kPlace});
        visit(self.strength, FieldInfo{.key = "strength", .doc = "Strength of the effect", .range = Range{0, 1}});
        visit(self.magnification, FieldInfo{.key = "magnification",
                                            .doc = "Magnify: magnification in the centre",
                                            .range = Range{1, 8},
                                            .logScale = true,
                                            .applies = self.effect == LensEffect::Magnify});
        visit(self.detail, FieldInfo{.key = "detail",
                                     .doc = "Factor on the setting `render.detail` for bricks that touch the lens, in "
                                            "data too large for one texture; 0 = full resolution",
                                     .range = Range{0, 8},
                                     .group = kData});
        visit(self.marks,
              FieldInfo{.key = "marks", .doc = "Mark the samples inside the lens in plots and tables", .group = kData});
        visit(self.name, FieldInfo{.key = "name", .doc = "Name by which layers refer to the lens", .group = kList});
        visit(self.enabled, FieldInfo{.key = "enabled", .doc = "Apply and show this lens", .group = kList});
        visit(self.inverted, FieldInfo{.key = "inverted", .doc = "Act outside instead of inside", .group = kList});
        visit(self.color,
              FieldInfo{.key = "color", .doc = "Colour of its outline (sRGB)", .range = Range{0, 1}, .group = kList});
    }
};

/// Whether a lens acts at a time.
inline bool activeAt(const Lens& lens, double time) {
    return lens.enabled && time >= lens.fromTime.value_or(time) && time <= lens.untilTime.value_or(time);
}
/// Whether it marks the samples inside of it in plots and tables at a time; a lens of a selection would mark that.
inline bool marksAt(const Lens& lens, double time) {
    return activeAt(lens, time) && lens.marks && lens.inSpace();
}

inline constexpr int kMaxLenses = 8; ///< further ones are ignored

/// A lens in world space. A point's lens coordinates are u = toUnit (p - center); its normalised radius, 0 at the
/// centre and 1 on the outline, is |u| (sphere), max |u_i| (box), max(|u_xy|, |u_z|) (cylinder), |u_xy| / (1 + u_z)
/// (disc: in the picture |u_xy| at the depth of its centre). The weight of a selection is the degree of interest.
struct PlacedLens {
    std::string name;
    LensShape shape = LensShape::Sphere;
    LensEffect effect = LensEffect::Replace;
    double rim = 0;
    bool inverted = false, marks = false;
    glm::dvec3 center{0};
    glm::dmat3 toUnit{1}, fromUnit{1}; ///< for a disc, fromUnit ignores u_z
    double inside = 1, outside = 1;    ///< opacity factors on the layers below at weight 1 and 0
    double saturation = 1;             ///< saturation factor on them at weight 1
    double focus = 0;                  ///< how much it confines the brushes to its inside
    double magnification = 1;
    double detail = 1; ///< Lens::detail

    bool operator==(const PlacedLens&) const = default;
    template <class N> N radius(const glm::vec<3, N>& world) const {
        const glm::vec<3, N> from = world - spreadOut<N>(center);
        return lensRadius<N>(shape, spreadOut<N>(toUnit[0]) * from.x + spreadOut<N>(toUnit[1]) * from.y +
                                        spreadOut<N>(toUnit[2]) * from.z);
    }
    double radius(glm::dvec3 world) const { return radius<double>(world); }
    /// 1 inside, 0 outside, smoothstep over the rim; reversed if inverted. `doi`: degree of interest there.
    template <class N> N weight(const glm::vec<3, N>& world, const std::type_identity_t<N>& doi = N(0)) const {
        const N own = shape == LensShape::Selection ? doi : lensWeight(radius(world), rim);
        return inverted ? N(1) - own : own;
    }
    double weight(glm::dvec3 world, double doi = 0) const { return weight<double>(world, doi); }
    /// The position whose data are shown at `world`: nearer to the centre by lensShare().
    glm::dvec3 bend(glm::dvec3 world) const;
    /// Whether it changes opacity or saturation of the layers below.
    bool acts() const { return effect != LensEffect::Magnify && effect != LensEffect::Focus; }
};

/// The enabled lenses, at most kMaxLenses, in order; with `time` those that act then.
std::vector<PlacedLens> placeLenses(const std::vector<Lens>& lenses, const WorldFrame& frame, const Camera& camera,
                                    glm::dvec3 cursor, std::optional<double> time = {});

/// Index of the lens with a name, -1 if there is none.
int findLens(const std::vector<PlacedLens>& lenses, const std::string& name);
/// Index of the lens that a layer is drawn in: -1 for everywhere (""), nullopt if there is none of that name.
std::optional<int> lensOf(const std::vector<PlacedLens>& lenses, const std::string& name);

/// Effect of all lenses on a layer at a position with this degree of interest; the layer belongs to lens `own` (-1: to
/// none).
template <class N> struct LensActionOf {
    N opacity{1}, saturation{1}; ///< factors
};
using LensAction = LensActionOf<double>;
template <class N>
LensActionOf<N> lensAction(std::span<const PlacedLens> lenses, int own, const glm::vec<3, N>& world,
                           const std::type_identity_t<N>& doi = N(0)) {
    LensActionOf<N> action;
    if (own >= 0) action.opacity = lenses[std::size_t(own)].weight(world, doi);
    for (const PlacedLens& lens : lenses.subspan(std::size_t(own) + 1)) {
        const N weight = lens.weight(world, doi);
        action.opacity = action.opacity * blended(N(lens.outside), N(lens.inside), weight);
        action.saturation = action.saturation * blended(N(1), N(lens.saturation), weight);
    }
    return action;
}

inline LensAction lensAction(const std::vector<PlacedLens>& lenses, int own, glm::dvec3 world, double doi = 0) {
    return lensAction<double>(lenses, own, world, doi);
}

/// Applies all magnifying lenses, the last of the list first. Positions inside the box stay inside.
glm::dvec3 bend(const std::vector<PlacedLens>& lenses, glm::dvec3 world, glm::dvec3 halfSize);

/// The degree of interest after lenses that confine the brushes.
template <class N> N confine(std::span<const PlacedLens> lenses, N doi, const glm::vec<3, N>& world) {
    N most(0);
    double share = 0;
    for (const PlacedLens& lens : lenses) {
        if (!(lens.focus > 0)) continue;
        share = std::max(share, lens.focus);
        most = larger(most, lens.weight(world));
    }
    return share > 0 ? blended(doi, N(1), N(share) * (N(1) - most)) : doi;
}

inline double confine(const std::vector<PlacedLens>& lenses, double doi, glm::dvec3 world) {
    return confine<double>(lenses, doi, world);
}

/// Lens weights as functions of physical positions.
struct LensSpace {
    std::vector<PlacedLens> lenses;
    WorldFrame frame;
    bool operator==(const LensSpace& other) const {
        return lenses == other.lenses && frame.scale == other.frame.scale && frame.offset == other.frame.offset &&
               frame.axes == other.frame.axes;
    }
};

} // namespace tessera::vis
