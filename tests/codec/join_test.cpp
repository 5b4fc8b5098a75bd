#include "codec/blocks/join.h"

#include "codec/archive/archive.h"
#include "codec/container/container.h"
#include "codec/pack/pack.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"
#include "volume/field/part_masks.h"
#include "volume/field/quantities.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <random>

namespace tessera::codec {
namespace {

using namespace testing;
namespace fs = std::filesystem;
using volume::ScalarType;

PackOptions bricksOf8(StoredLattice lattice = StoredLattice::CC, double maxError = 0) {
    PackOptions options;
    options.lattice = lattice;
    options.brickSize = 8;
    options.maxError = maxError;
    return options;
}

/// Packs some times of a data set.
std::string packed(const volume::Dataset& made, const std::vector<int>& times, const PackOptions& options,
                   const std::string& path) {
    volume::Dataset some = volume::withTimes(made, times);
    pack(some, options, path);
    return path;
}

TEST(Join, EveryKindOfSampleIsAsPacked) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({17, 12, 19}, everyKind(), 5);
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        const std::string path = packed(made, {0, 1}, bricksOf8(lattice), folder / "run.tsr");
        const std::vector<char> first = readFile(path);
        const int commits = Archive(path).commits();
        join(path, packed(made, {2, 3, 4}, bricksOf8(lattice), folder / "more.tsr"));
        const std::string once = packed(made, {0, 1, 2, 3, 4}, bricksOf8(lattice), folder / "once.tsr");
        const Archive joined(path), whole(once);
        expectSameArchives(whole, joined, 1); // coarse levels depend on the filter, which each chooses
        EXPECT_EQ(joined.metadata().resampled.size(), whole.metadata().resampled.size());
        for (std::size_t p = 0; p < joined.metadata().resampled.size(); ++p) {
            ASSERT_EQ(joined.metadata().resampled[p].has_value(), whole.metadata().resampled[p].has_value());
            if (!joined.metadata().resampled[p]) continue;
            EXPECT_EQ(joined.metadata().resampled[p]->largest, whole.metadata().resampled[p]->largest);
            EXPECT_NEAR(joined.metadata().resampled[p]->meanSquare, whole.metadata().resampled[p]->meanSquare,
                        1e-9 * whole.metadata().resampled[p]->meanSquare);
        }
        EXPECT_EQ(joined.commits(), commits + 1);
        EXPECT_EQ(joined.maskCount(), whole.maskCount()) << "the same masks are stored once";
        const VerifyReport report = verifyArchive(joined);
        EXPECT_EQ(report.damaged, 0u) << report.damage.front();
        // Nothing before the first commit has changed but the headers, and the plain decoder reads it, too.
        const std::vector<char> now = readFile(path);
        EXPECT_TRUE(std::equal(first.begin() + std::ptrdiff_t(kFirstChunk), first.end(),
                               now.begin() + std::ptrdiff_t(kFirstChunk)));
        const plain::Decoder decoder(now);
        EXPECT_EQ(decoder.frames(), 5u * 14u);
        for (std::size_t frame = 0; frame < decoder.frames(); ++frame) decoder.brick(frame, 0, 0);
    }
}

TEST(Join, WhatIsKnownOfBricksIsAsInTheParts) {
    const TemporaryFolder folder;
    const volume::Dataset made =
        makeDataset({20, 20, 20}, {{"T", ScalarType::F32, 2, Texture::Smooth, true, false}}, 4);
    const std::string path = packed(made, {0, 1}, bricksOf8(), folder / "run.tsr");
    join(path, packed(made, {2, 3}, bricksOf8(), folder / "more.tsr"));
    const Archive joined(path), more(folder / "more.tsr");
    for (std::size_t b = 0; b < joined.grid().brickCount(); ++b) {
        const glm::ivec3 brick = joined.grid().indexOf(b);
        for (int time = 0; time < 2; ++time) {
            const volume::BrickKey here{1, time + 2, 0, brick}, there{1, time, 0, brick};
            EXPECT_EQ(joined.stats(here).min, more.stats(there).min);
            EXPECT_EQ(joined.stats(here).max, more.stats(there).max);
            EXPECT_EQ(joined.distribution(here)->counts, more.distribution(there)->counts);
            EXPECT_EQ(joined.importance(here)->importance, more.importance(there)->importance);
            EXPECT_EQ(joined.brickBytes(here), more.brickBytes(there));
        }
        EXPECT_EQ(joined.change({1, 2, 0, brick}, 3), more.change({1, 0, 0, brick}, 1));
        EXPECT_FALSE(joined.change({1, 1, 0, brick}, 2)) << "nobody has compared the two times";
    }
}

