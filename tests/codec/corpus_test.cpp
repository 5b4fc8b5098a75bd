#include "codec/archive/archive.h"
#include "codec/archive/archive_state.h"
#include "codec/brick/brick_codec.h"
#include "codec/brick/whole_brick.h"
#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "tests/fuzz/fuzz_model.h"
#include "tests/volume/regions.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::LatticeKind;
using volume::ScalarType;

std::string corpus() {
    return TESSERA_SOURCE_DIR "/tests/fuzz/corpus/";
}

volume::Dataset corpusDataset() {
    return makeDataset({5, 4, 6},
                       {{"O2", ScalarType::F32, 1, Texture::Decimals, true, false},
                        {"region", ScalarType::U8, 1, Texture::Noise, true, true},
                        {"U", ScalarType::F32, 2, Texture::Nasty, false, false}},
                       1);
}

/// Rough samples, all of which change a little from time to time.
volume::Dataset slowDataset() {
    volume::Dataset made = makeDataset({9, 8, 10}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 4);
    const volume::Lattice lattice = made.info.lattice;
    made.info.parameters[0].ranges = {{0, 10}};
    made.read = [lattice](int, int, int time) {
        volume::Field field = volume::makeField(lattice, ScalarType::F32);
        std::mt19937 random(1);
        for (float& sample : field.as<float>()) sample = float(random() % 1000) / 100 + 0.05f * float(time);
        return field;
    };
    return made;
}

/// Waves of four samples, which fitted weights predict and wavelets do not.
volume::Dataset wavesDataset() {
    volume::Dataset made = makeDataset({33, 30, 26}, {{"a", ScalarType::U8, 1, Texture::Smooth, false, false}}, 1);
    const volume::Lattice lattice = made.info.lattice;
    made.read = [lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, ScalarType::U8);
        for (std::size_t i = 0; i < field.count(); ++i) {
            const int x = int(i) % 33, y = int(i) / 33 % 30, z = int(i) / (33 * 30);
            field.as<std::uint8_t>()[i] =
                std::uint8_t(128 + int(60 * std::sin(1.7 * x + 0.3) * std::sin(1.5 * y + 1.1 * z)) + (x * y + z) % 3);
        }
        return field;
    };
    return made;
}

/// Two small smooth bricks.
volume::Dataset mixedDataset() {
    return makeDataset({18, 15, 14}, {{"a", ScalarType::U8, 1, Texture::Smooth, false, false}}, 1);
}

// Archives of every set of features stay readable: these files were written once.
TEST(Corpus, StoredArchivesStillDecode) {
    const volume::Dataset made = corpusDataset();
    for (const char* features : {"-3", "-3-compact", "-3-bands", "-3-statistics"}) {
        const Archive archive(corpus() + "fuzz_archive/cc-exact" + features + ".tsr");
        for (int p = 0; p < 3; ++p)
            for (int c = 0; c < made.info.parameters[std::size_t(p)].components; ++c) {
                const volume::Field expected = made.read(p, c, 0), stored = readField(archive, p, c, 0);
                EXPECT_EQ(expected.samples, stored.samples);
                EXPECT_EQ(expected.mask ? *expected.mask : volume::Mask(), stored.mask ? *stored.mask : volume::Mask());
            }
        EXPECT_EQ(archive.distribution({0, 0, 0, {0, 0, 0}}).has_value(), std::string(features) == "-3-statistics");
        for (const char* name : {"bcc-exact", "bcc-bounded", "cc-bounded"})
            EXPECT_EQ(verifyArchive(Archive(corpus() + "fuzz_archive/" + name + features + ".tsr")).damaged, 0u);
    }
    for (const char* name : {"grown-3", "grown-3-compact", "grown-3-bands", "grown-3-statistics"}) {
        const Archive grown(corpus() + "fuzz_archive/" + name + ".tsr");
        EXPECT_EQ(grown.commits(), 3);
        EXPECT_EQ(grown.info().times, (std::vector<double>{0, 1.5}));
        EXPECT_EQ(verifyArchive(grown).damaged, 0u);
    }
}

