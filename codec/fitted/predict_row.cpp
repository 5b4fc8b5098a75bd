#include "codec/fitted/predict_row.h"

#include "codec/bytes/vector_intrinsics.h"

#include <algorithm>

namespace tessera::codec {

namespace {

template <class Word> constexpr std::uint32_t unsignedOf(Word word) {
    return static_cast<std::uint32_t>(std::int32_t(word));
}

/// One block of samples from x on.
template <class Word>
TESSERA_INLINE void predictBlock(const TapSet& set, const TapRows<Word>& taps, const std::int32_t* weights,
                                 CodeRange range, int shift, int x, Word* predicted, std::uint16_t* activity) {
    constexpr int kBlock = kPredictedBlock;
    std::uint32_t sums[kBlock], away[kBlock] = {};
    std::int32_t guess[kBlock];
    const Word *const first = taps.at(0) + x, *const second = taps.at(1) + x;
    for (int i = 0; i < kBlock; ++i)
        guess[i] = static_cast<std::int32_t>(unsignedOf(first[i]) + unsignedOf(second[i])) >> 1;
    for (int t = 0; t < set.near; ++t) {
        const Word* const row = taps.at(std::size_t(t)) + x;
        for (int i = 0; i < kBlock; ++i) {
            const std::uint32_t apart = unsignedOf(row[i]) - unsignedOf(guess[i]);
            away[i] += static_cast<std::int32_t>(apart) < 0 ? 0u - apart : apart;
        }
    }
    const std::int32_t* bias = weights + set.count / 2 * kActivityClasses;
    std::uint32_t kind[kBlock];
    for (int i = 0; i < kBlock; ++i) {
        away[i] = std::min(away[i] >> shift, kMostActivity);
        kind[i] = activityClass(away[i]);
        activity[x + i] = static_cast<std::uint16_t>(away[i] / 2);
        sums[i] = unsignedOf(bias[kind[i]]) + (1u << (kWeightBits - 1));
    }
    for (int t = 0; t < set.count; t += 2) {
        const std::int32_t* const pairs = weights + t / 2 * kActivityClasses;
        const Word *const even = taps.at(std::size_t(t)) + x, *const odd = taps.at(std::size_t(t) + 1) + x;
        for (int i = 0; i < kBlock; ++i)
            sums[i] += unsignedOf(evenOf(pairs[kind[i]])) * unsignedOf(even[i]) +
                       unsignedOf(oddOf(pairs[kind[i]])) * unsignedOf(odd[i]);
    }
    for (int i = 0; i < kBlock; ++i)
        predicted[x + i] =
            static_cast<Word>(std::clamp(static_cast<std::int32_t>(sums[i]) >> kWeightBits, range.least, range.most));
}

#if TESSERA_X86

/// The class of each of eight activities.
TESSERA_AVX2 TESSERA_INLINE __m256i classesOf2(__m256i away) {
    const __m256 above = _mm256_cvtepi32_ps(_mm256_add_epi32(away, _mm256_set1_epi32(1)));
    const __m256i octaves = _mm256_sub_epi32(_mm256_srli_epi32(_mm256_castps_si256(above), 22), _mm256_set1_epi32(254));
    return _mm256_min_epu32(octaves, _mm256_set1_epi32(kActivityClasses - 1));
}

TESSERA_AVX2 TESSERA_INLINE __m256i rowAt2(const std::int16_t* from) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}

/// predictNarrow512 for sixteen words at a time, with weights from memory.
TESSERA_AVX2 void predictNarrow2(const TapSet& set, const TapRows<std::int16_t>& taps, const std::int32_t* weights,
                                 CodeRange range, int width, std::int16_t* predicted, std::uint16_t* activity) {
    const __m256i zero = _mm256_setzero_si256();
    for (int x = 0; x < width; x += 16) {
        const auto* const* places = taps.places;
        const std::ptrdiff_t at = taps.first + x;
        const __m256i guess = _mm256_srai_epi16(_mm256_add_epi16(rowAt2(places[0] + at), rowAt2(places[1] + at)), 1);
        __m256i away = zero;
        for (int t = 0; t < set.near; ++t)
            away = _mm256_add_epi16(away, _mm256_abs_epi16(_mm256_sub_epi16(rowAt2(places[t] + at), guess)));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(activity + x), _mm256_srli_epi16(away, 1));
        const __m256i lowKind = classesOf2(_mm256_unpacklo_epi16(away, zero));
        const __m256i highKind = classesOf2(_mm256_unpackhi_epi16(away, zero));
        const std::int32_t* own = weights + set.count / 2 * kActivityClasses;
        const __m256i half = _mm256_set1_epi32(1 << (kWeightBits - 1));
        __m256i low = _mm256_add_epi32(_mm256_i32gather_epi32(own, lowKind, 4), half);
        __m256i high = _mm256_add_epi32(_mm256_i32gather_epi32(own, highKind, 4), half);
        own = weights;
        for (int t = 0; t < set.count; t += 2, own += kActivityClasses) {
            const __m256i one = rowAt2(places[t] + at), other = rowAt2(places[t + 1] + at);
            const __m256i lowPair = _mm256_i32gather_epi32(own, lowKind, 4);
            const __m256i highPair = _mm256_i32gather_epi32(own, highKind, 4);
            low = _mm256_add_epi32(low, _mm256_madd_epi16(lowPair, _mm256_unpacklo_epi16(one, other)));
            high = _mm256_add_epi32(high, _mm256_madd_epi16(highPair, _mm256_unpackhi_epi16(one, other)));
        }
        const __m256i sum =
            _mm256_packs_epi32(_mm256_srai_epi32(low, kWeightBits), _mm256_srai_epi32(high, kWeightBits));
        const __m256i least = _mm256_set1_epi16(static_cast<std::int16_t>(range.least));
        const __m256i most = _mm256_set1_epi16(static_cast<std::int16_t>(range.most));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(predicted + x),
                            _mm256_min_epi16(_mm256_max_epi16(sum, least), most));
    }
}

