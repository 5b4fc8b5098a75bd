#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

/// Data with another time axis: a quantity over time, such as a voltage, instead of the times.
namespace tessera::volume {

/// Description of the data on another axis, and the original index of each of its times.
struct OtherAxis {
    DatasetInfo info;
    std::vector<int> order; ///< time k was time order[k]
};

/// Uses a quantity as the time axis: times become its values in rising order, and the old times become a quantity.
/// Empty if there is no such quantity, one of its values is unknown, or it is not strictly monotonic.
std::optional<OtherAxis> axisBy(const DatasetInfo& info, std::string_view quantity);

/// The same samples on that axis.
Dataset onAxis(Dataset dataset, const OtherAxis& axis);
std::shared_ptr<const BrickSource> onAxis(std::shared_ptr<const BrickSource> source, OtherAxis axis);

} // namespace tessera::volume
