// The encoding half of brick_codec.h.
#include "codec/brick/brick_codec.h"
#include "codec/brick/brick_levels.h"
#include "codec/brick/whole_brick.h"
#include "volume/field/field.h"

#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

namespace tessera::codec {

namespace {

// Below kTryWhole bits per sample, coding as one stream is tried, first on kGlance samples.
constexpr double kTryWhole = 3.0;
constexpr std::size_t kGlance = 1 << 14;
constexpr double
    kGlanceAsShort = 1.5,
    kGlanceBeforeLzma = 2, kNearlyAsShort = 1.15,
    kPerhapsAsShort =
        1.3; // factors on the size of bands below which a fast trial counts as promising; for some before LZMA
constexpr double kWorthLevels = 0.9;
constexpr double kWorthMixing = 0.9; // factor on the size that makes up for slow decoding
constexpr double kSparse = 0.75;     // bits per sample
constexpr int kLeastZstdLevel = -4, kSomeZstdLevel = 3;

/// Codes of the samples, and what is stored in addition.
struct Numbers {
    std::vector<std::uint32_t> codes, exactIndex, exactBits, absentBits;
};

/// Lists the samples that decoded codes do not reproduce.
void addInexact(const BrickFormat& format, std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                double maxError, std::span<const std::uint32_t> decoded, Numbers& numbers) {
    constexpr std::size_t kRow = 512;
    std::array<float, kRow> wanted, rounded;
    const double allowed = isBounded(format.numbers) ? maxError : -1;
    for (std::size_t first = 0; first < decoded.size(); first += kRow) {
        const std::size_t count = std::min(kRow, decoded.size() - first);
        std::memcpy(wanted.data(), samples.data() + first * sizeof(float), count * sizeof(float));
        toSamples(format.numbers, std::span(reinterpret_cast<const std::int32_t*>(decoded.data()) + first, count),
                  rounded.data());
        // In nearly all rows every sample is close, which a vectorised loop sees.
        std::uint32_t far = 0;
        for (std::size_t i = 0; i < count; ++i)
            far |= std::abs(double(wanted[i]) - double(rounded[i])) <= allowed ||
                           std::bit_cast<std::uint32_t>(wanted[i]) == std::bit_cast<std::uint32_t>(rounded[i])
                       ? 0u
                       : 1u;
        for (std::size_t i = 0; far != 0 && i < count; ++i) {
            if (close(format.numbers, maxError, wanted[i], rounded[i]) || !volume::isPresent(present, first + i))
                continue;
            numbers.exactIndex.push_back(static_cast<std::uint32_t>(first + i));
            numbers.exactBits.push_back(std::bit_cast<std::uint32_t>(wanted[i]));
        }
    }
}

Numbers numbersOf(const BrickFormat& format, std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                  double maxError) {
    Numbers numbers;
    numbers.codes.resize(countOf(format.size));
    volume::dispatch(format.type, [&]<class T>(T) {
        const auto sampleAt = [&](std::size_t i) {
            T sample;
            std::memcpy(&sample, samples.data() + i * sizeof(T), sizeof(T));
            return sample;
        };
        if constexpr (std::same_as<T, float>) {
            codesOf(format.numbers, samples, numbers.codes.data());
            for (std::size_t i = 0; i < present.size(); ++i) {
                if (present[i] != 0) continue;
                numbers.codes[i] = 0;
                numbers.absentBits.push_back(std::bit_cast<std::uint32_t>(sampleAt(i)));
            }
            if (format.canHaveExact() && !format.isStepped())
                addInexact(format, samples, present, maxError, numbers.codes, numbers);
        } else {
            codesOf(format.numbers, format.type, samples, numbers.codes.data());
            for (std::size_t i = 0; i < present.size(); ++i) {
                if (present[i] != 0) continue;
                numbers.absentBits.push_back(static_cast<std::uint32_t>(static_cast<std::int32_t>(sampleAt(i))));
                if (format.isStepped()) numbers.codes[i] = 0;
            }
        }
    });
    return numbers;
}

/// Replaces each coarse sample by its difference from the previous one.
template <class Word> void toDifferences(std::span<const Band<Word>> bands) {
    std::uint32_t before = 0;
    forCoefficients(bands, [&](Word& word) {
        const std::uint32_t code = static_cast<std::uint32_t>(static_cast<std::int32_t>(word));
        word = static_cast<Word>(static_cast<std::int32_t>(code - before));
        before = code;
    });
}
template <class Word> std::vector<Band<const Word>> constBands(std::span<const Band<Word>> bands) {
    std::vector<Band<const Word>> out;
    for (const Band<Word>& band : bands)
        out.push_back({band.values, band.present, band.size, band.rowPitch, band.slicePitch, band.kind});
    return out;
}

/// Converts a transformed brick to tokens.
template <class Word>
std::vector<TokenRun> levelTokens(const BrickFormat& format, Contexts contexts, BrickLevels<Word>& levels) {
    std::vector<TokenRun> runs;
    for (int level = 0; level < format.levels; ++level) {
        const bool coarsest = level == format.levels - 1;
        const auto bands = bandsOf<Word>(boxesAt(levels, format, level), coarsest);
        if (coarsest) toDifferences<Word>(bands);
        runs.push_back(tokensOf<Word>(constBands<Word>(bands), contexts));
    }
    return runs;
}

/// The samples of a brick at a level; `boxes` are its sublattices.
template <class Word>
FittedLevel<Word> fittedLevel(const BrickFormat& format, int level, const BrickLevels<Word>& boxes) {
    FittedLevel<Word> of{level, boxes[0].box(), {}};
    if (level == 0 && format.sublattices() == 2) of.other = boxes[1].box();
    return of;
}

/// The same for a brick whose samples are predicted.
template <class Word>
std::vector<TokenRun> fittedLevels(const BrickFormat& format, Contexts contexts, const FittedWeights& weights,
                                   BrickLevels<Word>& boxes, FittedMemory<Word>& memory) {
    std::vector<TokenRun> runs;
    const int coarsest = format.levels - 1;
    for (int level = 0; level < coarsest; ++level)
        runs.push_back(
            fittedTokens<Word>(fittedLevel(format, level, boxes), contexts, weights, codeRange(format), memory));
    std::array<LevelBox<Word>, 1> last;
    last[0].reset(levelSize(format.sublatticeSize(0), coarsest), false);
    const glm::ivec3 size = last[0].size();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) {
            const Word* const from = boxes[0].box().row(y << coarsest, z << coarsest);
            for (int x = 0; x < size.x; ++x) last[0].box().row(y, z)[x] = from[x << coarsest];
        }
    const auto bands = bandsOf<Word>(last, true);
    toDifferences<Word>(bands);
    runs.push_back(tokensOf<Word>(constBands<Word>(bands), contexts));
    return runs;
}

/// Whether most floats of a brick occur more than once, as in mirrored or repetitive fields. Tests the values in one of
/// sixteen hash classes, since equal values share a class.
bool valuesRecur(std::span<const std::byte> samples, std::span<const std::uint8_t> present) {
    constexpr std::uint32_t kHash = 0x9E3779B1;
    constexpr std::size_t kFew = 256;
    std::vector<std::uint32_t> seen;
    for (std::size_t i = 0; i + sizeof(std::uint32_t) <= samples.size(); i += sizeof(std::uint32_t)) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &samples[i], sizeof bits);
        if ((bits * kHash) >> 28 == 0 && volume::isPresent(present, i / sizeof bits)) seen.push_back(bits);
    }
    const std::size_t count = seen.size();
    std::ranges::sort(seen);
    const auto repeated = std::ranges::unique(seen);
    return count >= kFew && 2 * repeated.size() >= count;
}

