#include "codec/blocks/pack_blocks.h"

#include "codec/archive/archive.h"
#include "codec/blocks/shared_job.h"
#include "codec/container/resample_error.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/child_process.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"
#include "tests/volume/regions.h"
#include "volume/field/quantities.h"

#include <atomic>
#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>
#include <thread>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;
namespace fs = std::filesystem;

volume::Dataset series(int times = 7) {
    return makeDataset({17, 12, 19},
                       {{"O2", ScalarType::F32, 1, Texture::Smooth, true, false},
                        {"U", ScalarType::F32, 2, Texture::Noise, false, false},
                        {"n", ScalarType::U16, 1, Texture::Smooth, false, false}},
                       times);
}

PackOptions small(double maxError = 0, StoredLattice lattice = StoredLattice::CC) {
    PackOptions options;
    options.lattice = lattice;
    options.brickSize = 8;
    options.maxError = maxError;
    return options;
}

/// Packs by several processes; returns how many of them failed.
int packBy(int processes, const volume::Dataset& made, const PackOptions& options, const std::string& path,
           std::size_t times, bool byParameter = false) {
    const std::size_t pieces = byParameter ? made.info.parameters.size() : 1;
    std::vector<pid_t> children;
    for (int rank = 0; rank < processes; ++rank)
        children.push_back(started([&] {
            const BlockOptions blocks{times, {rank, processes, processes, "1"}, {}, byParameter};
            const BlockSummary summary = packInBlocks(made, options, path, blocks);
            return summary.blocks == (made.info.times.size() + times - 1) / times * pieces && fs::exists(path);
        }));
    int failed = 0;
    for (const pid_t child : children) failed += statusOf(child) != 0 ? 1 : 0;
    return failed;
}

using PackBlocks = WithChildren;

TEST_F(PackBlocks, OneProcessPacksEveryBlock) {
    const TemporaryFolder folder;
    volume::Dataset made = series();
    const BlockSummary summary = packInBlocks(made, small(), folder / "blocks.tsr", {3, {}});
    EXPECT_EQ(summary.blocks, 3u);
    EXPECT_EQ(summary.packed, 3u);
    EXPECT_TRUE(summary.last);
    const PackSummary once = pack(made, small(), folder / "once.tsr");
    EXPECT_EQ(summary.own.sourceBytes, once.sourceBytes);
    EXPECT_EQ(summary.own.storedSamples, once.storedSamples);
    EXPECT_EQ(summary.own.archiveBytes, fs::file_size(folder / "blocks.tsr"));
    const Archive blocks(folder / "blocks.tsr");
    expectSameArchives(Archive(folder / "once.tsr"), blocks, 1); // coarse ones depend on the filter of each block
    EXPECT_EQ(verifyArchive(blocks).damaged, 0u);
    EXPECT_EQ(folder.files(), 2u) << "the folder of the blocks has gone";
}

TEST_F(PackBlocks, TheBytesDoNotDependOnTheNumberOfProcesses) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    for (const PackOptions& options : {small(), small(1e-3), small(0, StoredLattice::BCC)}) {
        ASSERT_EQ(packBy(1, made, options, folder / "one.tsr", 2), 0);
        const std::vector<char> one = readFile(folder / "one.tsr");
        for (const int processes : {2, 3, 6}) {
            ASSERT_EQ(packBy(processes, made, options, folder / "more.tsr", 2), 0);
            EXPECT_EQ(readFile(folder / "more.tsr"), one) << processes << " processes";
        }
        EXPECT_EQ(folder.files(), 2u);
    }
}

TEST_F(PackBlocks, BoundsAreRelativeToTheRangesOfAllTimes) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({16, 16, 16}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 4);
    made.read = [read = made.read](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        for (float& value : field.as<float>()) value *= t == 3 ? 100.0f : 1.0f;
        if (t < 2) field.mask = std::make_shared<const volume::Mask>(field.count(), std::uint8_t(0)); // no value at all
        return field;
    };
    ASSERT_EQ(packBy(2, made, small(1e-3), folder / "blocks.tsr", 1), 0);
    pack(made, small(1e-3), folder / "once.tsr");
    const Archive blocks(folder / "blocks.tsr"), once(folder / "once.tsr");
    EXPECT_EQ(blocks.info().parameters[0].ranges, once.info().parameters[0].ranges);
    EXPECT_GT(blocks.info().parameters[0].ranges[0].lo, 100) << "0 is no value of the data";
    const Range range = once.info().parameters[0].ranges[0];
    const double bound = 1e-3 * (range.hi - range.lo);
    EXPECT_GT(largestError(blocks, made, 0), 0.5 * bound);
    EXPECT_LE(largestError(blocks, made, 0), bound);
}

