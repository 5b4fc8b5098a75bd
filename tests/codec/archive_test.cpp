#include "codec/archive/archive.h"

#include "codec/pack/pack.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"
#include "volume/resample/resample.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <gtest/gtest.h>
#include <thread>

namespace tessera::codec {
namespace {

PackOptions onBcc() {
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    return options;
}

using namespace testing;
using volume::BrickKey;
using volume::Field;
using volume::LatticeKind;
using volume::ScalarType;

TEST(Archive, GivesBackEverySampleBitForBit) {
    const TemporaryFolder folder;
    for (const glm::ivec3 size : {glm::ivec3(1, 1, 1), glm::ivec3(2, 3, 17), glm::ivec3(41, 18, 35)})
        for (const WaveletChoice wavelet : {WaveletChoice::W11, WaveletChoice::W22, WaveletChoice::W46}) {
            volume::Dataset made = makeDataset(size, everyKind(), 2);
            PackOptions options;
            options.lattice = StoredLattice::CC;
            options.brickSize = 16;
            options.wavelet = wavelet;
            const std::string path = folder / "a.tsr";
            const PackSummary summary = pack(made, options, path);
            EXPECT_EQ(folder.files(), 1u);
            const Archive archive(path);
            EXPECT_EQ(archive.fileBytes(), summary.archiveBytes);
            for (int p = 0; p < int(made.info.parameters.size()); ++p)
                for (int c = 0; c < made.info.parameters[std::size_t(p)].components; ++c)
                    for (int t = 0; t < 2; ++t) {
                        SCOPED_TRACE(made.info.parameters[std::size_t(p)].name);
                        expectSame(made.read(p, c, t), readField(archive, p, c, t), true);
                    }
            const VerifyReport report = verifyArchive(archive);
            EXPECT_EQ(report.damaged, 0u) << (report.damage.empty() ? "" : report.damage[0]);
            EXPECT_EQ(report.samples, summary.storedSamples);
        }
}

TEST(Archive, KeepsWhatIsKnownOfTheData) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({20, 20, 20}, everyKind(), 3);
    pack(made, onBcc(), folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    volume::DatasetInfo expected = made.info;
    expected.lattice = volume::bccFor(made.info.lattice);
    EXPECT_EQ(archive.info(), expected);
    EXPECT_EQ(archive.metadata().source, made.info.lattice);
    const Field field = made.read(0, 0, 0);
    double lo = 1e9, hi = -1e9;
    for (int t = 0; t < 3; ++t)
        for (const double value : physicalValues(made.read(0, 0, t)))
            lo = std::min(lo, value), hi = std::max(hi, value);
    EXPECT_EQ(archive.info().parameters[0].ranges, (std::vector<Range>{{lo, hi}}));
    EXPECT_EQ(archive.info().parameters[5].ranges.size(), 4u);
}

TEST(Archive, BccBricksAreTheResampledFieldAtEveryPlace) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"T", ScalarType::F32, 1, Texture::Smooth, true, false},
                                                {"n", ScalarType::I16, 1, Texture::Smooth, false, false}};
    volume::Dataset made = makeDataset({30, 25, 47}, parameters, 1);
    PackOptions options = onBcc();
    options.brickSize = 8;
    pack(made, options, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    for (int p = 0; p < 2; ++p) {
        const Field expected = volume::toBcc(made.read(p, 0, 0), false);
        expectSame(expected, readField(archive, p, 0, 0), false);
        const volume::BrickGrid& grid = archive.grid();
        std::size_t seen = 0;
        for (int z = 0; z < grid.count().z; ++z)
            for (int y = 0; y < grid.count().y; ++y)
                for (int x = 0; x < grid.count().x; ++x) {
                    const BrickKey key{p, 0, 0, {x, y, z}};
                    const volume::BrickSamples brick = archive.read(key);
                    const volume::BrickStats stats = archive.stats(key);
                    const glm::ivec3 begin = grid.begin({x, y, z});
                    ASSERT_EQ(brick.size, grid.brickSamples({x, y, z}, 0));
                    std::size_t i = 0, present = 0;
                    for (int k = 0; k < brick.size.z; ++k)
                        for (int j = 0; j < brick.size.y; ++j)
                            for (int h = 0; h < brick.size.x; ++h, ++i) {
                                const std::size_t at = expected.lattice.index(begin + glm::ivec3(h, j, k));
                                ++seen;
                                const bool isPresent = brick.isPresent(i);
                                ASSERT_EQ(isPresent, expected.present(at));
                                if (!isPresent) continue;
                                ++present;
                                ASSERT_EQ(brick.values[i], float(expected.value(at)));
                                ASSERT_GE(brick.values[i], stats.min);
                                ASSERT_LE(brick.values[i], stats.max);
                            }
                    EXPECT_FLOAT_EQ(stats.presentFraction, float(double(present) / double(i)));
                }
        EXPECT_EQ(seen, expected.count());
    }
}

