#include "codec/bands/band_tokens.h"

#include "codec/bands/band_rows512.h"
#include "codec/bytes/entropy.h"

#include <array>
#include <bit>

namespace tessera::codec {

namespace {

/// Writes the tokens of one row, sixteen per chunk, to `tokens` and advances it.
template <class Word>
void rowTokens(const Band<const Word>& band, std::ptrdiff_t at, const Neighbours& near, Contexts contexts,
               const std::uint16_t* added, std::uint16_t* size, std::uint16_t*& tokens, TokenRun& run) {
    const Word* values = band.values + at;
    const std::uint32_t kind = contexts.byBand ? std::uint32_t(band.kind) << 13 : 0;
    for (int x0 = 0; x0 < band.size.x; x0 += kLanes)
        for (int x = x0; x < x0 + kLanes; ++x, ++tokens) {
            if (x >= band.size.x || (band.present && band.present[at + x] == 0)) {
                size[x] = 0;
                *tokens = TokenRun::kNone;
                continue;
            }
            size[x] = magnitudeOf(values[x], contexts.shift);
            const std::uint32_t symbol = zigzag(static_cast<std::uint32_t>(std::int32_t(values[x])));
            const std::uint32_t token = tokenOf(symbol).token;
            const std::uint32_t sum = near.sum(x, contexts.byBand) + (added ? added[x] : 0u);
            *tokens = static_cast<std::uint16_t>(kind | halfOctaves(sum) << 8 | token);
            run.zero = run.zero && symbol == 0;
            if (token < kDirect) continue;
            run.large.push_back(symbol);
            run.largeAt.push_back(static_cast<std::uint32_t>(tokens - run.tokens.data()));
        }
}

#if TESSERA_X86

/// Appends the symbols of one chunk that need raw bits. `count`: number of them so far; the buffer has room for more.
TESSERA_AVX512 TESSERA_INLINE void addLarge(__mmask16 large, __m512i symbols, const std::uint16_t* tokens,
                                            TokenRun& run, std::size_t& count) {
    const __m512i place = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(tokens - run.tokens.data())),
                                           _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
    if (run.large.size() < count + kLanes) {
        run.large.resize(2 * run.large.size() + kLanes);
        run.largeAt.resize(run.large.size());
    }
    _mm512_storeu_si512(run.large.data() + count, _mm512_maskz_compress_epi32(large, symbols));
    _mm512_storeu_si512(run.largeAt.data() + count, _mm512_maskz_compress_epi32(large, place));
    count += std::size_t(__builtin_popcount(large));
}

/// Tokens of sixteen symbols.
TESSERA_AVX512 TESSERA_INLINE __m512i tokens512(__m512i symbol, const std::uint16_t* tokens, TokenRun& run,
                                                std::size_t& count) {
    const __mmask16 large = _mm512_cmpge_epu32_mask(symbol, _mm512_set1_epi32(kDirect));
    if (large == 0) return symbol;
    addLarge(large, symbol, tokens, run, count);
    // Octave o has four parts: 32 + 4 (o - 5) + the two bits after the leading one.
    const __m512i octave = _mm512_sub_epi32(_mm512_set1_epi32(31), _mm512_lzcnt_epi32(symbol));
    const __m512i part = _mm512_and_si512(_mm512_srlv_epi32(symbol, _mm512_sub_epi32(octave, _mm512_set1_epi32(2))),
                                          _mm512_set1_epi32(3));
    return _mm512_mask_add_epi32(symbol, large,
                                 _mm512_add_epi32(_mm512_slli_epi32(octave, 2), _mm512_set1_epi32(kDirect - 20)), part);
}

TESSERA_AVX512 TESSERA_INLINE __m512i widened(__m512i words, bool upper) {
    return _mm512_cvtepu16_epi32(upper ? _mm512_extracti64x4_epi64(words, 1) : _mm512_castsi512_si256(words));
}
TESSERA_AVX512 TESSERA_INLINE __m512i narrowed(__m512i low, __m512i high) {
    return _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi32_epi16(low)), _mm512_cvtepi32_epi16(high), 1);
}

