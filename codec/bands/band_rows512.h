#pragma once

#include "codec/bands/band_rows.h"
#include "codec/bytes/vector_intrinsics.h"

/// Context computation for many positions at once.
namespace tessera::codec {

#if TESSERA_X86

TESSERA_AVX512 TESSERA_INLINE __m512i load512(const std::uint16_t* from) {
    return _mm512_loadu_si512(from);
}

/// Neighbours::sum for 32 positions from x on. A row of at most 32 is kept in registers: unaligned loads one element to
/// the side cross cache lines and wait for the preceding stores.
template <bool kByBand> TESSERA_AVX512 TESSERA_INLINE __m512i sums512(const Neighbours& near, int x, int width) {
    const __m512i north = load512(near.north + x), both = _mm512_add_epi16(north, load512(near.before + x));
    const __m512i ends = _mm512_add_epi16(load512(near.beforeNorth + x), load512(near.beforeSouth + x));
    __m512i sides;
    if (width <= 32) {
        alignas(64) static constexpr std::uint16_t kBefore[32] = {31, 0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                                  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
                                                                  21, 22, 23, 24, 25, 26, 27, 28, 29, 30};
        alignas(64) static constexpr std::uint16_t kBehind[32] = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                                  12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22,
                                                                  23, 24, 25, 26, 27, 28, 29, 30, 31, 0};
        const __m512i of = kByBand ? both : north;
        sides = _mm512_add_epi16(_mm512_maskz_permutexvar_epi16(~1u, _mm512_load_si512(kBefore), of),
                                 _mm512_maskz_permutexvar_epi16(~0u >> 1, _mm512_load_si512(kBehind), of));
    } else {
        sides = _mm512_add_epi16(load512(near.north + x - 1), load512(near.north + x + 1));
        if constexpr (kByBand)
            sides =
                _mm512_add_epi16(sides, _mm512_add_epi16(load512(near.before + x - 1), load512(near.before + x + 1)));
    }
    const __m512i sum = _mm512_add_epi16(_mm512_add_epi16(both, both), _mm512_add_epi16(sides, ends));
    return kByBand ? _mm512_add_epi16(sum, both) : sum;
}

/// Half octaves of sixteen sums.
TESSERA_AVX512 TESSERA_INLINE __m512i classes512(__m256i sums) {
    const __m512i sum = _mm512_add_epi32(_mm512_cvtepu16_epi32(sums), _mm512_set1_epi32(1));
    return _mm512_sub_epi32(_mm512_srli_epi32(_mm512_castps_si512(_mm512_cvtepi32_ps(sum)), 22),
                            _mm512_set1_epi32(254));
}

/// Sixteen table entries. Scalar loads are as fast as the gather instruction.
TESSERA_AVX512 TESSERA_INLINE __m512i entries512(const std::uint32_t* table, __m512i places) {
    alignas(64) std::uint32_t at[kLanes];
    _mm512_store_si512(at, places);
    __m128i quarters[4];
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t* own = at + 4 * i;
        quarters[i] = _mm_cvtsi32_si128(static_cast<int>(table[own[0]]));
        quarters[i] = _mm_insert_epi32(quarters[i], static_cast<int>(table[own[1]]), 1);
        quarters[i] = _mm_insert_epi32(quarters[i], static_cast<int>(table[own[2]]), 2);
        quarters[i] = _mm_insert_epi32(quarters[i], static_cast<int>(table[own[3]]), 3);
    }
    const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(quarters[0]), quarters[1], 1);
    const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(quarters[2]), quarters[3], 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

#endif

} // namespace tessera::codec