TEST(Archive, CoarseLevelsHaveTheSizesOfTheGridAndApproximateTheField) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"T", ScalarType::F32, 1, Texture::Smooth, false, false}};
    volume::Dataset made = makeDataset({64, 50, 70}, parameters, 1);
    for (const WaveletChoice wavelet : {WaveletChoice::W11, WaveletChoice::W22})
        for (const double maxError : {0.0, 1e-4}) {
            PackOptions options = onBcc();
            options.brickSize = 16;
            options.wavelet = wavelet;
            options.maxError = maxError;
            pack(made, options, folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            const volume::BrickGrid& grid = archive.grid();
            EXPECT_EQ(grid.levels, 3);
            for (int level = 0; level < grid.levels; ++level) {
                const volume::BrickSamples brick = archive.read({0, 0, level, {1, 1, 1}});
                ASSERT_EQ(brick.size, grid.brickSamples({1, 1, 1}, level));
                const glm::dvec3 first = glm::dvec3(grid.begin({1, 1, 1}));
                double squares = 0;
                std::size_t i = 0;
                for (int z = 0; z < brick.size.z; ++z)
                    for (int y = 0; y < brick.size.y; ++y)
                        for (int x = 0; x < brick.size.x; ++x, ++i) {
                            const double half = z % 2 * 0.5, scale = 1 << level;
                            const glm::dvec3 cells = glm::dvec3(first.x, first.y, first.z / 2) +
                                                     scale * glm::dvec3(x, y, z / 2) + grid.levelPhase(level) + half;
                            const glm::dvec3 at = grid.lattice.fromCells(cells) / made.info.lattice.spacing;
                            const double truth =
                                400 + 30 * (std::sin(at.x * 0.21) + std::cos(at.y * 0.17) + at.z * 0.02);
                            squares += std::pow(truth - double(brick.values[i]), 2);
                        }
                // A shift by half a cell of level 1 would be an error of 3, by one of level 2 of 6; the low-pass of
                // (2,2) itself changes this wave by 2 % and 9 %.
                const double rms = std::sqrt(squares / double(i));
                EXPECT_LT(rms, level == 0 ? 0.02 : level == 1 ? 0.8 : 3.3) << "level " << level;
            }
        }
}

