#pragma once

#include "codec/archive/archive.h"
#include "volume/field/dataset.h"

#include <memory>

namespace tessera::codec {

/// An archive as a data set of frames: on the stored lattice, in the stored type. To read slices, the brick layers that
/// contain them are decoded.
volume::Dataset storedDataset(std::shared_ptr<const Archive> archive);

} // namespace tessera::codec
