#include "codec/brick/numbers.h"

#include "codec/wavelet/lifting.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace tessera::codec {

namespace {

constexpr double kLargestCode = 1 << 29; // two bits remain for the growth of sums in the wavelets

std::uint32_t clampedCode(double k) {
    if (!(std::abs(k) <= kLargestCode)) return 0; // includes NaN: stored exactly in addition
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::rint(k)));
}

/// Calls `visit` for every `stride`-th present sample until it returns false.
template <class Visit> bool all(const FrameSamples& frame, std::size_t stride, Visit&& visit) {
    std::size_t begin = 0, next = 0; // first sample of the slab; next sample to visit
    return frame.forSlabs([&](const volume::Field& part, Slab) {
        const auto samples = part.as<float>();
        for (; next < begin + samples.size(); next += stride)
            if (part.present(next - begin) && !visit(samples[next - begin])) return false;
        begin += samples.size();
        return true;
    });
}

bool reproduces(const FrameSamples& samples, const NumberCoding& coding, std::size_t stride) {
    std::size_t seen = 0, failed = 0;
    const bool within = all(samples, stride, [&](float sample) {
        ++seen;
        if (!close(coding, 0, sample, sampleOf<float>(coding, codeOf(coding, sample)))) ++failed;
        return failed * 64 <= seen + 4096;
    });
    return within && seen > 0 && failed * 256 <= seen;
}

/// k / 2^m, with m from the lowest bit set in any finite sample, if the largest k is below 2^29.
std::optional<NumberCoding> binaryFractions(const FrameSamples& samples) {
    int lowest = std::numeric_limits<int>::max(), highest = std::numeric_limits<int>::min();
    const bool fits = all(samples, 1, [&](float sample) {
        if (sample == 0 || !std::isfinite(sample)) return true;
        int exponent = 0;
        const auto mantissa = static_cast<std::uint32_t>(std::ldexp(std::frexp(std::abs(sample), &exponent), 24));
        highest = std::max(highest, exponent);
        lowest = std::min(lowest, exponent - 24 + std::countr_zero(mantissa));
        return highest - lowest <= 29;
    });
    if (!fits || highest < lowest) return std::nullopt;
    return NumberCoding{NumberKind::Scaled, 0, std::ldexp(1.0, -lowest)};
}

/// Selects k / 10^d or k / 2^m, whichever has smaller k; with enough digits every float is a decimal fraction.
NumberCoding chooseLossless(const FrameSamples& samples) {
    const std::size_t stride = std::max<std::size_t>(1, samples.count() / 4096);
    std::optional<NumberCoding> best = binaryFractions(samples);
    if (best && !reproduces(samples, *best, 1)) best.reset();
    double power = 1;
    for (int digits = 0; digits <= 7 && (!best || power < best->step); ++digits, power *= 10) {
        const NumberCoding decimal{NumberKind::Scaled, 0, power};
        if (reproduces(samples, decimal, stride) && reproduces(samples, decimal, 1)) return decimal;
    }
    return best.value_or(NumberCoding{NumberKind::Float, 0, 1});
}

