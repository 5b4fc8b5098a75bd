#include "codec/band_coder.h"
#include "codec/band_rows.h"

namespace tessera::codec {

namespace {

/// Calls `visit(symbol, context class, lane of the row)` for each present coefficient, and `endOfChunk` behind each
/// chunk of lanes.
template <class Word, class Visit, class EndOfChunk>
void forSymbols(std::span<const Band<const Word>> bands, int shift, Visit&& visit, EndOfChunk&& endOfChunk) {
    std::vector<Magnitudes> magnitudes = magnitudesFor(bands);
    forBandRows(bands, [&](std::size_t b, int z, int y) {
        const Band<const Word>& band = bands[b];
        const Neighbours near(magnitudes[b], z, y);
        const std::ptrdiff_t at = z * band.slicePitch + y * band.rowPitch;
        const Word* values = band.values + at;
        std::uint16_t* size = magnitudes[b].row(z, y);
        for (int x0 = 0; x0 < band.size.x; x0 += kLanes) {
            const int end = std::min(x0 + kLanes, band.size.x);
            std::uint32_t classes[kLanes];
            for (int x = x0; x < x0 + kLanes; ++x) classes[x - x0] = classOf(near.sum(x));
            for (int x = x0; x < end; ++x) {
                if (band.present && band.present[at + x] == 0) {
                    size[x] = 0;
                    continue;
                }
                size[x] = magnitudeOf(values[x], shift);
                visit(zigzag(static_cast<std::uint32_t>(std::int32_t(values[x]))), classes[x - x0],
                      static_cast<std::uint32_t>(x - x0));
            }
            endOfChunk();
        }
        return true;
    });
}

/// Raw bits, lowest first.
class RawBits {
public:
    void put(std::uint32_t value, int bits) {
        pending_ |= static_cast<std::uint64_t>(value) << count_;
        count_ += bits;
        for (; count_ >= 8; count_ -= 8, pending_ >>= 8) bytes.push_back(static_cast<std::byte>(pending_));
    }
    void flush() {
        if (count_ > 0) bytes.push_back(static_cast<std::byte>(pending_));
    }
    Bytes bytes;

private:
    std::uint64_t pending_ = 0;
    int count_ = 0;
};

} // namespace

template <class Word>
void countTokens(std::span<const Band<const Word>> bands, int level, int shift, Histogram& histogram) {
    const std::size_t first = std::size_t(level) * kClasses;
    forSymbols(
        bands, shift,
        [&](std::uint32_t symbol, std::uint32_t context, std::uint32_t) {
            ++histogram.counts[first + context][tokenOf(symbol).token];
        },
        [] {});
}

BandEncoder::BandEncoder(Model model) : model_(std::move(model)), entries_(model_.tables.size() << 8) {
    for (std::size_t i = 0; i < model_.tables.size(); ++i) {
        std::uint32_t start = 0;
        for (std::size_t t = 0; t < kTokens; ++t) {
            const std::uint32_t frequency = model_.tables[i][t];
            if (frequency == 0) continue;
            // Rounded up: exact for the states below frequency * 2^20 that are divided by it.
            entries_[i << 8 | t] = {((std::uint64_t(1) << 44) + frequency - 1) / frequency, frequency, start};
            start += frequency;
        }
    }
}

template <class Word> void BandEncoder::encode(std::span<const Band<const Word>> bands, int level, Bytes& out) const {
    const Lanes lanes(bands);
    const std::uint8_t* tableOf = model_.tableOf.data() + std::size_t(level) * kClasses;
    // First forwards: tokens with their tables and lanes, and raw bits.
    std::vector<std::uint32_t> symbols; // lane << 16 | table << 8 | token
    symbols.reserve(lanes.chunks * kLanes);
    RawBits raw;
    std::uint32_t group = 0, any = 0;
    const auto groups = static_cast<std::uint32_t>(lanes.groups);
    forSymbols(
        bands, model_.shift,
        [&](std::uint32_t symbol, std::uint32_t context, std::uint32_t lane) {
            any |= symbol;
            const std::uint32_t table = tableOf[context];
            Token token = symbol < kDirect ? Token{symbol, 0} : tokenOf(symbol);
            if (entries_[table << 8 | token.token].frequency == 0) token = {kEscape, 32};
            if (token.rawBits == 32)
                raw.put(symbol, 32);
            else if (token.rawBits > 0)
                raw.put(symbol & ((1u << token.rawBits) - 1), token.rawBits);
            symbols.push_back((group * kLanes + lane) << 16 | table << 8 | token.token);
        },
        [&] { group = (group + 1) & (groups - 1); });
    if (any == 0) return;
    raw.flush();

    // Then backwards: a decoder undoes the last symbol first.
    std::uint32_t states[kMostGroups * kLanes];
    std::fill(std::begin(states), std::end(states), kLowestState);
    std::vector<std::uint16_t> words(symbols.size() + 1);
    std::size_t at = words.size();
    for (std::size_t i = symbols.size(); i-- > 0;) {
        const Entry& entry = entries_[symbols[i] & 0xffffu];
        std::uint32_t& state = states[symbols[i] >> 16];
        std::uint32_t x = state;
        // Written always, kept when the state is too large: half of the time is no branch to predict.
        words[at - 1] = static_cast<std::uint16_t>(x);
        const bool full = x >> 20 >= entry.frequency;
        at -= full ? 1 : 0;
        x = full ? x >> 16 : x;
        const auto quotient = static_cast<std::uint32_t>((x * entry.reciprocal) >> 44);
        state = (quotient << kProbabilityBits) + (x - quotient * entry.frequency) + entry.start;
    }

    auto length = static_cast<std::uint32_t>(raw.bytes.size());
    for (; length >= 128; length >>= 7) out.push_back(static_cast<std::byte>(length | 128u));
    out.push_back(static_cast<std::byte>(length));
    out.insert(out.end(), raw.bytes.begin(), raw.bytes.end());
    for (int lane = 0; lane < lanes.used; ++lane) appendU32(out, states[lane]);
    const std::size_t begin = out.size();
    out.resize(begin + 2 * (words.size() - at));
    for (std::size_t i = at, to = begin; i < words.size(); ++i, to += 2) {
        out[to] = static_cast<std::byte>(words[i]);
        out[to + 1] = static_cast<std::byte>(words[i] >> 8);
    }
}

template void countTokens(std::span<const Band<const std::int16_t>>, int, int, Histogram&);
template void countTokens(std::span<const Band<const std::int32_t>>, int, int, Histogram&);
template void BandEncoder::encode(std::span<const Band<const std::int16_t>>, int, Bytes&) const;
template void BandEncoder::encode(std::span<const Band<const std::int32_t>>, int, Bytes&) const;

} // namespace tessera::codec
