#pragma once

#include "volume/base/describe.h"

#include <cstdint>
#include <span>
#include <string_view>

namespace tessera::codec {

/// Thresholding of wavelet details, as in Donoho: De-noising by soft-thresholding (1995). Unlike an error bound it
/// guarantees nothing for a single sample: the errors of all levels add up.
enum class Threshold : std::uint8_t {
    Hard,    ///< details of magnitude `value` or less become 0
    Soft,    ///< the same, and all others shrink by `value`
    Quantile ///< the fraction `value` (0..1) of smallest magnitude becomes 0
};
inline constexpr std::string_view kThresholdNames[] = {"hard", "soft", "quantile"};

enum class ThresholdChoice : std::uint8_t { None, Hard, Soft, Quantile };
inline constexpr std::string_view kThresholdChoiceNames[] = {"none", "hard", "soft", "quantile"};

/// Thresholding options of an archive.
struct ThresholdOptions {
    ThresholdChoice kind = ThresholdChoice::None;
    double value = 0.005;
    bool byImportance = true;

    bool operator==(const ThresholdOptions&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.kind, FieldInfo{.key = "kind",
                                   .doc = "Which wavelet details are removed: hard (small ones become 0), soft (all "
                                          "others shrink as well), quantile (the smallest share of each brick)",
                                   .names = kThresholdChoiceNames});
        visit(self.value, FieldInfo{.key = "value",
                                    .doc = "For hard and soft: threshold relative to the range of the parameter; for "
                                           "quantile: the share of the details",
                                    .unit = "of range",
                                    .range = Range{0, 1}});
        visit(self.byImportance,
              FieldInfo{"byImportance",
                        "Scale the threshold by importance: 0 for the most important brick, the full value for "
                        "the least important one; off: the full value for every brick"});
    }
};

/// Thresholds details in place; `value` is at least 0. A quantile removes exactly its fraction; among equal details the
/// first ones.
void applyThreshold(std::span<std::int32_t> details, Threshold kind, double value);

} // namespace tessera::codec
