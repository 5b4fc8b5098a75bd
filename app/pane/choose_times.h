#pragma once

#include "app/pane/tool_row.h"
#include "volume/field/dataset.h"
#include "volume/field/time_pair.h"

#include <string>
#include <vector>

/// Several times in one plot.
namespace tessera::app {

/// The chosen times that the data reach to, each once and in order; without any, the time shown.
std::vector<volume::TimePair> chosenTimes(const volume::DatasetInfo& info, const std::vector<double>& chosen,
                                          double shown);

/// What words on the origin of numbers say of chosen times: ", at 0.85 V and 0.6 V"; "" without any.
std::string chosenTimesText(const volume::DatasetInfo& info, const std::vector<double>& chosen, double shown);

/// A tool for data of several times: the time shown, all, or a tick for each. The time shown stays when others are
/// added to it.
void chooseTimes(ToolRow& tools, const volume::DatasetInfo& info, std::vector<double>& times, const Session& session);

} // namespace tessera::app