/// Half octaves of 32 sums, in the upper bytes of words.
TESSERA_AVX512 TESSERA_INLINE __m512i wordClasses512(__m512i sums) {
    alignas(64) static constexpr auto kOfSmall = [] {
        std::array<std::uint16_t, 64> classes{}; // of sum + 1
        for (std::uint32_t i = 1; i < classes.size(); ++i) {
            const auto octave = static_cast<std::uint32_t>(std::bit_width(i) - 1);
            const std::uint32_t half = octave > 0 ? i >> (octave - 1) & 1u : 0u;
            classes[i] = static_cast<std::uint16_t>((2 * octave + half) << 8);
        }
        return classes;
    }();
    constexpr int kScale = 4; // octaves of the second range of sums
    const __m512i sum = _mm512_add_epi16(sums, _mm512_set1_epi16(1));
    if (_mm512_cmpge_epu16_mask(sum, _mm512_set1_epi16(64 << kScale)) != 0) [[unlikely]]
        return _mm512_slli_epi16(
            narrowed(classes512(_mm512_castsi512_si256(sums)), classes512(_mm512_extracti64x4_epi64(sums, 1))), 8);
    const __mmask32 larger = _mm512_cmpge_epu16_mask(sum, _mm512_set1_epi16(64));
    const __m512i at = _mm512_mask_srli_epi16(sum, larger, sum, kScale);
    const __m512i classes =
        _mm512_permutex2var_epi16(_mm512_load_si512(kOfSmall.data()), at, _mm512_load_si512(kOfSmall.data() + 32));
    return _mm512_mask_add_epi16(classes, larger, classes, _mm512_set1_epi16(2 * kScale << 8));
}

/// Coefficients of 32 positions: as words, if all of them fit.
struct Coefficients {
    __m512i words, low, high; ///< low, high: in 32 bits, if they do not fit
    bool fit;
};
template <class Word> TESSERA_AVX512 TESSERA_INLINE Coefficients coefficients512(const Word* from, __mmask32 active) {
    const __m512i none = _mm512_setzero_si512();
    if constexpr (sizeof(Word) == 2) {
        return {_mm512_maskz_loadu_epi16(active, from), none, none, true};
    } else {
        const __m512i low = _mm512_maskz_loadu_epi32(static_cast<__mmask16>(active), from),
                      high = _mm512_maskz_loadu_epi32(static_cast<__mmask16>(active >> kLanes), from + kLanes);
        const __m512i half = _mm512_set1_epi32(1 << 15),
                      both = _mm512_or_si512(_mm512_add_epi32(low, half), _mm512_add_epi32(high, half));
        const bool fit = _mm512_test_epi32_mask(both, _mm512_set1_epi32(static_cast<int>(0xffff0000u))) == 0;
        return {fit ? narrowed(low, high) : none, low, high, fit};
    }
}

/// Lanes of 32 positions that hold a coefficient.
TESSERA_AVX512 TESSERA_INLINE __mmask32 active512(const std::uint8_t* present, int x, int width) {
    const __mmask32 inside = width - x < 32 ? (1u << (width - x)) - 1u : ~0u;
    if (!present) return inside;
    const __m256i flags = _mm256_maskz_loadu_epi8(inside, present + x);
    return _mm256_test_epi8_mask(flags, flags);
}

