#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "tests/codec/plain_labels.h"
#include "tests/codec/sealed_file.h"
#include "volume/import/import.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::LatticeKind;
using volume::ScalarType;

constexpr ScalarType kIntegers[] = {ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::I32};

/// Waves over all of a type (`share` of it), with so much noise, some extremes, and gaps if `masked`; and a label.
volume::Dataset wavesOf(ScalarType type, double share, double noise, bool masked, int times = 1,
                        LatticeKind kind = LatticeKind::CC) {
    volume::Dataset made = makeDataset(
        {33, 26, 22}, {{"n", type}, {"region", ScalarType::U8, 1, Texture::Noise, true, true}}, times, kind);
    made.read = [lattice = made.info.lattice, type, share, noise, masked, read = made.read](int p, int c, int time) {
        if (p == 1) return read(p, c, time);
        volume::Field field = volume::makeField(lattice, type);
        field.offset = -3, field.scale = 0.5;
        std::mt19937 random(unsigned(7 + time));
        volume::Mask mask(field.count(), 1);
        volume::dispatch(type, [&]<class T>(T) {
            const double lo = double(std::numeric_limits<T>::lowest()), hi = double(std::numeric_limits<T>::max());
            const double middle = (lo + hi) / 2, reach = share * (hi - lo) / 2;
            std::size_t i = 0;
            for (int z = 0; z < lattice.size.z; ++z)
                for (int y = 0; y < lattice.size.y; ++y)
                    for (int x = 0; x < lattice.size.x; ++x, ++i) {
                        const double rough = noise * (double(random() % 2001) / 1000 - 1);
                        const double wave = std::sin(0.3 * x + 0.05 * time) * std::cos(0.2 * y - 0.1 * z);
                        field.as<T>()[i] =
                            static_cast<T>(std::clamp(std::rint(middle + reach * (wave + rough)), lo, hi));
                        if (share >= 1 && random() % 50 == 0)
                            field.as<T>()[i] =
                                random() % 2 == 0 ? std::numeric_limits<T>::max() : std::numeric_limits<T>::lowest();
                        if (masked && (random() % 97 == 0 || (y > 9 && y < 13))) mask[i] = 0;
                    }
        });
        if (masked) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    return made;
}

PackOptions onGrid(double absError, int brickSize = 16) {
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.absError = absError;
    options.brickSize = brickSize;
    return options;
}

std::uint32_t featuresOf(const std::string& path) {
    const std::vector<char> bytes = readFile(path);
    return parseHeaders(std::as_bytes(std::span(bytes)), bytes.size(), path).header.features;
}

/// Largest difference of present samples in stored numbers. The same ones must be present.
double largestApart(const volume::Field& stored, const volume::Field& source) {
    EXPECT_EQ(stored.type, source.type);
    double largest = 0;
    for (std::size_t i = 0; i < source.count(); ++i) {
        EXPECT_EQ(stored.present(i), source.present(i));
        if (source.present(i))
            largest = std::max(largest, std::abs(stored.value(i) - source.value(i)) / std::abs(source.scale));
    }
    return largest;
}

/// Every brick at every level as the second reader has it; at level 0 what readField gives.
void expectReadAlike(const Archive& archive, const std::string& path) {
    const plain::Decoder decoder(readFile(path));
    const glm::ivec3 count = archive.grid().count();
    const std::size_t frames = archive.info().parameters.size();
    for (int time = 0; time < int(archive.info().times.size()); ++time)
        for (std::size_t p = 0; p < frames; ++p)
            for (int level = 0; level < archive.grid().levels; ++level)
                for (int number = 0; number < count.x * count.y * count.z; ++number) {
                    const glm::ivec3 at{number % count.x, number / count.x % count.y, number / (count.x * count.y)};
                    const volume::BrickKey key{int(p), time, level, at};
                    const volume::BrickSamples read = archive.read(key);
                    const volume::BrickStats stats = archive.stats(key);
                    const plain::Brick brick =
                        plainBrick(decoder, archive, key, std::size_t(time) * frames + p, number);
                    ASSERT_EQ(brick.values.size(), read.values.size());
                    for (std::size_t i = 0; i < brick.values.size(); ++i) {
                        ASSERT_EQ(brick.present[i], read.isPresent(i));
                        if (!brick.present[i]) continue;
                        auto value = float(brick.values[i]);
                        if (level > 0) value = std::clamp(value, stats.min, stats.max);
                        ASSERT_EQ(value, read.values[i]) << p << " at " << time << " level " << level;
                    }
                }
}

TEST(SteppedIntegers, KeepTheBoundAtEverySampleOfEveryType) {
    const TemporaryFolder folder;
    int stepped = 0;
    for (const ScalarType type : kIntegers)
        for (const double share : {0.01, 0.8, 1.0})
            for (const double noise : {0.0, 0.02, 1.0})
                for (const bool masked : {false, true}) {
                    const double extent = type == ScalarType::U8 ? 255 : type == ScalarType::I32 ? 4294967295. : 65535;
                    for (const double bound : {1.0, 2.9, std::max(3., 0.02 * share * extent), 0.3 * extent}) {
                        SCOPED_TRACE(std::string(volume::name(type)) + " " + std::to_string(share) + " " +
                                     std::to_string(noise) + " within " + std::to_string(bound));
                        volume::Dataset made = wavesOf(type, share, noise, masked);
                        pack(made, onGrid(bound / 2), folder / "a.tsr"); // a number is half a unit
                        const Archive archive(folder / "a.tsr");
                        ASSERT_LE(largestApart(readField(archive, 0, 0, 0), made.read(0, 0, 0)), std::floor(bound));
                        ASSERT_EQ(readField(archive, 1, 0, 0).samples, made.read(1, 0, 0).samples) << "labels";
                        if ((featuresOf(folder / "a.tsr") & kSteppedIntegers) == 0) continue;
                        ++stepped;
                        ASSERT_EQ(verifyArchive(archive).damaged, 0u);
                        if (stepped % 5 == 0) expectReadAlike(archive, folder / "a.tsr");
                    }
                }
    EXPECT_GT(stepped, 60);
}

TEST(SteppedIntegers, ReachASignalToNoiseRatio) {
    const TemporaryFolder folder;
    for (const ScalarType type : kIntegers)
        for (const double wanted : {35.0, 45.0, 60.0})
            for (const double bound : {0.0, 0.05}) {
                volume::Dataset made = wavesOf(type, 0.8, 0.02, true);
                PackOptions options = onGrid(0);
                options.psnr = wanted;
                options.maxError = bound;
                pack(made, options, folder / "a.tsr");
                const Archive archive(folder / "a.tsr");
                const volume::Field stored = readField(archive, 0, 0, 0), source = made.read(0, 0, 0);
                double squares = 0, count = 0;
                for (std::size_t i = 0; i < source.count(); ++i)
                    if (source.present(i)) squares += std::pow(stored.value(i) - source.value(i), 2), ++count;
                const double extent = extentOf(archive.info().parameters[0]);
                EXPECT_GE(20 * std::log10(extent / std::sqrt(squares / count)), wanted) << volume::name(type);
                if (bound > 0) {
                    EXPECT_LE(largestApart(stored, source) * source.scale, bound * extent);
                }
                EXPECT_EQ(verifyArchive(archive).damaged, 0u);
            }
}

/// Bytes of an archive of the numbers within a bound, as integers or as floats of the same values.
double bytesOf(volume::Dataset made, ScalarType type, double bound, const std::string& path) {
    if (type == ScalarType::F32) {
        made.info.parameters[0].type = type;
        made.read = [read = made.read](int p, int c, int time) {
            const volume::Field from = read(p, c, time);
            volume::Field field = volume::makeField(from.lattice, ScalarType::F32);
            for (std::size_t i = 0; i < from.count(); ++i) field.as<float>()[i] = float(from.value(i));
            return field;
        };
    }
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.absError = bound;
    pack(made, options, path);
    return double(Archive(path).fileBytes());
}

/// Archives of scans are hardly longer than those of floats that are the same integers after rounding, and the shorter
/// the wider the bound.
void expectAsShortAsFloats(const volume::Dataset& made, double extent, const std::string& path) {
    double before = 1e30;
    for (const double part : {0.5e-2, 1e-2, 2e-2, 3e-2, 5e-2, 7e-2, 1e-1}) {
        const double bound = std::floor(part * extent);
        const double integers = bytesOf(made, made.info.parameters[0].type, bound, path);
        EXPECT_LE(integers, 1.02 * bytesOf(made, ScalarType::F32, bound + 0.4999, path)) << bound;
        EXPECT_LE(integers, before) << bound;
        before = integers;
    }
}

TEST(SteppedIntegers, TakeNoMoreThanFloatsAndLessWithAWiderBound) {
    const TemporaryFolder folder;
    for (const ScalarType type : kIntegers) {
        SCOPED_TRACE(volume::name(type));
        volume::Dataset waves = wavesOf(type, 0.6, 0.05, false);
        waves.info.parameters.resize(1);
        waves.read = [read = waves.read](int p, int c, int time) {
            volume::Field field = read(p, c, time);
            field.offset = 0, field.scale = 1;
            return field;
        };
        const double extent = type == ScalarType::U8 ? 255 : type == ScalarType::I32 ? 4294967295. : 65535;
        expectAsShortAsFloats(waves, 0.6 * extent, folder / "a.tsr");
    }
}

TEST(SteppedIntegers, OfScansTakeNoMoreThanFloatsAndLessWithAWiderBound) {
    const char* asked = std::getenv("TESSERA_DATA");
    const std::filesystem::path data = std::filesystem::path(asked ? asked : TESSERA_TEST_DATA) / "volumes";
    const TemporaryFolder folder;
    for (const char* name : {"lobster", "engine", "tooth"}) {
        std::string file;
        std::error_code missing;
        for (const auto& entry : std::filesystem::directory_iterator(data, missing))
            if (entry.path().extension() == ".json" && entry.path().stem().string().starts_with(name))
                file = entry.path().string();
        if (file.empty()) GTEST_SKIP() << "no " << name << " under $TESSERA_DATA";
        SCOPED_TRACE(name);
        volume::Dataset scan = volume::openFiles({file}, {});
        const double most = std::string(name) == "tooth" ? 1300 : 255;
        expectAsShortAsFloats(scan, most, folder / "a.tsr");
    }
}

TEST(SteppedIntegers, AreRefusedByWhoDoesNotKnowThemAndOthersSayNothing) {
    const TemporaryFolder folder;
    volume::Dataset made = wavesOf(ScalarType::U8, 0.8, 0.02, false);
    const std::string path = folder / "a.tsr";
    pack(made, onGrid(0), path);
    EXPECT_EQ(featuresOf(path) & kSteppedIntegers, 0u);
    pack(made, onGrid(4), path);
    ASSERT_NE(featuresOf(path) & kSteppedIntegers, 0u);
    const std::vector<char> chars = readFile(path);
    const auto bytes = std::as_bytes(std::span(chars));
    Header header = parseHeaders(bytes, bytes.size(), path).header;
    EXPECT_NO_THROW(Archive{path});
    header.features &= ~kSteppedIntegers;
    writeFile(path, sealed(header, Bytes(bytes.begin(), bytes.end())));
    EXPECT_THROW(Archive{path}, Error);
    EXPECT_THROW(plain::Decoder(readFile(path)), std::runtime_error);
}

// Where few numbers occur, rounding them is shorter, and old programs go on reading the archive.
TEST(SteppedIntegers, AreNotUsedWhereRoundedOnesAreShorter) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({40, 36, 32}, {{"n", ScalarType::U16, 1, Texture::Sparse}}, 1);
    pack(made, onGrid(3), folder / "a.tsr");
    EXPECT_EQ(featuresOf(folder / "a.tsr") & kSteppedIntegers, 0u);
    EXPECT_LE(largestApart(readField(Archive(folder / "a.tsr"), 0, 0, 0), made.read(0, 0, 0)), 3);
}

