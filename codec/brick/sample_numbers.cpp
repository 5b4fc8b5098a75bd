#include "codec/brick/sample_numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <span>
#include <utility>
#include <vector>

namespace tessera::codec {

namespace {

/// Calls `visit` for every present sample until it returns false.
template <class Visit> void forPresent(const volume::Field& part, Visit&& visit) {
    const auto samples = part.as<float>();
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (part.present(i) && !visit(samples[i])) return;
}

/// Whether numbers stand for samples: too many failures in all, or among those up to any sample, end it.
class Reproduction {
public:
    explicit Reproduction(const NumberCoding& coding) : coding_(coding) {}

    /// False once there are too many failures, whatever `before` came before.
    bool add(float sample, std::int64_t before = 0) {
        ++part_.seen;
        if (!close(coding_, 0, sample, sampleOf<float>(coding_, codeOf(coding_, sample)))) ++part_.failed;
        part_.most = std::max(part_.most, kWeight * part_.failed - part_.seen);
        return part_.most - before <= kLeast;
    }
    struct Part {
        std::int64_t seen = 0, failed = 0,
                     most = 0; ///< largest of kWeight failed - seen up to any sample
    };
    const Part& part() const { return part_; }
    /// Of consecutive parts.
    static bool holds(std::span<const Part> parts) {
        Part all;
        for (const Part& part : parts) {
            all.most = std::max(all.most, kWeight * all.failed - all.seen + part.most);
            all.seen += part.seen, all.failed += part.failed;
        }
        return all.most <= kLeast && all.seen > 0 && all.failed * kAllowed <= all.seen;
    }

private:
    static constexpr std::int64_t kWeight = 64, kLeast = 4096, kAllowed = 256;
    NumberCoding coding_;
    Part part_;
};

bool reproduces(std::span<const float> samples, const NumberCoding& coding) {
    Reproduction own(coding);
    for (const float sample : samples)
        if (!own.add(sample)) break;
    return Reproduction::holds({&own.part(), 1});
}

bool reproduces(const FrameSamples& samples, const NumberCoding& coding) {
    const auto ofPart = [&](const volume::Field& part, Slab slab) {
        const auto perSlice = std::int64_t(part.count()) / std::max(part.lattice.size.z, 1);
        Reproduction own(coding);
        forPresent(part, [&](float sample) { return own.add(sample, perSlice * slab.first); });
        return own.part();
    };
    return Reproduction::holds(samples.ofSlabs<Reproduction::Part>("exact", ofPart));
}

/// Every so many-th of the samples, those that are present: some thousand.
std::vector<float> probe(const FrameSamples& samples) {
    const std::size_t stride = std::max<std::size_t>(1, samples.count() / 4096);
    std::vector<float> some;
    for (std::size_t i = 0; i < samples.count(); i += stride) {
        float sample = 0;
        std::uint8_t present = 1;
        samples.read(i, 1, reinterpret_cast<std::byte*>(&sample), &present);
        if (present != 0) some.push_back(sample);
    }
    return some;
}

bool fits(const BitExtent& bits) {
    return bits.highest < bits.lowest || bits.highest - bits.lowest <= 29;
}

BitExtent bitsOf(const volume::Field& part) {
    BitExtent all;
    forPresent(part, [&](float sample) {
        if (sample == 0 || !std::isfinite(sample)) return true;
        const auto word = std::bit_cast<std::uint32_t>(sample) & 0x7fffffffu, exponent = word >> 23;
        const std::uint32_t digits = (word & 0x7fffffu) | (exponent > 0 ? 1u << 23 : 0u);
        const int place = std::max(int(exponent), 1) - 150; // of the last digit
        all.lowest = std::min(all.lowest, place + std::countr_zero(digits));
        all.highest = std::max(all.highest, place + int(std::bit_width(digits)));
        return fits(all);
    });
    return all;
}

/// k / 2^m, with m from the lowest bit set in any finite sample, if the largest k is below 2^29.
std::optional<NumberCoding> binaryFractions(const BitExtent& bits) {
    if (!fits(bits) || bits.highest < bits.lowest) return std::nullopt;
    return NumberCoding{NumberKind::Scaled, 0, std::ldexp(1.0, -bits.lowest)};
}

/// Selects k / 10^d or k / 2^m, whichever has smaller k; with enough digits every float is a decimal fraction.
NumberCoding chooseLossless(const FrameSamples& samples, const BitExtent& bits) {
    std::optional<NumberCoding> best = binaryFractions(bits);
    if (best && !reproduces(samples, *best)) best.reset();
    const std::vector<float> some = probe(samples);
    double power = 1;
    for (int digits = 0; digits <= 7 && (!best || power < best->step); ++digits, power *= 10) {
        const NumberCoding decimal{NumberKind::Scaled, 0, power};
        if (reproduces(some, decimal) && reproduces(samples, decimal)) return decimal;
    }
    return best.value_or(NumberCoding{NumberKind::Float, 0, 1});
}

std::optional<NumberCoding> chooseQuantised(const NumberRange& range, double maxError) {
    const double lo = range.lo, hi = range.hi;
    if (!(lo <= hi)) return std::nullopt;
    const double largest = std::max(std::abs(lo), std::abs(hi));
    const auto rounded = static_cast<float>(largest);
    const double ulp = double(std::nextafter(rounded, std::numeric_limits<float>::infinity())) - double(rounded);
    NumberCoding coding{NumberKind::Quantised, lo <= 0 && hi >= 0 ? 0.0 : (lo + hi) / 2, 2 * (maxError - ulp)};
    if (!(coding.step > 0) || !std::isfinite(coding.step)) return std::nullopt;
    if (std::max(hi - coding.origin, coding.origin - lo) / coding.step > kLargestCode) return std::nullopt;
    return coding;
}

/// Spacing of numbers k / 10^d or k / 2^m if the samples are such; 0 if they are not, or it is far below the bound.
double spacingOf(SampleNumbers& of, double maxError) {
    constexpr double kFar = 16;
    const NumberCoding exact = of.lossless();
    return exact.kind == NumberKind::Scaled && maxError * exact.step < kFar ? 1 / exact.step : 0;
}

/// The largest odd multiple of a spacing such that samples at this spacing round to multiples of it within the bound.
/// Decimal fractions are not floats: `safeError` is the bound less the error of rounding to floats.
double multipleWithin(double spacing, double maxError, double safeError) {
    if (!(spacing > 0)) return 0;
    int exponent = 0;
    const bool isBinary = std::frexp(spacing, &exponent) == 0.5;
    return (2 * std::floor((isBinary ? maxError : safeError) / spacing) + 1) * spacing;
}

} // namespace

namespace {

template <class T> NumberRange rangeOfIntegers(const volume::Field& part) {
    T lo = std::numeric_limits<T>::max(), hi = std::numeric_limits<T>::lowest();
    const auto samples = part.as<T>();
    if (part.mask && std::ranges::none_of(*part.mask, [](std::uint8_t flag) { return flag != 0; })) return {};
    if (samples.empty()) return {};
    if (!part.mask)
        for (const T sample : samples) lo = std::min(lo, sample), hi = std::max(hi, sample);
    else
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (part.present(i)) lo = std::min(lo, samples[i]), hi = std::max(hi, samples[i]);
    return {double(lo), double(hi), 0};
}

NumberRange rangeOfFloats(const volume::Field& part) {
    struct {
        float lo = std::numeric_limits<float>::infinity(), hi = -std::numeric_limits<float>::infinity(),
              least = std::numeric_limits<float>::infinity();
    } const none;
    constexpr std::size_t kLanes = 16; // so that the loop is vectorised
    std::array<float, kLanes> lo, hi, least;
    lo.fill(none.lo), hi.fill(none.hi), least.fill(none.least);
    const auto add = [&](std::size_t lane, float sample) {
        const float size = std::abs(sample);
        const bool finite = size <= std::numeric_limits<float>::max();
        lo[lane] = finite && sample < lo[lane] ? sample : lo[lane];
        hi[lane] = finite && sample > hi[lane] ? sample : hi[lane];
        least[lane] = finite && size < least[lane] ? size : least[lane];
    };
    const auto samples = part.as<float>();
    std::size_t i = 0;
    if (!part.mask)
        for (; i + kLanes <= samples.size(); i += kLanes)
            for (std::size_t lane = 0; lane < kLanes; ++lane) add(lane, samples[i + lane]);
    for (; i < samples.size(); ++i)
        if (part.present(i)) add(0, samples[i]);
    return {double(*std::ranges::min_element(lo)), double(*std::ranges::max_element(hi)),
            double(*std::ranges::min_element(least))};
}

} // namespace

NumberRange rangeOf(const volume::Field& part) {
    return volume::dispatch(part.type, [&]<class T>(T) {
        if constexpr (std::same_as<T, float>)
            return rangeOfFloats(part);
        else
            return rangeOfIntegers<T>(part);
    });
}

void SampleNumbers::survey() {
    struct Both {
        NumberRange range;
        BitExtent bits;
    };
    const bool isFloat = samples_.type() == volume::ScalarType::F32;
    range_.emplace(), bits_.emplace();
    for (const auto& [range, bits] : samples_.ofSlabs<Both>("numbers", [&](const volume::Field&part, Slab) {
             return Both{rangeOf(part), isFloat ? bitsOf(part) : BitExtent()};
         })) {
        range_ = {std::min(range_->lo, range.lo), std::max(range_->hi, range.hi), std::min(range_->least, range.least)};
        bits_ = {std::min(bits_->lowest, bits.lowest), std::max(bits_->highest, bits.highest)};
    }
}

const NumberRange& SampleNumbers::range() {
    if (!range_) survey();
    return *range_;
}

const BitExtent& SampleNumbers::bits() {
    if (!bits_) survey();
    return *bits_;
}

const NumberCoding& SampleNumbers::lossless() {
    if (!lossless_) lossless_ = chooseLossless(samples_, bits());
    return *lossless_;
}

NumberCoding chooseCoding(const FrameSamples& samples, double maxError) {
    SampleNumbers of(samples);
    return chooseCoding(of, maxError);
}

NumberCoding chooseCoding(SampleNumbers& of, double maxError) {
    if (of.samples().type() != volume::ScalarType::F32) return {};
    if (maxError > 0)
        if (const auto quantised = chooseQuantised(of.range(), maxError)) {
            // Numbers that lie on a grid already need no more codes than the grid has points.
            const double step = multipleWithin(spacingOf(of, maxError), maxError, quantised->step / 2);
            return step > quantised->step ? NumberCoding{NumberKind::Quantised, 0, step} : *quantised;
        }
    return of.lossless();
}

double reachOfIntegers(double maxError) {
    return std::floor(maxError) + 0.5;
}

namespace {

/// The origin is an integer, so that with a reach of n + 1/2 the code of an integer is never half a step from it, since
/// a step is an odd number of 33rds: what is decoded stays 1/66 nearer than the reach.
std::optional<NumberCoding> steppedIntegers(const NumberRange& range, double reach) {
    if (!(range.lo <= range.hi)) return std::nullopt;
    const double origin = range.lo <= 0 && range.hi >= 0 ? 0.0 : std::floor((range.lo + range.hi) / 2);
    const NumberCoding coding{NumberKind::Stepped, origin, 2 * reach / (2 * kReach + 1)};
    if (!(coding.step > 0) || !std::isfinite(coding.step)) return std::nullopt;
    if (std::max(range.hi - origin, origin - range.lo) / coding.step > kLargestCode) return std::nullopt;
    return coding;
}

} // namespace

std::optional<NumberCoding> steppedCoding(SampleNumbers& of, double maxError) {
    const NumberRange& range = of.range();
    if (of.samples().type() != volume::ScalarType::F32) return steppedIntegers(range, reachOfIntegers(maxError));
    const std::optional<NumberCoding> quantised = chooseQuantised(range, maxError);
    if (!quantised) return std::nullopt;
    double step = quantised->step;
    // Where floats are no denser than the samples, rounding to floats takes off up to half of their distance.
    const double spacing = spacingOf(of, maxError);
    const auto least = static_cast<float>(range.least);
    const double apart = double(std::nextafter(least, std::numeric_limits<float>::infinity())) - double(least);
    if (spacing > 0 && spacing <= apart) step = std::max(step, multipleWithin(spacing, maxError, quantised->step / 2));
    return NumberCoding{NumberKind::Stepped, quantised->origin, step / (2 * kReach + 1)};
}

std::optional<NumberCoding> steppedCoding(volume::ScalarType type, const NumberRange& range, double maxError) {
    if (type != volume::ScalarType::F32) return steppedIntegers(range, maxError);
    const std::optional<NumberCoding> quantised = chooseQuantised(range, maxError);
    if (!quantised) return std::nullopt;
    return NumberCoding{NumberKind::Stepped, quantised->origin, quantised->step / (2 * kReach + 1)};
}

int codeBitsOf(const NumberRange& range, const NumberCoding& coding) {
    std::uint32_t all = 0;
    for (const double end : {range.lo, range.hi}) {
        const std::uint32_t code = codeOf(coding, end);
        all |= code ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(code) >> 31);
    }
    return std::max(1, int(std::bit_width(all)) + 1);
}

