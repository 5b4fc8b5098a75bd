#include "codec/pack/error_bound.h"

#include "codec/pack/lossy_field.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace tessera::codec {

namespace {

/// Square root of the mean of `squareOf(part, i)` over the samples for which it returns a number.
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

/// The largest step with an RMS error of at most `wanted`, among all small steps and some larger ones (0.14 dB apart).
/// Searches up to four times that error.
std::int64_t largestStep(volume::ScalarType type, NumberCounts& counts, double wanted) {
    constexpr std::int64_t kMost = 1 << 29, kEvery = 64;
    constexpr double kFar = 4;
    const double reach = std::max(std::abs(counts.least()), std::abs(counts.most()));
    std::int64_t best = 1;
    for (std::int64_t step = 2; step < kMost && double(step) <= 2 * reach; step += 1 + step / kEvery) {
        const double rms = counts.rms(step);
        if (rms > kFar * wanted) break;
        if (rms <= wanted && stepFits(type, step, counts.least(), counts.most())) best = step;
    }
    return best;
}

FrameBound integerBoundForPsnr(const FrameSamples& samples, std::optional<NumberCounts>& counts, double wanted) {
    if (!counts) counts.emplace(samples);
    const std::int64_t step = largestStep(samples.type(), *counts, wanted);
    const std::int64_t farthest = step / 2; // of an integer from the nearest multiple
    return {double(farthest), step};
}

/// The largest error bound for floats with an RMS error of at most `wanted`, by trial on the frame: if many samples are
/// multiples of any step, as in a background, it is far larger than for uniformly distributed errors.
double floatBoundForPsnr(const FrameSamples& samples, double wanted, double extent) {
    constexpr int kTrials = 40;
    constexpr double kClose = 0.97,
                     kLargestStep =
                         16; // lower end of the accepted error, as a fraction (0.26 dB); largest factor between trials
    double bound = std::sqrt(3.0) * wanted, above = std::numeric_limits<double>::infinity(), best = 0;
    SampleNumbers known(samples);
    for (int trial = 0; trial < kTrials && bound > 0; ++trial) {
        const NumberCoding numbers = chooseCoding(known, bound);
        const double rms = numbers.kind != NumberKind::Quantised ? 0 : rmsOf(samples, [&](auto number) {
            const auto sample = static_cast<float>(number);
            const double error = double(sampleOf<float>(numbers, codeOf(numbers, sample))) - double(sample);
            return error * error;
        });
        if (rms <= wanted) {
            best = std::max(best, bound);
            if (rms >= kClose * wanted || bound >= extent || numbers.kind != NumberKind::Quantised) break;
        } else {
            above = std::min(above, bound);
        }
        if (std::isfinite(above) && best >= 0.995 * above) break;
        double next =
            bound * (rms > 0 ? std::clamp(0.985 * wanted / rms, 1 / kLargestStep, kLargestStep) : kLargestStep);
        if (next >= above || next <= best) next = best > 0 ? (best + std::min(above, 2 * extent)) / 2 : above / 2;
        bound = std::min(next, extent);
    }
    return best;
}

FrameBound boundForPsnr(const FrameSamples& samples, std::optional<NumberCounts>& counts, double extent, double psnr) {
    const double wanted = extent * std::pow(10.0, -psnr / 20);
    if (samples.type() != volume::ScalarType::F32) return integerBoundForPsnr(samples, counts, wanted);
    return {floatBoundForPsnr(samples, wanted, extent), 1};
}

} // namespace

/// For 32-bit types with many different numbers, a representative part of the samples is counted.
NumberCounts::NumberCounts(const FrameSamples& samples) {
    constexpr std::size_t kMost = 1 << 20; // 32-bit samples examined
    const std::size_t stride = samples.type() == volume::ScalarType::I32 ? samples.count() / kMost + 1 : 1;
    std::map<double, double> wide;
    std::vector<double> narrow(1 << 17, 0);
    constexpr int kZero = 1 << 16; // index of 0 for the narrow types
    double lo = 0, hi = 0;
    samples.forSlabs([&](const volume::Field& part, Slab) {
        volume::dispatch(part.type, [&]<class T>(T) {
            if constexpr (!std::same_as<T, float>) {
                const auto numbers = part.as<T>();
                for (std::size_t i = 0; i < numbers.size(); ++i) {
                    if (!part.present(i)) continue;
                    const auto number = std::int64_t(numbers[i]);
                    if constexpr (sizeof(T) > 2) {
                        lo = std::min(lo, double(number)), hi = std::max(hi, double(number));
                        if (i % stride == 0) wide[double(number)] += 1;
                    } else {
                        narrow[std::size_t(number + kZero)] += 1;
                    }
                }
            }
        });
        return true;
    });
    for (const double end : {lo, hi})
        if (end != 0) wide.try_emplace(end, 0);
    counts_.assign(wide.begin(), wide.end());
    for (std::size_t i = 0; i < narrow.size(); ++i)
        if (narrow[i] > 0) counts_.emplace_back(double(i) - kZero, narrow[i]);
    for (const auto& [number, count] : counts_) samples_ += count;
}

double NumberCounts::rms(std::int64_t step) {
    if (const auto known = rms_.find(step); known != rms_.end()) return known->second;
    double squares = 0;
    std::int64_t over = 0, last = 0; // the last number lies `over` above a multiple of the step
    for (const auto& [number, count] : counts_) {
        const auto whole = std::int64_t(number);
        over += whole - last;
        last = whole;
        if (over >= step) over -= step;
        if (over < 0 || over >= step) over = (over % step + step) % step; // numbers far apart
        const auto apart = double(std::min(over, step - over));
        squares += count * apart * apart;
    }
    return rms_[step] = samples_ > 0 ? std::sqrt(squares / samples_) : 0;
}

volume::Parameter boundedBy(const PackOptions& options, const volume::Parameter& parameter, std::size_t component) {
    volume::Parameter of = parameter;
    if (options.ofComponents && component < parameter.ranges.size()) {
        of.components = 1;
        of.ranges = {parameter.ranges[component]};
    }
    return of;
}

FrameBound boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples) {
    std::optional<NumberCounts> counts;
    return boundFor(options, parameter, samples, counts);
}

FrameBound boundFor(const PackOptions& options, const volume::Parameter& parameter, const FrameSamples& samples,
                    std::optional<NumberCounts>& counts) {
    if (parameter.categorical) return {};
    double error = std::numeric_limits<double>::infinity();
    const double scale = std::abs(samples.scale()), extent = extentOf(parameter);
    if (options.maxError > 0) error = std::min(error, options.maxError * extent / scale);
    if (options.absError > 0) error = std::min(error, options.absError / scale);
    const FrameBound stated{error, stepWithin(samples.type(), error)};
    if (!(options.psnr > 0)) return std::isfinite(error) ? stated : FrameBound();
    FrameBound bound = boundForPsnr(samples, counts, extent / scale, options.psnr);
    const bool isFloat = samples.type() == volume::ScalarType::F32;
    const bool stricter = isFloat ? stated.error < bound.error : stated.step < bound.step;
    const double rms = extent / scale * std::pow(10.0, -options.psnr / 20);
    if (std::isfinite(error) && stricter) bound = stated;
    const double furthest = isFloat ? error : std::floor(error);
    if (furthest > rms) bound.rms = rms, bound.mostError = furthest; // a smaller error keeps the mean by itself
    return bound;
}

} // namespace tessera::codec