TEST(Join, UnchangedBricksAreStillRepeats) {
    const TemporaryFolder folder;
    volume::Dataset still = makeDataset({16, 16, 16}, {{"T", ScalarType::F32, 1, Texture::Noise, false, false}}, 4);
    still.read = [read = still.read](int p, int c, int) { return read(p, c, 0); };
    const std::string path = packed(still, {0, 1}, bricksOf8(), folder / "run.tsr");
    join(path, packed(still, {2, 3}, bricksOf8(), folder / "more.tsr"));
    const Archive joined(path);
    EXPECT_EQ(joined.repeats().bricks, 16u) << "of times 1 and 3";
    for (int time = 0; time < 4; ++time) expectSame(readField(joined, 0, 0, time), still.read(0, 0, time), true);
}

TEST(Join, BoundsHoldForTheRangeOfBoth) {
    const TemporaryFolder folder;
    volume::Dataset grows = makeDataset({16, 16, 16}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 4);
    grows.read = [read = grows.read](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        for (float& value : field.as<float>()) value *= float(t + 1);
        return field;
    };
    grows.info.quantities = {{"voltage", "V", {1, 2, 3, 4}}};
    const std::string path = packed(grows, {0, 1}, bricksOf8(StoredLattice::CC, 1e-3), folder / "run.tsr");
    const Range first = Archive(path).info().parameters[0].ranges[0];
    join(path, packed(grows, {2, 3}, bricksOf8(StoredLattice::CC, 1e-3), folder / "more.tsr"));
    const Archive joined(path);
    const Range both = joined.info().parameters[0].ranges[0];
    EXPECT_EQ(both.lo, first.lo);
    EXPECT_GT(both.hi, 1.5 * first.hi);
    EXPECT_LE(largestError(joined, grows, 0), joined.metadata().maxError * (both.hi - both.lo));
    EXPECT_EQ(joined.metadata().maxError, 1e-3);
    EXPECT_EQ(joined.info().quantities[0].values, (std::vector<double>{1, 2, 3, 4}));
}

TEST(Join, ParametersAreAddedAtTheSameTimes) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> all{{"T", ScalarType::F32, 1, Texture::Smooth, true, false},
                                         {"U", ScalarType::F32, 2, Texture::Noise, true, false},
                                         {"n", ScalarType::U8, 1, Texture::Smooth, false, false}};
    const volume::Dataset made = makeDataset({17, 12, 19}, all, 3);
    const std::vector<int> times{0, 1, 2};
    const std::string whole = packed(made, times, bricksOf8(), folder / "whole.tsr");
    const std::string path = packed(volume::withParameters(made, {0}), times, bricksOf8(), folder / "T.tsr");
    join(path, packed(volume::withParameters(made, {1, 2}), times, bricksOf8(), folder / "others.tsr"));
    expectSameArchives(Archive(whole), Archive(path));
    EXPECT_EQ(verifyArchive(Archive(path)).damaged, 0u);
    // Times are appended to what has been joined so.
    volume::Dataset later = made;
    for (double& time : later.info.times) time += 10;
    join(path, packed(later, times, bricksOf8(), folder / "later.tsr"));
    EXPECT_EQ(Archive(path).info().times.size(), 6u);
    for (int p = 0; p < 3; ++p) expectSame(readField(Archive(path), p, 0, 4), made.read(p, 0, 1), true);
}

