#include "codec/archive/archive.h"
#include "codec/brick/brick_codec.h"
#include "codec/pack/pack.h"
#include "codec/wavelet/body_centred.h"
#include "codec/wavelet/level_box.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "tests/codec/plain_labels.h"
#include "volume/resample/resample.h"

#include <gtest/gtest.h>
#include <random>

namespace tessera::codec {
namespace {

using namespace testing;

template <class Word, class Value> LevelBox<Word> boxOf(glm::ivec3 size, const Value& value) {
    LevelBox<Word> box(size, false);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) box.box().row(y, z)[x] = static_cast<Word>(value(x, y, z));
    return box;
}

template <class Word> void roundTrip(int bits, bool wide) {
    std::mt19937 random(4);
    for (int turn = 0; turn < 40; ++turn) {
        const auto side = [&] { return 1 + int(random() % 11); };
        const glm::ivec3 even(side(), side(), side()), odd(even.x, even.y, std::max(1, even.z - int(random() % 2)));
        const auto noise = [&](int, int, int) { return static_cast<std::int32_t>(random()) >> (32 - bits); };
        const LevelBox<Word> from = boxOf<Word>(even, noise);
        const LevelBox<Word> original = boxOf<Word>(odd, noise);
        LevelBox<Word> box = original;
        subtractPrediction<Word>(from.box(), box.box(), wide);
        addPrediction<Word>(from.box(), box.box(), wide);
        for (int z = 0; z < odd.z; ++z)
            for (int y = 0; y < odd.y; ++y)
                for (int x = 0; x < odd.x; ++x) ASSERT_EQ(box.box().row(y, z)[x], original.box().row(y, z)[x]);
    }
}

TEST(BodyCentred, ComesBackBitForBit) {
    roundTrip<std::int16_t>(8, false);
    roundTrip<std::int32_t>(17, false);
    roundTrip<std::int32_t>(17, true);
    roundTrip<std::int32_t>(32, true);
}

TEST(BodyCentred, SumsOfNarrowCodesDoNotOverflow) {
    // The worst signs: 9 9 inside and -1 -1 outside along every axis.
    const int largest = (1 << kBitsOfPrediction) - 1;
    const auto worst = [&](int x, int y, int z) {
        const auto inner = [](int i) { return i == 1 || i == 2; };
        return (inner(x) == inner(y)) == inner(z) ? largest : -largest - 1;
    };
    const LevelBox<std::int32_t> even = boxOf<std::int32_t>({4, 4, 4}, worst);
    LevelBox<std::int32_t> narrow = boxOf<std::int32_t>({4, 4, 4}, [](int, int, int) { return 0; }), wide = narrow;
    subtractPrediction<std::int32_t>(even.box(), narrow.box(), false);
    subtractPrediction<std::int32_t>(even.box(), wide.box(), true);
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) EXPECT_EQ(narrow.box().row(y, z)[x], wide.box().row(y, z)[x]);
}

TEST(BodyCentred, ForeseesCubics) {
    const auto cubic = [](double x, double y, double z) {
        return 64 * (x * x * x - 2 * x * y * y + y * z + 3 * z * z);
    };
    const LevelBox<std::int32_t> even =
        boxOf<std::int32_t>({9, 9, 9}, [&](int x, int y, int z) { return cubic(x, y, z); });
    LevelBox<std::int32_t> odd =
        boxOf<std::int32_t>({9, 9, 9}, [&](int x, int y, int z) { return cubic(x + 0.5, y + 0.5, z + 0.5); });
    subtractPrediction<std::int32_t>(even.box(), odd.box(), true);
    for (int z = 1; z < 7; ++z)
        for (int y = 1; y < 7; ++y)
            for (int x = 1; x < 7; ++x) EXPECT_EQ(odd.box().row(y, z)[x], 0);
}

TEST(BodyCentred, CoarseOddSamplesLieBetweenEvenOnes) {
    for (int level = 1; level < 5; ++level) {
        const double step = std::ldexp(1.0, -(level + 1));
        const LevelBox<std::int32_t> even =
            boxOf<std::int32_t>({5, 5, 5}, [](int x, int y, int z) { return 6400 * x - 3200 * y + 1600 * z; });
        LevelBox<std::int32_t> odd({5, 5, 5}, false);
        interpolateOdd<std::int32_t>(even.box(), odd.box(), level);
        for (int z = 0; z < 5; ++z)
            for (int y = 0; y < 5; ++y)
                for (int x = 0; x < 5; ++x)
                    EXPECT_NEAR(odd.box().row(y, z)[x], 6400 * (x + step) - 3200 * (y + step) + 1600 * (z + step),
                                0.51);
    }
}

