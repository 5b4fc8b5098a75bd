#pragma once

#include "vis/scene/layers.h"
#include "volume/base/data_units.h"
#include "volume/base/describe.h"
#include "volume/field/space_axis.h"

#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

/// Callouts: details beside the volume, joined to a placeholder in it by a line (M. Tory and C. Swindells: Comparing
/// ExoVis, orientation icon, and in-place 3D visualization techniques, 2003).
namespace tessera::app {

/// What a callout shows in detail, its placeholder.
enum class CalloutOf { Lens, Brush, Plane };
inline constexpr std::string_view kCalloutOfNames[] = {"lens", "brush", "plane"};

enum class CalloutKind { Scene, Slice, Histogram, Profile, Numbers };
inline constexpr std::string_view kCalloutKindNames[] = {"scene", "slice", "histogram", "profile", "numbers"};

/// How many callouts are drawn; further ones are not.
inline constexpr std::size_t kMostCallouts = 8;

struct Callout {
    CalloutOf of = CalloutOf::Lens;
    std::string placeholder = {}; ///< name of a lens or brush; of a plane "x", "y", "z" or the pane of an oblique slice
    CalloutKind kind = CalloutKind::Scene;
    std::string channel = {}; ///< of all kinds but scenes; "" = the channel of the first layer
    volume::SpaceAxis axis = volume::SpaceAxis::Z;
    std::optional<std::vector<vis::Layer>> layers = {}; ///< of its own; none: those of the view
    std::optional<double> time = {};                    ///< of its own; none: that of the view
    glm::quat turn{1, 0, 0, 0};                         ///< of a scene: from the view's eye axes to its own
    float zoom = 1;
    std::string name = {};
    bool enabled = true;

    bool operator==(const Callout&) const = default;
    static void describe(auto& self, auto&& visit) {
        const bool scene = self.kind == CalloutKind::Scene, plane = self.of == CalloutOf::Plane;
        visit(self.of, FieldInfo{.key = "of",
                                 .doc = "What is shown in detail: the inside of a lens or of a brush, or a plane",
                                 .names = kCalloutOfNames});
        visit(self.placeholder,
              FieldInfo{"placeholder", "Name of the lens or brush; of a plane x, y or z, the axis across which it lies "
                                       "at the cross-hair, or the pane of an oblique slice"});
        visit(self.kind, FieldInfo{.key = "kind",
                                   .doc = "What it is: the scene cut to the placeholder, a slice through its middle, a "
                                          "histogram of its samples, a profile through its middle, or a table of the "
                                          "mean and range of every parameter",
                                   .names = kCalloutKindNames});
        visit(self.channel, FieldInfo{.key = "channel",
                                      .doc = "Parameter of a slice, histogram or profile",
                                      .refersTo = "channel",
                                      .applies = !scene && self.kind != CalloutKind::Numbers});
        visit(self.axis,
              FieldInfo{.key = "axis",
                        .doc = "Axis across which the slice of a lens or brush lies, and along which its "
                               "profile runs",
                        .names = volume::kSpaceAxisNames,
                        .applies = self.kind == CalloutKind::Profile || (self.kind == CalloutKind::Slice && !plane)});
        visit(
            self.layers,
            FieldInfo{.key = "layers", .doc = "Layers of this scene alone; none: those of the view", .applies = scene});
        visit(self.time, FieldInfo{.key = "time",
                                   .doc = "Time of this callout alone; none: that of the view",
                                   .unit = kUnitOfTimes});
        visit(self.turn, FieldInfo{.key = "turn",
                                   .doc = "Rotation of its camera against that of the view, as a quaternion",
                                   .hidden = true});
        visit(self.zoom, FieldInfo{.key = "zoom",
                                   .doc = "Magnification of a scene; at 1 the placeholder just fits",
                                   .range = Range{0.2, 10},
                                   .logScale = true,
                                   .applies = scene});
        visit(self.name, FieldInfo{"name", "Title; empty: what is shown and where"});
        visit(self.enabled, FieldInfo{"enabled", "Show this callout"});
    }
};

} // namespace tessera::app