/// The class of each of sixteen activities.
TESSERA_AVX512 TESSERA_INLINE __m512i classesOf(__m512i away) {
    const __m512 above = _mm512_cvtepi32_ps(_mm512_add_epi32(away, _mm512_set1_epi32(1)));
    const __m512i octaves = _mm512_sub_epi32(_mm512_srli_epi32(_mm512_castps_si512(above), 22), _mm512_set1_epi32(254));
    return _mm512_min_epu32(octaves, _mm512_set1_epi32(kActivityClasses - 1));
}

/// For each of sixteen lanes the entry of its class.
struct ByClass {
    __m512i low, high;

    TESSERA_AVX512 TESSERA_INLINE explicit ByClass(const std::int32_t* classes)
        : low(_mm512_loadu_si512(classes)), high(_mm512_loadu_si512(classes + 16)) {}
    TESSERA_AVX512 TESSERA_INLINE __m512i of(__m512i kind) const { return _mm512_permutex2var_epi32(low, kind, high); }
};

template <class Word> TESSERA_AVX512 TESSERA_INLINE __m512i rowAt(const TapRows<Word>& taps, std::size_t tap, int x) {
    return _mm512_loadu_si512(taps.at(tap) + x);
}

/// 32-bit words, sixteen at a time.
template <Pass kPass>
TESSERA_AVX512 void predictWide512(const TapRows<std::int32_t>& taps, const std::int32_t* weights, CodeRange range,
                                   int shift, int width, std::int32_t* predicted, std::uint16_t* activity) {
    constexpr const TapSet& kSet = tapsOf(kPass);
    constexpr auto kCount = static_cast<std::size_t>(kSet.count), kNear = static_cast<std::size_t>(kSet.near);
    const __m128i by = _mm_cvtsi32_si128(shift);
    for (int x = 0; x < width; x += 16) {
        const __m512i guess = _mm512_srai_epi32(_mm512_add_epi32(rowAt(taps, 0, x), rowAt(taps, 1, x)), 1);
        __m512i away = _mm512_setzero_si512();
#pragma GCC unroll 16
        for (std::size_t t = 0; t < kNear; ++t)
            away = _mm512_add_epi32(away, _mm512_abs_epi32(_mm512_sub_epi32(rowAt(taps, t, x), guess)));
        away = _mm512_min_epu32(_mm512_srl_epi32(away, by), _mm512_set1_epi32(int(kMostActivity)));
        const __m512i kind = classesOf(away);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(activity + x),
                            _mm512_cvtepi32_epi16(_mm512_srli_epi32(away, 1)));
        // Two sums, so that additions do not wait for each other.
        __m512i even = ByClass(weights + kCount / 2 * kActivityClasses).of(kind);
        __m512i odd = _mm512_set1_epi32(1 << (kWeightBits - 1));
#pragma GCC unroll 20
        for (std::size_t t = 0; t < kCount; t += 2) {
            const __m512i pair = ByClass(weights + t / 2 * kActivityClasses).of(kind);
            const __m512i low = _mm512_srai_epi32(_mm512_slli_epi32(pair, 16), 16), high = _mm512_srai_epi32(pair, 16);
            even = _mm512_add_epi32(even, _mm512_mullo_epi32(low, rowAt(taps, t, x)));
            odd = _mm512_add_epi32(odd, _mm512_mullo_epi32(high, rowAt(taps, t + 1, x)));
        }
        const __m512i sum = _mm512_srai_epi32(_mm512_add_epi32(even, odd), kWeightBits);
        _mm512_storeu_si512(predicted + x, _mm512_min_epi32(_mm512_max_epi32(sum, _mm512_set1_epi32(range.least)),
                                                            _mm512_set1_epi32(range.most)));
    }
}

