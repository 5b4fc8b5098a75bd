#pragma once

#include "codec/brick/frame_samples.h"
#include "codec/container/pack_options.h"
#include "volume/field/dataset.h"

#include <cstdint>

/// Rounding of a frame according to the packing options.
namespace tessera::codec {

/// The rounding of a frame.
struct FrameBound {
    double error = 0;      ///< largest absolute error of a sample in stored numbers; 0: exact
    std::int64_t step = 1; ///< for integers: they become multiples of it
};

/// The strictest of the requested bounds. A PSNR is converted by trial on the frame to the coarsest rounding that
/// reaches it; for integers to the largest step, odd or even.
FrameBound boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples);

} // namespace tessera::codec
