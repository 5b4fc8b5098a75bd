#include "codec/brick/brick_codec.h"

#include "codec/brick/brick_levels.h"
#include "codec/brick/subsamples.h"
#include "codec/brick/whole_brick.h"
#include "codec/wavelet/body_centred.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <optional>
#include <utility>

namespace tessera::codec {

namespace {

using volume::LatticeKind;
using volume::ScalarType;

/// Inverts toDifferences: restores codes from differences to the previous coarse sample.
template <class Word> void fromDifferences(std::span<const Band<Word>> bands) {
    std::uint32_t code = 0;
    forCoefficients(bands, [&](Word& word) {
        code += static_cast<std::uint32_t>(static_cast<std::int32_t>(word));
        word = static_cast<Word>(static_cast<std::int32_t>(code));
    });
}

/// Decodes the coefficients of one level; `in` must end with them.
template <class Word>
DecodeStatus decodeLevel(std::span<const std::byte> in, std::span<const Band<Word>> bands, int level,
                         const BandDecoder& decoder) {
    if (bands.empty()) return in.empty() ? DecodeStatus::Ok : DecodeStatus::Trailing;
    if (in.empty()) return DecodeStatus::Truncated;
    if (in[0] == kBands) {
        if (in.size() == 1) return DecodeStatus::Truncated;
        return decoder.decode<Word>(in.subspan(1), bands, level);
    }
    std::size_t count = 0;
    forCoefficients(bands, [&](Word) { ++count; });
    if (count == 0 && in.size() == 1 && in[0] == kNothing) return DecodeStatus::Ok;
    std::vector<std::uint32_t> symbols(count);
    if (const DecodeStatus status = decodeStream(in, symbols); status != DecodeStatus::Ok) return status;
    const std::uint32_t* next = symbols.data();
    forCoefficients(bands, [&](Word& word) { word = static_cast<Word>(static_cast<std::int32_t>(unzigzag(*next++))); });
    return in.empty() ? DecodeStatus::Ok : DecodeStatus::Trailing;
}

template <class Word>
void interpolateOddLevel(const BrickFormat& format, int level, std::array<LevelBox<Word>, 2>& samples) {
    samples[1].reset(levelSize(format.sublatticeSize(1), level), false);
    interpolateOdd<Word>(std::as_const(samples[0]).box(), samples[1].box(), level);
}

template <class Word>
DecodeStatus decodeLevels(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                          std::span<const std::uint8_t> present, const BandDecoder& decoder, DecodedBrick& out) {
    const auto step = static_cast<std::size_t>(format.sublattices());
    const bool masked = !present.empty(), predicted = format.predictsOdd(masked);
    auto& [samples, details, spare] = out.boxes<Word>();
    for (int l = format.levels - 1; l >= level; --l) {
        const bool coarsest = l == format.levels - 1;
        auto& coded = coarsest ? samples : details;
        for (std::size_t s = 0; s < step; ++s) {
            if (s == 1 && predicted) {
                coded[s].reset(l == 0 ? format.sublatticeSize(1) : glm::ivec3(0), false);
                coded[s].setUndivided();
                continue;
            }
            coded[s].reset(levelSize(format.sublatticeSize(int(s)), l), masked);
            if (coded[s].masked()) placeFlags<Word>(format, present, l, int(s), !coarsest, coded[s]);
        }
        std::span<const std::byte> in = segments[std::size_t(format.levels - 1 - l)];
        if (l == 0)
            if (const DecodeStatus status = decodeExtras(format, present, in, out); status != DecodeStatus::Ok)
                return status;
        const auto bands = bandsOf<Word>(std::span(coded).first(step), coarsest);
        if (const DecodeStatus status = decodeLevel<Word>(in, bands, l, decoder); status != DecodeStatus::Ok)
            return status;
        if (coarsest) {
            fromDifferences<Word>(bands);
            continue;
        }
        for (std::size_t s = 0; s < (predicted ? 1 : step); ++s)
            joinLevel<Word>(format, samples[s], details[s], spare[s]);
        if (predicted) std::swap(spare[1], details[1]);
        std::swap(samples, spare);
    }
    if (predicted && level == 0)
        addPrediction<Word>(std::as_const(samples[0]).box(), samples[1].box(), format.codeBits > kBitsOfPrediction);
    else if (predicted)
        interpolateOddLevel<Word>(format, level, samples);
    return DecodeStatus::Ok;
}

/// Decodes a brick whose samples are predicted by fitted weights.
template <class Word>
DecodeStatus decodeFittedLevels(const BrickFormat& format, std::span<const std::span<const std::byte>> segments,
                                int level, const BandDecoder& decoder, DecodedBrick& out) {
    auto& [samples, details, spare] = out.boxes<Word>();
    const int coarsest = format.levels - 1;
    samples[0].reset(levelSize(format.sublatticeSize(0), coarsest), false);
    for (int l = coarsest; l >= level; --l) {
        std::span<const std::byte> in = segments[std::size_t(coarsest - l)];
        if (l == 0)
            if (const DecodeStatus status = decodeExtras(format, {}, in, out); status != DecodeStatus::Ok)
                return status;
        if (l == coarsest) {
            const auto bands = bandsOf<Word>(std::span(samples).first(1), true);
            if (const DecodeStatus status = decodeLevel<Word>(in, bands, l, decoder); status != DecodeStatus::Ok)
                return status;
            fromDifferences<Word>(bands);
            continue;
        }
        spare[0].reset(levelSize(format.sublatticeSize(0), l), false);
        spare[1].reset(l == 0 && format.sublattices() == 2 ? format.sublatticeSize(1) : glm::ivec3(0), false);
        if (spare[0].size() == samples[0].size() && countOf(spare[1].size()) == 0) { // nothing new
            if (!in.empty()) return DecodeStatus::Trailing;
            continue;
        }
        if (in.empty()) return DecodeStatus::Truncated;
        if (in[0] != kBands && in[0] != kNothing) return DecodeStatus::BadMode;
        if (const DecodeStatus status =
                decodeFitted<Word>(in.subspan(1), in[0] == kNothing, l, std::as_const(samples[0]).box(), spare[0].box(),
                                   spare[1].box(), decoder, codeRange(format), out.fitted<Word>());
            status != DecodeStatus::Ok)
            return status;
        std::swap(samples, spare);
    }
    if (level > 0 && format.sublattices() == 2) interpolateOddLevel<Word>(format, level, samples);
    return DecodeStatus::Ok;
}

/// Decodes a brick stored as one stream; coarse levels are computed from all samples.
template <class Word>
DecodeStatus decodeWhole(const BrickFormat& format, std::span<const std::byte> in, int level,
                         std::span<const std::uint8_t> present, DecodedBrick& out) {
    // Wavelets preserve constants.
    if (const auto only = onlyCode(in); only && present.empty()) {
        const auto code = static_cast<Word>(static_cast<std::int32_t>(*only));
        for (int s = 0; s < format.sublattices(); ++s)
            out.boxes<Word>().samples[std::size_t(s)].fill(levelSize(format.sublatticeSize(s), level), code);
        return DecodeStatus::Ok;
    }
    const std::size_t total = countOf(format.size);
    const auto absent = std::size_t(std::count(present.begin(), present.end(), std::uint8_t(0)));
    std::vector<std::uint32_t> codes(total - absent);
    std::optional<MixedShape> mixed;
    if (format.mixed && absent == 0) mixed = {format.size, format.sublattices()};
    if (const DecodeStatus status = codec::decodeWhole(in, codes, mixed); status != DecodeStatus::Ok) return status;
    if (absent > 0) {
        std::vector<std::uint32_t> spread(total);
        const std::uint32_t* next = codes.data();
        for (std::size_t i = 0; i < total; ++i)
            if (present[i] != 0) spread[i] = *next++;
        codes = std::move(spread);
    }
    auto& samples = out.boxes<Word>().samples;
    BrickLevels<Word> levels;
    splitBrick<Word>(format, codes, present, level + 1, levels);
    const auto boxes = boxesAt(levels, format, level);
    std::move(boxes.begin(), boxes.end(), samples.begin());
    if (level > 0 && format.predictsOdd(!present.empty())) interpolateOddLevel<Word>(format, level, samples);
    return DecodeStatus::Ok;
}

} // namespace

DecodeStatus decodeBrick(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                         std::span<const std::uint8_t> present, const BandDecoder& bands, DecodedBrick& out,
                         std::span<const std::uint8_t> parts) {
    assert(level >= 0 && level < format.levels && int(segments.size()) == format.levels - level);
    assert(present.empty() || present.size() == countOf(format.size));
    out.begin(format, level);
    out.present = maskAt(format, present, level);
    std::vector<std::span<const std::byte>> coefficients;
    if (format.subsampled) {
        coefficients.assign(segments.begin(), segments.end());
        if (const DecodeStatus status = takeSubsamples(format, present, coefficients[0], out.subsamples);
            status != DecodeStatus::Ok)
            return status;
        segments = coefficients;
    }
    if (format.isStepped()) return decodeStepped(format, segments, level, present, parts, out);
    const bool narrow = out.narrow = fitsInt16(format, !present.empty());
    // Skip the extra streams to find the mode byte of a brick with one level.
    std::span<const std::byte> first = segments[0];
    if (format.levels == 1) {
        if (const DecodeStatus status = decodeExtras(format, present, first, out); status != DecodeStatus::Ok)
            return status;
        out.exact.clear();
    }
    if ((first.empty() || !isWhole(first[0])) && !bands.model().fitted.empty()) {
        if (!canBeFitted(format, !present.empty())) return DecodeStatus::BadMode;
        return narrow ? decodeFittedLevels<std::int16_t>(format, segments, level, bands, out)
                      : decodeFittedLevels<std::int32_t>(format, segments, level, bands, out);
    }
    if (first.empty() || !isWhole(first[0]))
        return narrow ? decodeLevels<std::int16_t>(format, segments, level, present, bands, out)
                      : decodeLevels<std::int32_t>(format, segments, level, present, bands, out);
    if (level == 0) {
        std::span<const std::byte> last = segments.back();
        if (const DecodeStatus status = decodeExtras(format, present, last, out); status != DecodeStatus::Ok)
            return status;
        if (format.levels > 1 && !last.empty()) return DecodeStatus::Trailing;
    }
    for (std::size_t s = 1; s + 1 < segments.size(); ++s)
        if (!segments[s].empty()) return DecodeStatus::Trailing;
    if (level > 0 && segments.size() > 1 && !segments.back().empty()) return DecodeStatus::Trailing;
    return narrow ? decodeWhole<std::int16_t>(format, first, level, present, out)
                  : decodeWhole<std::int32_t>(format, first, level, present, out);
}

} // namespace tessera::codec