RoundingErrors roundingErrors(const FrameSamples& samples, const NumberCoding& coding) {
    RoundingErrors sum;
    samples.forSlabs([&](const volume::Field& part, Slab) {
        forPresent(part, [&](float sample) {
            if (!std::isfinite(sample)) return true;
            ++sum.count;
            if (coding.kind != NumberKind::Quantised) return true;
            const double apart = double(sampleOf<float>(coding, codeOf(coding, sample))) - double(sample);
            sum.squares += apart * apart;
            return true;
        });
        return true;
    });
    return sum;
}

RoundingErrors roundingErrors(const FrameSamples& samples, const FrameSamples& rounded) {
    RoundingErrors sum;
    const double times = rounded.scale() / samples.scale();
    volume::Field after;
    samples.forSlabs([&](const volume::Field& part, Slab slab) {
        rounded.take(slab.first, slab.count, after);
        volume::dispatch(part.type, [&]<class T>(T) {
            const auto from = part.as<T>(), to = std::as_const(after).as<T>();
            for (std::size_t i = 0; i < from.size(); ++i) {
                if (!part.present(i)) continue;
                const double apart = double(to[i]) * times - double(from[i]);
                ++sum.count;
                sum.squares += apart * apart;
            }
        });
        return true;
    });
    return sum;
}

} // namespace tessera::codec