TEST(Archive, ErrorBoundHoldsInFloatForEveryPresentSample) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"T", ScalarType::F32, 1, Texture::Smooth, true, false},
                                                {"U", ScalarType::F32, 3, Texture::Noise, false, false},
                                                {"c", ScalarType::F32, 1, Texture::Constant, false, false},
                                                {"x", ScalarType::F32, 1, Texture::Nasty, false, false},
                                                {"n", ScalarType::U16, 1, Texture::Nasty, false, false}};
    volume::Dataset made = makeDataset({33, 20, 21}, parameters, 2);
    for (const double bound : {1e-1, 1e-3, 1e-5, 1e-7, 1e-9}) {
        PackOptions options;
        options.lattice = StoredLattice::CC;
        options.maxError = bound;
        pack(made, options, folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        for (int p = 0; p < int(parameters.size()); ++p)
            for (int c = 0; c < parameters[std::size_t(p)].components; ++c)
                for (int t = 0; t < 2; ++t) {
                    const Field original = made.read(p, c, t), decoded = readField(archive, p, c, t);
                    double range = 0;
                    for (int k = 0; k < parameters[std::size_t(p)].components; ++k)
                        range =
                            std::max(range, archive.info().parameters[std::size_t(p)].ranges[std::size_t(k)].hi -
                                                archive.info().parameters[std::size_t(p)].ranges[std::size_t(k)].lo);
                    for (std::size_t i = 0; i < original.count(); ++i) {
                        ASSERT_EQ(original.present(i), decoded.present(i));
                        if (!original.present(i)) continue;
                        const double a = original.value(i), b = decoded.value(i);
                        if (!std::isfinite(a)) {
                            const std::size_t bytes = volume::byteSize(original.type);
                            ASSERT_EQ(std::memcmp(&original.samples[i * bytes], &decoded.samples[i * bytes], bytes), 0);
                        } else {
                            ASSERT_LE(std::abs(a - b), bound * range) << parameters[std::size_t(p)].name << " " << i;
                        }
                    }
                }
        EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    }
}

TEST(Archive, CategoricalLevelsHoldOnlyLabels) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"region", ScalarType::U8, 1, Texture::Nasty, true, true}};
    volume::Dataset made = makeDataset({40, 40, 40}, parameters, 1);
    made.read = [read = made.read](int p, int c, int t) {
        Field field = read(p, c, t);
        for (std::uint8_t& label : field.as<std::uint8_t>()) label = label % 2 == 0 ? 3 : 200;
        return field;
    };
    pack(made, {}, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    for (int level = 0; level < archive.grid().levels; ++level) {
        const volume::BrickSamples brick = archive.read({0, 0, level, {0, 0, 0}});
        for (std::size_t i = 0; i < brick.values.size(); ++i)
            if (brick.isPresent(i)) {
                ASSERT_TRUE(brick.values[i] == 3.0f || brick.values[i] == 200.0f) << brick.values[i];
            }
    }
}

TEST(Archive, EqualMasksAreStoredOnce) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"a", ScalarType::U8, 1, Texture::Smooth, true, false},
                                                {"b", ScalarType::F32, 3, Texture::Smooth, true, false},
                                                {"c", ScalarType::F32, 1, Texture::Smooth, false, false}};
    volume::Dataset made = makeDataset({40, 30, 20}, parameters, 3);
    pack(made, {}, folder / "a.tsr");
    EXPECT_EQ(Archive(folder / "a.tsr").maskCount(), 1);
}

TEST(Archive, MagnitudesAreAnswered) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"U", ScalarType::F32, 3, Texture::Noise, false, false},
                                                {"V", ScalarType::F32, 2, Texture::Noise, false, false}};
    volume::Dataset made = makeDataset({12, 12, 12}, parameters, 1);
    pack(made, {}, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    for (const auto& [first, count, channel] : {std::tuple{0, 3, 3}, std::tuple{4, 2, 6}}) {
        std::vector<double> square(archive.read({first, 0, 0, {0, 0, 0}}).values.size());
        for (int c = 0; c < count; ++c) {
            const volume::BrickSamples part = archive.read({first + c, 0, 0, {0, 0, 0}});
            for (std::size_t i = 0; i < square.size(); ++i)
                square[i] += double(part.values[i]) * double(part.values[i]);
        }
        const volume::BrickSamples whole = archive.read({channel, 0, 0, {0, 0, 0}});
        const volume::BrickStats stats = archive.stats({channel, 0, 0, {0, 0, 0}});
        for (std::size_t i = 0; i < square.size(); ++i) {
            ASSERT_NEAR(double(whole.values[i]), std::sqrt(square[i]), 1e-3);
            ASSERT_LE(whole.values[i], stats.max * 1.0001f);
        }
    }
}

TEST(Archive, SameInputSameBytes) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({50, 40, 30}, everyKind(), 1);
    PackOptions options;
    options.brickSize = 8;
    pack(made, options, folder / "a.tsr");
    volume::Dataset again = makeDataset({50, 40, 30}, everyKind(), 1);
    pack(again, options, folder / "b.tsr");
    EXPECT_EQ(readFile(folder / "a.tsr"), readFile(folder / "b.tsr"));
}

