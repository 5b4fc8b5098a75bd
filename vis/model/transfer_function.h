#pragma once

#include "volume/describe.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

namespace tessera::vis {

/// How values of one channel become colour and opacity; shared by every view that shows the channel.
struct TransferFunction {
    std::string colormap = "viridis";
    bool reversed = false;
    bool autoRange = true; ///< follow the parameter's range over all times
    Range range{0, 1};     ///< physical values at the ends of the colour map, used if !autoRange
    /// Opacity curve: x in 0..1 along the range, y the opacity of a layer `kReferenceLength` thick. Sorted by x, at
    /// least 2.
    std::vector<glm::vec2> opacity{{0.0f, 0.0f}, {1.0f, 0.8f}};

    bool operator==(const TransferFunction&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.colormap, FieldInfo{.key = "colormap", .unit = "", .doc = "Colour map", .refersTo = "colormap"});
        visit(self.reversed, FieldInfo{.key = "reversed", .unit = "", .doc = "Run the colour map backwards"});
        visit(self.autoRange,
              FieldInfo{.key = "autoRange", .unit = "", .doc = "Colour the parameter's own range over all times"});
        visit(self.range, FieldInfo{.key = "range", .unit = "", .doc = "Values at the ends of the colour map"});
        visit(self.opacity,
              FieldInfo{
                  .key = "opacity", .unit = "", .doc = "Opacity curve: (position 0..1, opacity 0..1)", .hidden = true});
    }
};

/// World length (longest stretched edge = 1) over which an opacity of the curve applies; shorter steps get
/// 1 - (1 - a)^(step / kReferenceLength).
inline constexpr double kReferenceLength = 1.0 / 128;

struct ColormapInfo {
    std::string_view name, kind; ///< kind: "sequential", "diverging", "cyclic", "categorical", "other"
};
/// The colour maps that can be chosen, perceptually uniform ones first.
std::span<const ColormapInfo> colormaps();

/// Colour (sRGB, 0..1) of a map at x in 0..1, linear between its control colours (a categorical map shows its colours
/// as equal steps); unknown names give viridis.
glm::dvec3 colormapColor(std::string_view name, double x);

/// Range in use: the channel's own or the stated one.
Range effectiveRange(const TransferFunction& function, Range channelRange);

/// Colour and opacity at a physical value: the one definition that legends, tables, plots and the reference use. A
/// categorical map colours a value by its nearest integer, whatever the range: label n has colour n modulo their
/// number.
glm::dvec4 evaluate(const TransferFunction& function, Range range, double value);

/// evaluate() at the centres of `size` equal parts of the range, for a colour bar. RGBA, sRGB colour, not
/// premultiplied. Only categorical maps depend on the range.
std::vector<glm::vec4> makeTable(const TransferFunction& function, int size, Range range = {0, 1});

} // namespace tessera::vis