std::optional<NumberCoding> chooseQuantised(const FloatRange& range, double maxError) {
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
double spacingOf(const FrameSamples& samples, double maxError) {
    constexpr double kFar = 16;
    const NumberCoding exact = chooseLossless(samples);
    return exact.kind == NumberKind::Scaled && maxError * exact.step < kFar ? 1 / exact.step : 0;
}

FloatRange rangeOf(const volume::Field& part) {
    constexpr std::size_t kLanes = 16; // so that the loop is vectorised
    std::array<float, kLanes> lo, hi, least;
    lo.fill(FloatRange().lo), hi.fill(FloatRange().hi), least.fill(FloatRange().least);
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
    return {*std::ranges::min_element(lo), *std::ranges::max_element(hi), *std::ranges::min_element(least)};
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

FloatRange floatRangeOf(const FrameSamples& frame) {
    FloatRange all;
    for (const FloatRange& part : frame.ofSlabs<FloatRange>(
             "range", [](const volume::Field& part, Slab) { return rangeOf(part); }))
        all = {std::min(all.lo, part.lo), std::max(all.hi, part.hi), std::min(all.least, part.least)};
    return all;
}

NumberCoding chooseCoding(const FrameSamples& samples, double maxError) {
    if (samples.type() != volume::ScalarType::F32) return {};
    if (maxError > 0)
        if (const auto quantised = chooseQuantised(floatRangeOf(samples), maxError)) {
            // Numbers that lie on a grid already need no more codes than the grid has points.
            const double step = multipleWithin(spacingOf(samples, maxError), maxError, quantised->step / 2);
            return step > quantised->step ? NumberCoding{NumberKind::Quantised, 0, step} : *quantised;
        }
    return chooseLossless(samples);
}

std::optional<NumberCoding> steppedCoding(const FrameSamples& samples, double maxError) {
    const FloatRange range = floatRangeOf(samples);
    const std::optional<NumberCoding> quantised = chooseQuantised(range, maxError);
    if (!quantised) return std::nullopt;
    double step = quantised->step;
    // Where floats are no denser than the samples, rounding to floats takes off up to half of their distance.
    const double spacing = spacingOf(samples, maxError);
    const float least = range.least;
    const double apart = double(std::nextafter(least, std::numeric_limits<float>::infinity())) - double(least);
    if (spacing > 0 && spacing <= apart) step = std::max(step, multipleWithin(spacing, maxError, quantised->step / 2));
    return NumberCoding{NumberKind::Stepped, quantised->origin, step / (2 * kReach + 1)};
}

std::optional<NumberCoding> steppedCoding(const FloatRange& range, double maxError) {
    const std::optional<NumberCoding> quantised = chooseQuantised(range, maxError);
    if (!quantised) return std::nullopt;
    return NumberCoding{NumberKind::Stepped, quantised->origin, quantised->step / (2 * kReach + 1)};
}

int codeBitsOf(const FloatRange& range, const NumberCoding& coding) {
    std::uint32_t all = 0;
    for (const float end : {range.lo, range.hi}) {
        const std::uint32_t code = codeOf(coding, end);
        all |= code ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(code) >> 31);
    }
    return std::max(1, int(std::bit_width(all)) + 1);
}

RoundingErrors roundingErrors(const FrameSamples& samples, const NumberCoding& coding) {
    RoundingErrors sum;
    all(samples, 1, [&](float sample) {
        if (!std::isfinite(sample)) return true;
        ++sum.count;
        if (coding.kind != NumberKind::Quantised) return true;
        const double apart = double(sampleOf<float>(coding, codeOf(coding, sample))) - double(sample);
        sum.squares += apart * apart;
        return true;
    });
    return sum;
}

double boundOf(const NumberCoding& stepped) {
    return stepped.step * (2 * kReach + 1) / 2;
}

std::uint32_t codeOf(const NumberCoding&, std::uint8_t sample) {
    return sample;
}
std::uint32_t codeOf(const NumberCoding&, std::int16_t sample) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(sample));
}
std::uint32_t codeOf(const NumberCoding&, std::uint16_t sample) {
    return sample;
}
std::uint32_t codeOf(const NumberCoding&, std::int32_t sample) {
    return static_cast<std::uint32_t>(sample);
}
std::uint32_t codeOf(const NumberCoding& coding, float sample) {
    switch (coding.kind) {
    case NumberKind::Integer:
    case NumberKind::Float:
        break;
    case NumberKind::Scaled:
        return clampedCode(double(sample) * coding.step);
    case NumberKind::Quantised:
    case NumberKind::Stepped:
        return clampedCode((double(sample) - coding.origin) / coding.step);
    }
    return codeOfFloat(sample);
}

namespace {

/// clampedCode(number(sample)) of a row, in a loop that compilers vectorise.
template <class Number>
TESSERA_INLINE void roundRow(const std::byte* floats, std::size_t count, std::uint32_t* codes, Number number) {
    constexpr double kRound = 3.0 * (std::int64_t(1) << 51); // adding it leaves no binary places: as std::rint
    for (std::size_t i = 0; i < count; ++i) {
        float sample = 0;
        std::memcpy(&sample, floats + i * sizeof(float), sizeof(float));
        const double k = number(double(sample)), rounded = (k + kRound) - kRound;
        codes[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::abs(k) <= kLargestCode ? rounded : 0.0));
    }
}

TESSERA_INLINE void roundAll(const NumberCoding& coding, const std::byte* floats, std::size_t count,
                             std::uint32_t* codes) {
    const double origin = coding.origin, step = coding.step;
    if (isBounded(coding))
        roundRow(floats, count, codes, [=](double sample) { return (sample - origin) / step; });
    else
        roundRow(floats, count, codes, [=](double sample) { return sample * step; });
}
TESSERA_AVX512 void roundAll512(const NumberCoding& coding, const std::byte* floats, std::size_t count,
                                std::uint32_t* codes) {
    roundAll(coding, floats, count, codes);
}
TESSERA_AVX2 void roundAll2(const NumberCoding& coding, const std::byte* floats, std::size_t count,
                            std::uint32_t* codes) {
    roundAll(coding, floats, count, codes);
}

} // namespace