std::vector<MadeParameter> kinds() {
    return {{"a", volume::ScalarType::U8, 1, Texture::Smooth, false, false},
            {"b", volume::ScalarType::I32, 1, Texture::Nasty, false, false},
            {"c", volume::ScalarType::U16, 1, Texture::Noise, true, false},
            {"d", volume::ScalarType::F32, 2, Texture::Smooth, true, false},
            {"e", volume::ScalarType::F32, 1, Texture::Decimals, false, false},
            {"f", volume::ScalarType::F32, 1, Texture::Nasty, false, false},
            {"region", volume::ScalarType::U8, 1, Texture::Noise, false, true}};
}

TEST(BodyCentred, ArchivesAreExactAndTheSecondReaderAgrees) {
    const TemporaryFolder folder;
    for (const glm::ivec3 size : {glm::ivec3(19, 18, 21), glm::ivec3(9, 1, 2), glm::ivec3(33, 16, 8)})
        for (const double maxError : {0.0, 1e-3}) {
            volume::Dataset made = makeDataset(size, kinds(), 1);
            PackOptions options;
            options.brickSize = 8;
            options.lattice = StoredLattice::BCC;
            options.bccTransform = BccTransform::BodyCentred;
            options.maxError = maxError;
            pack(made, options, folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            EXPECT_EQ(verifyArchive(archive).damaged, 0u);
            if (maxError == 0) {
                const volume::Field expected = volume::toBcc(made.read(0, 0, 0), false);
                EXPECT_EQ(readField(archive, 0, 0, 0).samples, expected.samples);
            }
            const plain::Decoder decoder(readFile(folder / "a.tsr"));
            const auto channels = archive.info().channels();
            const glm::ivec3 count = archive.grid().count();
            std::size_t frame = 0;
            for (std::size_t channel = 0; channel < channels.size(); ++channel) {
                if (channels[channel].magnitude) continue;
                for (int level = 0; level < decoder.levels(); ++level)
                    for (int number = 0; number < count.x * count.y * count.z; ++number) {
                        const glm::ivec3 at{number % count.x, number / count.x % count.y, number / (count.x * count.y)};
                        const volume::BrickKey key{int(channel), 0, level, at};
                        const volume::BrickSamples read = archive.read(key);
                        const volume::BrickStats stats = archive.stats(key);
                        const plain::Brick brick = plainBrick(decoder, archive, key, frame, number);
                        for (std::size_t i = 0; i < brick.values.size(); ++i) {
                            auto value = float(brick.values[i]);
                            if (!brick.present[i] || !std::isfinite(value)) continue;
                            if (level > 0) value = std::clamp(value, stats.min, stats.max);
                            ASSERT_EQ(value, read.values[i]) << channels[channel].name << " level " << level;
                        }
                    }
                ++frame;
            }
        }
}

TEST(BodyCentred, IsShorterWhereSamplesAreLikeTheirNeighbours) {
    const TemporaryFolder folder;
    volume::Dataset made =
        makeDataset({48, 48, 48}, {{"a", volume::ScalarType::U16, 1, Texture::Smooth, false, false}}, 1);
    made.read = [lattice = made.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::U16);
        std::mt19937 random(6);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i)
                    field.as<std::uint16_t>()[i] = static_cast<std::uint16_t>(
                        20000 + 9000 * std::sin(0.31 * x + 0.2 * y) * std::cos(0.27 * z - 0.11 * x) +
                        double(random() % 256));
        return field;
    };
    const auto bytes = [&](BccTransform transform) {
        PackOptions options;
        options.lattice = StoredLattice::BCC;
        options.bccTransform = transform;
        volume::Dataset copy = made;
        return pack(copy, options, folder / "a.tsr").archiveBytes;
    };
    const auto separable = bytes(BccTransform::Separable), centred = bytes(BccTransform::BodyCentred);
    EXPECT_LT(double(centred), 0.97 * double(separable));
    EXPECT_NEAR(double(bytes(BccTransform::Auto)), double(centred), 64);
}

} // namespace
} // namespace tessera::codec
