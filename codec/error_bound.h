#pragma once

#include "codec/frame_samples.h"
#include "codec/pack.h"

/// What the error bounds of pack mean for a frame.
namespace tessera::codec {

/// Extent of all components of a parameter: what an error relative to its range refers to.
double extentOf(const volume::Parameter& parameter);

/// The strictest of the bounds asked for, in stored numbers; 0: exact. One for a PSNR is found by trial on the frame.
double boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples);

} // namespace tessera::codec
