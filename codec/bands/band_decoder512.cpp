#include "codec/bands/band_rows512.h"
#include "codec/bands/band_stream.h"

#if TESSERA_X86

namespace tessera::codec {

namespace {

/// Reads the raw bits of lanes with a token that is not direct; false when the stream ends. For octaves with up to 25
/// raw bits.
TESSERA_AVX512 inline bool rawSymbols512(BandStream& in, __mmask16 some, __m512i token, __m512i& symbol) {
    const __m512i code = _mm512_sub_epi32(token, _mm512_set1_epi32(kDirect));
    const __m512i bits =
        _mm512_maskz_add_epi32(some, _mm512_srli_epi32(code, 2), _mm512_set1_epi32(3)); // 0 in other lanes
    // Prefix sums of the bits over the lanes.
    __m512i sum = bits;
    const __m512i zero = _mm512_setzero_si512();
    sum = _mm512_add_epi32(sum, _mm512_alignr_epi32(sum, zero, 15));
    sum = _mm512_add_epi32(sum, _mm512_alignr_epi32(sum, zero, 14));
    sum = _mm512_add_epi32(sum, _mm512_alignr_epi32(sum, zero, 12));
    sum = _mm512_add_epi32(sum, _mm512_alignr_epi32(sum, zero, 8));
    const auto total =
        static_cast<std::uint32_t>(_mm_extract_epi32(_mm512_extracti32x4_epi32(sum, 3), 3)); // at most 16 * 25
    if (in.rawEnd - in.rawAt < total) return false;
    const __m512i at = _mm512_add_epi32(_mm512_sub_epi32(sum, bits), _mm512_set1_epi32(static_cast<int>(in.rawAt & 7)));
    const __m512i words =
        _mm512_mask_i32gather_epi32(zero, some, _mm512_srli_epi32(at, 3), in.raw + (in.rawAt >> 3), 1);
    const __m512i shifted = _mm512_srlv_epi32(words, _mm512_and_si512(at, _mm512_set1_epi32(7)));
    const __m512i base = _mm512_or_si512(_mm512_and_si512(code, _mm512_set1_epi32(3)), _mm512_set1_epi32(4));
    const __m512i low = _mm512_sub_epi32(_mm512_sllv_epi32(_mm512_set1_epi32(1), bits), _mm512_set1_epi32(1));
    const __m512i raw = _mm512_or_si512(_mm512_sllv_epi32(base, bits), _mm512_and_si512(shifted, low));
    symbol = _mm512_mask_mov_epi32(symbol, some, raw);
    in.rawAt += total;
    return true;
}

/// A constant in a register: compilers would rematerialise known constants.
TESSERA_AVX512 TESSERA_INLINE __m512i kept512(int value) {
    __m512i vector = _mm512_set1_epi32(value);
    asm("" : "+v"(vector));
    return vector;
}

/// The chunks of all bands' rows at one (y, z), in coding order.
struct Chunks512 {
    struct alignas(64) Sixteen {
        std::uint32_t lanes[kLanes];
    };
    std::vector<Sixteen> tables;      ///< per position: index of the context's table << kProbabilityBits
    std::vector<__mmask16> active;    ///< lanes that hold a coefficient
    std::vector<std::uint8_t> tokens; ///< sixteen per chunk, 0 where there is no coefficient
    std::vector<std::uint32_t> raw;   ///< chunks with raw bits
    std::size_t count = 0, rawCount = 0;