TEST(SteppedIntegers, OfASeriesKeepTheBoundAndGrowAsIfWrittenAtOnce) {
    const TemporaryFolder folder;
    constexpr int kTimes = 6;
    for (const ScalarType type : {ScalarType::U8, ScalarType::I32})
        for (const bool masked : {false, true}) {
            const double bound = type == ScalarType::U8 ? 12 : 3e6;
            volume::Dataset all = wavesOf(type, 0.5, type == ScalarType::U8 ? 0.01 : 1e-4, masked, kTimes);
            all.info.parameters.resize(1);
            // The noise is the same at all times, so that what is coded before foretells it.
            all.read = [type, masked](int, int, int time) {
                volume::Dataset one = wavesOf(type, 0.5, type == ScalarType::U8 ? 0.05 : 1e-3, masked);
                volume::Field field = one.read(0, 0, 0);
                volume::dispatch(type, [&]<class T>(T) {
                    for (T& sample : field.as<T>())
                        sample = static_cast<T>(double(sample) + time * (sizeof(T) == 1 ? 2 : 1e6));
                });
                return field;
            };
            pack(all, onGrid(bound / 2), folder / "whole.tsr");
            const Archive whole(folder / "whole.tsr");
            ASSERT_NE(featuresOf(folder / "whole.tsr") & kSteppedIntegers, 0u) << volume::name(type) << masked;
            EXPECT_NE(featuresOf(folder / "whole.tsr") & kPredictedFrames, 0u);
            EXPECT_EQ(verifyArchive(whole).damaged, 0u);
            for (int time = 0; time < kTimes; ++time)
                ASSERT_LE(largestApart(readField(whole, 0, 0, time), all.read(0, 0, time)), bound);
            expectReadAlike(whole, folder / "whole.tsr");
            volume::Dataset begin = all, rest = all;
            begin.info.times.resize(2);
            rest.info.times.erase(rest.info.times.begin(), rest.info.times.begin() + 2);
            rest.read = [read = all.read](int p, int c, int time) { return read(p, c, time + 2); };
            pack(begin, onGrid(bound / 2), folder / "grown.tsr");
            append(rest, folder / "grown.tsr");
            const Archive grown(folder / "grown.tsr");
            for (int time = 0; time < kTimes; ++time)
                ASSERT_EQ(readField(grown, 0, 0, time).samples, readField(whole, 0, 0, time).samples) << time;
        }
}

