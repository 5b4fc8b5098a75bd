#pragma once

#include "codec/brick/frame_samples.h"
#include "codec/container/pack_options.h"
#include "volume/field/dataset.h"

#include <cstdint>

/// The error bounds of pack applied to a frame.
namespace tessera::codec {

/// How a frame is rounded.
struct FrameBound {
    double error = 0;      ///< largest of a sample, in stored numbers; 0: exact
    std::int64_t step = 1; ///< of integers: what they become multiples of
};

/// The strictest of the requested bounds. For a PSNR it is found by trial on the frame: the coarsest rounding that
/// reaches it; for integers the largest step, odd or even, found in a few trials.
FrameBound boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples);

} // namespace tessera::codec