    explicit Chunks512(std::size_t most) : tables(most), active(most), tokens(most * kLanes), raw(most + 1) {}
};

/// State of the loop over chunks, kept in registers.
struct Cursor512 {
    const std::byte* next;
    unsigned group;
};

/// Decodes the tokens of all chunks. False: the stream ends too early.
TESSERA_AVX512 bool decodeTokens512(BandStream& in, Cursor512& cursor, Chunks512& chunks) {
    const std::uint32_t* const table = in.table;
    const std::byte *next = cursor.next, *const end = in.end;
    const __m512i slotMask = kept512(static_cast<int>(kSlotMask)), lowest = kept512(static_cast<int>(kLowestState));
    unsigned group = cursor.group;
    std::uint32_t* raw = chunks.raw.data();
    for (std::size_t chunk = 0; chunk < chunks.count; ++chunk) {
        std::uint32_t* own = in.states[group];
        group = (group + 1) & in.groupMask;
        const __mmask16 active = chunks.active[chunk];
        const __m512i state = _mm512_load_si512(own), tables = _mm512_load_si512(chunks.tables[chunk].lanes);
        const __m512i entry = entries512(table, _mm512_or_si512(tables, _mm512_and_si512(state, slotMask)));
        const __m512i frequency = _mm512_and_si512(_mm512_srli_epi32(entry, 8), slotMask); // 12 bits
        __m512i after = _mm512_add_epi32(_mm512_mullo_epi32(frequency, _mm512_srli_epi32(state, kProbabilityBits)),
                                         _mm512_srli_epi32(entry, 20));
        const __mmask16 low = _mm512_mask_cmplt_epu32_mask(active, after, lowest);
        const int count = __builtin_popcount(low);
        const std::ptrdiff_t left = end - next;
        __m256i words;
        if (left >= 32) [[likely]] {
            words = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(next));
        } else {
            if (left < 2 * count) return false;
            words = _mm256_maskz_loadu_epi16(static_cast<__mmask16>((1u << (left / 2)) - 1u), next);
        }
        next += 2 * count;
        const __m512i refill = _mm512_maskz_expand_epi32(low, _mm512_cvtepu16_epi32(words));
        after = _mm512_mask_or_epi32(after, low, _mm512_slli_epi32(after, 16), refill);
        _mm512_store_si512(own, _mm512_mask_mov_epi32(state, active, after));
        const __m128i tokens = _mm512_maskz_cvtepi32_epi8(active, entry);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(chunks.tokens.data() + chunk * kLanes), tokens);
        *raw = static_cast<std::uint32_t>(chunk);
        raw += _mm_cmpge_epu8_mask(tokens, _mm_set1_epi8(kDirect)) != 0 ? 1 : 0;
    }
    chunks.rawCount = std::size_t(raw - chunks.raw.data());
    cursor = {next, group};
    return true;
}

/// Converts sixteen tokens to coefficients, reading their raw bits; false when the stream ends.
template <class Word>
TESSERA_AVX512 bool rawChunk512(BandStream& in, const std::uint8_t* tokens, __mmask16 inside, const Word* predicted,
                                Word* values, std::uint16_t* sizes) {
    const __m512i token = _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(tokens)));
    __m512i symbol = token;
    const __mmask16 some = _mm512_cmpge_epu32_mask(token, _mm512_set1_epi32(kDirect));
    // 22 octaves with up to 25 raw bits follow the direct tokens.
    if (_mm512_cmpge_epu32_mask(token, _mm512_set1_epi32(kDirect + 23 * 4)) == 0) {
        if (!rawSymbols512(in, some, token, symbol)) return false;
    } else {
        alignas(64) std::uint32_t all[kLanes];
        _mm512_store_si512(all, symbol);
        for (std::uint32_t rest = some; rest != 0; rest &= rest - 1) {
            std::uint32_t& one = all[__builtin_ctz(rest)];
            const int bits = rawBitsOf(one);
            if (in.rawEnd - in.rawAt < static_cast<std::uint64_t>(bits)) return false;
            one = symbolBase(one) | takeRaw(in, bits);
        }
        symbol = _mm512_load_si512(all);
    }
    const __m512i sign = _mm512_sub_epi32(_mm512_setzero_si512(), _mm512_and_si512(symbol, _mm512_set1_epi32(1)));
    __m512i value = _mm512_xor_si512(_mm512_srli_epi32(symbol, 1), sign);
    const __m512i size =
        _mm512_min_epu32(_mm512_srl_epi32(_mm512_abs_epi32(value), _mm_cvtsi32_si128(in.contexts.shift)),
                         _mm512_set1_epi32(static_cast<int>(kLargestMagnitude)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(sizes), _mm512_cvtepi32_epi16(size));
    if constexpr (sizeof(Word) == 2) {
        if (predicted)
            value = _mm512_add_epi32(value, _mm512_cvtepi16_epi32(_mm256_maskz_loadu_epi16(inside, predicted)));
        _mm512_mask_cvtepi32_storeu_epi16(values, inside, value);
    } else {
        if (predicted) value = _mm512_add_epi32(value, _mm512_maskz_loadu_epi32(inside, predicted));
        _mm512_mask_storeu_epi32(values, inside, value);
    }
    return true;
}

