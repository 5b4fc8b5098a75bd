#pragma once

#include "vis/scene/brush_effect.h"
#include "vis/scene/flow_layer.h"
#include "vis/scene/glyph_layer.h"
#include "vis/scene/look.h"
#include "vis/scene/strokes.h"
#include "volume/base/data_units.h"
#include "volume/base/describe.h"

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace tessera::vis {

/// How a layer's samples along a ray become a colour. All styles except composite and iso-surface are projections of
/// the whole ray (vis/shaders/lib/layers/projections.glsl, tests/reference/projection.h). Shaders know them as
/// STYLE_COMPOSITE and so on.
enum class RayStyle { Composite, Maximum, Minimum, Average, XRay, LocalMaximum, Iso };
inline constexpr std::string_view kRayStyleNames[] = {"composite", "maximum",      "minimum", "average",
                                                      "xray",      "localmaximum", "iso"};
/// The styles of volume layers; the last style is that of iso-surfaces.
inline constexpr std::span<const std::string_view> kVolumeStyleNames(kRayStyleNames, std::size_t(RayStyle::Iso));

/// The quantity of a channel that a volume layer shows.
enum class Quantity { Value, Gradient };
inline constexpr std::string_view kQuantityNames[] = {"value", "gradient"};

/// Whether the transfer function is applied after interpolation, before it, or to ray segments; for composite layers.
enum class Classification { Post, Pre, PreIntegrated };
inline constexpr std::string_view kClassificationNames[] = {"post", "pre", "preintegrated"};

/// A scalar drawn through its transfer function by the ray caster.
struct VolumeLayer {
    static constexpr std::string_view kType = "volume";
    std::string channel;
    RayStyle style = RayStyle::Composite;
    Quantity quantity = Quantity::Value;
    Classification classification = Classification::Post; ///< of values; composite only
    double threshold = 0;                                 ///< physical value; local maximum only
    bool shaded = true;                                   ///< by the gradient; composite only
    float density = 1;                                    ///< factor on optical depth
    std::string colorBy = {};                             ///< colouring channel; "": `channel`
    Look look = {};                                       ///< composite only
    bool operator==(const VolumeLayer&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kValues = "Values along rays";
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(self.colorBy, FieldInfo{.key = "colorBy",
                                      .doc = "Parameter whose transfer function gives the colours; the opacity still "
                                             "comes from the parameter shown. Gray where it has no value",
                                      .refersTo = "colorChannel"});
        visit(
            self.style,
            FieldInfo{.key = "style", .doc = "How samples along a ray become one colour", .names = kVolumeStyleNames});
        visit(self.quantity, FieldInfo{.key = "quantity",
                                       .doc = "Show the value or the magnitude of its gradient",
                                       .names = kQuantityNames,
                                       .group = kValues});
        visit(self.classification,
              FieldInfo{.key = "classification",
                        .doc = "Composite: colour of the interpolated value (post), interpolated colours of the "
                               "samples (pre), or mean colour of all values between two samples (preintegrated)",
                        .names = kClassificationNames,
                        .applies = self.style == RayStyle::Composite && self.quantity == Quantity::Value,
                        .group = kValues});
        visit(self.threshold, FieldInfo{.key = "threshold",
                                        .doc = "Local maximum: smallest value that counts as a maximum",
                                        .applies = self.style == RayStyle::LocalMaximum});
        visit(self.shaded, FieldInfo{.key = "shaded",
                                     .doc = "Phong shading by the gradient",
                                     .applies = self.style == RayStyle::Composite});
        visit(self.density,
              FieldInfo{
                  .key = "density", .doc = "Factor on the optical depth", .range = Range{0.01, 100}, .logScale = true});
        visit(self.look, lookField(self.style == RayStyle::Composite));
    }
};

enum class SurfaceMethod { Rays, Polygons, SpaceTime };
inline constexpr std::string_view kSurfaceMethodNames[] = {"rays", "polygons", "spaceTime"};

/// An iso-surface: intersected by rays, refined by bisection; extracted as a mesh; or cut from the surface in space and
/// time (volume/four).
struct IsoLayer {
    static constexpr std::string_view kType = "iso";
    std::string channel;
    double value = 0.5;                  ///< physical
    glm::vec3 color{0.8f, 0.45f, 0.15f}; ///< sRGB
    float opacity = 1;
    SurfaceMethod method = SurfaceMethod::Rays;
    std::string colorBy = {}; ///< colouring channel; "": `color`
    Strokes strokes = {};
    Look look = {};
    /// Whether it is drawn as a mesh: strokes need one.
    bool meshed() const { return method != SurfaceMethod::Rays || !strokes.vector.empty(); }
    bool operator==(const IsoLayer&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel,
              FieldInfo{.key = "channel", .doc = "Parameter whose surface is shown", .refersTo = "channel"});
        visit(self.value, FieldInfo{"value", "Value on the surface"});
        visit(self.color, FieldInfo{.key = "color", .doc = "Colour of the surface (sRGB)", .range = Range{0, 1}});
        visit(self.opacity, FieldInfo{.key = "opacity", .doc = "Opacity of the surface", .range = Range{0, 1}});
        visit(self.method,
              FieldInfo{.key = "method",
                        .doc = "Intersect each ray with the surface (rays), extract the surface of the time shown as "
                               "polygons, or cut it from the surface in space and time, which is made of tetrahedra "
                               "between the samples of two stored times (spaceTime): slower and no more exact. A "
                               "surface with strokes is one of polygons",
                        .names = kSurfaceMethodNames});
        visit(self.colorBy, FieldInfo{.key = "colorBy",
                                      .doc = "Parameter whose transfer function colours the surface; where it has no "
                                             "value the surface has its own colour",
                                      .refersTo = "colorChannel"});
        visit(self.strokes, strokesField());
        visit(self.look, lookField());
    }
};

