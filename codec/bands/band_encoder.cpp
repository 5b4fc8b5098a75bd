#include "codec/bands/band_coder.h"
#include "codec/bands/band_rows512.h"

#include <array>
#include <bit>
#include <cstring>
#include <memory>

namespace tessera::codec {

namespace {

/// Writer of raw bits, LSB first.
class RawBits {
public:
    /// At most `count` calls of put.
    explicit RawBits(std::size_t count) : bytes_(4 * count + 8) {}

    void put(std::uint32_t value, int bits) {
        pending_ |= static_cast<std::uint64_t>(value) << count_;
        count_ += bits;
        if (count_ < 32) return;
        auto low = static_cast<std::uint32_t>(pending_);
        if constexpr (std::endian::native == std::endian::big) low = __builtin_bswap32(low);
        std::memcpy(bytes_.data() + at_, &low, sizeof low);
        at_ += sizeof low, count_ -= 32, pending_ >>= 32;
    }
    Bytes taken() {
        for (; count_ > 0; count_ -= 8, pending_ >>= 8) bytes_[at_++] = static_cast<std::byte>(pending_);
        bytes_.resize(at_);
        return std::move(bytes_);
    }

private:
    Bytes bytes_;
    std::size_t at_ = 0;
    std::uint64_t pending_ = 0;
    int count_ = 0;
};

/// Result of the backward pass: states, words from the end of their buffer, and indices of escapes.
struct Coded {
    alignas(64) std::uint32_t states[kMostGroups * kLanes];
    std::size_t size = 0, at = 0;
    std::unique_ptr<std::uint16_t[]> words; ///< `size` of them
    std::vector<std::uint32_t> escaped;     ///< token indices, descending

    explicit Coded(std::size_t tokens)
        : size(tokens + kLanes), at(size), words(std::make_unique_for_overwrite<std::uint16_t[]>(size)) {
        std::fill(std::begin(states), std::end(states), kLowestState);
    }
};

/// Codes tokens in reverse order, since rANS decodes in the opposite order. `tables`: table index << 8 per class and
/// kind of band.
void codeTokens(const TokenRun& run, const std::uint32_t* tables, std::span<const BandEncoder::Entry> entries,
                Coded& out) {
    const std::size_t groups = std::size_t(run.groups);
    for (std::size_t i = run.tokens.size(); i-- > 0;) {
        const std::uint32_t token = run.tokens[i];
        if (token == TokenRun::kNone) continue;
        const std::uint32_t table = tables[token >> 8];
        const BandEncoder::Entry* entry = &entries[table | (token & 255u)];
        if (entry->frequency == 0) {
            entry = &entries[table | kEscape];
            out.escaped.push_back(static_cast<std::uint32_t>(i));
        }
        std::uint32_t& state = out.states[i / kLanes % groups * kLanes + i % kLanes];
        std::uint32_t x = state;
        // Written always, kept only if the state is too large: a branch would be mispredicted half of the time.
        out.words[out.at - 1] = static_cast<std::uint16_t>(x);
        const bool full = x >> 20 >= entry->frequency;
        out.at -= full ? 1 : 0;
        x = full ? x >> 16 : x;
        const auto quotient = static_cast<std::uint32_t>((x * entry->reciprocal) >> 44);
        state = (quotient << kProbabilityBits) + (x - quotient * entry->frequency) + entry->start;
    }
}

#if TESSERA_X86

/// Chunks whose entries are looked up before the first of them is coded: the lookups do not wait for coder states.
constexpr std::size_t kAhead = 32;
using Entries = std::array<std::uint32_t, kAhead * kLanes>;

/// Replaces indices by the entries at them, two at a time: as fast as gathers where those are fast.
[[gnu::noinline]] void lookUp(const std::uint32_t* __restrict packed, std::uint32_t* __restrict entries,
                              std::size_t count) {
    for (std::size_t i = 0; i < count; i += 2) {
        std::uint64_t two;
        std::memcpy(&two, entries + i, sizeof two);
        two = packed[two & 0xffffffff] | std::uint64_t(packed[two >> 32]) << 32;
        std::memcpy(entries + i, &two, sizeof two);
    }
}

/// The entries of the tokens of `count` chunks from `first` on; the last of `packed` where there is no token.
TESSERA_AVX512 void findEntries(const TokenRun& run, const std::uint32_t* tables, std::span<const std::uint32_t> packed,
                                std::size_t first, std::size_t count, Entries& entries) {
    const __m512i none = _mm512_set1_epi32(TokenRun::kNone),
                  idle = _mm512_set1_epi32(static_cast<int>(packed.size() - 1));
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint16_t* tokens = run.tokens.data() + (first + i) * kLanes;
        const __m512i both = _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(tokens)));
        const __mmask16 active = _mm512_cmpneq_epu32_mask(both, none);
        // A chunk belongs to one band.
        const std::uint32_t* own =
            tables + std::size_t(active == 0 ? 0 : tokens[__builtin_ctz(active)] >> 13) * kClasses;
        const __m512i table =
            _mm512_permutex2var_epi32(_mm512_load_si512(own), _mm512_srli_epi32(both, 8), _mm512_load_si512(own + 16));
        const __m512i index = _mm512_or_si512(table, _mm512_and_si512(both, _mm512_set1_epi32(255)));
        _mm512_store_si512(entries.data() + i * kLanes, _mm512_mask_mov_epi32(idle, active, index));
    }
    lookUp(packed.data(), entries.data(), count * kLanes);
}

