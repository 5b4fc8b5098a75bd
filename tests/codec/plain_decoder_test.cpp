#include "tests/codec/plain/decoder.h"

#include "codec/archive.h"
#include "codec/pack.h"
#include "tests/codec/make_dataset.h"

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
                    const plain::Brick brick = decoder.brick(frame, number, level);
                    ASSERT_EQ(brick.size, (plain::Size{expected.size.x, expected.size.y, expected.size.z}));
                    for (std::size_t i = 0; i < brick.values.size(); ++i) {
                        const auto value = float(brick.values[i]);
                        const bool present = brick.present[i] && std::isfinite(value);
                        ASSERT_EQ(present, expected.present.empty() || expected.present[i] != 0);
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

TEST(PlainDecoder, GivesBackStoredNumbersOfAbsentSamplesToo) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({9, 8, 7}, {{"a", ScalarType::F32, 1, Texture::Nasty, true, false}}, 1);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 16;
    pack(made, options, folder / "a.tsr");
    const volume::Field field = made.load(0, 0, 0);
    const plain::Brick brick = plain::Decoder(readFile(folder / "a.tsr")).brick(0, 0, 0);
    for (std::size_t i = 0; i < field.count(); ++i) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, field.samples.data() + 4 * i, 4);
        ASSERT_EQ(brick.bits[i], bits);
    }
}

} // namespace
} // namespace tessera::codec
