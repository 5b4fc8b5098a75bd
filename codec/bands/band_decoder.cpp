#include "codec/bands/band_coder.h"
#include "codec/bands/band_stream.h"

namespace tessera::codec {

namespace {

/// Decodes sixteen symbols, one per lane of `active`. False: the stream ends too early.
template <class Word>
bool decodeChunk(BandStream& in, const Neighbours& near, const PredictedRow<Word>& predicted, int kind, int x0,
                 std::uint32_t active, Word* values, std::uint16_t* sizes) {
    std::uint32_t* states = in.states[in.group];
    in.group = (in.group + 1) & in.groupMask;
    for (int lane = 0; lane < kLanes; ++lane) {
        const int x = x0 + lane;
        if ((active >> lane & 1u) == 0) continue;
        const std::uint32_t state = states[lane];
        const std::uint32_t sum = near.sum(x, in.contexts.byBand) + (predicted.activity ? predicted.activity[x] : 0u);
        const std::uint32_t entry = in.table[in.tableOf[kind][halfOctaves(sum)] | (state & kSlotMask)];
        std::uint32_t token = entry & 255u;
        std::uint32_t after = (entry >> 8 & 4095u) * (state >> kProbabilityBits) + (entry >> 20);
        if (after < kLowestState) {
            if (in.end - in.next < 2) return false;
            after = after << 16 | static_cast<std::uint32_t>(in.next[0]) | static_cast<std::uint32_t>(in.next[1]) << 8;
            in.next += 2;
        }
        states[lane] = after;
        if (token >= kDirect) {
            const int bits = rawBitsOf(token);
            if (in.rawEnd - in.rawAt < static_cast<std::uint64_t>(bits)) return false;
            token = symbolBase(token) | takeRaw(in, bits);
        }
        const auto value = static_cast<std::int32_t>(unzigzag(token));
        values[x] = predicted.values ? sumOf(static_cast<Word>(value), predicted.values[x]) : static_cast<Word>(value);
        sizes[x] = magnitudeOf(value, in.contexts.shift);
    }
    return true;
}

template <class Word>
bool decodeRows(BandStream& in, std::span<const Band<Word>> bands, RowPredictor<Word>* predictor) {
    std::vector<Magnitudes> magnitudes = magnitudesFor(bands);
    return forBandRows(bands, [&](std::size_t b, int z, int y) {
        const Band<Word>& band = bands[b];
        const Neighbours near(magnitudes[b], z, y);
        const std::ptrdiff_t at = z * band.slicePitch + y * band.rowPitch;
        std::uint16_t* sizes = magnitudes[b].row(z, y);
        const PredictedRow<Word> predicted = predictor ? predictor->begin(b, z, y) : PredictedRow<Word>();
        if (band.present) {
            std::fill_n(band.values + at, band.size.x, Word(0));
            std::fill_n(sizes, band.size.x, std::uint16_t(0));
        }
        for (int x0 = 0; x0 < band.size.x; x0 += kLanes) {
            const std::uint32_t active = activeLanes(band.present ? band.present + at : nullptr, x0, band.size.x);
            if (!decodeChunk(in, near, predicted, band.kind, x0, active, band.values + at, sizes)) return false;
        }
        if (predictor) predictor->end(b, z, y);
        return true;
    });
}

} // namespace

BandDecoder::BandDecoder(Model model) : model_(std::move(model)), table_(decodeTable(model_)) {}

template <class Word>
DecodeStatus BandDecoder::decode(std::span<const std::byte> in, std::span<const Band<Word>> bands, int level, Cpu cpu,
                                 RowPredictor<Word>* predictor) const {
    if (in.empty()) {
        if (predictor) return DecodeStatus::Truncated;
        for (const Band<Word>& band : bands)
            for (int z = 0; z < band.size.z; ++z)
                for (int y = 0; y < band.size.y; ++y)
                    std::fill_n(band.values + z * band.slicePitch + y * band.rowPitch, std::max(0, band.size.x),
                                Word(0));
        return DecodeStatus::Ok;
    }
    std::uint64_t rawBytes = 0;
    if (const DecodeStatus status = takeLength(in, rawBytes); status != DecodeStatus::Ok) return status;
    const Lanes lanes(bands);
    const std::size_t statesBytes = 4 * static_cast<std::size_t>(lanes.used);
    if (in.size() < rawBytes || in.size() - rawBytes < statesBytes) return DecodeStatus::Truncated;
    if ((in.size() - rawBytes) % 2 != 0) return DecodeStatus::Trailing;

    BandStream stream;
    stream.raw = in.data();
    stream.rawEnd = 8 * rawBytes;
    in = in.subspan(rawBytes);
    for (int lane = 0; lane < kMostGroups * kLanes; ++lane)
        stream.states[lane / kLanes][lane % kLanes] = lane < lanes.used ? readU32(in.data() + 4 * lane) : kLowestState;
    stream.next = in.data() + statesBytes;
    stream.end = in.data() + in.size();
    stream.table = table_.data();
    for (int kind = 0; kind < kBandKinds; ++kind)
        for (std::size_t c = 0; c < kClasses; ++c)
            stream.tableOf[kind][c] = std::uint32_t(model_.tableOf[model_.contexts.first(level, kind) + c])
                                      << kProbabilityBits;
    stream.groupMask = static_cast<unsigned>(lanes.groups - 1);
    stream.contexts = model_.contexts;
#if TESSERA_X86
    const bool whole = cpu != Cpu::Avx512       ? decodeRows(stream, bands, predictor)
                       : stream.contexts.byBand ? decodeRows512<Word, true>(stream, bands, predictor)
                                                : decodeRows512<Word, false>(stream, bands, predictor);
#else
    const bool whole = decodeRows(stream, bands, predictor);
    (void)cpu;
#endif
    if (!whole) return DecodeStatus::Truncated;
    if (stream.next != stream.end || (stream.rawAt + 7) / 8 != rawBytes) return DecodeStatus::Trailing;
    // The encoder starts with the lowest state, so the decoder must end with it.
    for (const auto& group : stream.states)
        for (const std::uint32_t state : group)
            if (state != kLowestState) return DecodeStatus::BadData;
    return DecodeStatus::Ok;
}

template DecodeStatus BandDecoder::decode(std::span<const std::byte>, std::span<const Band<std::int16_t>>, int, Cpu,
                                          RowPredictor<std::int16_t>*) const;
template DecodeStatus BandDecoder::decode(std::span<const std::byte>, std::span<const Band<std::int32_t>>, int, Cpu,
                                          RowPredictor<std::int32_t>*) const;

} // namespace tessera::codec