TEST(Join, AddedParametersShareTheMasksOfEveryTime) {
    const TemporaryFolder folder;
    const std::vector<int> times{0, 1, 2, 3};
    volume::Dataset made = makeDataset({20, 20, 20},
                                       {{"T", ScalarType::U8, 1, Texture::Smooth, false, false},
                                        {"p", ScalarType::U8, 1, Texture::Smooth, false, false}},
                                       4);
    made.read = [read = made.read](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        volume::Mask mask(field.count());
        std::mt19937 random{std::uint32_t(t)}; // masks cost more than anything else
        for (std::uint8_t& flag : mask) flag = random() % 2;
        field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    const std::string whole = packed(made, times, bricksOf8(), folder / "whole.tsr");
    const std::string path = packed(volume::withParameters(made, {0}), times, bricksOf8(), folder / "T.tsr");
    join(path, packed(volume::withParameters(made, {1}), times, bricksOf8(), folder / "p.tsr"));
    expectSameArchives(Archive(whole), Archive(path));
    EXPECT_LT(double(fs::file_size(path)), 1.1 * double(fs::file_size(whole)));
}

TEST(Join, IsOnlyOfferedForWhatItCanJoin) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> both{{"T", ScalarType::U8, 1, Texture::Smooth, false, false},
                                          {"region", ScalarType::U8, 1, Texture::Noise, false, true}};
    const volume::Dataset made = makeDataset({80, 20, 20}, both, 4),
                          label = makeDataset({80, 20, 20}, {both[1], {"p", ScalarType::U8}}, 4);
    PackOptions plain;
    plain.lattice = StoredLattice::CC;
    const std::string one = packed(made, {0}, plain, folder / "one.tsr"), // one large brick
        more = packed(made, {1, 2}, plain, folder / "more.tsr");
    const std::string run = packed(made, {0, 1}, bricksOf8(), folder / "run.tsr");
    EXPECT_TRUE(canJoin(run, packed(made, {2}, bricksOf8(), folder / "next.tsr")));
    EXPECT_FALSE(canJoin(one, more)) << "bricks of another size";
    EXPECT_FALSE(canJoin(run, packed(label, {2}, bricksOf8(), folder / "label.tsr"))) << "another parameter";
    EXPECT_FALSE(canJoin(run, packed(made, {2}, bricksOf8(StoredLattice::CC, 0.1), folder / "lossy.tsr")));
}

TEST(Join, DamageIsNotCopied) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({17, 12, 19}, {{"T", ScalarType::F32, 1, Texture::Noise, true, false}}, 4);
    const std::string path = packed(made, {0, 1}, bricksOf8(), folder / "run.tsr");
    const std::string more = packed(made, {2, 3}, bricksOf8(), folder / "more.tsr");
    const std::vector<char> before = readFile(path);
    std::vector<char> bytes = readFile(more);
    bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 1);
    writeFile(more, bytes);
    EXPECT_THROW(join(path, more), Error);
    EXPECT_EQ(readFile(path), before);
}

TEST(Join, RefusesWhatDoesNotFollowAndChangesNothing) {
    const TemporaryFolder folder;
    const volume::Dataset made =
        makeDataset({17, 12, 19}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 8);
    const std::string path = packed(made, {0, 1}, bricksOf8(), folder / "run.tsr");
    const std::vector<char> before = readFile(path);
    const volume::Dataset other =
        makeDataset({17, 12, 18}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 4);
    const volume::Dataset named =
        makeDataset({17, 12, 19}, {{"p", ScalarType::F32, 1, Texture::Smooth, false, false}}, 4);
    const struct {
        std::string more;
        const char* reason;
    } cases[] = {{packed(made, {1, 2}, bricksOf8(), folder / "early.tsr"), "not after the last one"},
                 {packed(made, {2, 3}, bricksOf8(StoredLattice::CC, 0.1), folder / "lossy.tsr"), "other options"},
                 {packed(other, {2, 3}, bricksOf8(), folder / "grid.tsr"), "another grid"},
                 {packed(named, {2, 3}, bricksOf8(), folder / "name.tsr"), "only be added at all times"},
                 {packed(made, {0, 1, 2, 3, 4, 5, 6, 7}, bricksOf8(StoredLattice::D4), folder / "d4.tsr"), "D4*"}};
    for (const auto& [more, reason] : cases) {
        try {
            join(path, more);
            ADD_FAILURE() << more << " was joined";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
        }
        EXPECT_EQ(readFile(path), before) << more;
    }
}

} // namespace
} // namespace tessera::codec
