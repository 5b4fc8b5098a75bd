#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <string>
#include <string_view>
#include <vector>

/// Parts of parameters: stated by rules, or found from the samples on either side of region borders.
namespace tessera::volume {

/// One rule of ImportOptions::parts: "p=region:1|3", "T=region:0,1,3" (one part), "T=joined", "p=jumps".
struct PartsRule {
    std::string parameter;                        ///< "*" = every one that is no label
    std::string label;                            ///< "" = joined
    std::vector<std::vector<std::string>> groups; ///< values of the label, or their names; empty = joined
    bool jumps = false;                           ///< by what its own samples show (volume/import/data_jumps.h)
    bool operator==(const PartsRule&) const = default;
};

/// Throws Error when the text is not a rule.
PartsRule parsePartsRule(std::string_view text);

/// Text such as "2 parts by region: 1 | 3", or "2 parts by jumps of the data: ..." for a label created from jumps; ""
/// for a parameter with one part.
std::string partsText(const Parameter& parameter);

/// Sets the parts stated by rules, except "jumps" rules. Throws Error for a parameter, label or value that does not
/// exist, or a value in two parts. The last of several rules for a parameter is used.
void setParts(DatasetInfo& info, const std::vector<PartsRule>& rules);

/// Samples of two regions at this distance along an axis, with only absent ones between, are never used together by a
/// filter.
inline constexpr int kPartsApart = 5;

/// The parts of a parameter by a label, from up to three times (first, middle and last). Between two regions whose
/// samples are closer than kPartsApart along an axis the parameter jumps if, on a quarter of the border or more, the
/// values extrapolated from both sides to the middle differ by more than three times the usual difference inside, and
/// by more than a five-hundredth of the range (a tenth if one side is a layer of one sample everywhere, where curvature
/// and jump cannot be distinguished). Regions separated by a jump are in different parts; all others share one,
/// including those too far apart to meet.
Parts foundParts(const Dataset& dataset, int parameter, int label, const Progress& progress = {});

/// Applies foundParts to every parameter (or those in `only`, if not empty) with the first label, except those named in
/// `stated`. Returns a description, one line each.
std::vector<std::string> findParts(Dataset& dataset, const std::vector<PartsRule>& stated,
                                   const std::vector<std::string>& only = {}, const Progress& progress = {});

} // namespace tessera::volume
