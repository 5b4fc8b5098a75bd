#pragma once

#include "codec/bands/band.h"
#include "codec/bytes/range_coder.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Coding of bands by adaptive bits, whose contexts are magnitudes of neighbours: for small or smooth fields, where the
/// tables and states of codec/bands/band_coder.h would be a large part of the bytes. (FORMAT.md "Adaptive bits".)
namespace tessera::codec {

/// A sample corrected by a multiple of a unit.
struct Correction {
    std::uint32_t index = 0; ///< in storage order
    std::int32_t times = 0;
    bool operator==(const Correction&) const = default;
};

/// What was learnt from the bands so far; the same in writer and reader.
class AdaptiveBands {
public:
    static constexpr int kGroups = 16, kSteps = 20;
    /// Contexts of the bands with so many high halves at a level.
    static int groupOf(int highHalves, int level) { return 4 * highHalves + (level < 3 ? level : 3); }

    void encode(RangeEncoder& coder, const Band<const std::int32_t>& band, int group) { code(coder, band, group); }
    void decode(RangeDecoder& coder, const Band<std::int32_t>& band, int group) { code(coder, band, group); }

    /// The differences between successive coefficients.
    void encodeCoarse(RangeEncoder& coder, std::span<const Band<std::int32_t>> bands);
    void decodeCoarse(RangeDecoder& coder, std::span<const Band<std::int32_t>> bands);

    /// Corrections with ascending indices below `samples`.
    void encode(RangeEncoder& coder, std::span<const Correction> corrections);
    DecodeStatus decode(RangeDecoder& coder, std::size_t samples, std::vector<Correction>& corrections);

private:
    static constexpr int kClasses = 32;
    template <class Coder, class Word> void code(Coder& coder, const Band<Word>& band, int group);
    template <class Coder> std::int32_t codeOne(Coder& coder, std::int32_t value, int group, std::uint32_t near);

    std::array<std::array<AdaptiveBit, 8>, kGroups> row_;
    std::array<std::array<AdaptiveBit, kClasses>, kGroups> significant_;
    std::array<std::array<std::array<AdaptiveBit, kSteps>, kClasses>, kGroups / 2> larger_;
    std::array<AdaptiveNumber, kGroups / 2> rest_;
    AdaptiveNumber coarse_, count_, gap_, times_;
};

} // namespace tessera::codec