/// Replaces the entries of lanes `none` of a chunk, whose tokens have no frequency, by those of the escape.
TESSERA_AVX512 [[gnu::noinline]] __m512i withEscapes(const TokenRun& run, const std::uint32_t* tables,
                                                     std::span<const std::uint32_t> packed, std::size_t chunk,
                                                     __mmask16 none, __m512i entry, Coded& out) {
    alignas(64) std::uint32_t entries[kLanes];
    _mm512_store_si512(entries, entry);
    for (std::size_t lane = kLanes; lane-- > 0;) {
        if ((none >> lane & 1) == 0) continue;
        const std::size_t i = chunk * kLanes + lane;
        entries[lane] = packed[tables[run.tokens[i] >> 8] | kEscape];
        out.escaped.push_back(static_cast<std::uint32_t>(i));
    }
    return _mm512_load_si512(entries);
}

/// The same, one chunk at a time.
TESSERA_AVX512 void codeTokens512(const TokenRun& run, const std::uint32_t* tables,
                                  std::span<const std::uint32_t> packed, Coded& out) {
    // Moves the first n of sixteen words to the end; from the n-th place on.
    alignas(64) static constexpr std::uint16_t kToEnd[32] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15,
                                                             0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const std::size_t mask = std::size_t(run.groups) - 1;
    alignas(64) Entries entries;
    std::uint16_t* words = out.words.get() + out.at;
    for (std::size_t end = run.tokens.size() / kLanes; end > 0;) {
        const std::size_t count = std::min(end, kAhead), first = end - count;
        findEntries(run, tables, packed, first, count, entries);
        for (std::size_t chunk = end; chunk-- > first;) {
            __m512i entry = _mm512_load_si512(entries.data() + (chunk - first) * kLanes);
            const __mmask16 none = _mm512_testn_epi32_mask(entry, entry);
            if (none != 0) [[unlikely]]
                entry = withEscapes(run, tables, packed, chunk, none, entry, out);
            const __m512i frequency = _mm512_and_si512(entry, _mm512_set1_epi32(0xffff));
            std::uint32_t* states = out.states + (chunk & mask) * kLanes;
            const __m512i state = _mm512_load_si512(states);
            const __mmask16 full = _mm512_cmpge_epu32_mask(_mm512_srli_epi32(state, 20), frequency);
            const int taken = __builtin_popcount(full);
            const __m256i low = _mm512_cvtepi32_epi16(_mm512_maskz_compress_epi32(full, state));
            const __m256i toEnd = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kToEnd + taken));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(words - kLanes), _mm256_permutexvar_epi16(toEnd, low));
            words -= taken;
            const __m512i x = _mm512_mask_srli_epi32(state, full, state, 16);
            // The quotient, below 2^20, in float from a reciprocal that is too small by 2^-21: right or one too small.
            const __m512 divisor = _mm512_cvtepu32_ps(frequency), guess = _mm512_rcp14_ps(divisor);
            const __m512 reciprocal =
                _mm512_mul_ps(guess, _mm512_sub_ps(_mm512_set1_ps(2 - 0x1p-21f), _mm512_mul_ps(divisor, guess)));
            const __m512i quotient = _mm512_cvttps_epu32(_mm512_mul_ps(_mm512_cvtepu32_ps(x), reciprocal));
            const __m512i rest = _mm512_sub_epi32(x, _mm512_mullo_epi32(quotient, frequency));
            const __mmask16 under = _mm512_cmpge_epu32_mask(rest, frequency);
            const __m512i after = _mm512_add_epi32(_mm512_slli_epi32(quotient, kProbabilityBits),
                                                   _mm512_add_epi32(rest, _mm512_srli_epi32(entry, 16)));
            const __m512i more = _mm512_sub_epi32(_mm512_set1_epi32(kProbabilityOne), frequency);
            _mm512_store_si512(states, _mm512_mask_add_epi32(after, under, after, more));
        }
        end = first;
    }
    out.at = static_cast<std::size_t>(words - out.words.get());
}