TEST(Corpus, AStoredArchiveOfPartsIsShownFromSamplesOfLevelZero) {
    const Archive archive(corpus() + "fuzz_archive/parts-3-subsamples.tsr");
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    const int last = archive.grid().levels - 1;
    ASSERT_GT(last, 0);
    EXPECT_EQ(archive.read({0, 0, last, {0, 0, 0}}).values[0], archive.read({0, 0, 0, {0, 0, 0}}).values[0]);
}

TEST(Corpus, AStoredArchiveOfPredictedFramesHasItsSamplesAtEveryTime) {
    const std::string path = corpus() + "fuzz_archive/predicted-3.tsr";
    const plain::Decoder decoder(readFile(path));
    EXPECT_EQ(decoder.depth(3, 0), 3);
    const Archive archive(path);
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    const volume::Dataset made = slowDataset();
    for (int time = 3; time >= 0; --time) {
        const volume::Field is = readField(archive, 0, 0, time), was = made.read(0, 0, time);
        for (std::size_t i = 0; i < was.count(); ++i) ASSERT_NEAR(is.as<float>()[i], was.as<float>()[i], 0.01001);
    }
}

TEST(Corpus, AStoredArchiveOfFittedPredictionsHasItsSamples) {
    const Archive archive(corpus() + "fuzz_archive/fitted-3.tsr");
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    ASSERT_FALSE(stateOf(archive, false).lastModels[0].model.fitted.empty());
    EXPECT_EQ(readField(archive, 0, 0, 0).samples, wavesDataset().read(0, 0, 0).samples);
}

TEST(Corpus, AStoredArchiveOfMixedBricksHasItsSamples) {
    const Archive archive(corpus() + "fuzz_archive/mixed-3.tsr");
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    ASSERT_NE(stateOf(archive, false).header.features & kMixedBricks, 0u);
    EXPECT_EQ(readField(archive, 0, 0, 0).samples, mixedDataset().read(0, 0, 0).samples);
}

