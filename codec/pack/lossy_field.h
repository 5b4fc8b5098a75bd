#pragma once

#include "codec/brick/numbers.h"
#include "codec/wavelet/lifting.h"
#include "codec/wavelet/threshold.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/field.h"

#include <cstdint>
#include <span>
#include <vector>

/// What is given up of a field before it is coded: fields that look nearly the same and take fewer bytes.
namespace tessera::codec {

/// A field of integers whose numbers are counted in steps, which its offset and scale undo: every physical value within
/// `maxError` (in stored numbers) of what it was. 0 stays 0. The step depends on the type and the bound alone. Floats
/// and labels are not for this.
volume::Field inSteps(volume::Field field, double maxError);
/// The same with any step that stepFits.
volume::Field countedIn(volume::Field field, std::int64_t step);
/// Whether whole numbers from lo to hi, of a type, stay within it when they are rounded to multiples of a step.
bool stepFits(volume::ScalarType type, std::int64_t step, double lo, double hi);
/// The step inSteps takes: at most 2 maxError + 1, and such that no value leaves the type.
int stepWithin(volume::ScalarType type, double maxError);

struct Thresholded {
    NumberCoding numbers;     ///< that code it exactly
    double maxError = 0;      ///< largest |difference| of a sample, in stored numbers
    std::size_t weakened = 0; ///< bricks whose threshold was lowered to keep the bound
};

/// Gives up details of every brick of a frame. `value`: in stored numbers, of a quantile the part of the details; a
/// brick gets `strength` (0..1, by brick) of it. Where `maxError` is above 0 no sample moves further: the threshold of
/// a brick is halved until it does not. Without a bound floats are rounded to 1/65536 of the range of the field first.
/// Absent samples, and floats no rounded number stands for, stay as they are.
Thresholded giveUpDetails(const volume::BrickGrid& grid, FrameSamples& samples, Wavelet wavelet, Threshold kind,
                          double value, std::span<const float> strength, double maxError);

} // namespace tessera::codec
