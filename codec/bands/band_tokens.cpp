#include "codec/bands/band_tokens.h"

#include "codec/bands/band_rows512.h"
#include "codec/bytes/entropy.h"

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

/// The same, sixteen at a time. `count`: number of large symbols so far; the buffer has room for more.
template <class Word, bool kByBand>
TESSERA_AVX512 void rowTokens512(const Band<const Word>& band, std::ptrdiff_t at, const Neighbours& near,
                                 Contexts contexts, const std::uint16_t* added, std::uint16_t* sizes,
                                 std::uint16_t*& tokens, TokenRun& run, std::size_t& count) {
    const Word* values = band.values + at;
    const __m512i kind = _mm512_set1_epi32(kByBand ? band.kind << 13 : 0);
    __m512i any = _mm512_setzero_si512(), sums = any; // for 32 positions
    for (int x = 0; x < band.size.x; x += kLanes, tokens += kLanes) {
        const auto inside = static_cast<__mmask16>((1u << std::min(kLanes, band.size.x - x)) - 1u);
        __mmask16 active = inside;
        if (band.present) {
            const __m128i flags = _mm_maskz_loadu_epi8(inside, band.present + at + x);
            active = _mm_test_epi8_mask(flags, flags);
        }
        if (x % (2 * kLanes) == 0) sums = sums512<kByBand>(near, x, band.size.x);
        if (x % (2 * kLanes) == 0 && added) sums = _mm512_add_epi16(sums, load512(added + x));
        const __m512i context =
            classes512(x % (2 * kLanes) == 0 ? _mm512_castsi512_si256(sums) : _mm512_extracti64x4_epi64(sums, 1));

        __m512i value;
        if constexpr (sizeof(Word) == 2)
            value = _mm512_cvtepi16_epi32(_mm256_maskz_loadu_epi16(active, values + x));
        else
            value = _mm512_maskz_loadu_epi32(active, values + x);
        const __m512i symbol = _mm512_xor_si512(_mm512_slli_epi32(value, 1), _mm512_srai_epi32(value, 31));
        any = _mm512_or_si512(any, symbol);
        const __m512i size =
            _mm512_min_epu32(_mm512_srl_epi32(_mm512_abs_epi32(value), _mm_cvtsi32_si128(contexts.shift)),
                             _mm512_set1_epi32(static_cast<int>(kLargestMagnitude)));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(sizes + x), _mm512_cvtepi32_epi16(size));

        __m512i token = symbol;
        const __mmask16 large = _mm512_cmpge_epu32_mask(symbol, _mm512_set1_epi32(kDirect));
        if (large != 0) { // octave o has four parts: 32 + 4 (o - 5) + the two bits after the leading one
            const __m512i octave = _mm512_sub_epi32(_mm512_set1_epi32(31), _mm512_lzcnt_epi32(symbol));
            const __m512i part = _mm512_and_si512(
                _mm512_srlv_epi32(symbol, _mm512_sub_epi32(octave, _mm512_set1_epi32(2))), _mm512_set1_epi32(3));
            token = _mm512_mask_add_epi32(
                token, large, _mm512_add_epi32(_mm512_slli_epi32(octave, 2), _mm512_set1_epi32(kDirect - 20)), part);
            const __m512i place =
                _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(tokens - run.tokens.data())),
                                 _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
            if (run.large.size() < count + kLanes) {
                run.large.resize(2 * run.large.size() + kLanes);
                run.largeAt.resize(run.large.size());
            }
            _mm512_storeu_si512(run.large.data() + count, _mm512_maskz_compress_epi32(large, symbol));
            _mm512_storeu_si512(run.largeAt.data() + count, _mm512_maskz_compress_epi32(large, place));
            count += std::size_t(__builtin_popcount(large));
        }
        const __m512i both = _mm512_or_si512(_mm512_or_si512(_mm512_slli_epi32(context, 8), token), kind);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(tokens),
                            _mm512_cvtepi32_epi16(_mm512_mask_mov_epi32(_mm512_set1_epi32(0xffff), active, both)));
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
