#pragma once

#include "codec/brick/frame_samples.h"
#include "codec/container/growing_file.h"
#include "codec/container/index.h"
#include "volume/bricks/brick_grid.h"

namespace tessera::codec {

/// Codes which samples of a frame are present, brick by brick, and appends that to a file. Throws MachineError.
MaskRecord writeMask(const FrameSamples& samples, const volume::BrickGrid& grid, int zstdLevel, GrowingFile& file);

} // namespace tessera::codec
