#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <string>
#include <string_view>
#include <vector>

/// Absent samples: rules by label, value or NaN, and the resulting masks, shared where equal.
namespace tessera::volume {

/// One rule of ImportOptions::absent, e.g. "O2=region:0,3", "O2=0", "*=nan", "O2=none".
struct AbsentRule {
    std::string parameter;           ///< "*" = every one that is no label
    std::string label;               ///< "" = the parameter's own values count
    std::vector<std::string> values; ///< numbers, or names of the label's values
    bool nothing = false;            ///< "none": no automatic rule for this parameter
    bool operator==(const AbsentRule&) const = default;
};

/// Throws Error when the text is not a rule. NaN is always absent, so "=nan" gives a rule without values.
AbsentRule parseAbsentRule(std::string_view text);
std::string toText(const AbsentRule& rule);

/// Suggested rules: a parameter that is exactly 0 at all samples with certain values of a label (at every probed time),
/// but not everywhere. Reads up to three times of every parameter.
std::vector<AbsentRule> suggestAbsentRules(const Dataset& dataset, const Progress& progress = {});

/// Fills in the values of labels that state none: the distinct values at the first time, at most 256.
void findLabels(Dataset& dataset);

/// The data set with NaN and the samples of the rules absent; equal masks are shared. Throws Error for a parameter or
/// label that does not exist.
Dataset withAbsent(Dataset dataset, const std::vector<AbsentRule>& rules);

/// True for usual names of labels: region, material, label, id, zone, ... (also "regionId", "mat_id").
bool isLabelName(std::string_view name);

} // namespace tessera::volume
