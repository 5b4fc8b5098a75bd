#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/codec/least_memory.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "volume/bricks/brick_importance.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::BrickKey;
using volume::ScalarType;

/// Frames of which only some places move: x < 8 never, the slab 8 <= x < 16 at every second time, the rest always.
volume::Dataset movingSlabs(int times, bool masked = false) {
    std::vector<MadeParameter> parameters{{"T", ScalarType::F32, 1, Texture::Smooth, masked, false},
                                          {"U", ScalarType::F32, 2, Texture::Nasty, masked, false},
                                          {"n", ScalarType::U16, 1, Texture::Noise, false, false},
                                          {"region", ScalarType::U8, 1, Texture::Noise, masked, true}};
    volume::Dataset made = makeDataset({24, 10, 9}, parameters, times);
    made.read = [read = made.read](int p, int c, int t) {
        volume::Field still = read(p, c, 0);
        const volume::Field slow = read(p, c, t / 2 * 2), fast = read(p, c, t);
        const std::size_t bytes = volume::byteSize(still.type);
        for (std::size_t i = 0; i < still.count(); ++i) {
            const std::size_t x = i % std::size_t(still.lattice.size.x);
            const volume::Field& from = x < 8 ? still : x < 16 ? slow : fast;
            if (&from != &still)
                std::copy_n(from.samples.begin() + std::ptrdiff_t(i * bytes), bytes,
                            still.samples.begin() + std::ptrdiff_t(i * bytes));
        }
        return still;
    };
    return made;
}

PackOptions smallBricks(StoredLattice lattice, double absError = 0) {
    PackOptions options;
    options.lattice = lattice;
    options.brickSize = 8;
    options.absError = absError;
    return options;
}

/// Every brick of an archive: its notes hold for what is read of it.
void expectTrueNotes(const Archive& archive) {
    const glm::ivec3 count = archive.grid().count();
    const int channels = int(archive.info().channels().size()), times = int(archive.info().times.size());
    const int step = archive.metadata().alternating ? 2 : 1;
    for (int channel = 0; channel < channels; ++channel)
        for (int n = 0; n < count.x * count.y * count.z; ++n) {
            const glm::ivec3 brick(n % count.x, n / count.x % count.y, n / (count.x * count.y));
            for (int time = 0; time < times; ++time) {
                const auto importance = archive.importance({channel, time, 0, brick});
                ASSERT_TRUE(importance);
                EXPECT_TRUE(importance->importance >= 0 && importance->importance <= 1);
                for (int to = time + step; to < times; to += step) {
                    const auto change = archive.change({channel, time, 0, brick}, to);
                    ASSERT_TRUE(change);
                    EXPECT_EQ(change, archive.change({channel, to, 0, brick}, time));
                    const volume::BrickSamples a = archive.read({channel, time, 0, brick}),
                                               b = archive.read({channel, to, 0, brick});
                    if (a.present != b.present) {
                        EXPECT_TRUE(std::isinf(change->max));
                        continue;
                    }
                    double largest = 0, squares = 0, samples = 0;
                    for (std::size_t i = 0; i < a.values.size(); ++i) {
                        if (!a.isPresent(i)) continue;
                        const double moved = std::abs(double(a.values[i]) - double(b.values[i]));
                        if (!std::isfinite(moved)) continue; // the magnitude of what is nearly infinite
                        largest = std::max(largest, moved);
                        squares += moved * moved;
                        ++samples;
                    }
                    EXPECT_GE(double(change->max), largest);
                    if (samples > 0) {
                        EXPECT_GE(double(change->rms) * (1 + 1e-6), std::sqrt(squares / samples));
                    }
                }
            }
        }
}

TEST(BrickNotes, BoundWhatIsReadOnEveryLattice) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4})
        for (const double bound : {0.0, 0.5}) {
            volume::Dataset made = movingSlabs(8, true);
            pack(made, smallBricks(lattice, bound), folder / "a.tsr");
            expectTrueNotes(Archive(folder / "a.tsr"));
        }
}

