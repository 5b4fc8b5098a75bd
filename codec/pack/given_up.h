#pragma once

#include "codec/archive/frame_options.h"
#include "codec/container/pack_options.h"
#include "codec/pack/lossy_field.h"

#include <cstdint>
#include <vector>

/// What a frame gives up on request: details below a threshold, and bricks of little importance.
namespace tessera::codec {

/// Thresholds the details of a frame, most strongly in the least important bricks. `extent`: of the range of the
/// parameter.
Thresholded giveUp(FrameSamples& samples, const volume::BrickGrid& grid, const FrameOptions& frame,
                   const ThresholdOptions& options, double extent);

/// Marks every sample of the omitted bricks, a flag each, as absent.
void leaveOut(FrameSamples& samples, const volume::BrickGrid& grid, const std::vector<std::uint8_t>& discarded);

} // namespace tessera::codec