/// Converts a row of direct tokens to coefficients, 32 lanes at a time. Magnitudes of lanes beyond the row are 0 and
/// overwrite the zero padding before the next row.
template <class Word>
TESSERA_AVX512 inline void directRow512(const std::uint8_t* tokens, int width, int shift, const Word* predicted,
                                        Word* values, std::uint16_t* sizes) {
    for (int x = 0; x < width; x += 32) {
        const __mmask32 inside = width - x >= 32 ? ~__mmask32(0) : (__mmask32(1) << (width - x)) - 1;
        const __m512i symbol = _mm512_cvtepu8_epi16(_mm256_maskz_loadu_epi8(inside, tokens + x));
        const __m512i sign = _mm512_sub_epi16(_mm512_setzero_si512(), _mm512_and_si512(symbol, _mm512_set1_epi16(1)));
        const __m512i value = _mm512_xor_si512(_mm512_srli_epi16(symbol, 1), sign);
        _mm512_storeu_si512(sizes + x, _mm512_srl_epi16(_mm512_abs_epi16(value), _mm_cvtsi32_si128(shift)));
        if constexpr (sizeof(Word) == 2) {
            const __m512i from = predicted ? _mm512_maskz_loadu_epi16(inside, predicted + x) : _mm512_setzero_si512();
            const __m512i sum = _mm512_add_epi16(value, from);
            if (inside == ~__mmask32(0)) // masked stores would delay what reads the row next
                _mm512_storeu_si512(values + x, sum);
            else
                _mm512_mask_storeu_epi16(values + x, inside, sum);
        } else {
            const auto low = static_cast<__mmask16>(inside), high = static_cast<__mmask16>(inside >> 16);
            __m512i first = _mm512_cvtepi16_epi32(_mm512_castsi512_si256(value));
            __m512i second = _mm512_cvtepi16_epi32(_mm512_extracti64x4_epi64(value, 1));
            if (predicted) {
                first = _mm512_add_epi32(first, _mm512_maskz_loadu_epi32(low, predicted + x));
                second = _mm512_add_epi32(second, _mm512_maskz_loadu_epi32(high, predicted + x + 16));
            }
            _mm512_mask_storeu_epi32(values + x, low, first);
            _mm512_mask_storeu_epi32(values + x + 16, high, second);
        }
    }
}

/// Appends the chunks of a row: the addresses of their contexts' tables and their active lanes.
template <bool kByBand>
TESSERA_AVX512 TESSERA_INLINE void appendRow512(const BandStream& in, const Neighbours& near,
                                                const std::uint16_t* added, int kind, const std::uint8_t* present,
                                                int width, Chunks512& chunks) {
    const __m512i low = _mm512_load_si512(in.tableOf[kind]), high = _mm512_load_si512(in.tableOf[kind] + 16);
    std::size_t count = chunks.count;
    for (int x = 0; x < width; x += 2 * kLanes) {
        __m512i sums = sums512<kByBand>(near, x, width);
        if (added) sums = _mm512_add_epi16(sums, load512(added + x));
        const __m512i first = classes512(_mm512_castsi512_si256(sums));
        _mm512_store_si512(chunks.tables[count].lanes, _mm512_permutex2var_epi32(low, first, high));
        chunks.active[count++] = static_cast<__mmask16>(activeLanes(present, x, width));
        if (width - x <= kLanes) break;
        const __m512i second = classes512(_mm512_extracti64x4_epi64(sums, 1));
        _mm512_store_si512(chunks.tables[count].lanes, _mm512_permutex2var_epi32(low, second, high));
        chunks.active[count++] = static_cast<__mmask16>(activeLanes(present, x + kLanes, width));
    }
    chunks.count = count;
}

/// A row of a band.
template <class Word> struct BandRow {
    std::size_t band = 0;
    int z = 0, y = 0;
    PredictedRow<Word> predicted;
};