/// Codes all samples as one stream in segment 0 if that is shorter than bands: for constants, labels, repeated slices.
void tryWhole(const BrickFormat& format, std::span<const std::byte> samples, std::span<const std::uint8_t> present,
              Compressor& compressor, std::vector<Bytes>& segments) {
    std::size_t bytes = 0;
    for (const Bytes& segment : segments) bytes += segment.size();
    const std::size_t count = countOf(format.size);
    if (bytes <= segments.size()) return;
    // Levels of detail are worth more than a few bytes if they are large.
    const bool dense = 8.0 * double(bytes) > kTryWhole * double(count);
    if (dense && (format.type != volume::ScalarType::F32 || !valuesRecur(samples, present))) return;
    const int usual = compressor.level();
    Bytes whole;
    const auto tryLevel = [&](std::span<const std::uint32_t> codes, int level, double nearly) {
        compressor.setLevel(level);
        whole = encodeWhole(codes, compressor);
        compressor.setLevel(usual);
        return double(whole.size()) <= nearly * double(bytes) * double(codes.size()) / double(count);
    };
    const bool sparse = 8.0 * double(bytes) < kSparse * double(count);
    if (!sparse && !compressor.triesLzma() && present.empty() && volume::byteSize(format.type) == 1 &&
        count > kGlance) {
        Bytes glance;
        constexpr std::size_t kPieces = 2, kPiece = kGlance / kPieces;
        for (std::size_t i = 0; i < kPieces; ++i) {
            const auto piece = samples.subspan((2 * i + 1) * (count - kPiece) / (2 * kPieces), kPiece);
            glance.insert(glance.end(), piece.begin(), piece.end());
        }
        compressor.setLevel(kLeastZstdLevel);
        const Bytes seen = compressor.compress(glance);
        compressor.setLevel(usual);
        const double share = double(kGlance) / double(count);
        if (seen.empty() || double(seen.size()) > kGlanceAsShort * double(bytes) * share) return;
    }
    std::vector<std::uint32_t> codes = numbersOf(format, samples, present, 0).codes;
    if (!present.empty()) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < codes.size(); ++i)
            if (volume::isPresent(present, i)) codes[kept++] = codes[i];
        codes.resize(kept);
    }
    if (!sparse && isBounded(format.numbers) && codes.size() > 2 * kGlance) {
        const std::span<const std::uint32_t> middle = std::span(codes).subspan((codes.size() - kGlance) / 2, kGlance);
        if (!tryLevel(middle, kLeastZstdLevel, compressor.triesLzma() ? kGlanceBeforeLzma : kGlanceAsShort)) return;
    }
    // If a fast compression is about as short as bands, a thorough one is worth its time.
    if (!tryLevel(codes, kSomeZstdLevel, compressor.triesLzma() ? kPerhapsAsShort : kNearlyAsShort)) return;
    if (usual != kSomeZstdLevel) (void)tryLevel(codes, usual, 1);
    if (double(whole.size()) >= (dense ? kWorthLevels : 1.0) * double(bytes)) return;
    for (Bytes& segment : segments) segment.clear();
    segments[0] = std::move(whole);
}

