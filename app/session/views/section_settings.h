#pragma once

#include "volume/base/describe.h"
#include "volume/flow/section_weight.h"

#include <vector>

namespace tessera::app {

/// The quantity shown for the planes of a section (app/views/curves/section_data.h).
enum class SectionMeasure { Mean, Least, Most, Integral, Flux, Flow, Area };
inline constexpr std::string_view kSectionMeasureNames[] = {"mean", "least", "most", "integral",
                                                            "flux", "flow",  "area"};

/// The direction perpendicular to the planes: an axis, or the line of the view.
enum class SectionAcross { X, Y, Z, Line };
inline constexpr std::string_view kSectionAcrossNames[] = {"x", "y", "z", "line"};

/// Averages over planes in a profile view.
struct SectionSettings {
    SectionAcross across = SectionAcross::Z;
    volume::SectionWeight weight = volume::SectionWeight::Area;
    SectionMeasure measure = SectionMeasure::Mean;
    bool byRegion = true;
    std::vector<int> regions; ///< values of the label shown; none: every one
    bool everything = false;  ///< a curve beside that of the selection
    bool operator==(const SectionSettings&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.across,
              FieldInfo{.key = "across",
                        .doc = "Axis perpendicular to the planes, or the line through the corners of the view",
                        .names = kSectionAcrossNames});
        visit(
            self.weight,
            FieldInfo{.key = "weight", .doc = "Weight of the mean over a plane", .names = volume::kSectionWeightNames});
        visit(self.measure,
              FieldInfo{.key = "measure", .doc = "Quantity shown for every plane", .names = kSectionMeasureNames});
        visit(self.byRegion, FieldInfo{"byRegion", "One curve for each region of the label"});
        visit(self.regions, FieldInfo{"regions", "Values of the label that have a curve; empty: all"});
        visit(self.everything, FieldInfo{"everything", "Beside each curve of the selection one of everything"});
    }
};

} // namespace tessera::app
