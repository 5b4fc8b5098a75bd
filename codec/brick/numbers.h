#pragma once

#include "volume/base/cpu.h"
#include "volume/field/scalar.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

/// Quantisation: samples as 32-bit integer codes, the input of the wavelet transforms.
namespace tessera::codec {

enum class NumberKind : std::uint8_t {
    Integer,   ///< u8, i16, u16, i32: the number itself
    Scaled,    ///< f32 with integer multiples of a step: value = float(code / step), e.g. decimals with step = 10^d
    Float,     ///< f32: the bits as an ordered integer (codeOfFloat)
    Quantised, ///< f32 within an error bound: value = float(origin + step * code)
    Stepped,   ///< the same with a small step, but coefficients are quantised instead (codec/brick/stepped_brick.h);
               ///< of integer types rounded, and held within the type
};

/// The number coding of one frame. All arithmetic is in double, with the result rounded once to float; codes are
/// signed.
struct NumberCoding {
    NumberKind kind = NumberKind::Integer;
    double origin = 0, step = 1;
    bool operator==(const NumberCoding&) const = default;
};

/// Codes are not larger; two bits remain for the growth of sums in the wavelets.
inline constexpr double kLargestCode = 1 << 29;

/// The bound that a Stepped coding is for: of integers, before they are rounded.
double boundOf(const NumberCoding& stepped);
/// Largest error of a sample's code with that coding: 2 kReach + 1 codes make a step of the Quantised one.
inline constexpr std::int32_t kReach = 16;

/// Code of one sample.
std::uint32_t codeOf(const NumberCoding& coding, std::uint8_t sample);
std::uint32_t codeOf(const NumberCoding& coding, std::int16_t sample);
std::uint32_t codeOf(const NumberCoding& coding, std::uint16_t sample);
std::uint32_t codeOf(const NumberCoding& coding, std::int32_t sample);
std::uint32_t codeOf(const NumberCoding& coding, float sample);
/// Code of any number with a bounded coding.
std::uint32_t codeOf(const NumberCoding& coding, double number);
/// Codes of a row of floats, which may be unaligned.
void codesOf(const NumberCoding& coding, std::span<const std::byte> floats, std::uint32_t* codes, Cpu cpu = bestCpu());
/// Codes of a row of numbers of a type, which may be unaligned.
void codesOf(const NumberCoding& coding, volume::ScalarType type, std::span<const std::byte> numbers,
             std::uint32_t* codes);

/// The nearest integer of a type, ties to even; of what is no number the lowest.
template <class T> T nearestInteger(double number) {
    constexpr double kLowest = double(std::numeric_limits<T>::lowest()), kMost = double(std::numeric_limits<T>::max());
    constexpr double kRound = 3.0 * (std::int64_t(1) << 51); // adding it leaves no binary places: as std::rint
    const double above = number > kLowest ? number : kLowest, held = above < kMost ? above : kMost;
    return static_cast<T>((held + kRound) - kRound);
}

/// The stored value of a code as a real number, not rounded.
double valueOf(const NumberCoding& coding, std::uint32_t code);
/// The sample of one code, in the type of the field; integers that are not Stepped keep the low bits of the code.
template <class T> T sampleOf(const NumberCoding& coding, std::uint32_t code) {
    return coding.kind == NumberKind::Stepped ? nearestInteger<T>(valueOf(coding, code)) : static_cast<T>(code);
}
template <> float sampleOf<float>(const NumberCoding& coding, std::uint32_t code);

/// Converts a row of 16- or 32-bit codes to as many samples.
template <class T, class Word> void toSamples(const NumberCoding& coding, std::span<const Word> codes, T* samples);

/// float(offset + scale * number) for a row of codes, with the number that a code stands for in a field of a type; for
/// integer types those of coarse levels may lie beyond the samples.
template <class Word>
void toValues(const NumberCoding& coding, volume::ScalarType type, double offset, double scale,
              std::span<const Word> codes, float* values);

/// Whether a coding has a bound on the error of its samples, rather than being exact.
inline bool isBounded(const NumberCoding& coding) {
    return coding.kind == NumberKind::Quantised || coding.kind == NumberKind::Stepped;
}
/// Whether `sample` may be replaced by `decoded`: equal bits, or for Quantised and Stepped a difference of at most
/// `maxError`.
inline bool close(const NumberCoding& coding, double maxError, float sample, float decoded) {
    if (std::bit_cast<std::uint32_t>(sample) == std::bit_cast<std::uint32_t>(decoded)) return true;
    return isBounded(coding) && std::abs(double(sample) - double(decoded)) <= maxError;
}

} // namespace tessera::codec
