#pragma once

#include "volume/field/dataset.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Parameters recognised by name and unit: velocity, density, the label of regions.
namespace tessera::volume {

/// Channels of the components of a vector parameter by name; "" finds the velocity: the first vector in m/s (or of
/// length per time), else one named U, u, v, vel or velocity. Nothing where there is none.
std::optional<std::array<int, 3>> velocityChannels(const DatasetInfo& info, const std::string& name = {});

/// How far a vector moves what it carries.
struct FlowUnits {
    double perTime = 1;  ///< lengths of the data in one unit of its times, by a vector of 1
    bool stated = false; ///< false: units of lengths, times and the vector do not say it, so that 1 is assumed
};
/// Of a vector parameter of a data set: 1000 for m/s, mm and s.
FlowUnits flowUnits(const DatasetInfo& info, const Parameter& vector);

/// The same in words: "1 m/s = 1000 mm per s"; where it is assumed, why.
std::string flowUnitsText(const DatasetInfo& info, const Parameter& vector);

/// Channel of the density: a scalar named rho, density or Density, in kg/m3 where it has a unit.
std::optional<int> densityChannel(const DatasetInfo& info);

/// Channel of a categorical parameter by name; "" finds the first one.
std::optional<int> labelChannel(const DatasetInfo& info, const std::string& name = {});

/// The names of all channels, "O2, T, U.x", for a message about one that is not there.
std::string channelNames(const DatasetInfo& info);

/// The parameter a channel belongs to.
const Parameter& parameterOf(const DatasetInfo& info, int channel);

/// The name of a label value: what the data state, else the name of the label and the value, "region 3".
std::string labelName(const Parameter& label, int value);

/// A label value by its name or number. Empty if the data have neither.
std::optional<int> labelValue(const Parameter& label, const std::string& nameOrNumber);

} // namespace tessera::volume
