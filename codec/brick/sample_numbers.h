#pragma once

#include "codec/brick/frame_samples.h"
#include "codec/brick/numbers.h"

#include <limits>
#include <optional>

/// The coding of numbers that suits the samples of a frame.
namespace tessera::codec {

/// Of the finite present samples; lo > hi if there are none.
struct NumberRange {
    double lo = std::numeric_limits<double>::infinity(), hi = -std::numeric_limits<double>::infinity(),
           least = std::numeric_limits<double>::infinity(); ///< of floats: smallest magnitude
};
NumberRange rangeOf(const volume::Field& samples);

/// Exponents of the lowest and the highest bit that is set in any finite present sample; lowest > highest: in none.
/// Where they are too far apart for codes, those of some samples.
struct BitExtent {
    int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
};

/// What is known of the samples of a frame. Each is found when it is first asked for.
class SampleNumbers {
public:
    /// The samples must outlive this object, unchanged.
    explicit SampleNumbers(const FrameSamples& samples) : samples_(samples) {}

    const FrameSamples& samples() const { return samples_; }
    const NumberRange& range();
    /// Of floats.
    const BitExtent& bits();
    /// The coding of floats without a bound.
    const NumberCoding& lossless();

private:
    void survey();

    const FrameSamples& samples_;
    std::optional<NumberRange> range_;
    std::optional<BitExtent> bits_;
    std::optional<NumberCoding> lossless_;
};

/// Selects the coding of a frame. Integer types: Integer. f32 with `maxError` 0: Scaled if (almost) all present samples
/// are k / 10^d or k / 2^m with |k| <= 2^29, else Float. f32 with `maxError` > 0 (absolute, in stored units):
/// Quantised, with a step that leaves room for the rounding to float; lossless if the bound is below the resolution of
/// float.
NumberCoding chooseCoding(SampleNumbers& of, double maxError);
NumberCoding chooseCoding(const FrameSamples& samples, double maxError);

/// The coding by quantised coefficients with an error bound above 0; none if the bound is below the resolution of
/// floats, or codes would be too large. Of integers, what is decoded is within the bound after it is rounded.
std::optional<NumberCoding> steppedCoding(SampleNumbers& of, double maxError);
/// The same for samples of a range, whatever numbers they are; the bound is that of what is decoded before integers are
/// rounded.
std::optional<NumberCoding> steppedCoding(volume::ScalarType type, const NumberRange& range, double maxError);
/// The furthest that what is decoded may lie from an integer before it is rounded, if no integer may change by more
/// than `maxError`.
double reachOfIntegers(double maxError);
/// Width of |code| over samples of a range, in bits. For bounded codings.
int codeBitsOf(const NumberRange& range, const NumberCoding& coding);
/// The samples of a frame of floats that are present and finite, and the errors of rounding them.
struct RoundingErrors {
    double count = 0, squares = 0; ///< squares: sum; 0 if the coding is not Quantised
};
RoundingErrors roundingErrors(const FrameSamples& samples, const NumberCoding& coding);
/// The same of integers that are rounded to others at a coarser scale.
RoundingErrors roundingErrors(const FrameSamples& samples, const FrameSamples& rounded);

} // namespace tessera::codec
