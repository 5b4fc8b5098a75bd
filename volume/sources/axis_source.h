#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

/// Data whose times are counted otherwise: by a voltage in place of seconds.
namespace tessera::volume {

/// What is known of data on another axis, and where each of its times was before.
struct OtherAxis {
    DatasetInfo info;
    std::vector<int> order; ///< time k was time order[k]
};

/// With a quantity in place of the times: they are its values, rising; the times become a quantity. Nothing where there
/// is no such quantity, one of its values is not known, or it does not rise or fall all the time.
std::optional<OtherAxis> axisBy(const DatasetInfo& info, std::string_view quantity);

/// The same samples on that axis.
Dataset onAxis(Dataset dataset, const OtherAxis& axis);
std::shared_ptr<const BrickSource> onAxis(std::shared_ptr<const BrickSource> source, OtherAxis axis);

} // namespace tessera::volume