/// Codes them as a mixed brick if that is much shorter than what they are now.
void tryMixed(const BrickFormat& format, std::span<const std::byte> samples, std::span<const std::uint8_t> present,
              Compressor& compressor, std::vector<Bytes>& segments) {
    // With one level, other streams may come before the mode.
    if (!format.mixed || format.levels == 1 || !present.empty() || !compressor.triesLzma()) return;
    if (countOf(format.size) > kMostMixed) return;
    std::size_t bytes = 0;
    for (const Bytes& segment : segments) bytes += segment.size();
    const std::vector<std::uint32_t> codes = numbersOf(format, samples, present, 0).codes;
    Bytes mixed = encodeWholeMixed(codes, {format.size, format.sublattices()}, compressor);
    if (mixed.empty() || double(mixed.size()) >= kWorthMixing * double(bytes)) return;
    for (Bytes& segment : segments) segment.clear();
    segments[0] = std::move(mixed);
}

} // namespace

PreparedBrick prepareBrick(const BrickFormat& format, std::span<const std::byte> samples,
                           std::span<const std::uint8_t> present, double maxError, Contexts contexts,
                           SplitMemory& memory, std::span<const std::uint32_t> prediction, const FittedWeights* fitted,
                           std::span<const std::uint8_t> parts) {
    assert(samples.size() == countOf(format.size) * volume::byteSize(format.type));
    assert(present.empty() || present.size() == countOf(format.size));
    PreparedBrick brick;
    Numbers numbers;
    const bool plain = format.type != volume::ScalarType::F32 && present.empty() && !format.isStepped();
    if (!plain) numbers = numbersOf(format, samples, present, maxError);
    if (format.isStepped()) {
        for (std::size_t i = 0; i < prediction.size(); ++i) numbers.codes[i] -= prediction[i];
        for (std::size_t i = 0; !prediction.empty() && i < present.size(); ++i)
            if (present[i] == 0) numbers.codes[i] = 0;
        SteppedBrick stepped = encodeStepped(format, numbers.codes, present, parts, memory.boxes32);
        for (std::size_t i = 0; i < prediction.size(); ++i) stepped.codes[i] += prediction[i];
        if (format.canHaveExact()) addInexact(format, samples, present, maxError, stepped.codes, numbers);
        brick = {std::move(stepped.segments), std::move(stepped.codes), {}, {}, {}, {}};
    }
    const bool predicts = fitted && !fitted->empty();
    assert(!predicts || canBeFitted(format, !present.empty()));
    const auto tokens = [&]<class Word>(BrickLevels<Word>& levels, FittedMemory<Word>& own) {
        const int count = predicts ? 1 : format.levels; // not split, if predicted
        if (plain)
            splitIntegers<Word>(format, samples, count, levels);
        else
            splitBrick<Word>(format, numbers.codes, present, count, levels);
        brick.levels = predicts ? fittedLevels<Word>(format, contexts, *fitted, levels, own)
                                : levelTokens<Word>(format, contexts, levels);
    };
    if (!format.isStepped())
        fitsInt16(format, !present.empty()) ? tokens(memory.boxes16, memory.fitted16)
                                            : tokens(memory.boxes32, memory.fitted32);
    brick.exactIndex = std::move(numbers.exactIndex);
    brick.exactBits = std::move(numbers.exactBits);
    brick.absentBits = std::move(numbers.absentBits);
    return brick;
}