TEST_F(PackBlocks, ProcessesShareTheParametersOfATime) {
    const TemporaryFolder folder;
    volume::test::TwoRegions regions;
    regions.place = 9;
    const volume::Dataset several = series(5), single = series(1),
                          parted = volume::test::twoRegions(volume::test::ccLattice({25, 22, 21}),
                                                            volume::test::constantIn, regions, 3);
    for (const volume::Dataset& made : {several, single, parted})
        for (const PackOptions& options : {small(), small(1e-3), small(1e-3, StoredLattice::BCC)}) {
            ASSERT_EQ(packBy(1, made, options, folder / "one.tsr", 2, true), 0);
            const Archive one(folder / "one.tsr");
            EXPECT_EQ(verifyArchive(one).damaged, 0u);
            volume::Dataset source = made;
            pack(source, options, folder / "once.tsr");
            if (options.maxError == 0) { // floats within a bound may depend on what repeats
                expectSameArchives(Archive(folder / "once.tsr"), one, 1);
            } else {
                EXPECT_EQ(one.info(), Archive(folder / "once.tsr").info());
                EXPECT_LE(one.metadata().maxError, options.maxError);
            }
            for (const int processes : {2, 3}) {
                ASSERT_EQ(packBy(processes, made, options, folder / "more.tsr", 2, true), 0);
                EXPECT_EQ(readFile(folder / "more.tsr"), readFile(folder / "one.tsr")) << processes << " processes";
            }
            EXPECT_EQ(folder.files(), 3u);
        }
}

TEST_F(PackBlocks, AnArchiveThatWasResampledIsSoAsBefore) {
    const TemporaryFolder folder;
    volume::Dataset made = series();
    pack(made, small(0, StoredLattice::BCC), folder / "source.tsr");
    const auto source = std::make_shared<const Archive>(folder / "source.tsr");
    for (const bool byParameter : {false, true}) {
        packInBlocks(storedDataset(source), small(1e-3, StoredLattice::BCC), folder / "again.tsr",
                     {2, {}, {}, byParameter}, {}, packedBefore(source));
        const Archive again(folder / "again.tsr");
        ASSERT_EQ(again.metadata().resampled.size(), 3u);
        for (std::size_t p = 0; p < 3; ++p) {
            const ResampleError &was = *source->metadata().resampled[p], &is = *again.metadata().resampled[p];
            EXPECT_GT(was.samples, 0);
            EXPECT_NEAR(is.samples, was.samples, 1e-6 * was.samples);
            EXPECT_NEAR(is.meanSquare, was.meanSquare, 1e-9 * was.meanSquare);
            EXPECT_EQ(is.largest, was.largest);
        }
    }
}

TEST_F(PackBlocks, TheParametersOfAnInterruptedBlockAreNotPackedAgain) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    ASSERT_EQ(packBy(1, made, small(), folder / "whole.tsr", 2, true), 0);
    volume::Dataset deadly = made;
    deadly.read = [read = made.read](int p, int c, int t) {
        if (t == 2 && p == 1) ::raise(SIGKILL); // while the second parameter of the second block is read
        return read(p, c, t);
    };
    const BlockOptions blocks{2, {}, {}, true};
    ASSERT_EQ(statusOf(started([&] { return packInBlocks(deadly, small(), folder / "run.tsr", blocks).last; })),
              -SIGKILL);
    EXPECT_TRUE(fs::exists(folder / "run.tsr.blocks/1-0.tsr"));
    EXPECT_EQ(Archive(folder / "run.tsr.blocks/joined.tsr").info().times.size(), 2u);
    // A crash while pieces are merged leaves them beside what was begun, or beside the block.
    writeFile(folder / "run.tsr.blocks/1.merging", {'b', 'e', 'g', 'u', 'n'});
    std::vector<int> last{6};
    PackedBefore ofSeries;
    ofSeries.ofSeries = true;
    packInBlocks(volume::withTimes(made, last), small(), folder / "last.tsr", blocks, {}, ofSeries);
    fs::rename(folder / "last.tsr", folder / "run.tsr.blocks/3.tsr");
    writeFile(folder / "run.tsr.blocks/3-0.tsr", {'l', 'e', 'f', 't'});
    std::set<std::pair<int, int>> again;
    volume::Dataset watched = made;
    watched.read = [read = made.read, &again](int p, int c, int t) {
        again.insert({p, t});
        return read(p, c, t);
    };
    EXPECT_EQ(packInBlocks(watched, small(), folder / "run.tsr", blocks).packed, 5u);
    EXPECT_FALSE(again.contains({0, 2}));
    EXPECT_FALSE(again.contains({1, 6}));
    EXPECT_TRUE(again.contains({1, 2}));
    EXPECT_EQ(readFile(folder / "run.tsr"), readFile(folder / "whole.tsr"));
    EXPECT_EQ(folder.files(), 2u);
}

