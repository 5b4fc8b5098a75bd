#include "codec/error_bound.h"

#include "codec/lossy_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::codec {

namespace {

/// Root of the mean of `squareOf(part, i)` over samples that it gives a number for.
template <class SquareOf> double rmsOf(const FrameSamples& samples, SquareOf&& squareOf) {
    double squares = 0, count = 0;
    samples.forSlabs([&](const volume::Field& part, Slab) {
        volume::dispatch(part.type, [&]<class T>(T) {
            const auto numbers = part.as<T>();
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                if (!part.present(i) || !std::isfinite(double(numbers[i]))) continue;
                squares += squareOf(numbers[i]), ++count;
            }
        });
        return true;
    });
    return count > 0 ? std::sqrt(squares / count) : 0;
}

double integerBoundForPsnr(const FrameSamples& samples, double wanted) {
    double bound = std::sqrt(3.0) * wanted; // as below, but the step is 1 at least
    for (int step = stepWithin(samples.type(), bound); step > 1; step = stepWithin(samples.type(), bound)) {
        const double rms = rmsOf(samples, [step](auto number) {
            const double apart = std::remainder(double(number), double(step));
            return apart * apart;
        });
        if (rms <= wanted) return bound;
        bound = std::min(step / 2 - 0.5, 0.97 * bound); // of large steps not one by one
    }
    return 0;
}

/// A bound on the error of stored numbers that gives at least `psnr` dB, found by trial on the frame itself: the error
/// of a quantised number is spread about evenly, so the first guess is rarely far off.
double boundForPsnr(const FrameSamples& samples, double extent, double psnr) {
    const double wanted = extent * std::pow(10.0, -psnr / 20);
    if (samples.type() != volume::ScalarType::F32) return integerBoundForPsnr(samples, wanted);
    double bound = std::sqrt(3.0) * wanted;
    for (int trial = 0; trial < 200; ++trial, bound *= 0.97) {
        const NumberCoding numbers = chooseCoding(samples, bound);
        if (numbers.kind != NumberKind::Quantised) return bound;
        const double rms = rmsOf(samples, [&](auto number) {
            const auto sample = static_cast<float>(number);
            const double error = double(sampleOf<float>(numbers, codeOf(numbers, sample))) - double(sample);
            return error * error;
        });
        if (rms <= wanted) return bound;
    }
    return 0;
}

} // namespace

double extentOf(const volume::Parameter& parameter) {
    double extent = 0;
    for (std::size_t c = 0; c < std::min(parameter.ranges.size(), std::size_t(parameter.components)); ++c)
        extent = std::max(extent, parameter.ranges[c].hi - parameter.ranges[c].lo);
    return extent;
}

double boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples) {
    if (parameter.categorical) return 0;
    double bound = std::numeric_limits<double>::infinity();
    const double scale = std::abs(samples.scale()), extent = extentOf(parameter);
    if (options.maxError > 0) bound = std::min(bound, options.maxError * extent / scale);
    if (options.absError > 0) bound = std::min(bound, options.absError / scale);
    if (options.psnr > 0) bound = std::min(bound, boundForPsnr(samples, extent / scale, options.psnr));
    return std::isfinite(bound) ? bound : 0;
}

} // namespace tessera::codec
