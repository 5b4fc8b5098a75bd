#pragma once

#include "volume/describe.h"

#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace tessera::vis {

/// One side of a brush: values of a channel between lo and hi, with a soft edge outside. NaN never matches.
struct BrushInterval {
    std::string channel;
    double lo = 0, hi = 1; ///< physical values; degree of interest 1 between them
    double soft = 0;       ///< physical width over which it falls linearly to 0 outside

    bool operator==(const BrushInterval&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel,
              FieldInfo{.key = "channel", .unit = "", .doc = "Parameter that is brushed", .refersTo = "channel"});
        visit(self.lo, FieldInfo{.key = "lo", .unit = "", .doc = "Lower end"});
        visit(self.hi, FieldInfo{.key = "hi", .unit = "", .doc = "Upper end"});
        visit(self.soft, FieldInfo{.key = "soft", .unit = "", .doc = "Width of the soft edge"});
    }
};

/// A rectangle in two parameters (or an interval in one): all intervals must hold, so the DOI is their minimum.
struct Brush {
    std::string name = "brush";
    bool enabled = true;
    bool inverted = false;
    std::vector<BrushInterval> intervals;

    bool operator==(const Brush&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{.key = "name", .unit = "", .doc = "Name of the brush"});
        visit(self.enabled, FieldInfo{.key = "enabled", .unit = "", .doc = "Takes part in the selection"});
        visit(self.inverted, FieldInfo{.key = "inverted", .unit = "", .doc = "Selects what lies outside"});
        visit(self.intervals, FieldInfo{.key = "intervals", .unit = "", .doc = "Parameter ranges that must all hold"});
    }
};

enum class Combine { All, Any };
inline constexpr std::string_view kCombineNames[] = {"all", "any"};

/// The one selection that every view shares. The degree of interest (DOI) of a sample is 1 when no brush is enabled,
/// else the minimum (all) or maximum (any) over the enabled brushes.
struct Selection {
    std::vector<Brush> brushes;
    Combine combine = Combine::All;
    float contextOpacity = 0.04f;   ///< opacity factor of samples with DOI 0
    float contextSaturation = 0.1f; ///< colour saturation of samples with DOI 0

    bool operator==(const Selection&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.brushes,
              FieldInfo{.key = "brushes", .unit = "", .doc = "Brushes, in the order they were made", .hidden = true});
        visit(self.combine, FieldInfo{.key = "combine",
                                      .unit = "",
                                      .doc = "A point is in focus if all brushes, or any brush, hold",
                                      .names = kCombineNames});
        visit(self.contextOpacity,
              FieldInfo{
                  .key = "contextOpacity", .unit = "", .doc = "Opacity of what is not brushed", .range = Range{0, 1}});
        visit(self.contextSaturation, FieldInfo{.key = "contextSaturation",
                                                .unit = "",
                                                .doc = "Colour saturation of what is not brushed",
                                                .range = Range{0, 1}});
    }
    /// True when at least one brush is enabled.
    bool active() const;
};

/// 1 inside [lo, hi], 0 beyond the soft edge, linear between.
double intervalDoi(const BrushInterval& interval, double value);

/// Degree of interest of a point whose channels `valueOf` gives (NaN = absent).
double degreeOfInterest(const Selection& selection, const std::function<double(const std::string& channel)>& valueOf);

} // namespace tessera::vis