TEST_F(PackBlocks, WhatAKilledProcessLeftIsGoneOnWith) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    ASSERT_EQ(packBy(1, made, small(), folder / "whole.tsr", 2), 0);
    volume::Dataset deadly = made;
    deadly.read = [read = made.read](int p, int c, int t) {
        if (t == 4) ::raise(SIGKILL); // while the third block is read
        return read(p, c, t);
    };
    const pid_t child = started([&] { return packInBlocks(deadly, small(), folder / "run.tsr", {2, {}}).last; });
    ASSERT_EQ(statusOf(child), -SIGKILL);
    EXPECT_FALSE(fs::exists(folder / "run.tsr"));
    {
        const Archive far(folder / "run.tsr.blocks/joined.tsr"); // what is complete can be read
        EXPECT_EQ(far.info().times, (std::vector<double>{0, 0.5, 1, 1.5}));
        EXPECT_EQ(verifyArchive(far).damaged, 0u);
    }
    int least = 99; // the first time that is read again
    volume::Dataset watched = made;
    watched.read = [read = made.read, &least](int p, int c, int t) {
        least = std::min(least, t);
        return read(p, c, t);
    };
    const BlockSummary summary = packInBlocks(watched, small(), folder / "run.tsr", {2, {}});
    EXPECT_EQ(least, 4);
    EXPECT_EQ(summary.packed, 2u);
    EXPECT_EQ(readFile(folder / "run.tsr"), readFile(folder / "whole.tsr"));
    EXPECT_EQ(folder.files(), 2u);
}

// One that was killed while it was alone in the folder that an earlier job left, and before the first one came.
TEST_F(PackBlocks, TheFolderGoesThoughAProcessOfTheJobWasKilled) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    volume::Dataset deadly = made;
    deadly.read = [](int, int, int) -> volume::Field {
        ::raise(SIGKILL);
        return {};
    };
    const auto packed = [&](const volume::Dataset& of, const std::string& job, int rank) {
        return statusOf(started([&] {
            packInBlocks(of, small(), folder / "run.tsr", {2, {rank, 3, 3, job}});
            return true;
        }));
    };
    ASSERT_EQ(packed(deadly, "1", 0), -SIGKILL);
    ASSERT_EQ(packed(deadly, "2", 2), -SIGKILL);
    ASSERT_EQ(packed(made, "2", 1), 0);
    EXPECT_TRUE(fs::exists(folder / "run.tsr.blocks")) << "the first one is still to come";
    ASSERT_EQ(packed(made, "2", 0), 0);
    EXPECT_EQ(folder.files(), 1u);
}

TEST_F(PackBlocks, OthersDoTheBlockOfAKilledProcess) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    ASSERT_EQ(packBy(1, made, small(), folder / "whole.tsr", 2), 0);
    volume::Dataset slow = made;
    slow.read = [read = made.read](int p, int c, int t) {
        if (t == 0) ::pause(); // until it is killed
        return read(p, c, t);
    };
    const pid_t first = started([&] { return packInBlocks(slow, small(), folder / "run.tsr", {2, {}}).last; });
    while (!fs::exists(folder / "run.tsr.blocks/block-0.lock")) std::this_thread::yield();
    const pid_t second = started([&] { return packInBlocks(made, small(), folder / "run.tsr", {2, {}}).packed == 4; });
    while (!fs::exists(folder / "run.tsr.blocks/3.tsr")) std::this_thread::yield();
    EXPECT_FALSE(fs::exists(folder / "run.tsr.blocks/joined.tsr")) << "the first block is missing";
    ASSERT_EQ(::kill(first, SIGKILL), 0);
    EXPECT_EQ(statusOf(first), -SIGKILL);
    EXPECT_EQ(statusOf(second), 0) << "it did all four blocks";
    EXPECT_EQ(readFile(folder / "run.tsr"), readFile(folder / "whole.tsr"));
    EXPECT_EQ(folder.files(), 2u);
}

