#pragma once

#include "volume/base/describe.h"

#include <string>

namespace tessera::app {

/// Contour lines of a view of slices; its own settings, without a section around them.
struct ContourSettings {
    int count = 0;
    std::string channel; ///< "" = the channel shown
    bool values = false;
    /// True where lines have values of their own, which the renderer does not draw.
    bool drawn() const { return !channel.empty() || values; }
    bool operator==(const ContourSettings&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.count,
              FieldInfo{.key = "contours", .doc = "Number of contour lines, 0 = none", .range = Range{0, 50}});
        visit(self.channel,
              FieldInfo{.key = "contourOf",
                        .doc = "Parameter of the contour lines, drawn at round values; empty: the parameter shown",
                        .refersTo = "optionalChannel"});
        visit(self.values, FieldInfo{"contourValues", "Draw the lines at round values, labelled with them"});
    }
};

} // namespace tessera::app