#endif

/// The raw bits of the symbols that need them, in order.
Bytes rawBits(const TokenRun& run, std::span<const std::uint32_t> escaped) {
    RawBits raw(run.large.size() + escaped.size());
    std::size_t left = escaped.size();
    const auto escapeUpTo = [&](std::uint32_t at) { // direct tokens, which equal their symbols
        for (; left > 0 && escaped[left - 1] < at; --left) raw.put(run.tokens[escaped[left - 1]] & 255u, 32);
    };
    for (std::size_t i = 0; i < run.large.size(); ++i) {
        const std::uint32_t symbol = run.large[i], at = run.largeAt[i];
        escapeUpTo(at);
        if (left > 0 && escaped[left - 1] == at) {
            raw.put(symbol, 32);
            --left;
            continue;
        }
        const int bits = rawBitsOf(run.tokens[at] & 255u);
        raw.put(symbol & ((1u << bits) - 1), bits);
    }
    escapeUpTo(~0u);
    return raw.taken();
}

} // namespace

BandEncoder::BandEncoder(Model model)
    : model_(std::move(model)), entries_(model_.tables.size() << 8), packed_(entries_.size() + 1) {
    for (std::size_t i = 0; i < model_.tables.size(); ++i) {
        std::uint32_t start = 0;
        for (std::size_t t = 0; t < kTokens; ++t) {
            const std::uint32_t frequency = model_.tables[i][t];
            if (frequency == 0) continue;
            // Reciprocal, rounded up: exact for the dividends that occur, states below frequency * 2^20.
            entries_[i << 8 | t] = {((std::uint64_t(1) << 44) + frequency - 1) / frequency, frequency, start};
            packed_[i << 8 | t] = frequency | start << 16;
            start += frequency;
        }
    }
    packed_.back() = kProbabilityOne; // does not change a state
}

void BandEncoder::encode(const TokenRun& run, int level, Bytes& out, Cpu cpu) const {
    if (run.zero) return;
    alignas(64) std::uint32_t tables[kBandKinds * kClasses];
    for (int kind = 0; kind < kBandKinds; ++kind)
        for (std::size_t c = 0; c < kClasses; ++c)
            tables[std::size_t(kind) * kClasses + c] =
                std::uint32_t(model_.tableOf[model_.contexts.first(level, kind) + c]) << 8;
    Coded coded(run.tokens.size());
#if TESSERA_X86
    if (cpu == Cpu::Avx512)
        codeTokens512(run, tables, packed_, coded);
    else
#endif
        codeTokens(run, tables, entries_, coded);
    (void)cpu;
    const Bytes raw = rawBits(run, coded.escaped);
    appendLength(out, static_cast<std::uint32_t>(raw.size()));
    out.insert(out.end(), raw.begin(), raw.end());
    for (int lane = 0; lane < run.used; ++lane) appendU32(out, coded.states[lane]);
    const std::size_t begin = out.size(), count = coded.size - coded.at;
    out.resize(begin + 2 * count);
    const std::uint16_t* words = coded.words.get() + coded.at;
    if constexpr (std::endian::native == std::endian::little) {
        if (count > 0) std::memcpy(out.data() + begin, words, 2 * count);
    } else {
        for (std::size_t i = 0; i < count; ++i) {
            out[begin + 2 * i] = static_cast<std::byte>(words[i]);
            out[begin + 2 * i + 1] = static_cast<std::byte>(words[i] >> 8);
        }
    }
}

} // namespace tessera::codec