/// 16-bit words, 32 at a time. Pairs of taps are multiplied and added by one instruction, which needs them side by
/// side: `low` and `high` have the first and the second four words of every eight.
template <Pass kPass>
TESSERA_AVX512 void predictNarrow512(const TapRows<std::int16_t>& taps, const std::int32_t* weights, CodeRange range,
                                     int width, std::int16_t* predicted, std::uint16_t* activity) {
    constexpr const TapSet& kSet = tapsOf(kPass);
    constexpr auto kCount = static_cast<std::size_t>(kSet.count), kNear = static_cast<std::size_t>(kSet.near);
    const __m512i zero = _mm512_setzero_si512();
    for (int x = 0; x < width; x += 32) {
        const __m512i guess = _mm512_srai_epi16(_mm512_add_epi16(rowAt(taps, 0, x), rowAt(taps, 1, x)), 1);
        __m512i away = zero;
#pragma GCC unroll 16
        for (std::size_t t = 0; t < kNear; ++t)
            away = _mm512_add_epi16(away, _mm512_abs_epi16(_mm512_sub_epi16(rowAt(taps, t, x), guess)));
        _mm512_storeu_si512(activity + x, _mm512_srli_epi16(away, 1));
        const __m512i lowKind = classesOf(_mm512_unpacklo_epi16(away, zero));
        const __m512i highKind = classesOf(_mm512_unpackhi_epi16(away, zero));
        const ByClass bias(weights + kCount / 2 * kActivityClasses);
        const __m512i half = _mm512_set1_epi32(1 << (kWeightBits - 1));
        __m512i low = _mm512_add_epi32(bias.of(lowKind), half), high = _mm512_add_epi32(bias.of(highKind), half);
#pragma GCC unroll 20
        for (std::size_t t = 0; t < kCount; t += 2) {
            const ByClass pair(weights + t / 2 * kActivityClasses);
            const __m512i one = rowAt(taps, t, x), other = rowAt(taps, t + 1, x);
            low = _mm512_add_epi32(low, _mm512_madd_epi16(pair.of(lowKind), _mm512_unpacklo_epi16(one, other)));
            high = _mm512_add_epi32(high, _mm512_madd_epi16(pair.of(highKind), _mm512_unpackhi_epi16(one, other)));
        }
        const __m512i sum =
            _mm512_packs_epi32(_mm512_srai_epi32(low, kWeightBits), _mm512_srai_epi32(high, kWeightBits));
        const __m512i least = _mm512_set1_epi16(static_cast<std::int16_t>(range.least));
        const __m512i most = _mm512_set1_epi16(static_cast<std::int16_t>(range.most));
        _mm512_storeu_si512(predicted + x, _mm512_min_epi16(_mm512_max_epi16(sum, least), most));
    }
}

template <Pass kPass, class Word>
void predictPass512(const TapRows<Word>& taps, const std::int32_t* weights, CodeRange range, int shift, int width,
                    Word* predicted, std::uint16_t* activity) {
    if constexpr (sizeof(Word) == 2)
        predictNarrow512<kPass>(taps, weights, range, width, predicted, activity);
    else
        predictWide512<kPass>(taps, weights, range, shift, width, predicted, activity);
}

template <class Word>
void predictRow512(Pass pass, const TapRows<Word>& taps, const std::int32_t* weights, CodeRange range, int shift,
                   int width, Word* predicted, std::uint16_t* activity) {
    switch (pass) {
    case Pass::AlongZ:
        return predictPass512<Pass::AlongZ>(taps, weights, range, shift, width, predicted, activity);
    case Pass::AlongY:
        return predictPass512<Pass::AlongY>(taps, weights, range, shift, width, predicted, activity);
    case Pass::AlongX:
        return predictPass512<Pass::AlongX>(taps, weights, range, shift, width, predicted, activity);
    case Pass::Odd:
        return predictPass512<Pass::Odd>(taps, weights, range, shift, width, predicted, activity);
    }
}

#endif

} // namespace

template <class Word>
void predictRow(Pass pass, const TapRows<Word>& taps, const PassWeights& weights, CodeRange range, int shift, int width,
                Word* predicted, std::uint16_t* activity, Cpu cpu) {
#if TESSERA_X86
    if (cpu == Cpu::Avx512 && (sizeof(Word) > 2 || shift == 0))
        return predictRow512<Word>(pass, taps, weights.data(), range, shift, width, predicted, activity);
    if constexpr (sizeof(Word) == 2)
        if (cpu != Cpu::Portable && shift == 0)
            return predictNarrow2(tapsOf(pass), taps, weights.data(), range, width, predicted, activity);
#endif
    (void)cpu;
    for (int x = 0; x < width; x += kPredictedBlock)
        predictBlock<Word>(tapsOf(pass), taps, weights.data(), range, shift, x, predicted, activity);
}

template void predictRow(Pass, const TapRows<std::int16_t>&, const PassWeights&, CodeRange, int, int, std::int16_t*,
                         std::uint16_t*, Cpu);
template void predictRow(Pass, const TapRows<std::int32_t>&, const PassWeights&, CodeRange, int, int, std::int32_t*,
                         std::uint16_t*, Cpu);

} // namespace tessera::codec
