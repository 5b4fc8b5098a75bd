#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// The samples of a source as they are drawn: on the sheet of its axes (volume/field/axis_map.h), where every cell is
/// as long as any other. Places that are found in it are those of the sheet. A source with even axes is returned as it
/// is.
std::shared_ptr<const BrickSource> sheetSource(std::shared_ptr<const BrickSource> source);

} // namespace tessera::volume