// A bound that equal bricks of the time before keep costs nothing.
TEST(SteppedIntegers, RepeatWithinTheBound) {
    const TemporaryFolder folder;
    volume::Dataset made = wavesOf(ScalarType::U16, 0.5, 0.01, false, 4);
    made.read = [read = made.read](int p, int c, int) { return read(p, c, 0); };
    const PackSummary summary = pack(made, onGrid(500), folder / "a.tsr");
    EXPECT_NE(featuresOf(folder / "a.tsr") & kSteppedIntegers, 0u);
    EXPECT_EQ(summary.repeatedBricks, 2 * 3 * summary.bricks);
}

// A frame larger than memory is coded from slabs, to the same bytes.
TEST(SteppedIntegers, InSlabsAreTheSame) {
    const TemporaryFolder folder;
    for (const double psnr : {0., 40.}) {
        volume::Dataset made = wavesOf(ScalarType::I16, 0.5, 0.02, true);
        PackOptions options = onGrid(psnr > 0 ? 0 : 300, 8);
        options.psnr = psnr;
        pack(made, options, folder / "whole.tsr");
        volume::Dataset parts = made;
        parts.read = [read = made.read](int p, int c, int t, volume::SliceRange slices) {
            return volume::slicesOf(read(p, c, t), slices);
        };
        pack(parts, options, folder / "slabs.tsr", {}, {}, 1);
        ASSERT_NE(featuresOf(folder / "whole.tsr") & kSteppedIntegers, 0u);
        EXPECT_EQ(readFile(folder / "whole.tsr"), readFile(folder / "slabs.tsr"));
    }
}

} // namespace
} // namespace tessera::codec