/// Decodes some rows in passes: contexts, then tokens, then coefficients, with raw bits last, so that the token loop
/// has no other dependencies.
template <class Word, bool kByBand>
TESSERA_AVX512 bool decodeSome512(BandStream& in, Cursor512& cursor, std::span<const Band<Word>> bands,
                                  std::vector<Magnitudes>& magnitudes, std::span<const BandRow<Word>> rows,
                                  Chunks512& chunks) {
    chunks.count = 0;
    for (const auto& [b, z, y, predicted] : rows) {
        const Band<Word>& band = bands[b];
        const std::uint8_t* present = band.present ? band.present + z * band.slicePitch + y * band.rowPitch : nullptr;
        appendRow512<kByBand>(in, Neighbours(magnitudes[b], z, y), predicted.activity, kByBand ? band.kind : 0, present,
                              band.size.x, chunks);
    }
    if (!decodeTokens512(in, cursor, chunks)) return false;
    std::size_t first = 0, raw = 0;
    for (const auto& [b, z, y, predicted] : rows) {
        const Band<Word>& band = bands[b];
        Word* values = band.values + z * band.slicePitch + y * band.rowPitch;
        const std::uint8_t* tokens = chunks.tokens.data() + first * kLanes;
        std::uint16_t* sizes = magnitudes[b].row(z, y);
        directRow512<Word>(tokens, band.size.x, in.contexts.shift, predicted.values, values, sizes);
        const std::size_t own = std::size_t((band.size.x + kLanes - 1) / kLanes);
        for (; raw < chunks.rawCount && chunks.raw[raw] < first + own; ++raw) {
            const std::size_t at = chunks.raw[raw] - first;
            const auto x = static_cast<std::ptrdiff_t>(at * kLanes);
            const auto inside =
                static_cast<__mmask16>((1u << std::min(kLanes, band.size.x - static_cast<int>(x))) - 1u);
            const Word* const from = predicted.values ? predicted.values + x : nullptr;
            if (!rawChunk512<Word>(in, tokens + x, inside, from, values + x, sizes + x)) return false;
        }
        first += own;
    }
    return true;
}

/// Decodes the rows at one (z, y) of all bands with the same turn at a time.
template <class Word, bool kByBand>
bool decodeTurns512(BandStream& in, std::span<const Band<Word>> bands, RowPredictor<Word>* predictor) {
    std::vector<Magnitudes> magnitudes = magnitudesFor(bands);
    std::size_t most = 0;
    for (const Band<Word>& band : bands) most += std::size_t((std::max(band.size.x, 0) + kLanes - 1) / kLanes);
    Chunks512 chunks(most);
    Cursor512 cursor{in.next, 0};
    std::vector<BandRow<Word>> rows;
    const auto decode = [&] {
        for (BandRow<Word>& row : rows)
            if (predictor) row.predicted = predictor->begin(row.band, row.z, row.y);
        if (!decodeSome512<Word, kByBand>(in, cursor, bands, magnitudes, rows, chunks)) return false;
        for (const BandRow<Word>& row : rows)
            if (predictor) predictor->end(row.band, row.z, row.y);
        rows.clear();
        return true;
    };
    const bool whole = forBandRows(bands, [&](std::size_t b, int z, int y) {
        if (!rows.empty() && (rows[0].z != z || rows[0].y != y || bands[rows[0].band].turn != bands[b].turn) &&
            !decode())
            return false;
        rows.push_back({b, z, y, {}});
        return true;
    });
    if (!whole || !decode()) return false;
    in.next = cursor.next;
    return true;
}

} // namespace

template <class Word, bool kByBand>
bool decodeRows512(BandStream& in, std::span<const Band<Word>> bands, RowPredictor<Word>* predictor) {
    return decodeTurns512<Word, kByBand>(in, bands, predictor);
}

template bool decodeRows512<std::int16_t, true>(BandStream&, std::span<const Band<std::int16_t>>,
                                                RowPredictor<std::int16_t>*);
template bool decodeRows512<std::int16_t, false>(BandStream&, std::span<const Band<std::int16_t>>,
                                                 RowPredictor<std::int16_t>*);
template bool decodeRows512<std::int32_t, true>(BandStream&, std::span<const Band<std::int32_t>>,
                                                RowPredictor<std::int32_t>*);
template bool decodeRows512<std::int32_t, false>(BandStream&, std::span<const Band<std::int32_t>>,
                                                 RowPredictor<std::int32_t>*);

} // namespace tessera::codec

#endif
