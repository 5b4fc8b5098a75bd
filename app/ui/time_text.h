#pragma once

#include "volume/field/dataset.h"

#include <string>
#include <string_view>
#include <vector>

/// Text of a time of a data set: the name and unit of its axis, with the quantities over time. Does not use ImGui.
namespace tessera::app {

/// "t = 0.26 s", "operating point 11", "voltage 0.62 V".
std::string timeText(const volume::DatasetInfo& info, double time);
/// The value and unit alone: "0.26 s".
std::string timeValueText(const volume::DatasetInfo& info, double time);
/// Title of an axis of times: "t [s]", "operating point".
std::string timeTitle(const volume::DatasetInfo& info);
/// The same without its unit: "t" for time.
std::string timeWord(const volume::DatasetInfo& info);

/// Quantities at a time, those that are known: "0.62 V, 17 439 A/m²"; one without a unit by its name. `first` comes
/// first; at most `most` of them.
std::string quantitiesText(const volume::DatasetInfo& info, double time, std::string_view first = {},
                           std::size_t most = 4);
/// Both: "t = 0.26 s   0.62 V, 17 439 A/m²".
std::string stateText(const volume::DatasetInfo& info, double time, std::string_view first = {});
/// Names of times in a legend, one for each: "0.26 s, 0.40 V" with the first quantity that has a unit; where the axis
/// of times has no unit, the quantity alone if it tells them apart: "0.85 V".
std::vector<std::string> stateNames(const volume::DatasetInfo& info, const std::vector<double>& times);
/// A value with five significant digits and groups of thousands: "17 439", "0.62".
std::string groupedNumber(double value);

} // namespace tessera::app