TEST_F(PackBlocks, AProcessThatStartsLateDoesNotBeginAgain) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    const auto launchedAs = [](int rank) { return BlockOptions{2, {rank, 2, 1, "7"}}; };
    EXPECT_EQ(packInBlocks(made, small(), folder / "run.tsr", launchedAs(0)).packed, 4u);
    const std::vector<char> before = readFile(folder / "run.tsr");
    EXPECT_TRUE(fs::exists(folder / "run.tsr.blocks")) << "the other process has not come yet";
    volume::Dataset unread = made;
    unread.read = [](int, int, int) -> volume::Field { throw Error("nothing is to be read"); };
    const BlockSummary late = packInBlocks(unread, small(), folder / "run.tsr", launchedAs(1));
    EXPECT_EQ(late.packed, 0u);
    EXPECT_FALSE(late.last);
    EXPECT_EQ(late.own.archiveBytes, before.size());
    EXPECT_EQ(folder.files(), 1u);
}

TEST_F(PackBlocks, WhoHasLeftAFormerRunHasNotLeftThisOne) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    const auto launchedAs = [](int rank) { return BlockOptions{2, {rank, 2, 1, "7"}}; };
    volume::Dataset bad = made;
    bad.read = [](int, int, int) -> volume::Field { throw Error("cannot be read"); };
    for (const int rank : {0, 1}) EXPECT_THROW(packInBlocks(bad, small(), folder / "run.tsr", launchedAs(rank)), Error);
    EXPECT_EQ(packInBlocks(made, small(), folder / "run.tsr", launchedAs(0)).packed, 4u);
    ASSERT_TRUE(fs::exists(folder / "run.tsr.blocks")) << "the other would wait for the folder for ever";
    EXPECT_EQ(packInBlocks(made, small(), folder / "run.tsr", launchedAs(1)).packed, 0u);
    EXPECT_EQ(folder.files(), 1u);
}

TEST_F(PackBlocks, TheFolderOfCompleteWorkDoesNotHideNewData) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    EXPECT_EQ(packInBlocks(made, small(), folder / "run.tsr", {2, {0, 2, 1, "7"}}).packed, 4u); // the other never comes
    ASSERT_TRUE(fs::exists(folder / "run.tsr.blocks"));
    volume::Dataset other = made;
    other.read = [read = made.read](int p, int c, int t) { return read(p, c, 6 - t); };
    EXPECT_EQ(packInBlocks(other, small(), folder / "run.tsr", {2, {}}).packed, 4u);
    expectSame(readField(Archive(folder / "run.tsr"), 2, 0, 0), made.read(2, 0, 6), true);
    EXPECT_EQ(folder.files(), 1u);
}

TEST_F(PackBlocks, AnotherRunOfALauncherWithoutNamesBeginsAnew) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    const BlockOptions first{2, {0, 2, 1, "-"}};
    EXPECT_EQ(packInBlocks(made, small(), folder / "run.tsr", first).packed, 4u); // the other never comes
    EXPECT_EQ(packInBlocks(made, small(), folder / "run.tsr", first).packed, 4u);
}

TEST_F(PackBlocks, BricksOfAnAutomaticSizeAreAlike) { // of small integers at one time they are larger than at several
    const TemporaryFolder folder;
    const volume::Dataset made =
        makeDataset({80, 70, 60}, {{"n", ScalarType::U8, 1, Texture::Smooth, false, false}}, 3);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    packInBlocks(made, options, folder / "run.tsr", {2, {}});
    const Archive archive(folder / "run.tsr");
    EXPECT_EQ(archive.info().times.size(), 3u);
    EXPECT_EQ(archive.grid().brickSize, 64);
    for (int t = 0; t < 3; ++t) expectSame(readField(archive, 0, 0, t), made.read(0, 0, t), true);
}

TEST_F(PackBlocks, ABlockWithoutSamplesBringsNoRange) {
    const TemporaryFolder folder;
    for (const int absent : {0, 1, 2}) {
        volume::Dataset made = makeDataset({16, 16, 16}, {{"T", ScalarType::F32, 2, Texture::Smooth, false, false}}, 3);
        made.read = [read = made.read, absent](int p, int c, int t) {
            volume::Field field = read(p, c, t);
            if (t == absent) field.mask = std::make_shared<const volume::Mask>(field.count(), std::uint8_t(0));
            return field;
        };
        packInBlocks(made, small(), folder / "blocks.tsr", {1, {}});
        pack(made, small(), folder / "once.tsr");
        const Archive blocks(folder / "blocks.tsr"), once(folder / "once.tsr");
        EXPECT_EQ(blocks.info().parameters[0].ranges, once.info().parameters[0].ranges) << "absent at time " << absent;
        EXPECT_GT(once.info().parameters[0].ranges[0].lo, 100);
    }
}

