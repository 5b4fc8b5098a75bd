#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/labels.h"

#include <memory>

namespace tessera::volume {

/// The source with names and colours of label values as stated; without rules the source itself. Throws Error
/// (applyLabels).
std::shared_ptr<const BrickSource> withLabelNames(std::shared_ptr<const BrickSource> source,
                                                  const std::vector<std::string>& rules);

} // namespace tessera::volume