/// Waves of 16 bits with gaps, at two times.
volume::Dataset roughDataset() {
    volume::Dataset made = makeDataset({18, 15, 14}, {{"a", ScalarType::I16}}, 2);
    made.read = [lattice = made.info.lattice](int, int, int time) {
        volume::Field field = volume::makeField(lattice, ScalarType::I16);
        volume::Mask mask(field.count(), 1);
        std::mt19937 random(3);
        for (std::size_t i = 0; i < field.count(); ++i) {
            const int x = int(i) % 18, y = int(i) / 18 % 15, z = int(i) / (18 * 15);
            field.as<std::int16_t>()[i] = static_cast<std::int16_t>(
                int(9000 * std::sin(0.3 * x + 0.2 * y) * std::cos(0.25 * z)) + int(random() % 60) + 7 * time);
            mask[i] = y > 10 && x > 12 ? 0 : 1;
        }
        field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    return made;
}

TEST(Corpus, AStoredArchiveOfIntegersWithinABoundKeepsIt) {
    const std::string path = corpus() + "fuzz_archive/integers-3.tsr";
    const Archive archive(path);
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    ASSERT_NE(stateOf(archive, false).header.features & kSteppedIntegers, 0u);
    EXPECT_EQ(plain::Decoder(readFile(path)).depth(1, 0), 1) << "predicted from the time before";
    for (int time = 0; time < 2; ++time) {
        const volume::Field is = readField(archive, 0, 0, time), was = roughDataset().read(0, 0, time);
        for (std::size_t i = 0; i < was.count(); ++i) {
            ASSERT_EQ(is.present(i), was.present(i));
            if (was.present(i)) {
                ASSERT_LE(std::abs(is.as<std::int16_t>()[i] - was.as<std::int16_t>()[i]), 20);
            }
        }
    }
}

/// Two sides between which p jumps.
volume::Dataset sidesDataset() {
    volume::Dataset made =
        makeDataset({12, 11, 10}, {{"p", ScalarType::F32}, {"region", ScalarType::U8, 1, {}, false, true}}, 1);
    made.info.parameters[0].parts = {"region", {{0}, {2, 3}}};
    made.read = [lattice = made.info.lattice](int p, int, int) {
        volume::Field field = volume::makeField(lattice, p == 0 ? ScalarType::F32 : ScalarType::U8);
        for (std::size_t i = 0; i < field.count(); ++i) {
            const int x = int(i) % 12, y = int(i) / 12 % 11, z = int(i) / (12 * 11),
                      side = y + x / 4 > 6 ? 2 + z % 2 : 0;
            if (p == 0)
                field.as<float>()[i] = float((side > 0 ? 900 : 100) + 3 * std::sin(0.4 * x) + z);
            else
                field.as<std::uint8_t>()[i] = std::uint8_t(side);
        }
        return field;
    };
    return made;
}

TEST(Corpus, AStoredArchiveOfPartsApartKeepsItsBound) {
    const Archive archive(corpus() + "fuzz_archive/parted-3.tsr");
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    ASSERT_NE(stateOf(archive, false).header.features & kPartedFrames, 0u);
    const volume::Field is = readField(archive, 0, 0, 0), was = sidesDataset().read(0, 0, 0);
    for (std::size_t i = 0; i < was.count(); ++i) ASSERT_NEAR(is.as<float>()[i], was.as<float>()[i], 0.5);
    EXPECT_EQ(readField(archive, 1, 0, 0).samples, sidesDataset().read(1, 0, 0).samples);
}

TEST(Corpus, AStoredArchiveWithCorrectionsKeepsLabelsAndItsBound) {
    const auto archive = std::make_shared<const Archive>(corpus() + "fuzz_archive/corrected-3.tsr");
    EXPECT_EQ(verifyArchive(*archive).damaged, 0u);
    ASSERT_NE(stateOf(*archive, false).header.features & kCorrections, 0u);
    const plain::Decoder decoder(readFile(corpus() + "fuzz_archive/corrected-3.tsr"));
    ASSERT_EQ(decoder.corrections().size(), 1u);
    const volume::Dataset back = gridDataset(archive, 0), made = sidesDataset();
    const volume::Field is = back.read(0, 0, 0), was = made.read(0, 0, 0);
    for (std::size_t i = 0; i < was.count(); ++i) ASSERT_NEAR(is.as<float>()[i], was.as<float>()[i], 0.5);
    EXPECT_EQ(back.read(1, 0, 0).samples, made.read(1, 0, 0).samples);
    // The second reader finds the labels, too.
    const plain::Brick labels = decoder.corrections()[0].brick(1, 0, 0);
    for (std::size_t i = 0; i < labels.values.size(); ++i) ASSERT_EQ(labels.values[i], made.read(1, 0, 0).value(i));
}

/// Not a check: writes the seeds of fuzz_brick and fuzz_archive when the format changes
/// (--gtest_also_run_disabled_tests).
TEST(Corpus, DISABLED_WriteSeeds) {
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC})
        for (const double maxError : {0.0, 1e-2}) {
            volume::Dataset made = corpusDataset();
            PackOptions options;
            options.brickSize = 4;
            options.lattice = lattice;
            options.maxError = maxError;
            pack(made, options,
                 corpus() + "fuzz_archive/" + std::string(kStoredLatticeNames[std::size_t(lattice)]) +
                     (maxError > 0 ? "-bounded-3-statistics.tsr" : "-exact-3-statistics.tsr"));
        }
    // Two bricks of two parts and their label, and one that has grown twice.
    volume::Dataset parts = volume::test::twoRegions(volume::test::ccLattice({12, 6, 7}), volume::test::linearIn);
    PackOptions ofParts;
    ofParts.brickSize = 8;
    pack(parts, ofParts, corpus() + "fuzz_archive/parts-3-subsamples.tsr");
    volume::Dataset slow = slowDataset();
    PackOptions within;
    within.lattice = StoredLattice::CC;
    within.maxError = 1e-3;
    within.brickSize = 8;
    pack(slow, within, corpus() + "fuzz_archive/predicted-3.tsr");
    volume::Dataset waves = wavesDataset();
    PackOptions fits;
    fits.lattice = StoredLattice::CC;
    fits.effort = 7;
    fits.brickSize = 16;
    pack(waves, fits, corpus() + "fuzz_archive/fitted-3.tsr");
    volume::Dataset mixed = mixedDataset();
    PackOptions mixes;
    mixes.lattice = StoredLattice::CC;
    mixes.brickSize = 16;
    pack(mixed, mixes, corpus() + "fuzz_archive/mixed-3.tsr");
    volume::Dataset rough = roughDataset();
    PackOptions rounds;
    rounds.lattice = StoredLattice::CC;
    rounds.absError = 20;
    rounds.brickSize = 16;
    pack(rough, rounds, corpus() + "fuzz_archive/integers-3.tsr");
    volume::Dataset sides = sidesDataset();
    rounds.absError = 0.5;
    rounds.brickSize = 8;
    pack(sides, rounds, corpus() + "fuzz_archive/parted-3.tsr");
    rounds.lattice = StoredLattice::BCC;
    pack(sides, rounds, corpus() + "fuzz_archive/corrected-3.tsr");
    const std::string grown = corpus() + "fuzz_archive/grown-3-statistics.tsr";
    for (int step = 0; step < 3; ++step) {
        const char* const name = step == 1 ? "p" : "T";
        volume::Dataset made = makeDataset({5, 4, 6}, {{name, ScalarType::F32, 1, Texture::Smooth, true, false}}, 1);
        PackOptions options;
        options.brickSize = 4;
        if (step == 2) {
            made = makeDataset({5, 4, 6},
                               {{"T", ScalarType::F32, 1, Texture::Smooth, true, false},
                                {"p", ScalarType::F32, 1, Texture::Noise, false, false}},
                               1);
            made.info.times = {1.5};
        }
        if (step == 0)
            pack(made, options, grown);
        else
            append(made, grown);
    }
    Compressor compressor(3);
    int number = 0;
    for (int type = 0; type < 5; ++type)
        for (int masked = 0; masked < 2; ++masked) {
            // The head of fuzz_brick.cpp.
            std::vector<char> head{char(masked), 8, 7, 9, 0, 5, char(type), char(masked), 0, char(masked), 0x5b, 1};
            BrickFormat format{masked != 0 ? LatticeKind::BCC : LatticeKind::CC,
                               {9, 8, 10},
                               1,
                               Wavelet::W22,
                               static_cast<ScalarType>(type),
                               {},
                               masked != 0};
            if (format.type == ScalarType::F32) format.numbers = {NumberKind::Scaled, 1, 0.5};
            volume::Dataset made = makeDataset(format.size, {{"x", format.type, 1, Texture::Smooth, false, false}}, 1);
            const volume::Field field = made.read(0, 0, 0);
            std::vector<std::uint8_t> present;
            for (std::size_t i = 0; masked != 0 && i < field.count(); ++i)
                present.push_back((0x5b >> (i * 7 % 8) & 1) != 0);
            const Bytes body = encodeBrick(format, field.samples, present, 0, compressor, BandEncoder(fuzzModel(1)))[0];
            for (const std::byte byte : body) head.push_back(char(byte));
            writeFile(corpus() + "fuzz_brick/" + std::to_string(number++), head);
        }
    { // all samples at once, through LZMA
        std::vector<char> head{0, 15, 14, 13, 0, 5, char(ScalarType::U8), 0, 0, 0, 0, 1};
        std::string digits;
        for (int i = 0; digits.size() < std::size_t(16 * 15 * 14); ++i) digits += std::to_string(i * i / 7) + ";";
        const std::vector<std::uint32_t> symbols(digits.begin(), digits.begin() + 16 * 15 * 14);
        Compressor thorough(kMostZstdLevel, true);
        Bytes body{std::byte{5}};
        encodeStream(symbols, thorough, body);
        ASSERT_EQ(body[1], std::byte{7});
        for (const std::byte byte : body) head.push_back(char(byte));
        writeFile(corpus() + "fuzz_brick/" + std::to_string(number++), head);
    }
    for (int lattice = 0; lattice < 2; ++lattice) { // fitted predictions
        std::vector<char> head{char(lattice), 16, 15, 19, 2, 5, char(ScalarType::U8), 16, 0, 0, 0, 1};
        const BrickFormat format{lattice != 0 ? LatticeKind::BCC : LatticeKind::CC,
                                 {17, 16, 20},
                                 3,
                                 Wavelet::W22,
                                 ScalarType::U8,
                                 {},
                                 false,
                                 codeBitsOf(ScalarType::U8),
                                 true};
        volume::Dataset made = makeDataset(format.size, {{"x", format.type, 1, Texture::Smooth, false, false}}, 1);
        const std::vector<Bytes> segments = encodeBrick(format, made.read(0, 0, 0).samples, {}, 0, compressor,
                                                        BandEncoder(fuzzFittedModel(format.levels)));
        for (const Bytes& segment : segments) {
            if (&segment != &segments.back()) // as the target reads them
                for (const std::size_t byte : {segment.size() % 256, segment.size() / 256}) head.push_back(char(byte));
            for (const std::byte byte : segment) head.push_back(char(byte));
        }
        writeFile(corpus() + "fuzz_brick/" + std::to_string(number++), head);
    }
    for (int lattice = 0; lattice < 2; ++lattice) { // mixed
        std::vector<char> head{char(lattice), 15, 14, 13, 0, 5, char(ScalarType::U8), 32, 0, 0, 0, 1};
        volume::Dataset made = makeDataset({16, 15, 14}, {{"x", ScalarType::U8, 1, Texture::Smooth, false, false}}, 1);
        const volume::Field field = made.read(0, 0, 0);
        std::vector<std::uint32_t> codes;
        for (const std::uint8_t sample : field.as<std::uint8_t>()) codes.push_back(sample);
        for (const std::byte byte : encodeWholeMixed(codes, {{16, 15, 14}, 1 + lattice}, compressor))
            head.push_back(char(byte));
        writeFile(corpus() + "fuzz_brick/" + std::to_string(number++), head);
    }
    for (const ScalarType type : {ScalarType::U8, ScalarType::I32}) { // integers by quantised coefficients
        std::vector<char> head{0, 15, 14, 13, 0, 10, char(type), 0, char(128 + 8 * 2 + 6), 0, 0, 1};
        const BrickFormat format{
            LatticeKind::CC, {16, 15, 14}, 1,     static_cast<Wavelet>(10), type, {NumberKind::Stepped, 3, 0.25},
            false,           32,           false, {{6, 4}, 1u << int(type)}};
        volume::Dataset made = makeDataset(format.size, {{"x", type}}, 1);
        for (const Bytes& segment : encodeBrick(format, made.read(0, 0, 0).samples, {}, 4, compressor,
                                                BandEncoder(makeModel(Histogram(1, {}), 1))))
            for (const std::byte byte : segment) head.push_back(char(byte));
        writeFile(corpus() + "fuzz_brick/" + std::to_string(number++), head);
    }
    for (int seed = 0; seed < 5; ++seed) {
        const bool byBand = seed == 4;
        std::mt19937 random(static_cast<unsigned>(seed));
        std::vector<std::int32_t> values(40 * 5 * 3);
        for (std::int32_t& value : values)
            value = seed == 3 ? static_cast<std::int32_t>(random())
                              : static_cast<std::int32_t>(random() % (1u << (3 + 4 * (seed % 4))));
        const Band<const std::int32_t> band{values.data(), nullptr, {40, 5, 3}, 40, 200, byBand ? 3 : 0};
        const BandEncoder encoder(fuzzModel(1, byBand));
        Bytes bytes = serialise(encoder.model());
        // The head of fuzz_bands.cpp.
        std::vector<char> file{char(bytes.size() % 256), char(bytes.size() / 256 + (byBand ? 4 * 3 : 0)), 39, 4, 2};
        encoder.encode(tokensOf<std::int32_t>(std::span(&band, 1), encoder.model().contexts), 0, bytes);
        for (const std::byte byte : bytes) file.push_back(char(byte));
        writeFile(corpus() + "fuzz_bands/" + std::to_string(seed), file);
    }
}

} // namespace
} // namespace tessera::codec
