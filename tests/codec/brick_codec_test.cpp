#include "codec/brick/brick_codec.h"

#include "codec/brick/sample_numbers.h"
#include "codec/brick/subsamples.h"
#include "tests/codec/make_dataset.h"

#include <bit>
#include <cstring>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::LatticeKind;
using volume::ScalarType;

struct MadeBrick {
    BrickFormat format;
    Bytes samples;
    std::vector<std::uint8_t> present;
    double maxError = 0;
};

std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

MadeBrick randomBrick(std::mt19937& random) {
    constexpr int kSizes[] = {1, 2, 3, 8, 17};
    constexpr Texture kTextures[] = {Texture::Smooth,   Texture::Noise, Texture::Constant,
                                     Texture::Decimals, Texture::Nasty, Texture::Sparse};
    const auto pick = [&](const auto& list) { return list[random() % std::size(list)]; };
    MadeBrick made;
    made.format.kind = random() % 2 == 0 ? LatticeKind::CC : LatticeKind::BCC;
    made.format.size = {pick(kSizes), pick(kSizes), pick(kSizes)};
    made.format.levels = 1 + int(random() % 4);
    made.format.wavelet = static_cast<Wavelet>(random() % std::size(kWaveletNames));
    made.format.type = static_cast<ScalarType>(random() % 5);
    const Texture texture = pick(kTextures);
    volume::Field field = volume::makeField({LatticeKind::CC, made.format.size, {}, {}}, made.format.type);
    volume::dispatch(made.format.type, [&]<class T>(T) {
        std::size_t i = 0;
        for (int z = 0; z < made.format.size.z; ++z)
            for (int y = 0; y < made.format.size.y; ++y)
                for (int x = 0; x < made.format.size.x; ++x)
                    field.as<T>()[i++] = madeSample<T>(texture, {x, y, z}, 0, 0, random);
    });
    if (random() % 2 == 0) {
        for (std::size_t i = 0; i < field.count(); ++i) made.present.push_back(random() % 4 != 0);
        field.mask = std::make_shared<const volume::Mask>(made.present);
        made.format.keepsAbsent = random() % 2 == 0;
    }
    if (made.format.type == ScalarType::F32 && random() % 3 == 0) made.maxError = 0.01;
    made.format.numbers = chooseCoding(field, made.maxError);
    made.samples = field.samples;
    if (made.format.type != ScalarType::F32) made.format.codeBits = codeBitsOf(made.format.type);
    made.format.subsampled = made.format.levels > 1 && random() % 3 == 0;
    return made;
}

std::vector<Bytes> encoded(const MadeBrick& made, const Model& model, Compressor& compressor) {
    std::vector<Bytes> segments =
        encodeBrick(made.format, made.samples, made.present, made.maxError, compressor, BandEncoder(model));
    if (made.format.subsampled) addSubsamples(made.format, made.samples, made.present, compressor, segments);
    return segments;
}

/// The model of the brick itself, or of another one: any brick must come back with any model.
Model modelOf(const MadeBrick& made, bool own, bool byBand) {
    const Contexts contexts{3, byBand};
    Histogram histogram(made.format.levels, contexts);
    SplitMemory memory;
    if (own) countBrick(prepareBrick(made.format, made.samples, made.present, 0, contexts, memory), histogram);
    for (std::size_t t = 0; !own && t < 30; ++t) histogram.counts[5][t] = 100;
    return makeModel(histogram, 16);
}

std::vector<std::span<const std::byte>> views(const std::vector<Bytes>& segments, std::size_t count) {
    return {segments.begin(), segments.begin() + std::ptrdiff_t(count)};
}

TEST(BrickCodec, DecodesWhatItEncodes) {
    std::mt19937 random(11);
    Compressor compressor(3);
    for (int trial = 0; trial < 1000; ++trial) {
        const MadeBrick made = randomBrick(random);
        const Model model = modelOf(made, trial % 3 != 0, trial % 2 == 0);
        const BandDecoder decoder(model);
        const std::vector<Bytes> segments = encoded(made, model, compressor);
        ASSERT_EQ(int(segments.size()), made.format.levels);
        for (int level = made.format.levels - 1; level >= 0; --level) {
            DecodedBrick decoded;
            ASSERT_EQ(decodeBrick(made.format, views(segments, std::size_t(made.format.levels - level)), level,
                                  made.present, decoder, decoded),
                      DecodeStatus::Ok);
            const std::vector<std::uint32_t> codes = decoded.codes();
            ASSERT_EQ(codes.size(), countOf(samplesAt(made.format, level)));
            ASSERT_EQ(decoded.present, maskAt(made.format, made.present, level));
            ASSERT_EQ(decoded.subsamples, made.format.subsampled ? subsamplesOf(made.format, made.samples, made.present)
                                                                 : std::vector<std::uint32_t>());
            if (level > 0) continue;
            ASSERT_EQ(decoded.present, made.present);
            std::vector<std::uint32_t> exact(codes.size());
            std::vector<bool> isExact(exact.size());
            for (const ExactSample& sample : decoded.exact)
                exact[sample.index] = sample.bits, isExact[sample.index] = true;
            std::size_t absent = 0;
            volume::dispatch(made.format.type, [&]<class T>(T) {
                for (std::size_t i = 0; i < codes.size(); ++i) {
                    T original;
                    std::memcpy(&original, made.samples.data() + i * sizeof(T), sizeof(T));
                    std::uint32_t bits = 0;
                    T value = sampleOf<T>(made.format.numbers, codes[i]);
                    if (!volume::isPresent(made.present, i)) {
                        if (!made.format.keepsAbsent) continue;
                        bits = decoded.absent[absent++];
                        std::memcpy(&value, &bits, sizeof(T));
                    } else if (isExact[i]) {
                        std::memcpy(&value, &exact[i], sizeof(T));
                    }
                    if constexpr (std::is_same_v<T, float>) {
                        if (made.format.numbers.kind == NumberKind::Quantised && std::isfinite(original)) {
                            ASSERT_LE(std::abs(double(value) - double(original)), made.maxError);
                            continue;
                        }
                    }
                    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): every bit counts
                    ASSERT_EQ(std::memcmp(&value, &original, sizeof(T)), 0) << "trial " << trial << " sample " << i;
                }
            });
        }
    }
}

