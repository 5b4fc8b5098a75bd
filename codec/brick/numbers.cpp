#include "codec/brick/numbers.h"

#include "codec/wavelet/lifting.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <optional>

namespace tessera::codec {

namespace {

std::uint32_t clampedCode(double k) {
    if (!(std::abs(k) <= kLargestCode)) return 0; // includes NaN: stored exactly in addition
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::rint(k)));
}

} // namespace

double boundOf(const NumberCoding& stepped) {
    return stepped.step * (2 * kReach + 1) / 2;
}

namespace {

template <class T> std::uint32_t codeOfInteger(const NumberCoding& coding, T sample) {
    if (coding.kind == NumberKind::Stepped) return codeOf(coding, double(sample));
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(sample));
}

} // namespace

std::uint32_t codeOf(const NumberCoding& coding, std::uint8_t sample) {
    return codeOfInteger(coding, sample);
}
std::uint32_t codeOf(const NumberCoding& coding, std::int16_t sample) {
    return codeOfInteger(coding, sample);
}
std::uint32_t codeOf(const NumberCoding& coding, std::uint16_t sample) {
    return codeOfInteger(coding, sample);
}
std::uint32_t codeOf(const NumberCoding& coding, std::int32_t sample) {
    return codeOfInteger(coding, sample);
}
std::uint32_t codeOf(const NumberCoding& coding, double number) {
    return clampedCode((number - coding.origin) / coding.step);
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
        return codeOf(coding, double(sample));
    }
    return codeOfFloat(sample);
}

namespace {

/// clampedCode(number(sample)) of a row, in a loop that compilers vectorise.
template <class T = float, class Number>
TESSERA_INLINE void roundRow(const std::byte* samples, std::size_t count, std::uint32_t* codes, Number number) {
    constexpr double kRound = 3.0 * (std::int64_t(1) << 51); // adding it leaves no binary places: as std::rint
    for (std::size_t i = 0; i < count; ++i) {
        T sample{};
        std::memcpy(&sample, samples + i * sizeof(T), sizeof(T));
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

void codesOf(const NumberCoding& coding, volume::ScalarType type, std::span<const std::byte> numbers,
             std::uint32_t* codes) {
    volume::dispatch(type, [&]<class T>(T) {
        const std::size_t count = numbers.size() / sizeof(T);
        if constexpr (std::same_as<T, float>) {
            codesOf(coding, numbers, codes);
        } else if (coding.kind == NumberKind::Stepped) {
            roundRow<T>(numbers.data(), count, codes, [origin = coding.origin, step = coding.step](double sample) {
                return (sample - origin) / step;
            });
        } else {
            for (std::size_t i = 0; i < count; ++i) {
                T sample;
                std::memcpy(&sample, numbers.data() + i * sizeof(T), sizeof(T));
                codes[i] = codeOf(coding, sample);
            }
        }
    });
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
        const double origin = coding.origin, step = coding.step;
        if (coding.kind == NumberKind::Stepped)
            for (std::size_t i = 0; i < codes.size(); ++i)
                samples[i] = nearestInteger<T>(origin + step * double(codes[i]));
        else
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
void toValues(const NumberCoding& coding, volume::ScalarType type, double offset, double scale,
              std::span<const Word> codes, float* values) {
    if (coding.kind == NumberKind::Stepped && type != volume::ScalarType::F32) {
        const double origin = coding.origin, step = coding.step;
        volume::dispatch(type, [&]<class T>(T) {
            if constexpr (!std::same_as<T, float>)
                for (std::size_t i = 0; i < codes.size(); ++i)
                    values[i] = static_cast<float>(offset +
                                                   scale * double(nearestInteger<T>(origin + step * double(codes[i]))));
        });
        return;
    }
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
template void toValues(const NumberCoding&, volume::ScalarType, double, double, std::span<const std::int16_t>, float*);
template void toValues(const NumberCoding&, volume::ScalarType, double, double, std::span<const std::int32_t>, float*);

} // namespace tessera::codec
