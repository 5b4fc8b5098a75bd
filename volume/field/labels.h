#pragma once

#include "volume/field/dataset.h"

#include <string>
#include <string_view>
#include <vector>

/// Names and colours of label values as users and files state them.
namespace tessera::volume {

/// One rule of ImportOptions::labels: "region:0=cathode,1=anode#e07b39,3=#888888".
struct LabelRule {
    std::string parameter;
    std::vector<Label> labels; ///< rising values; name or colour may be "": left as it is
    bool operator==(const LabelRule&) const = default;
};

/// Throws Error when the text is no rule: no parameter, no whole number, neither name nor colour, a value twice.
LabelRule parseLabelRule(std::string_view text);
/// A rule for these labels; names lose what a rule cannot hold (commas, '=', and '#' with six digits after it).
std::string toText(const LabelRule& rule);

/// "anode#e07b39" as a label; without a colour at its end all of it is the name.
Label labelOf(int value, std::string_view text);
/// The same backwards.
std::string labelText(const Label& label);

/// Names and colours the labels that rules state; values not known are added. Throws Error for a parameter that does
/// not exist or, with `samplesKnown`, is no label: its samples are then known to be no few whole numbers.
void applyLabels(DatasetInfo& info, const std::vector<LabelRule>& rules, bool samplesKnown = true);

} // namespace tessera::volume
