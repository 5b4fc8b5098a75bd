#pragma once

#include "volume/field/dataset.h"

#include <string>
#include <string_view>
#include <vector>

/// Parts of parameters as rules state them.
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

/// The rule that states the parts of a parameter: "p=region:1|3", "T=joined".
std::string partsRule(const Parameter& parameter);

/// Sets the parts stated by rules, except "jumps" rules. Throws Error for a parameter, label or value that does not
/// exist, or a value in two parts. The last of several rules for a parameter is used.
void setParts(DatasetInfo& info, const std::vector<PartsRule>& rules);

/// Name of the label that a rule "p=jumps" creates (volume/import/data_jumps.h).
std::string jumpsLabel(const std::string& parameter);

} // namespace tessera::volume