enum class SliceOrientation { X, Y, Z, Oblique };
inline constexpr std::string_view kSliceOrientationNames[] = {"x", "y", "z", "oblique"};

/// A plane coloured by a channel, with contour lines.
struct SliceLayer {
    static constexpr std::string_view kType = "slice";
    std::string channel;
    SliceOrientation orientation = SliceOrientation::Z;
    bool atCursor = true;      ///< passes through the linked cursor, else at `position`
    double position = 0.5;     ///< 0..1 along the normal through the box
    glm::vec3 normal{0, 0, 1}; ///< of an oblique slice, world axes
    int contours = 0;          ///< contour lines over the colour range
    float opacity = 1;
    Strokes strokes = {};
    bool operator==(const SliceLayer&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{.key = "channel", .doc = "Parameter shown", .refersTo = "channel"});
        visit(
            self.orientation,
            FieldInfo{.key = "orientation", .doc = "Axis perpendicular to the slice", .names = kSliceOrientationNames});
        visit(self.atCursor, FieldInfo{"atCursor", "Pass through the linked cross-hair"});
        visit(self.position, FieldInfo{.key = "position",
                                       .doc = "Position along the normal, 0 to 1 through the box of the data",
                                       .range = Range{0, 1},
                                       .applies = !self.atCursor});
        visit(self.normal, FieldInfo{.key = "normal",
                                     .doc = "Normal of an oblique slice",
                                     .range = Range{-1, 1},
                                     .applies = self.orientation == SliceOrientation::Oblique});
        visit(self.contours,
              FieldInfo{.key = "contours", .doc = "Number of contour lines, 0 = none", .range = Range{0, 50}});
        visit(self.opacity, FieldInfo{.key = "opacity", .doc = "Opacity of the slice", .range = Range{0, 1}});
        visit(self.strokes, strokesField());
    }
};

using Technique = std::variant<VolumeLayer, IsoLayer, SliceLayer, FlowLayer, GlyphLayer>;

/// Colour of a volume (sRGB) where its colouring parameter is absent.
inline constexpr glm::vec3 kNoValueColor{0.5f};

/// The parameter that a technique shows.
inline const std::string& shownChannel(const Technique& technique) {
    return std::visit([](const auto& own) -> const std::string& { return own.channel; }, technique);
}

/// The parameter that colours a technique instead of the one it shows; "": none.
inline const std::string& colorByOf(const Technique& technique) {
    static const std::string kNone;
    return std::visit(
        [](const auto& own) -> const std::string& {
            if constexpr (requires { own.colorBy; })
                return own.colorBy;
            else
                return kNone;
        },
        technique);
}

/// The look of a technique that supports one, else null.
inline const Look* lookOf(const Technique& technique) {
    return std::visit(
        [](const auto& own) -> const Look* {
            if constexpr (requires { own.look; })
                return &own.look;
            else if constexpr (requires { own.style; })
                return &own.style.look;
            else
                return nullptr;
        },
        technique);
}

struct Layer {
    std::string name;
    bool visible = true;
    Technique technique;
    std::string lens = {};     ///< name of the lens that it is drawn in; "": everywhere
    std::string transfer = {}; ///< name of its own transfer function; "": that of its channel
    double timeShift = 0;      ///< seconds, added to the scene's time
    BrushEffect brushes = BrushEffect::Fade;
    bool operator==(const Layer&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kOwn = "This layer alone";
        visit(self.name, FieldInfo{"name", "Name of the layer"});
        visit(self.visible, FieldInfo{"visible", "Show the layer"});
        visit(self.technique, FieldInfo{"technique", "What the layer draws"});
        visit(self.lens, FieldInfo{.key = "lens",
                                   .doc = "Lens to which the layer belongs: it is drawn only inside; empty: everywhere",
                                   .refersTo = "lens",
                                   .group = kOwn});
        visit(self.transfer,
              FieldInfo{.key = "transfer",
                        .doc = "Name of the transfer function of this layer alone; empty: that of its parameter",
                        .group = kOwn});
        visit(self.timeShift,
              FieldInfo{
                  .key = "timeShift", .doc = "Time offset from the time shown", .unit = kUnitOfTimes, .group = kOwn});
        visit(self.brushes,
              FieldInfo{.key = "brushes",
                        .doc = "Effect of the brushes: fade what is not brushed (fade), no effect (none), draw only "
                               "what is not brushed (context) or only what is brushed (focus)",
                        .names = kBrushEffectNames,
                        .group = kOwn});
    }
};

} // namespace tessera::vis
