#pragma once

#include "codec/bands/band_rows.h"
#include "codec/bytes/decode_status.h"

#include <bit>
#include <cstring>
#include <span>
#include <type_traits>

/// What the readers of bands share: the stream of the coder, and its raw bits.
namespace tessera::codec {

inline constexpr std::uint32_t kSlotMask = kProbabilityOne - 1;

/// Reader of the compressed bytes of some bands.
struct BandStream {
    alignas(64) std::uint32_t states[kMostGroups][kLanes]{};
    const std::byte *next = nullptr, *end = nullptr; ///< words
    const std::byte* raw = nullptr;                  ///< raw bits, followed by the words
    std::uint64_t rawAt = 0, rawEnd = 0;             ///< in bits
    const std::uint32_t* table = nullptr;
    alignas(64) std::uint32_t tableOf[kBandKinds][kClasses]{}; ///< table number << kProbabilityBits
    unsigned group = 0, groupMask = 0;
    Contexts contexts;
};

/// Modulo the word.
template <class Word> constexpr Word sumOf(Word a, Word b) {
    using Unsigned = std::make_unsigned_t<Word>;
    return static_cast<Word>(static_cast<Unsigned>(static_cast<Unsigned>(a) + static_cast<Unsigned>(b)));
}

/// Reads `bits` raw bits; the caller has checked that they are available. The words follow the raw bits, so a load
/// beyond the raw bits stays within the stream.
inline std::uint32_t takeRaw(BandStream& in, int bits) {
    std::uint64_t word = 0;
    const std::byte* at = in.raw + (in.rawAt >> 3);
    const std::ptrdiff_t left = in.end - at;
    if (left >= 8)
        std::memcpy(&word, at, 8);
    else
        std::memcpy(&word, at, static_cast<std::size_t>(left));
    if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap64(word);
    word >>= in.rawAt & 7;
    in.rawAt += static_cast<std::uint64_t>(bits);
    return static_cast<std::uint32_t>(word & ((std::uint64_t(1) << bits) - 1));
}

/// Lanes of a chunk that hold a coefficient.
TESSERA_INLINE std::uint32_t activeLanes(const std::uint8_t* present, int x0, int width) {
    const int count = std::min(kLanes, width - x0);
    const std::uint32_t inside = (1u << count) - 1;
    if (!present) return inside;
    std::uint32_t active = 0;
    for (int lane = 0; lane < count; ++lane) active |= (present[x0 + lane] != 0 ? 1u : 0u) << lane;
    return active;
}

#if TESSERA_X86

/// Decodes the rows of all bands with vectors of 512 bits. False: the stream ends too early.
template <class Word, bool kByBand>
bool decodeRows512(BandStream& in, std::span<const Band<Word>> bands, RowPredictor<Word>* predictor);

#endif

} // namespace tessera::codec