TEST(BrickNotes, WhatDoesNotMoveIsStoredOnce) {
    const TemporaryFolder folder;
    volume::Dataset made = movingSlabs(6);
    const PackSummary summary = pack(made, smallBricks(StoredLattice::CC), folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    // Of three bricks along x, two along y, two along z: 5 times the first, 3 times the second repeat; 5 components.
    EXPECT_EQ(summary.repeatedBricks, 5u * 4 * (5 + 3));
    EXPECT_EQ(archive.repeats().bricks, summary.repeatedBricks);
    EXPECT_EQ(archive.repeats().bytes, summary.repeatedBytes);
    EXPECT_GT(summary.repeatedBytes, 10000u);
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    for (int p = 0; p < 4; ++p)
        for (int c = 0; c < archive.info().parameters[std::size_t(p)].components; ++c)
            for (int t = 0; t < 6; ++t) EXPECT_EQ(readField(archive, p, c, t).samples, made.read(p, c, t).samples);
    EXPECT_EQ(archive.change({0, 0, 0, {0, 0, 0}}, 5), volume::BrickChange{});
    EXPECT_EQ(archive.change({0, 2, 0, {1, 0, 0}}, 3), volume::BrickChange{});
    EXPECT_GT(archive.change({0, 2, 0, {1, 0, 0}}, 4)->max, 0);
    EXPECT_GT(archive.change({0, 2, 0, {2, 0, 0}}, 3)->max, 0);
    // At coarse levels too they are what they were.
    for (int level = 0; level < archive.grid().levels; ++level)
        EXPECT_EQ(archive.read({0, 0, level, {0, 0, 0}}).values, archive.read({0, 5, level, {0, 0, 0}}).values);
}

TEST(BrickNotes, SlowDriftStaysWithinTheBound) {
    const TemporaryFolder folder;
    const double bound = 1.0;
    const int times = 60;
    volume::Dataset made = makeDataset({16, 8, 8}, {{"T", ScalarType::F32, 1, Texture::Smooth, true, false}}, times);
    made.read = [read = made.read](int p, int c, int t) {
        volume::Field field = read(p, c, 0);
        for (float& value : field.as<float>()) value += 0.002f * float(t);
        return field;
    };
    const PackSummary summary = pack(made, smallBricks(StoredLattice::CC, bound), folder / "a.tsr");
    EXPECT_GT(summary.repeatedBricks, 10u);
    EXPECT_LT(summary.repeatedBricks, 2u * (times - 1));
    const Archive archive(folder / "a.tsr");
    for (int t = 0; t < times; ++t) {
        const volume::Field stored = readField(archive, 0, 0, t), wanted = made.read(0, 0, t);
        for (std::size_t i = 0; i < stored.count(); ++i)
            if (wanted.present(i)) {
                ASSERT_LE(std::abs(stored.value(i) - wanted.value(i)), bound) << t;
            }
    }
    expectTrueNotes(archive);
}

TEST(BrickNotes, AppendingGoesOnAsIfItHadNotStopped) {
    const TemporaryFolder folder;
    const volume::Dataset made = movingSlabs(6, true);
    for (const double bound : {0.0, 0.5}) {
        volume::Dataset all = made;
        const PackSummary once = pack(all, smallBricks(StoredLattice::CC, bound), folder / "once.tsr");
        std::uint64_t repeated = 0;
        for (int first = 0; first < 6; first += 2) {
            volume::Dataset part = made;
            part.info.times = {made.info.times[std::size_t(first)], made.info.times[std::size_t(first) + 1]};
            part.read = [read = made.read, first](int p, int c, int t) { return read(p, c, t + first); };
            const PackSummary summary = first == 0
                                            ? pack(part, smallBricks(StoredLattice::CC, bound), folder / "grown.tsr")
                                            : append(part, folder / "grown.tsr");
            repeated += summary.repeatedBricks;
        }
        EXPECT_EQ(repeated, once.repeatedBricks);
        const Archive grown(folder / "grown.tsr"), whole(folder / "once.tsr");
        EXPECT_EQ(grown.repeats().bricks, whole.repeats().bricks);
        expectTrueNotes(grown);
        for (int t = 0; t < 5; ++t)
            for (int x = 0; x < 3; ++x)
                EXPECT_EQ(grown.change({0, t, 0, {x, 0, 0}}, t + 1), whole.change({0, t, 0, {x, 0, 0}}, t + 1));
    }
}

TEST(BrickNotes, ThePlainReaderFollowsRepeats) {
    const TemporaryFolder folder;
    volume::Dataset made = movingSlabs(3, true);
    pack(made, smallBricks(StoredLattice::CC), folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    const plain::Decoder decoder(readFile(folder / "a.tsr"));
    const volume::Field expected = readField(archive, 0, 0, 2);
    for (int number = 0; number < 3; ++number) {
        const plain::Brick brick = decoder.brick(2 * 5, number, 0);
        for (int x = 0; x < 8; ++x)
            if (brick.present[std::size_t(x)]) {
                EXPECT_EQ(float(brick.values[std::size_t(x)]), expected.as<float>()[std::size_t(8 * number + x)]);
            }
    }
}

TEST(BrickNotes, WithLittleMemoryNothingIsKnownOfChanges) {
    const TemporaryFolder folder;
    const volume::Lattice lattice{volume::LatticeKind::CC, {128, 128, 100}, {1, 1, 1}, {0, 0, 0}};
    volume::Dataset made = makeDataset(lattice.size, {{"T", ScalarType::U8, 1, Texture::Constant, false, false}}, 2);
    made.info.parameters[0].ranges = {{0, 255}};
    PackOptions options;
    options.lattice = StoredLattice::CC;
    const auto packed = [&](double limit) {
        options.memoryMb = limit;
        return pack(made, options, folder / "a.tsr");
    };
    const PackSummary summary = packed(leastMemory(packed)); // another frame does not fit
    EXPECT_EQ(summary.notes.size(), 1u);
    const Archive archive(folder / "a.tsr");
    EXPECT_FALSE(archive.change({0, 0, 0, {0, 0, 0}}, 1));
    EXPECT_EQ(archive.change({0, 1, 0, {0, 0, 0}}, 1), volume::BrickChange{});
    EXPECT_TRUE(archive.importance({0, 0, 0, {0, 0, 0}}));
}

// Archives from before notes have none, and do not get any by growing.
TEST(BrickNotes, FormerArchivesHaveNone) {
    const TemporaryFolder folder;
    const std::string path = folder / "grown.tsr";
    writeFile(path, readFile(std::string(TESSERA_SOURCE_DIR) + "/tests/fuzz/corpus/fuzz_archive/cc-exact-3.tsr"));
    const Archive former(path);
    EXPECT_FALSE(former.importance({0, 0, 0, {0, 0, 0}}));
    volume::Dataset more = makeDataset({5, 4, 6},
                                       {{"O2", ScalarType::F32, 1, Texture::Decimals, true, false},
                                        {"region", ScalarType::U8, 1, Texture::Noise, true, true},
                                        {"U", ScalarType::F32, 2, Texture::Nasty, false, false}},
                                       2);
    more.info.times = {1, 2};
    append(more, path);
    const Archive grown(path);
    EXPECT_EQ(grown.info().times.size(), 3u);
    EXPECT_FALSE(grown.importance({0, 1, 0, {0, 0, 0}}));
    EXPECT_FALSE(grown.distribution({0, 1, 0, {0, 0, 0}}));
    EXPECT_FALSE(grown.change({0, 1, 0, {0, 0, 0}}, 2));
    EXPECT_EQ(grown.repeats().bricks, 0u);
    EXPECT_EQ(verifyArchive(grown).damaged, 0u);
}

TEST(BrickNotes, ImportanceIsThatOfEachFrame) {
    const TemporaryFolder folder;
    volume::Dataset made = movingSlabs(3);
    for (volume::Parameter& parameter : made.info.parameters)
        parameter.ranges.assign(std::size_t(parameter.components == 1 ? 1 : parameter.components + 1), Range{0, 450});
    pack(made, smallBricks(StoredLattice::CC), folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    int channel = 0;
    for (int p = 0; p < 4; ++p) {
        const volume::Parameter& about = made.info.parameters[std::size_t(p)];
        for (int c = 0; c < about.components; ++c, ++channel)
            for (int t = 0; t < 3; ++t) {
                const auto wanted =
                    volume::importanceOfBricks(archive.grid(), made.read(p, c, t), {0, 450}, about.categorical);
                for (std::size_t b = 0; b < wanted.size(); ++b) {
                    const auto found = archive.importance({channel, t, 0, archive.grid().indexOf(b)});
                    ASSERT_TRUE(found);
                    EXPECT_NEAR(found->importance, wanted[b].importance, 1e-5) << about.name << c << " " << t;
                    EXPECT_NEAR(found->detail, wanted[b].detail, 1e-5) << about.name << c << " " << t;
                }
            }
        if (about.components > 1) ++channel; // the magnitude
    }
}

} // namespace
} // namespace tessera::codec
