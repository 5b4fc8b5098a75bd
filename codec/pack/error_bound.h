#pragma once

#include "codec/brick/frame_samples.h"
#include "codec/pack/pack.h"

#include <cstdint>

/// What the error bounds of pack mean for a frame.
namespace tessera::codec {

/// What a frame is rounded to.
struct FrameBound {
    double error = 0;      ///< largest of a sample, in stored numbers; 0: exact
    std::int64_t step = 1; ///< of integers: what they become multiples of
};

/// The strictest of the bounds asked for. One for a PSNR is found by trial on the frame: the coarsest rounding that
/// reaches it, for integers the largest step, odd or even, that some trials find.
FrameBound boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples);

} // namespace tessera::codec