TEST(Archive, NothingIsLeftBehindWhenPackingFails) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> parameters{{"a", ScalarType::U8, 1, Texture::Smooth, false, false}};
    volume::Dataset made = makeDataset({20, 20, 20}, parameters, 4);
    std::stop_source source;
    int frames = 0;
    const Progress progress{[&](double, const std::string&) {
                                if (++frames == 5) source.request_stop();
                            },
                            source.get_token()};
    EXPECT_THROW(pack(made, {}, folder / "a.tsr", progress), Cancelled);
    EXPECT_EQ(folder.files(), 0u);
    made.read = [read = made.read](int p, int c, int t) {
        if (t == 2) throw Error("truncated", "x.raw");
        return read(p, c, t);
    };
    EXPECT_THROW(pack(made, {}, folder / "a.tsr"), Error);
    EXPECT_EQ(folder.files(), 0u);
    EXPECT_THROW(pack(made, {}, folder / "no/such/folder.tsr"), MachineError);
    PackOptions bad;
    bad.brickSize = 12;
    EXPECT_THROW(pack(made, bad, folder / "a.tsr"), Error);
}

TEST(Archive, OneSmallVolumeOfIntegersIsOneBrick) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    const auto edgeOf = [&](ScalarType type, glm::ivec3 size, int times, StoredLattice lattice, int asked) {
        volume::Dataset made = makeDataset(size, {{"a", type, 1, Texture::Sparse, false, false}}, times);
        PackOptions options;
        options.lattice = lattice;
        options.brickSize = asked;
        pack(made, options, path);
        return Archive(path).grid().brickSize;
    };
    EXPECT_EQ(edgeOf(ScalarType::F32, {98, 34, 34}, 1, StoredLattice::CC, 0), 64);
    EXPECT_EQ(edgeOf(ScalarType::U8, {98, 34, 34}, 1, StoredLattice::BCC, 0), 64);
    EXPECT_EQ(edgeOf(ScalarType::U8, {98, 34, 34}, 2, StoredLattice::CC, 0), 64);
    EXPECT_EQ(edgeOf(ScalarType::U8, {130, 8, 8}, 1, StoredLattice::CC, 0), 64);
    EXPECT_EQ(edgeOf(ScalarType::U8, {64, 34, 34}, 1, StoredLattice::CC, 0), 64);
    EXPECT_EQ(edgeOf(ScalarType::U8, {98, 34, 34}, 1, StoredLattice::CC, 32), 32);
    EXPECT_EQ(edgeOf(ScalarType::U8, {98, 34, 34}, 1, StoredLattice::CC, 0), 128);
    EXPECT_EQ(Archive(path).grid().count(), glm::ivec3(1));
    // What grows keeps its bricks.
    volume::Dataset more = makeDataset({98, 34, 34}, {{"a", ScalarType::U8, 1, Texture::Sparse, false, false}}, 1);
    more.info.times = {5};
    append(more, path);
    EXPECT_EQ(Archive(path).grid().brickSize, 128);
    EXPECT_EQ(Archive(path).info().times.size(), 2u);
}