/// The same, two chunks at a time.
template <class Word, bool kByBand>
TESSERA_AVX512 void rowTokens512(const Band<const Word>& band, std::ptrdiff_t at, const Neighbours& near,
                                 Contexts contexts, const std::uint16_t* added, std::uint16_t* sizes,
                                 std::uint16_t*& tokens, TokenRun& run, std::size_t& count) {
    const __m512i kind = _mm512_set1_epi16(static_cast<short>(kByBand ? band.kind << 13 : 0)),
                  most = _mm512_set1_epi16(static_cast<short>(kLargestMagnitude));
    const __m128i shift = _mm_cvtsi32_si128(contexts.shift);
    __m512i any = _mm512_setzero_si512();
    for (int x = 0; x < band.size.x; x += 2 * kLanes) {
        const __mmask32 active = active512(band.present ? band.present + at : nullptr, x, band.size.x);
        __m512i sums = sums512<kByBand>(near, x, band.size.x);
        if (added) sums = _mm512_add_epi16(sums, load512(added + x));
        const __m512i context = _mm512_or_si512(wordClasses512(sums), kind);
        const Coefficients values = coefficients512(band.values + at + x, active);
        __m512i token, size;
        if (values.fit) {
            const __m512i symbol =
                _mm512_xor_si512(_mm512_slli_epi16(values.words, 1), _mm512_srai_epi16(values.words, 15));
            any = _mm512_or_si512(any, symbol);
            size = _mm512_min_epu16(_mm512_srl_epi16(_mm512_abs_epi16(values.words), shift), most);
            token = symbol;
            if (_mm512_cmpge_epu16_mask(symbol, _mm512_set1_epi16(kDirect)) != 0) {
                const __m512i low = tokens512(widened(symbol, false), tokens, run, count);
                token = narrowed(low, tokens512(widened(symbol, true), tokens + kLanes, run, count));
            }
        } else {
            __m512i parts[2], partSizes[2];
            for (int i = 0; i < 2; ++i) {
                const __m512i value = i == 0 ? values.low : values.high;
                const __m512i symbol = _mm512_xor_si512(_mm512_slli_epi32(value, 1), _mm512_srai_epi32(value, 31));
                any = _mm512_or_si512(any, symbol);
                partSizes[i] = _mm512_min_epu32(_mm512_srl_epi32(_mm512_abs_epi32(value), shift),
                                                _mm512_set1_epi32(static_cast<int>(kLargestMagnitude)));
                parts[i] = tokens512(symbol, tokens + i * kLanes, run, count);
            }
            token = narrowed(parts[0], parts[1]);
            size = narrowed(partSizes[0], partSizes[1]);
        }
        _mm512_storeu_si512(sizes + x, size);
        const __m512i all = _mm512_mask_mov_epi16(_mm512_set1_epi16(-1), active, _mm512_or_si512(context, token));
        if (band.size.x - x > kLanes) {
            _mm512_storeu_si512(tokens, all);
            tokens += 2 * kLanes;
        } else {
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(tokens), _mm512_castsi512_si256(all));
            tokens += kLanes;
        }
    }
    if (_mm512_test_epi32_mask(any, any) != 0) run.zero = false;
}

#endif

} // namespace

template <class Word>
TokenRun tokensOf(std::span<const Band<const Word>> bands, Contexts contexts, Cpu cpu, RowPredictor<Word>* predictor) {
    const Lanes lanes(bands);
    TokenRun run;
    run.groups = lanes.groups;
    run.used = lanes.used;
    run.tokens.resize(lanes.chunks * kLanes);
    std::uint16_t* next = run.tokens.data();
    std::vector<Magnitudes> magnitudes = magnitudesFor(bands);
    std::size_t large = 0;
    forBandRows(bands, [&](std::size_t b, int z, int y) {
        const Band<const Word>& band = bands[b];
        const Neighbours near(magnitudes[b], z, y);
        const std::ptrdiff_t at = z * band.slicePitch + y * band.rowPitch;
        std::uint16_t* sizes = magnitudes[b].row(z, y);
        const std::uint16_t* added = predictor ? predictor->begin(b, z, y).activity : nullptr;
#if TESSERA_X86
        if (cpu == Cpu::Avx512 && contexts.byBand)
            rowTokens512<Word, true>(band, at, near, contexts, added, sizes, next, run, large);
        else if (cpu == Cpu::Avx512)
            rowTokens512<Word, false>(band, at, near, contexts, added, sizes, next, run, large);
        else
#endif
            rowTokens<Word>(band, at, near, contexts, added, sizes, next, run);
        if (predictor) predictor->end(b, z, y);
        return true;
    });
    if (large > 0) {
        run.large.resize(large);
        run.largeAt.resize(large);
    }
    (void)cpu;
    return run;
}

void countTokens(const TokenRun& run, int level, Histogram& histogram, int every) {
    constexpr std::size_t kMany = 1024; // chunks
    const std::size_t chunks = run.tokens.size() / kLanes, step = chunks < kMany ? 1 : std::size_t(every);
    const std::size_t first = histogram.contexts.first(level);
    // With one kind, the kind bits of tokens are masked out. (Kinds and classes are powers of two.)
    const std::size_t contexts = std::size_t(histogram.contexts.kindsOf(level)) * kClasses - 1;
    auto* const counts = histogram.counts.data() + first;
    for (std::size_t chunk = 0; chunk < chunks; chunk += step)
        for (std::size_t i = chunk * kLanes; i < (chunk + 1) * kLanes; ++i) {
            const std::size_t token = run.tokens[i];
            if (token != TokenRun::kNone)
                counts[token >> 8 & contexts][token & 255] += static_cast<std::uint32_t>(step);
        }
}

template TokenRun tokensOf(std::span<const Band<const std::int16_t>>, Contexts, Cpu, RowPredictor<std::int16_t>*);
template TokenRun tokensOf(std::span<const Band<const std::int32_t>>, Contexts, Cpu, RowPredictor<std::int32_t>*);

} // namespace tessera::codec
