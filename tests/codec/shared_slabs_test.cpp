#include "codec/archive/archive.h"
#include "codec/blocks/pack_blocks.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/child_process.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <thread>
#include <vector>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;
namespace fs = std::filesystem;

volume::Dataset volumes(int times = 1) {
    return inParts(makeDataset({17, 12, 37},
                               {{"O2", ScalarType::F32, 1, Texture::Smooth, true, false},
                                {"U", ScalarType::F32, 2, Texture::Noise, false, false},
                                {"n", ScalarType::U16, 1, Texture::Smooth, false, false},
                                {"region", ScalarType::U8, 1, Texture::Smooth, false, true}},
                               times));
}

PackOptions small(StoredLattice lattice = StoredLattice::CC) {
    PackOptions options;
    options.lattice = lattice;
    options.brickSize = 8;
    return options;
}

BlockOptions together(int rank, int processes, std::size_t times = 1, bool byParameter = false) {
    return {times, {rank, processes, processes, "1"}, {}, byParameter, true};
}

/// Packs by several processes that share slabs; returns how many of them failed.
int packTogether(int processes, const volume::Dataset& made, const PackOptions& options, const std::string& path,
                 std::size_t times = 1, bool byParameter = false) {
    std::vector<pid_t> children;
    for (int rank = 0; rank < processes; ++rank)
        children.push_back(started([&] {
            packInBlocks(made, options, path, together(rank, processes, times, byParameter));
            return fs::exists(path);
        }));
    int failed = 0;
    for (const pid_t child : children) failed += statusOf(child) != 0 ? 1 : 0;
    return failed;
}

std::vector<char> packedAlone(const volume::Dataset& made, const PackOptions& options, const TemporaryFolder& folder,
                              bool byParameter = false) {
    packInBlocks(made, options, folder / "alone.tsr", {1, {}, {}, byParameter});
    return readFile(folder / "alone.tsr");
}

using SharedSlabs = WithChildren;

TEST_F(SharedSlabs, GiveTheArchiveOfOneProcess) {
    const TemporaryFolder folder;
    std::vector<PackOptions> ways;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        const PackOptions plain = small(lattice);
        ways.push_back(plain);
        ways.push_back(plain), ways.back().maxError = 1e-3;
        ways.push_back(plain), ways.back().absError = 0.7;
        ways.push_back(plain), ways.back().psnr = 40;
        ways.push_back(plain), ways.back().effort = 7;
    }
    ways.push_back(small(StoredLattice::BCC)), ways.back().resample.filter = volume::ResampleFilter::BSpline5;
    const volume::Dataset made = volumes();
    int number = 0;
    for (const PackOptions& options : ways) {
        const bool byParameter = number++ % 2 == 1;
        const std::vector<char> alone = packedAlone(made, options, folder, byParameter);
        for (const int processes : {1, 2, 3}) {
            ASSERT_EQ(packTogether(processes, made, options, folder / "more.tsr", 1, byParameter), 0) << number;
            EXPECT_TRUE(readFile(folder / "more.tsr") == alone) << "way " << number << ", " << processes;
        }
    }
    EXPECT_EQ(folder.files(), 2u) << "what was shared is gone";
}

TEST_F(SharedSlabs, OfASeriesAreTheSameForAnyNumberOfProcesses) {
    const TemporaryFolder folder;
    const volume::Dataset made = volumes(5);
    PackOptions options = small();
    options.maxError = 1e-3;
    const std::vector<char> alone = packedAlone(made, options, folder);
    ASSERT_EQ(packTogether(3, made, options, folder / "single.tsr"), 0);
    EXPECT_TRUE(readFile(folder / "single.tsr") == alone);
    // Within a block slabs are not compared with the time before, but tables of its frames serve again.
    ASSERT_EQ(packTogether(1, made, options, folder / "one.tsr", 3), 0);
    ASSERT_EQ(packTogether(2, made, options, folder / "two.tsr", 3), 0);
    EXPECT_TRUE(readFile(folder / "two.tsr") == readFile(folder / "one.tsr"));
    EXPECT_EQ(verifyArchive(Archive(folder / "two.tsr")).damaged, 0u);
}

