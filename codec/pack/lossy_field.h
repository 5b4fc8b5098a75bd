#pragma once

#include "codec/brick/sample_numbers.h"
#include "codec/wavelet/lifting.h"
#include "codec/wavelet/threshold.h"
#include "volume/bricks/brick_grid.h"
#include "volume/field/dataset.h"
#include "volume/field/field.h"

#include <cstdint>
#include <span>
#include <vector>

/// Lossy preprocessing of a field that reduces the size of its code.
namespace tessera::codec {

/// Divides integers by a step, which offset and scale of the field compensate: every physical value stays within
/// `maxError` (in stored numbers) of the original, and 0 stays 0. The step depends only on the type and the bound. Not
/// for floats and labels.
volume::Field inSteps(volume::Field field, double maxError);
/// The same with a given step, for which stepFits must be true.
volume::Field countedIn(volume::Field field, std::int64_t step);
/// Whether integers from lo to hi stay within a type when rounded to multiples of a step.
bool stepFits(volume::ScalarType type, std::int64_t step, double lo, double hi);
/// The step of inSteps: at most 2 maxError + 1, such that no value leaves the range of the type.
int stepWithin(volume::ScalarType type, double maxError);

struct Thresholded {
    NumberCoding numbers;     ///< codes the result exactly
    double maxError = 0;      ///< largest absolute difference of a sample in stored numbers
    std::size_t weakened = 0; ///< number of bricks whose threshold was lowered to keep the bound
};

/// Thresholds the wavelet details of every brick of a frame. `value`: in stored numbers; for a quantile, the fraction
/// of details. It is multiplied by `strength` (0..1, per brick). If `maxError` is above 0, no sample changes by more:
/// the threshold of a brick is halved until that holds. Without a bound, floats are first rounded to 1/65536 of the
/// range of the field. Absent samples and floats without a rounded number are unchanged.
Thresholded giveUpDetails(const volume::BrickGrid& grid, FrameSamples& samples, Wavelet wavelet, Threshold kind,
                          double value, std::span<const float> strength, double maxError);

} // namespace tessera::codec