TEST_F(PackBlocks, AnExistingArchiveStaysUntilTheNewOneIsComplete) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    writeFile(folder / "run.tsr", {'o', 'l', 'd'});
    volume::Dataset bad = made;
    bad.read = [read = made.read](int p, int c, int t) {
        if (t == 5) throw Error("cannot be read");
        return read(p, c, t);
    };
    EXPECT_THROW(packInBlocks(bad, small(), folder / "run.tsr", {2, {}}), Error);
    EXPECT_EQ(readFile(folder / "run.tsr"), (std::vector<char>{'o', 'l', 'd'}));
    packInBlocks(made, small(), folder / "run.tsr", {2, {}});
    EXPECT_EQ(Archive(folder / "run.tsr").info().times.size(), 7u);
}

TEST_F(PackBlocks, OtherWorkInTheFolderIsRefused) {
    const TemporaryFolder folder;
    const volume::Dataset made = series();
    volume::Dataset bad = made;
    bad.read = [read = made.read](int p, int c, int t) {
        if (t == 5) throw Error("cannot be read");
        return read(p, c, t);
    };
    EXPECT_THROW(packInBlocks(bad, small(), folder / "run.tsr", {2, {}}), Error);
    for (const auto& [options, times] : {std::pair(small(1e-3), 2), {small(), 3}}) {
        try {
            packInBlocks(made, options, folder / "run.tsr", {std::size_t(times), {}});
            ADD_FAILURE() << "it was mixed with other work";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("run.tsr.blocks: belongs to other data or options"),
                      std::string::npos)
                << error.what();
        }
    }
    EXPECT_THROW(packInBlocks(made, small(), folder / "run.tsr", {2, {}, "--absent T=0"}), Error) << "read otherwise";
    EXPECT_FALSE(fs::exists(folder / "run.tsr"));
    fs::create_directory(folder / "folder.tsr");
    EXPECT_THROW(packInBlocks(made, small(), folder / "folder.tsr", {2, {}}), Error);
    EXPECT_FALSE(fs::exists(folder / "folder.tsr.blocks"));
}

TEST_F(PackBlocks, VanishedBlocksArePackedAgain) {
    const TemporaryFolder folder;
    const volume::Dataset whole = series();
    volume::Dataset made = whole;
    std::atomic<bool> removed = false;
    made.read = [read = made.read, &folder, &removed](int p, int c, int t) {
        if (t == 6 && !removed.exchange(true)) fs::remove(folder / "run.tsr.blocks/joined.tsr");
        return read(p, c, t);
    };
    packInBlocks(made, small(), folder / "run.tsr", {2, {}});
    const Archive archive(folder / "run.tsr");
    ASSERT_EQ(archive.info().times.size(), 7u);
    for (int t = 0; t < 7; ++t) expectSame(readField(archive, 2, 0, t), whole.read(2, 0, t), true);
}

TEST_F(PackBlocks, ARemovedFolderIsSaidToBe) {
    const TemporaryFolder folder;
    volume::Dataset made = series();
    made.read = [read = made.read, &folder](int p, int c, int t) {
        if (t == 2 && p == 2) fs::remove_all(folder / "run.tsr.blocks");
        return read(p, c, t);
    };
    EXPECT_THROW(packInBlocks(made, small(), folder / "run.tsr", {2, {}}), std::exception);
    EXPECT_FALSE(fs::exists(folder / "run.tsr"));
}

TEST_F(PackBlocks, WhatDependsOnAllTimesIsRefused) {
    const TemporaryFolder folder;
    PackOptions d4 = small(), sized = small(), discards = small();
    d4.lattice = StoredLattice::D4;
    sized.sizeMb = 1;
    discards.discard = 0.1;
    for (const PackOptions& options : {d4, sized, discards})
        EXPECT_THROW(packInBlocks(series(), options, folder / "run.tsr", {2, {}}), Error);
    EXPECT_EQ(folder.files(), 0u);
}

TEST_F(PackBlocks, EachProcessHasABlock) {
    EXPECT_EQ(blockTimes(1000, {0, 4, 1, ""}), 16u);
    EXPECT_EQ(blockTimes(10, {0, 4, 1, ""}), 3u);
    EXPECT_EQ(blockTimes(3, {0, 8, 1, ""}), 1u);
}

} // namespace
} // namespace tessera::codec