void codesOf(const NumberCoding& coding, std::span<const std::byte> floats, std::uint32_t* codes, Cpu cpu) {
    const std::size_t count = floats.size() / sizeof(float);
    if (isBounded(coding) || coding.kind == NumberKind::Scaled) {
        if (cpu == Cpu::Avx512) return roundAll512(coding, floats.data(), count, codes);
        if (cpu == Cpu::Avx2) return roundAll2(coding, floats.data(), count, codes);
        return roundAll(coding, floats.data(), count, codes);
    }
    for (std::size_t i = 0; i < count; ++i) {
        float sample = 0;
        std::memcpy(&sample, floats.data() + i * sizeof(float), sizeof(float));
        codes[i] = codeOf(coding, sample);
    }
}

double valueOf(const NumberCoding& coding, std::uint32_t code) {
    const double k = static_cast<std::int32_t>(code);
    switch (coding.kind) {
    case NumberKind::Integer:
        break;
    case NumberKind::Scaled:
        return k / coding.step;
    case NumberKind::Float:
        return double(floatOfCode(code));
    case NumberKind::Quantised:
    case NumberKind::Stepped:
        return coding.origin + coding.step * k;
    }
    return k;
}

template <> float sampleOf<float>(const NumberCoding& coding, std::uint32_t code) {
    if (coding.kind == NumberKind::Float) return floatOfCode(code); // bitwise, including NaN payloads
    return static_cast<float>(valueOf(coding, code));
}

namespace {

/// Calls `visit` with the function from codes to real numbers.
template <class Visit> void withValues(const NumberCoding& coding, Visit&& visit) {
    const double origin = coding.origin, step = coding.step;
    switch (coding.kind) {
    case NumberKind::Integer:
        return visit([](std::int32_t k) { return double(k); });
    case NumberKind::Scaled:
        return visit([step](std::int32_t k) { return double(k) / step; });
    case NumberKind::Quantised:
    case NumberKind::Stepped:
        return visit([origin, step](std::int32_t k) { return origin + step * double(k); });
    case NumberKind::Float:
        return visit([](std::int32_t k) { return double(floatOfCode(static_cast<std::uint32_t>(k))); });
    }
}

} // namespace

template <class T, class Word> void toSamples(const NumberCoding& coding, std::span<const Word> codes, T* samples) {
    if constexpr (!std::same_as<T, float>) {
        for (std::size_t i = 0; i < codes.size(); ++i) samples[i] = static_cast<T>(codes[i]);
    } else if (coding.kind == NumberKind::Float) { // bitwise, including NaNs
        for (std::size_t i = 0; i < codes.size(); ++i) samples[i] = floatOfCode(static_cast<std::uint32_t>(codes[i]));
    } else {
        withValues(coding, [&](auto&& value) {
            for (std::size_t i = 0; i < codes.size(); ++i) samples[i] = static_cast<float>(value(codes[i]));
        });
    }
}

template <class Word>
void toValues(const NumberCoding& coding, double offset, double scale, std::span<const Word> codes, float* values) {
    if (coding.kind == NumberKind::Integer && offset == 0 && scale == 1) {
        for (std::size_t i = 0; i < codes.size(); ++i) values[i] = static_cast<float>(codes[i]);
        return;
    }
    withValues(coding, [&](auto&& value) {
        for (std::size_t i = 0; i < codes.size(); ++i) values[i] = static_cast<float>(offset + scale * value(codes[i]));
    });
}

template void toSamples(const NumberCoding&, std::span<const std::int16_t>, std::uint8_t*);
template void toSamples(const NumberCoding&, std::span<const std::int16_t>, std::int16_t*);
template void toSamples(const NumberCoding&, std::span<const std::int16_t>, std::uint16_t*);
template void toSamples(const NumberCoding&, std::span<const std::int16_t>, std::int32_t*);
template void toSamples(const NumberCoding&, std::span<const std::int16_t>, float*);
template void toSamples(const NumberCoding&, std::span<const std::int32_t>, std::uint8_t*);
template void toSamples(const NumberCoding&, std::span<const std::int32_t>, std::int16_t*);
template void toSamples(const NumberCoding&, std::span<const std::int32_t>, std::uint16_t*);
template void toSamples(const NumberCoding&, std::span<const std::int32_t>, std::int32_t*);
template void toSamples(const NumberCoding&, std::span<const std::int32_t>, float*);
template void toValues(const NumberCoding&, double, double, std::span<const std::int16_t>, float*);
template void toValues(const NumberCoding&, double, double, std::span<const std::int32_t>, float*);

} // namespace tessera::codec