// Every face of a brick costs bytes where coefficients are rounded; what a view reads whole anyway needs few of them.
TEST(Archive, SmallVolumesWithinABoundHaveLargeBricks) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    PackOptions bounded;
    bounded.maxError = 1e-3;
    bounded.lattice = StoredLattice::CC;
    std::uint64_t bytes = 0;
    const auto edgeOf = [&](ScalarType type, glm::ivec3 size, const PackOptions& options) {
        volume::Dataset made = makeDataset(size, {{"n", ScalarType::U8}, {"a", type}}, 1);
        bytes = pack(made, options, path).archiveBytes;
        return Archive(path).grid().brickSize;
    };
    EXPECT_EQ(edgeOf(ScalarType::F32, {98, 34, 34}, bounded), 128);
    const std::uint64_t inLarge = bytes;
    volume::Dataset more = makeDataset({98, 34, 34}, {{"n", ScalarType::U8}, {"a"}}, 1);
    more.info.times = {5};
    append(more, path);
    EXPECT_EQ(Archive(path).grid().brickSize, 128);
    EXPECT_EQ(edgeOf(ScalarType::F32, {64, 34, 34}, bounded), 64) << "one of the usual size holds it";
    EXPECT_EQ(edgeOf(ScalarType::F32, {1025, 64, 32}, bounded), 64) << "larger than 128^3";
    EXPECT_EQ(edgeOf(ScalarType::I16, {130, 34, 34}, bounded), 128);
    const auto changed = [&](auto member, auto value) {
        PackOptions options = bounded;
        options.*member = value;
        return edgeOf(ScalarType::F32, {98, 34, 34}, options);
    };
    EXPECT_EQ(changed(&PackOptions::brickSize, 64), 64);
    EXPECT_LT(inLarge, bytes);
    EXPECT_EQ(changed(&PackOptions::maxError, 0.0), 64) << "lossless";
    EXPECT_EQ(changed(&PackOptions::discard, 0.01), 64);
    EXPECT_EQ(changed(&PackOptions::threshold, ThresholdOptions{ThresholdChoice::Soft, 0.01, true}), 64);
    EXPECT_EQ(changed(&PackOptions::lattice, StoredLattice::BCC), 128);
}

TEST(Archive, AKeyOutsideIsAnError) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({20, 20, 20}, {{"a", ScalarType::U8, 1, Texture::Smooth, false, false}}, 1);
    pack(made, {}, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    EXPECT_THROW((void)archive.read({1, 0, 0, {0, 0, 0}}), Error);
    EXPECT_THROW((void)archive.read({0, 1, 0, {0, 0, 0}}), Error);
    EXPECT_THROW((void)archive.read({0, 0, 9, {0, 0, 0}}), Error);
    EXPECT_THROW((void)archive.read({0, 0, 0, {0, 0, 1}}), Error);
}

TEST(Archive, BrickSizesThatCannotBeAreRefused) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({9, 8, 7}, {{"n", ScalarType::U8}}, 1);
    for (const int size : {1, 2, 3, 12, 100, 129, 256}) {
        PackOptions options;
        options.brickSize = size;
        try {
            pack(made, options, folder / "a.tsr");
            ADD_FAILURE() << size;
        } catch (const Error& error) {
            EXPECT_EQ(error.reason(),
                      "the brick size must be a power of two from 4 to 128, not " + std::to_string(size));
        }
    }
}

TEST(Archive, OnBccNoVolumeIsOneLargeBrick) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({80, 8, 8}, {{"n", ScalarType::U8}}, 1);
    made.info.lattice.kind = volume::LatticeKind::BCC;
    made.info.bounds.hi = made.info.lattice.position(made.info.lattice.size - 1);
    made.read = [lattice = made.info.lattice, read = made.read](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        field.lattice = lattice;
        return field;
    };
    pack(made, onBcc(), folder / "a.tsr");
    EXPECT_EQ(Archive(folder / "a.tsr").grid().brickSize, 64);
}

TEST(Archive, ProgressEndsAtOneAndTimesAreAddedUp) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({9, 8, 7}, {{"T"}, {"p"}}, 3);
    constexpr auto kPause = std::chrono::milliseconds(2);
    int reads = 0;
    made.read = [&, read = made.read](int p, int c, int t) {
        ++reads;
        std::this_thread::sleep_for(kPause);
        return read(p, c, t);
    };
    std::vector<double> fractions;
    const Progress progress{[&](double fraction, const std::string&) { fractions.push_back(fraction); }, {}};
    PackOptions options;
    options.maxError = 0.01; // of a range that is not known: everything is read twice, and for numbers of regions
    const PackSummary summary = pack(made, options, folder / "a.tsr", progress);
    EXPECT_EQ(reads, 18);
    EXPECT_GE(summary.loadSeconds, 12 * 0.002);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_EQ(fractions.front(), 0);
    EXPECT_EQ(fractions.back(), 1);
}

} // namespace
} // namespace tessera::codec
