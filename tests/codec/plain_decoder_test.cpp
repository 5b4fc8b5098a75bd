#include "tests/codec/plain/decoder.h"

#include "codec/archive/archive.h"
#include "codec/brick/brick_codec.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain_labels.h"

#include <cstring>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

// Two readers written apart agree on every brick at every level: FORMAT.md says all that is needed.
TEST(PlainDecoder, AgreesOnEveryBrickAtEveryLevel) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"a", ScalarType::U8, 1, Texture::Smooth, true, false},
                                                {"b", ScalarType::I32, 1, Texture::Smooth, false, false},
                                                {"c", ScalarType::U16, 1, Texture::Noise, true, false},
                                                {"d", ScalarType::F32, 2, Texture::Smooth, true, false},
                                                {"e", ScalarType::F32, 1, Texture::Decimals, true, false},
                                                {"f", ScalarType::F32, 1, Texture::Nasty, false, false},
                                                {"g", ScalarType::I16, 1, Texture::Nasty, true, false},
                                                {"h", ScalarType::U8, 1, Texture::Sparse, true, false},
                                                {"i", ScalarType::F32, 1, Texture::Sparse, false, false},
                                                {"region", ScalarType::U8, 1, Texture::Noise, false, true}};
    int trial = 0;
    for (std::size_t choice = 0; choice < std::size(kWaveletChoiceNames); ++choice) {
        volume::Dataset made = makeDataset({19, 18, 21}, parameters, 1);
        PackOptions options;
        options.wavelet = static_cast<WaveletChoice>(choice);
        options.brickSize = trial % 3 == 0 ? 16 : 8;
        options.lattice = trial % 2 == 0 ? StoredLattice::CC : StoredLattice::BCC;
        options.maxError = trial % 4 >= 2 ? 1e-3 : 0;
        ++trial;
        const std::string path = folder / "a.tsr";
        pack(made, options, path);
        const Archive archive(path);
        const plain::Decoder decoder(readFile(path));
        const glm::ivec3 count = archive.grid().count();
        ASSERT_EQ(decoder.bricks(), (plain::Size{count.x, count.y, count.z}));
        ASSERT_EQ(decoder.levels(), archive.grid().levels);
        const auto channels = archive.info().channels();
        std::size_t frame = 0;
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            if (channels[channel].magnitude) continue;
            for (int level = 0; level < decoder.levels(); ++level)
                for (int number = 0; number < count.x * count.y * count.z; ++number) {
                    const glm::ivec3 index{number % count.x, number / count.x % count.y, number / (count.x * count.y)};
                    const volume::BrickKey key{int(channel), 0, level, index};
                    const volume::BrickSamples expected = archive.read(key);
                    const volume::BrickStats stats = archive.stats(key);
                    const plain::Brick brick = plainBrick(decoder, archive, key, frame, number);
                    ASSERT_EQ(brick.size, (plain::Size{expected.size.x, expected.size.y, expected.size.z}));
                    for (std::size_t i = 0; i < brick.values.size(); ++i) {
                        const auto value = float(brick.values[i]);
                        const bool present = brick.present[i] && std::isfinite(value);
                        ASSERT_EQ(present, expected.isPresent(i));
                        if (!present) continue;
                        const float held =
                            level > 0 && stats.min <= stats.max ? std::clamp(value, stats.min, stats.max) : value;
                        ASSERT_EQ(held, expected.values[i])
                            << kWaveletChoiceNames[choice] << " " << channels[channel].name << " level " << level;
                    }
                }
            ++frame;
        }
    }
}

TEST(PlainDecoder, AgreesWhereBandsHaveTablesOfTheirOwn) {
    // Details along x are 1 or -1, those along z 0 or 2: the neighbours look alike, the values do not.
    const glm::ivec3 size{40, 36, 32};
    volume::Dataset made = makeDataset(size, {{"a", ScalarType::U16, 1, Texture::Smooth, false, false}}, 1);
    volume::Field field = made.read(0, 0, 0);
    std::mt19937 random(1);
    std::vector<std::uint16_t> samples(field.count());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const int x = int(i) % size.x, z = int(i) / (size.x * size.y);
        samples[i] = std::uint16_t(x % 2 == 0 && z % 2 == 0 ? 500 + random() % 300 : 0);
    }
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const auto at = [&](int i, int k) -> std::uint16_t& {
                    return samples[(std::size_t(k) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) +
                                   std::size_t(i)];
                };
                const bool odd = x % 2 == 1;
                if (odd) at(x, z) = std::uint16_t(at(x - 1, z) + (random() % 2 == 0 ? 1 : -1));
                if (z % 2 == 1) at(x, z) = std::uint16_t(at(x, z - 1) + (odd ? 0 : random() % 2 * 2));
            }
    std::memcpy(field.samples.data(), samples.data(), field.samples.size());
    made.read = [field](int, int, int) { return field; };
    const TemporaryFolder folder;
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.wavelet = WaveletChoice::N1;
    pack(made, options, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    const BrickFormat format{
        volume::LatticeKind::CC,    size, archive.grid().levels, Wavelet::N1, ScalarType::U16, {}, false,
        codeBitsOf(ScalarType::U16)};
    Histogram histogram(format.levels, {0, true});
    SplitMemory memory;
    countBrick(prepareBrick(format, field.samples, {}, 0, histogram.contexts, memory), histogram);
    const Model model = makeModel(histogram, 24);
    const auto tablesOf = [&](int kind) {
        return model.tableOf.begin() + std::ptrdiff_t(model.contexts.first(0, kind));
    };
    ASSERT_FALSE(std::equal(tablesOf(1), tablesOf(1) + kClasses, tablesOf(4)));
    const plain::Decoder decoder(readFile(folder / "a.tsr"));
    for (int level = 0; level < decoder.levels(); ++level) {
        const volume::BrickSamples expected = archive.read({0, 0, level, {0, 0, 0}});
        const plain::Brick brick = decoder.brick(0, 0, level);
        ASSERT_EQ(brick.values.size(), expected.values.size());
        for (std::size_t i = 0; i < brick.values.size(); ++i) {
            ASSERT_EQ(float(brick.values[i]), expected.values[i]) << "level " << level;
            ASSERT_TRUE(level > 0 || brick.values[i] == double(samples[i]));
        }
    }
}

TEST(PlainDecoder, GivesBackStoredNumbersOfAbsentSamplesToo) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({9, 8, 7}, {{"a", ScalarType::F32, 1, Texture::Nasty, true, false}}, 1);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 16;
    pack(made, options, folder / "a.tsr");
    const volume::Field field = made.read(0, 0, 0);
    const plain::Brick brick = plain::Decoder(readFile(folder / "a.tsr")).brick(0, 0, 0);
    for (std::size_t i = 0; i < field.count(); ++i) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, field.samples.data() + 4 * i, 4);
        ASSERT_EQ(brick.bits[i], bits);
    }
}

} // namespace
} // namespace tessera::codec