// That the processes share the work, rather than each doing all of it.
TEST_F(SharedSlabs, AreEachReadByOneProcess) {
    const TemporaryFolder folder;
    volume::Dataset made =
        inParts(makeDataset({16, 16, 64}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 1));
    made.info.parameters[0].ranges = {{-10, 10}}; // so that only what is packed is read
    const std::string log = folder / "log";
    made.read = [read = made.read, log](int p, int c, int t, volume::SliceRange slices) {
        std::ofstream(log + std::to_string(::getpid()), std::ios::app) << slices.first << " " << slices.count << "\n";
        ::usleep(20000); // the others find something to do
        return read(p, c, t, slices);
    };
    ASSERT_EQ(packTogether(2, made, small(), folder / "two.tsr"), 0);
    std::multiset<std::pair<int, int>> slabs;
    int processes = 0;
    for (const auto& entry : fs::directory_iterator(folder / "")) {
        if (!entry.path().filename().string().starts_with("log")) continue;
        std::ifstream in(entry.path());
        ++processes;
        for (int first = 0, count = 0; in >> first >> count;) slabs.insert({first, count});
    }
    EXPECT_EQ(processes, 2);
    std::multiset<std::pair<int, int>> each;
    for (int first = 0; first < 64; first += 8) each.insert({first, 8});
    EXPECT_EQ(slabs, each);
}

/// A data set of which reading `slice` in the process with this rank calls `what`.
volume::Dataset onReading(int slice, volume::Dataset made, const std::function<void()>& what) {
    made.read = [read = made.read, slice, what](int p, int c, int t, volume::SliceRange slices) {
        if (p == 1 && slices.first <= slice && slice < slices.first + std::max(slices.count, 1)) what();
        return read(p, c, t, slices);
    };
    return made;
}

TEST_F(SharedSlabs, OfAKilledProcessAreDoneByTheOthers) {
    const TemporaryFolder folder;
    const volume::Dataset made = volumes();
    const std::vector<char> alone = packedAlone(made, small(), folder);
    for (const bool writer : {true, false}) {
        const std::string path = folder / (writer ? "writer.tsr" : "helper.tsr"), met = path + ".met";
        const auto waits = [&] {
            while (!fs::exists(met)) std::this_thread::yield();
        };
        const volume::Dataset deadly = onReading(20, made, [&] {
            std::ofstream(met).flush();
            ::raise(SIGKILL);
        });
        const volume::Dataset patient = onReading(4, made, waits); // the other one is in the middle of the frame
        const auto isHere = [&] { return fs::exists(path + ".blocks/block-0.lock"); };
        const pid_t one = started([&] { // the one that comes first writes
            return packInBlocks(writer ? deadly : patient, small(), path, together(0, 2)).last;
        });
        while (!isHere()) std::this_thread::yield();
        const pid_t two = started([&] {
            packInBlocks(writer ? patient : deadly, small(), path, together(1, 2));
            return true;
        });
        EXPECT_EQ(statusOf(writer ? one : two), -SIGKILL);
        EXPECT_EQ(statusOf(writer ? two : one), 0);
        EXPECT_TRUE(readFile(path) == alone) << writer;
    }
}

TEST_F(SharedSlabs, ANextRunGoesOnFromWholeTimes) {
    const TemporaryFolder folder;
    const volume::Dataset made = volumes(3);
    const std::vector<char> alone = packedAlone(made, small(), folder);
    volume::Dataset deadly = made;
    deadly.read = [read = made.read](int p, int c, int t, volume::SliceRange slices) {
        if (t == 1 && p == 2) ::raise(SIGKILL);
        return read(p, c, t, slices);
    };
    for (const pid_t child :
         {started([&] { return packInBlocks(deadly, small(), folder / "run.tsr", together(0, 2)).last; }),
          started([&] { return packInBlocks(deadly, small(), folder / "run.tsr", together(1, 2)).last; })})
        EXPECT_EQ(statusOf(child), -SIGKILL);
    EXPECT_EQ(Archive(folder / "run.tsr.blocks/joined.tsr").info().times.size(), 1u);
    ASSERT_EQ(packTogether(2, made, small(), folder / "run.tsr"), 0);
    EXPECT_TRUE(readFile(folder / "run.tsr") == alone);
    EXPECT_EQ(folder.files(), 2u);
}

TEST_F(SharedSlabs, RefuseWhatTheyCannotDo) {
    const TemporaryFolder folder;
    volume::Dataset whole = makeDataset({9, 9, 9}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 1);
    EXPECT_THROW(packInBlocks(whole, small(), folder / "a.tsr", together(0, 1)), Error);
    PackOptions threshold = small();
    threshold.lossless = false;
    threshold.threshold = {ThresholdChoice::Soft, 0.01, true};
    EXPECT_THROW(packInBlocks(inParts(whole), threshold, folder / "a.tsr", together(0, 1)), Error);
    EXPECT_EQ(folder.files(), 0u);
    volume::Dataset bad = volumes();
    bad.read = [read = bad.read](int p, int c, int t, volume::SliceRange slices) {
        if (slices.first > 10) throw Error("is damaged", "made");
        return read(p, c, t, slices);
    };
    EXPECT_EQ(packTogether(2, bad, small(), folder / "a.tsr"), 2) << "nobody waits for ever";
    EXPECT_EQ(folder.files(), 0u);
}

} // namespace
} // namespace tessera::codec