void addToFit(const BrickFormat& format, std::span<const std::byte> samples, int shift, int every, SplitMemory& memory,
              WeightFit& fit) {
    assert(canBeFitted(format, false));
    const auto add = [&]<class Word>(BrickLevels<Word>& boxes, FittedMemory<Word>& own) {
        if (format.type == volume::ScalarType::F32)
            splitBrick<Word>(format, numbersOf(format, samples, {}, 0).codes, {}, 1, boxes);
        else
            splitIntegers<Word>(format, samples, 1, boxes);
        for (int level = 0; level + 1 < format.levels; ++level)
            codec::addToFit<Word>(fittedLevel(format, level, boxes), shift, level == 0 ? every : 1, own, fit);
    };
    fitsInt16(format, false) ? add(memory.boxes16, memory.fitted16) : add(memory.boxes32, memory.fitted32);
}

void countBrick(const PreparedBrick& brick, Histogram& histogram, int every) {
    for (std::size_t level = 0; level < brick.levels.size(); ++level)
        countTokens(brick.levels[level], int(level), histogram, every);
}

std::vector<Bytes> encodeBrick(const BrickFormat& format, const PreparedBrick& brick,
                               std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                               Compressor& compressor, const BandEncoder& bands) {
    std::vector<Bytes> segments = format.isStepped() ? brick.stepped : std::vector<Bytes>(brick.levels.size());
    for (std::size_t level = 0; level < brick.levels.size(); ++level) {
        if (brick.levels[level].tokens.empty()) continue; // no bands
        Bytes& out = segments[brick.levels.size() - 1 - level];
        out.push_back(brick.levels[level].zero ? kNothing : kBands);
        bands.encode(brick.levels[level], int(level), out);
    }
    if (!format.isStepped()) {
        tryWhole(format, samples, present, compressor, segments);
        tryMixed(format, samples, present, compressor, segments);
    }

    Bytes extras;
    if (format.keepsAbsent) encodeStream(brick.absentBits, compressor, extras);
    if (format.canHaveExact()) {
        appendU32(extras, static_cast<std::uint32_t>(brick.exactIndex.size()));
        encodeStream(brick.exactIndex, compressor, extras);
        encodeStream(brick.exactBits, compressor, extras);
    }
    Bytes& fine = segments.back();
    fine.insert(fine.begin(), extras.begin(), extras.end());
    return segments;
}

std::vector<Bytes> encodeBrick(const BrickFormat& format, std::span<const std::byte> samples,
                               std::span<const std::uint8_t> present, double maxError, Compressor& compressor,
                               const BandEncoder& bands) {
    SplitMemory memory;
    const PreparedBrick brick =
        prepareBrick(format, samples, present, maxError, bands.model().contexts, memory, {}, &bands.model().fitted);
    return encodeBrick(format, brick, samples, present, compressor, bands);
}

} // namespace tessera::codec