TEST(BrickCodec, RefusesEveryTruncationAndEveryTrailingByte) {
    std::mt19937 random(12);
    Compressor compressor(3);
    for (int trial = 0; trial < 60; ++trial) {
        const MadeBrick made = randomBrick(random);
        const Model model = modelOf(made, trial % 3 != 0, trial % 2 == 0);
        const BandDecoder decoder(model);
        const std::vector<Bytes> segments = encoded(made, model, compressor);
        for (std::size_t s = 0; s < segments.size(); ++s) {
            const std::size_t stride = segments[s].size() / 200 + 1;
            for (std::size_t length = 0; length <= segments[s].size() + 1;
                 length += length + stride < segments[s].size() ? stride : 1) {
                if (length == segments[s].size()) continue;
                // A copy of exactly that length, so that the sanitizer sees one byte too many.
                Bytes changed(segments[s].begin(),
                              segments[s].begin() + std::ptrdiff_t(std::min(length, segments[s].size())));
                changed.resize(length);
                auto inputs = views(segments, segments.size());
                inputs[s] = changed;
                DecodedBrick decoded;
                ASSERT_NE(decodeBrick(made.format, inputs, 0, made.present, decoder, decoded), DecodeStatus::Ok)
                    << "segment " << s << " length " << length;
            }
        }
    }
}

TEST(BrickCodec, SurvivesEveryFlippedBit) {
    std::mt19937 random(13);
    Compressor compressor(3);
    for (int trial = 0; trial < 60; ++trial) {
        const MadeBrick made = randomBrick(random);
        const Model model = modelOf(made, true, true);
        const BandDecoder decoder(model);
        std::vector<Bytes> segments = encoded(made, model, compressor);
        for (Bytes& segment : segments)
            for (std::size_t i = 0; i < segment.size(); i += i < 24 ? 1 : 1 + segment.size() / 50)
                for (int bit = 0; bit < 8; ++bit) {
                    segment[i] ^= static_cast<std::byte>(1 << bit);
                    DecodedBrick decoded;
                    (void)decodeBrick(made.format, views(segments, segments.size()), 0, made.present, decoder, decoded);
                    segment[i] ^= static_cast<std::byte>(1 << bit);
                }
    }
}

TEST(BrickCodec, AConstantBrickCostsAFewBytes) {
    Compressor compressor(3);
    BrickFormat format{LatticeKind::BCC, {32, 32, 64}, 4, Wavelet::W22, ScalarType::U16, {}, false};
    Bytes samples(countOf(format.size) * 2);
    for (std::size_t i = 0; i < samples.size(); i += 2) samples[i] = std::byte{200};
    const BandEncoder encoder(makeModel(Histogram(format.levels, {}), 1));
    std::size_t bytes = 0;
    for (const Bytes& segment : encodeBrick(format, samples, {}, 0, compressor, encoder)) bytes += segment.size();
    EXPECT_LE(bytes, 8u);
}

TEST(Entropy, StreamsRoundTripAtEveryWidth) {
    std::mt19937 random(14);
    Compressor compressor(3);
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<std::uint32_t> symbols(random() % 300);
        const int bits = 1 + int(random() % 32);
        const bool constant = random() % 5 == 0;
        const auto value = std::uint32_t(random()) >> (32 - bits);
        for (std::uint32_t& symbol : symbols) symbol = constant ? value : std::uint32_t(random()) >> (32 - bits);
        Bytes bytes;
        encodeStream(symbols, compressor, bytes);
        // Never much larger than the raw bytes.
        ASSERT_LE(bytes.size(), symbols.size() * 4 + 6);
        std::span<const std::byte> in = bytes;
        std::vector<std::uint32_t> decoded(symbols.size());
        ASSERT_EQ(decodeStream(in, decoded), DecodeStatus::Ok);
        ASSERT_TRUE(in.empty());
        ASSERT_EQ(decoded, symbols);
    }
}

TEST(Entropy, ZigzagKeepsSmallNumbersSmall) {
    const std::int32_t values[] = {
        0, -1, 1, -2, 2, std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()};
    const std::uint32_t symbols[] = {0, 1, 2, 3, 4, 0xfffffffeu, 0xffffffffu};
    for (std::size_t i = 0; i < std::size(values); ++i) {
        EXPECT_EQ(zigzag(std::uint32_t(values[i])), symbols[i]);
        EXPECT_EQ(unzigzag(symbols[i]), std::uint32_t(values[i]));
    }
}

} // namespace
} // namespace tessera::codec
