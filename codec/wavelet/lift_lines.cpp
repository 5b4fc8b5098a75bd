#include "codec/wavelet/lift_lines.h"

#include "codec/bytes/vector_intrinsics.h"
#include "codec/wavelet/filter.h"

#include <type_traits>

namespace tessera::codec {

namespace {

#if TESSERA_X86

/// Thirty-two consecutive words of a line.
template <class Word> struct Words32 { __m512i part[sizeof(Word) / 2]; };

template <class Word> TESSERA_AVX512 TESSERA_INLINE __m512i addWords(__m512i a, __m512i b) {
    if constexpr (sizeof(Word) == 2)
        return _mm512_add_epi16(a, b);
    else
        return _mm512_add_epi32(a, b);
}
template <class Word> TESSERA_AVX512 TESSERA_INLINE __m512i takeWords(__m512i a, __m512i b) {
    if constexpr (sizeof(Word) == 2)
        return _mm512_sub_epi16(a, b);
    else
        return _mm512_sub_epi32(a, b);
}
template <class Word> TESSERA_AVX512 TESSERA_INLINE __m512i setWords(int value) {
    if constexpr (sizeof(Word) == 2)
        return _mm512_set1_epi16(static_cast<short>(value));
    else
        return _mm512_set1_epi32(value);
}
template <class Word, int kBits> TESSERA_AVX512 TESSERA_INLINE __m512i shiftWords(__m512i a) {
    if constexpr (kBits == 0)
        return a;
    else if constexpr (sizeof(Word) == 2)
        return _mm512_srai_epi16(a, kBits);
    else
        return _mm512_srai_epi32(a, kBits);
}

template <class Word> TESSERA_AVX512 TESSERA_INLINE __m512i mixed(__m512i a, __m512i index, __m512i b) {
    if constexpr (sizeof(Word) == 2)
        return _mm512_permutex2var_epi16(a, index, b);
    else
        return _mm512_permutex2var_epi32(a, index, b);
}

/// Loads `count` words, followed by zeros.
template <class Word> TESSERA_AVX512 TESSERA_INLINE Words32<Word> loadWords(const Word* from, int count) {
    Words32<Word> words;
    const auto inside = static_cast<__mmask32>(count < 32 ? (1u << count) - 1u : ~0u);
    if constexpr (sizeof(Word) == 2) {
        words.part[0] = _mm512_maskz_loadu_epi16(inside, from);
    } else {
        words.part[0] = _mm512_maskz_loadu_epi32(static_cast<__mmask16>(inside), from);
        words.part[1] = _mm512_maskz_loadu_epi32(static_cast<__mmask16>(inside >> 16), from + 16);
    }
    return words;
}
template <class Word> TESSERA_AVX512 TESSERA_INLINE void storeWords(Word* to, int count, const Words32<Word>& words) {
    const auto inside = static_cast<__mmask32>(count < 32 ? (1u << count) - 1u : ~0u);
    if constexpr (sizeof(Word) == 2) {
        _mm512_mask_storeu_epi16(to, inside, words.part[0]);
    } else {
        _mm512_mask_storeu_epi32(to, static_cast<__mmask16>(inside), words.part[0]);
        _mm512_mask_storeu_epi32(to + 16, static_cast<__mmask16>(inside >> 16), words.part[1]);
    }
}

template <class Word> using Taps = typename LineLifter<Word>::Taps;

template <class Word> TESSERA_AVX512 TESSERA_INLINE __m512i picked(const Words32<Word>& source, const Word* at) {
    const __m512i index = _mm512_load_si512(at);
    if constexpr (sizeof(Word) == 2)
        return _mm512_permutexvar_epi16(index, source.part[0]);
    else
        return _mm512_permutex2var_epi32(source.part[0], index, source.part[1]);
}

/// The sums of the two words of a pair.
template <class Word>
TESSERA_AVX512 TESSERA_INLINE __m512i tapped(const Words32<Word>& source, const Taps<Word>& taps, int pair, int part) {
    const int at = part * int(64 / sizeof(Word));
    return addWords<Word>(picked(source, taps.at[pair][0] + at), picked(source, taps.at[pair][1] + at));
}

/// The lifting term of each word: floor((sum of w_j (left_j + right_j) + half) / 2^shift). (As changeOf in
/// lift_box.cpp, modulo the word.)
template <class Word, LiftStep kStep>
TESSERA_AVX512 TESSERA_INLINE __m512i changeOf(const Words32<Word>& source, const Taps<Word>& taps, int part) {
    const __m512i half = setWords<Word>(kStep.shift > 0 ? 1 << (kStep.shift > 0 ? kStep.shift - 1 : 0) : 0);
    if constexpr (kStep.pairs == 0) {
        return shiftWords<Word, kStep.shift>(addWords<Word>(source.part[part], half));
    } else if constexpr (kStep.pairs == 1) {
        return shiftWords<Word, kStep.shift>(addWords<Word>(tapped(source, taps, 0, part), half));
    } else if constexpr (isCubic(kStep)) {
        const __m512i a = tapped(source, taps, 0, part), b = tapped(source, taps, 1, part);
        const __m512i eighth = shiftWords<Word, 3>(addWords<Word>(takeWords<Word>(a, b), half));
        return shiftWords<Word, kStep.shift - 3>(addWords<Word>(a, eighth));
    } else {
        __m512i sum = half;
        for (int pair = 0; pair < kStep.pairs; ++pair)
            sum = addWords<Word>(sum, _mm512_mullo_epi32(tapped(source, taps, pair, part),
                                                         setWords<Word>(kStep.weight[std::size_t(pair)])));
        return shiftWords<Word, kStep.shift>(sum);
    }
}

/// Transforms lines of samples to coefficients, or back.
template <class Word, Wavelet kWavelet, bool kJoins>
TESSERA_AVX512 void liftLines(const LineLifter<Word>& lifter, const SliceLines<Word>& lines) {
    constexpr LiftFilter kFilter = filterOf(kWavelet);
    constexpr int kParts = sizeof(Word) / 2, kLane = 64 / int(sizeof(Word));
    const int evens = lifter.evens, odds = lifter.odds, evenRows = (lines.rows + 1) / 2;
    // Permutation between an interleaved line and its halves, two registers at a time.
    alignas(64) Word order[2][kLane];
    for (int i = 0; i < kLane; ++i)
        for (int half = 0; half < 2; ++half)
            order[half][i] = static_cast<Word>(kJoins ? (half * kLane + i) / 2 + i % 2 * kLane : 2 * i + half);
    const __m512i first = _mm512_load_si512(order[0]), second = _mm512_load_si512(order[1]);
    for (int y = 0; y < lines.rows; ++y) {
        const std::size_t split = std::size_t(y % 2 == 0 ? y / 2 : evenRows + y / 2) * lines.pitch,
                          whole = std::size_t(y) * lines.pitch;
        Words32<Word> even, odd;
        if constexpr (kJoins) {
            even = loadWords(lines.from + split, evens);
            odd = loadWords(lines.from + split + evens, odds);
            if constexpr (kFilter.updates)
                for (int part = 0; part < kParts; ++part)
                    even.part[part] =
                        takeWords<Word>(even.part[part], changeOf<Word, kFilter.update>(odd, lifter.update, part));
            for (int part = 0; part < kParts; ++part)
                odd.part[part] =
                    addWords<Word>(odd.part[part], changeOf<Word, kFilter.predict>(even, lifter.predict, part));
            Word* to = lines.to + whole;
            for (int part = 0; part < kParts && 2 * part * kLane < lifter.width; ++part) {
                _mm512_storeu_si512(to + 2 * part * kLane, mixed<Word>(even.part[part], first, odd.part[part]));
                if ((2 * part + 1) * kLane >= lifter.width) break;
                _mm512_storeu_si512(to + (2 * part + 1) * kLane, mixed<Word>(even.part[part], second, odd.part[part]));
            }
        } else {
            const Word* from = lines.from + whole;
            const Words32<Word> low = loadWords(from, lifter.width < 32 ? lifter.width : 32);
            const Words32<Word> high = loadWords(from + 32, lifter.width < 32 ? 0 : lifter.width - 32);
            if constexpr (sizeof(Word) == 2) {
                even.part[0] = mixed<Word>(low.part[0], first, high.part[0]);
                odd.part[0] = mixed<Word>(low.part[0], second, high.part[0]);
            } else {
                even.part[0] = mixed<Word>(low.part[0], first, low.part[1]);
                odd.part[0] = mixed<Word>(low.part[0], second, low.part[1]);
                even.part[1] = mixed<Word>(high.part[0], first, high.part[1]);
                odd.part[1] = mixed<Word>(high.part[0], second, high.part[1]);
            }
            for (int part = 0; part < kParts; ++part)
                odd.part[part] =
                    takeWords<Word>(odd.part[part], changeOf<Word, kFilter.predict>(even, lifter.predict, part));
            if constexpr (kFilter.updates)
                for (int part = 0; part < kParts; ++part)
                    even.part[part] =
                        addWords<Word>(even.part[part], changeOf<Word, kFilter.update>(odd, lifter.update, part));
            storeWords(lines.to + split, evens, even);
            storeWords(lines.to + split + evens, odds, odd);
        }
    }
}

#endif

/// Whether the sums of a step fit into the word at the supported code width.
template <class Word> constexpr bool sumsFit(const LiftStep& step) {
    return !step.antisymmetric && (sizeof(Word) == 4 || step.pairs < 2 || isCubic(step));
}

} // namespace

template <class Word> template <Wavelet kWavelet> void LineLifter<Word>::use() {
#if TESSERA_X86
    constexpr LiftFilter kFilter = filterOf(kWavelet);
    if constexpr (sumsFit<Word>(kFilter.predict) && sumsFit<Word>(kFilter.update)) {
        split_ = liftLines<Word, kWavelet, false>;
        join_ = liftLines<Word, kWavelet, true>;
    }
#endif
}

template <class Word>
LineLifter<Word>::LineLifter(Wavelet wavelet, int lineWidth, bool wide, Cpu cpu)
    : width(lineWidth), evens((lineWidth + 1) / 2), odds(lineWidth / 2) {
    if (cpu != Cpu::Avx512 || wide || width < 2 || width > 2 * kWords) return;
    const LiftFilter filter = filterOf(wavelet);
    const auto fill = [](const LiftStep& step, bool updates, int targets, int sources, Taps& taps) {
        for (int i = 0; i < targets; ++i) {
            const Pairs pairs = pairsAt(i, step.pairs, sources, updates);
            for (std::size_t j = 0; j < std::size_t(step.pairs); ++j) {
                taps.at[j][0][i] = static_cast<Word>(pairs.left[j]);
                taps.at[j][1][i] = static_cast<Word>(pairs.right[j]);
            }
        }
    };
    fill(filter.predict, false, odds, evens, predict);
    const int usable = usableDetails(filter.update.pairs, evens, odds);
    if (filter.updates && (usable < 1 || (filter.update.pairs == 0 && evens > odds))) return;
    if (filter.updates) fill(filter.update, true, evens, usable, update);
    withWavelet(wavelet, [&]<Wavelet kWavelet>() {
        if constexpr (!filterOf(kWavelet).update.antisymmetric) use<kWavelet>();
    });
}

template class LineLifter<std::int16_t>;
template class LineLifter<std::int32_t>;

} // namespace tessera::codec
