#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <string>
#include <string_view>
#include <vector>

/// Which regions a parameter jumps between: stated by rules, or found from the samples on either side of their borders.
namespace tessera::volume {

/// One rule of ImportOptions::parts: "p=region:1|3", "T=region:0,1,3" (one part), "T=joined", "p=jumps".
struct PartsRule {
    std::string parameter;                        ///< "*" = every one that is no label
    std::string label;                            ///< "" = joined
    std::vector<std::vector<std::string>> groups; ///< values of the label, or their names; empty = joined
    bool jumps = false;                           ///< by what its own samples show (volume/import/data_jumps.h)
    bool operator==(const PartsRule&) const = default;
};

/// Throws Error when the text is no rule.
PartsRule parsePartsRule(std::string_view text);

/// "2 parts by region: 1 | 3", "2 parts by jumps of the data: ..." where the label was made from these, "" where all of
/// a parameter is one part.
std::string partsText(const Parameter& parameter);

/// Sets the parts that rules state, but for those that say jumps. Throws Error for a parameter, label or value that
/// does not exist, or a value in two parts. Of two rules for a parameter the last one counts.
void setParts(DatasetInfo& info, const std::vector<PartsRule>& rules);

/// Samples of two regions this far apart along an axis, with only absent ones between, meet in no filter.
inline constexpr int kPartsApart = 5;

/// The parts of a parameter by a label, from up to three times (the first, the middle and the last). Between two
/// regions whose samples lie closer than kPartsApart along an axis the parameter jumps where, on a quarter of the
/// border or more, the values continued from both sides to the middle differ by more than three times what neighbours
/// inside do, and by more than a five-hundredth of the range (a tenth, where one side is a layer of one sample
/// everywhere and a bend cannot be told from a jump). What jumps are different parts; regions joined by no jump share
/// one, as do those too far apart to meet.
Parts foundParts(const Dataset& dataset, int parameter, int label, const Progress& progress = {});

/// foundParts of every parameter (of those in `only`, where that is not empty), by the first label, but for those that
/// `stated` names. Returns what was found in words, a line each.
std::vector<std::string> findParts(Dataset& dataset, const std::vector<PartsRule>& stated,
                                   const std::vector<std::string>& only = {}, const Progress& progress = {});

} // namespace tessera::volume
