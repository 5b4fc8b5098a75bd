#include "codec/archive/archive.h"
#include "codec/archive/archive_writer.h"
#include "codec/archive/commits.h"
#include "codec/container/container.h"
#include "codec/container/growing_file.h"
#include "codec/pack/pack.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain/decoder.h"

#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

std::vector<MadeParameter> several() {
    return {{"O2", ScalarType::F32, 1, Texture::Smooth, true, false},
            {"U", ScalarType::F32, 2, Texture::Noise, false, false},
            {"n", ScalarType::U16, 1, Texture::Smooth, false, false},
            {"region", ScalarType::U8, 1, Texture::Noise, true, true}};
}

/// Some times and parameters of a data set.
volume::Dataset part(const volume::Dataset& whole, std::size_t firstTime, std::size_t times, int firstParameter = 0,
                     int parameters = 99) {
    volume::Dataset some;
    some.info = whole.info;
    const auto& allTimes = whole.info.times;
    some.info.times.assign(allTimes.begin() + std::ptrdiff_t(firstTime),
                           allTimes.begin() + std::ptrdiff_t(firstTime + times));
    const auto& all = whole.info.parameters;
    const int endParameter = std::min(firstParameter + parameters, int(all.size()));
    some.info.parameters.assign(all.begin() + firstParameter, all.begin() + endParameter);
    some.read = [read = whole.read, firstTime, firstParameter](int p, int c, int t) {
        return read(p + firstParameter, c, t + int(firstTime));
    };
    return some;
}

PackOptions smallBricks(double absError = 0) {
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    options.brickSize = 8;
    options.absError = absError;
    return options;
}

TEST(Growing, AppendedTimesAndParametersAreAsPackedAtOnce) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({17, 12, 19}, several(), 5);
    for (const double bound : {0.0, 0.01}) {
        volume::Dataset all = part(made, 0, 5);
        pack(all, smallBricks(bound), folder / "once.tsr");

        volume::Dataset first = part(made, 0, 2), second = part(made, 2, 1), third = part(made, 3, 2);
        pack(first, smallBricks(bound), folder / "times.tsr");
        const PackSummary summary = append(second, folder / "times.tsr");
        append(third, folder / "times.tsr");
        const Archive byTime(folder / "times.tsr");
        expectSameArchives(Archive(folder / "once.tsr"), byTime);
        EXPECT_GE(byTime.commits(), 3);
        EXPECT_LT(summary.archiveBytes, byTime.fileBytes());
        EXPECT_EQ(verifyArchive(byTime).damaged, 0u);
        // Masks of the times before are found again.
        EXPECT_EQ(byTime.maskCount(), Archive(folder / "once.tsr").maskCount());

        volume::Dataset some = part(made, 0, 5, 0, 2), rest = part(made, 0, 5, 2);
        pack(some, smallBricks(bound), folder / "parameters.tsr");
        append(rest, folder / "parameters.tsr");
        expectSameArchives(Archive(folder / "once.tsr"), Archive(folder / "parameters.tsr"));
        EXPECT_EQ(verifyArchive(Archive(folder / "parameters.tsr")).damaged, 0u);
    }
}

TEST(Growing, ParametersMayComeInAnotherOrder) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({9, 9, 9}, several(), 2);
    volume::Dataset all = part(made, 0, 2), first = part(made, 0, 1), second = part(made, 1, 1);
    std::swap(second.info.parameters[0], second.info.parameters[2]);
    second.read = [read = second.read](int p, int c, int t) { return read(p == 0 ? 2 : p == 2 ? 0 : p, c, t); };
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    pack(all, options, folder / "once.tsr");
    pack(first, options, folder / "grown.tsr");
    append(second, folder / "grown.tsr");
    expectSameArchives(Archive(folder / "once.tsr"), Archive(folder / "grown.tsr"));
}

TEST(Growing, RelativeBoundsHoldForTheRangeOfTheWhole) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({20, 16, 12}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 3);
    made.read = [read = made.read](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        for (float& value : field.as<float>()) value *= float(1 + t); // every time has a wider range
        return field;
    };
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.maxError = 1e-3;
    volume::Dataset first = part(made, 0, 1), rest = part(made, 1, 2);
    pack(first, options, folder / "a.tsr");
    append(rest, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    const Range range = archive.info().parameters[0].ranges[0];
    const double largest = largestError(archive, made, 0);
    EXPECT_LE(largest, 1e-3 * (range.hi - range.lo));
    EXPECT_GT(largest, 0.5e-3 * (range.hi - range.lo));
    EXPECT_EQ(archive.metadata().maxError, 1e-3);
}

/// The times an archive has; every brick of it is decoded. Fails the test when there is damage.
std::size_t timesOf(const std::string& path) {
    try {
        const Archive archive(path);
        const VerifyReport report = verifyArchive(archive);
        for (const std::string& line : report.damage)
            EXPECT_NE(line.find("one of its two copies"), std::string::npos) << line;
        return archive.info().times.size();
    } catch (const Error& error) {
        ADD_FAILURE() << error.what();
        return 0;
    }
}

// What a disk may hold after a crash: appended bytes up to anywhere, then one header after the other, each torn.
TEST(Growing, ACrashAtAnyByteLeavesTheLastCommitOrTheNext) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({6, 5, 7}, several(), 3);
    volume::Dataset first = part(made, 0, 2), second = part(made, 2, 1);
    const std::string path = folder / "a.tsr", crashed = folder / "crashed.tsr";
    pack(first, smallBricks(), path);
    const std::vector<char> before = readFile(path);
    append(second, path);
    const std::vector<char> after = readFile(path);
    ASSERT_GT(after.size(), before.size());
    const auto head = std::ptrdiff_t(2 * kHeaderBytes);

    std::vector<char> bytes = after;
    std::copy_n(before.begin(), head, bytes.begin());
    for (std::size_t size = before.size(); size <= after.size(); size += size % 64 == 0 ? 1 : 3) {
        writeFile(crashed, {bytes.begin(), bytes.begin() + std::ptrdiff_t(size)});
        ASSERT_EQ(timesOf(crashed), 2u) << size;
    }
    const auto tear = [&](std::ptrdiff_t copy) {
        const std::ptrdiff_t begin = copy * std::ptrdiff_t(kHeaderBytes);
        for (std::ptrdiff_t n = 0; n < std::ptrdiff_t(kHeaderBytes); ++n) {
            bytes[std::size_t(begin + n)] = after[std::size_t(begin + n)];
            writeFile(crashed, bytes);
            const std::size_t times = timesOf(crashed);
            ASSERT_EQ(times, copy == 1 && n + 1 < std::ptrdiff_t(kHeaderBytes) && times == 2 ? 2u : 3u)
                << "header " << copy << " byte " << n;
            // And it goes on from there.
            if (n % 20 != 10) continue;
            volume::Dataset last = part(made, times, 3 - times);
            if (times < 3) append(last, crashed);
            volume::Dataset more = part(made, 2, 1);
            more.info.times = {99};
            append(more, crashed);
            EXPECT_EQ(timesOf(crashed), 4u);
            EXPECT_EQ(verifyArchive(Archive(crashed)).damaged, 0u);
        }
    };
    tear(1);
    tear(0);
    EXPECT_EQ(bytes, after);
}

TEST(Growing, ReadersSeeWholeTimesWhileItGrows) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({24, 24, 24},
                                       {{"x", ScalarType::F32, 1, Texture::Nasty, true, false},
                                        {"y", ScalarType::F32, 1, Texture::Nasty, false, false}},
                                       4);
    const std::string path = folder / "a.tsr";
    std::unique_ptr<Archive> early;
    std::vector<std::size_t> seen;
    const Progress progress{[&](double, const std::string&) {
                                if (!std::filesystem::exists(path)) return;
                                if (!early) early = std::make_unique<Archive>(path);
                                const std::size_t times = timesOf(path);
                                if (seen.empty() || seen.back() != times) seen.push_back(times);
                            },
                            {}};
    PackOptions options;
    options.lattice = StoredLattice::CC;
    pack(made, options, path, progress);
    EXPECT_EQ(seen, (std::vector<std::size_t>{1, 2, 3, 4}));
    ASSERT_TRUE(early);
    EXPECT_TRUE(early->outdated());
    EXPECT_FALSE(Archive(path).outdated());
    EXPECT_EQ(early->info().times.size(), 1u);
    EXPECT_EQ(readField(*early, 1, 0, 0).samples, made.read(1, 0, 0).samples);
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Growing, FailuresKeepWhatWasThere) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    volume::Dataset made = makeDataset({24, 24, 24}, {{"x", ScalarType::F32, 1, Texture::Nasty, false, false}}, 6);
    volume::Dataset first = part(made, 0, 2);
    pack(first, {}, path);
    const std::vector<char> before = readFile(path);
    const auto failing = [&](std::size_t from, std::size_t at) {
        volume::Dataset rest = part(made, from, 6 - from);
        rest.read = [read = rest.read, at](int p, int c, int t) {
            if (t == int(at)) throw Error("truncated", "x.raw");
            return read(p, c, t);
        };
        return rest;
    };
    volume::Dataset bad = failing(0, 3);
    EXPECT_THROW(pack(bad, {}, path), Error); // would have replaced it
    EXPECT_EQ(readFile(path), before);
    bad = failing(2, 0);
    EXPECT_THROW(append(bad, path), Error);
    EXPECT_EQ(readFile(path), before);
    bad = failing(2, 2);
    EXPECT_THROW(append(bad, path), Error);
    EXPECT_EQ(timesOf(path), 4u);
    EXPECT_EQ(Archive(path).fileBytes(), readFile(path).size());
    volume::Dataset rest = part(made, 4, 2);
    append(rest, path);
    EXPECT_EQ(timesOf(path), 6u);
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Growing, OneProgramWritesAtATime) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({9, 9, 9}, {{"x", ScalarType::U8, 1, Texture::Noise, false, false}}, 2);
    volume::Dataset first = part(made, 0, 1), second = part(made, 1, 1);
    const std::string path = folder / "a.tsr";
    pack(first, {}, path);
    {
        const Archive archive(path);
        const ArchiveWriter writer(archive, archive.metadata());
        EXPECT_THROW(append(second, path), Error);
    }
    const Archive archive(path);
    append(second, path);
    EXPECT_THROW(ArchiveWriter(archive, archive.metadata()), Error); // has changed meanwhile
}

/// Packs four times, and calls `meanwhile` once: before the archive has its name, or after its first time.
void packWhile(const std::string& path, bool named, const std::function<void()>& meanwhile) {
    volume::Dataset made = makeDataset({24, 24, 24}, {{"x", ScalarType::F32, 1, Texture::Nasty, false, false}}, 4);
    bool done = false;
    const Progress progress{[&](double, const std::string&) {
                                const bool begun =
                                    named ? std::filesystem::exists(path)
                                          : !std::filesystem::is_empty(std::filesystem::path(path).parent_path());
                                if (!begun || std::exchange(done, true)) return;
                                meanwhile();
                            },
                            {}};
    PackOptions options;
    options.lattice = StoredLattice::CC;
    pack(made, options, path, progress);
    EXPECT_TRUE(done);
}

TEST(Growing, AnArchiveThatIsBeingWrittenIsNotReplaced) {
    const TemporaryFolder folder;
    volume::Dataset other = makeDataset({9, 9, 9}, {{"x", ScalarType::U8, 1, Texture::Noise, false, false}}, 1);
    for (const bool named : {false, true}) {
        const std::string path = folder / (named ? "named.tsr" : "unnamed.tsr");
        packWhile(path, named, [&] { EXPECT_THROW(pack(other, {}, path), Error); });
        EXPECT_EQ(timesOf(path), 4u);
        std::filesystem::remove(path);
        EXPECT_EQ(folder.files(), 0u);
    }
    // One that is to be replaced is not written to either.
    const std::string path = folder / "a.tsr";
    pack(other, {}, path);
    other.info.times = {1};
    {
        const GrowingFile replacing(path);
        EXPECT_THROW(append(other, path), Error);
    }
    append(other, path);
    EXPECT_EQ(timesOf(path), 2u);
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Growing, AnArchiveThatWasReplacedMeanwhileIsNotTakenForItsOwn) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr", others = folder / "b.tsr";
    volume::Dataset other = makeDataset({9, 9, 9}, {{"x", ScalarType::U8, 1, Texture::Noise, false, false}}, 1);
    pack(other, {}, others);
    const std::vector<char> bytes = readFile(others);
    EXPECT_THROW(packWhile(path, true, [&] { std::filesystem::rename(others, path); }), Error); // as by mv
    EXPECT_EQ(readFile(path), bytes);
    EXPECT_EQ(folder.files(), 1u);
    // Nor is it removed where packing fails.
    std::filesystem::rename(path, others);
    EXPECT_THROW(packWhile(path, true,
                           [&] {
                               std::filesystem::rename(others, path);
                               throw Error("cancelled");
                           }),
                 Error);
    EXPECT_EQ(readFile(path), bytes);
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Growing, LabelsOfLaterTimesGetTheirNames) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    volume::Dataset made = makeDataset({9, 9, 9}, {{"region", ScalarType::U8, 1, Texture::Noise, false, true}}, 1);
    std::vector<volume::Label>& labels = made.info.parameters[0].labels;
    labels = {{1, "plate", "#112233"}, {9, "gas"}};
    pack(made, {}, path);
    made.info.times[0] += 1;
    labels = {{1, "another name"}, {7, "membrane", "#445566"}};
    append(made, path);
    EXPECT_EQ(Archive(path).info().parameters[0].labels,
              (std::vector<volume::Label>{{1, "plate", "#112233"}, {7, "membrane", "#445566"}, {9, "gas"}}));
}

TEST(Growing, AFolderIsNoArchive) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a.tsr");
    volume::Dataset made = makeDataset({9, 9, 9}, {{"x", ScalarType::U8, 1, Texture::Noise, false, false}}, 1);
    made.read = [](int, int, int) -> volume::Field { throw std::logic_error("read before the path was looked at"); };
    EXPECT_THROW(pack(made, {}, folder / "a.tsr"), Error);
}

TEST(Growing, WhatDoesNotContinueAnArchiveIsRefused) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({9, 8, 7}, several(), 4);
    volume::Dataset first = part(made, 0, 2);
    const std::string path = folder / "a.tsr";
    pack(first, {}, path);
    const std::vector<char> before = readFile(path);
    const auto refused = [&](const char* why, auto&& change) {
        volume::Dataset data = part(made, 2, 2);
        change(data);
        try {
            append(data, path);
            ADD_FAILURE() << "not refused: " << why;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
        EXPECT_EQ(readFile(path), before);
    };
    refused("another grid", [](auto& d) { d.info.lattice.size.x = 8; });
    refused("another grid", [](auto& d) { d.info.lattice.origin.y += 0.01; });
    refused("not after the last", [](auto& d) { d.info.times = {0.5, 1}; });
    refused("the type", [](auto& d) { d.info.parameters[0].type = ScalarType::I32; });
    refused("the unit", [](auto& d) { d.info.parameters[2].unit = "Pa"; });
    refused("components", [](auto& d) { d.info.parameters[1].components = 3; });
    refused("is a label in one", [](auto& d) { d.info.parameters[3].categorical = false; });
    refused("the archive has no parameter N2 at its times so far", [](auto& d) { d.info.parameters[0].name = "N2"; });
    refused("no parameter n", [](auto& d) { d.info.parameters.erase(d.info.parameters.begin() + 2); });
    refused("at all times", [](auto& d) {
        for (auto& parameter : d.info.parameters) parameter.name += "'";
    });
    volume::Dataset later = part(made, 2, 2);
    PackOptions d4;
    d4.lattice = StoredLattice::D4;
    volume::Dataset eight = makeDataset({17, 12, 19}, several(), 8);
    pack(eight, d4, folder / "d4.tsr");
    EXPECT_THROW(append(later, folder / "d4.tsr"), Error);
}

TEST(Growing, MetadataOfALongSeriesAreSerialisedAFewTimes) {
    // Each time adds little, and twenty values to the metadata, which would take far longer than the times themselves.
    const TemporaryFolder folder;
    const auto serialised = [&](int times) {
        GrowingFile file(folder / ("long" + std::to_string(times)));
        Commits commits;
        IndexPage page;
        Metadata metadata;
        metadata.info.parameters = {{"T", "K", 1, ScalarType::F32, false, {}, {}}};
        metadata.info.times.clear();
        metadata.info.quantities.assign(20, {"voltage", "V", {}});
        for (std::size_t q = 0; q < 20; ++q) metadata.info.quantities[q].name += std::to_string(q);
        int count = 0;
        for (int t = 0; t < times; ++t) {
            file.append(Bytes(2000));
            metadata.info.times.push_back(t);
            for (volume::Quantity& quantity : metadata.info.quantities) quantity.values.push_back(0.1 * t);
            if (commits.waits(file)) continue;
            ++count;
            commits.commit(file, page, metadata, std::size_t(t) + 1, false);
        }
        return count;
    };
    const int once = serialised(100);
    EXPECT_GE(once, 1);
    EXPECT_LE(serialised(1600), 4 * once); // for 16 times as many times, with the commits that are worth it
}

TEST(Growing, EveryFlippedByteOfManyCommitsIsNoticed) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({5, 4, 6}, several(), 3);
    const std::string path = folder / "a.tsr", flipped = folder / "flipped.tsr";
    for (std::size_t t = 0; t < 3; ++t) {
        volume::Dataset one = part(made, t, 1);
        if (t == 0)
            pack(one, smallBricks(), path);
        else
            append(one, path);
    }
    std::vector<char> bytes = readFile(path);
    EXPECT_EQ(Archive(path).commits(), 3);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] ^= 0x10;
        writeFile(flipped, bytes);
        bytes[i] ^= 0x10;
        try {
            EXPECT_GT(verifyArchive(Archive(flipped)).damaged, 0u) << "byte " << i << " of " << bytes.size();
        } catch (const Error&) { // refused at once
            EXPECT_GE(i, 2 * kHeaderBytes);
        }
    }
}

TEST(Growing, ThePlainDecoderReadsGrownArchives) {
    const TemporaryFolder folder;
    const volume::Dataset made = makeDataset({10, 9, 8}, several(), 3);
    const std::string path = folder / "a.tsr";
    PackOptions options = smallBricks();
    options.lattice = StoredLattice::CC;
    volume::Dataset some = part(made, 0, 2, 0, 2), rest = part(made, 0, 2, 2), last = part(made, 2, 1);
    pack(some, options, path);
    append(rest, path);
    append(last, path);
    std::vector<char> bytes = readFile(path);
    bytes.insert(bytes.end(), 100, 'x'); // an append that was not finished
    const plain::Decoder decoder(bytes);
    ASSERT_EQ(decoder.frames(), 3u * 5);
    EXPECT_EQ(decoder.metadata()["data"]["times"], (nlohmann::json{0.0, 0.5, 1.0}));
    std::size_t frame = 0;
    for (int t = 0; t < 3; ++t)
        for (int p = 0; p < 4; ++p)
            for (int c = 0; c < made.info.parameters[std::size_t(p)].components; ++c, ++frame) {
                const volume::Field field = made.read(p, c, t);
                const plain::Brick brick = decoder.brick(frame, 0, 0);
                const auto size = made.info.lattice.size;
                std::size_t i = 0;
                for (int z = 0; z < brick.size[2]; ++z)
                    for (int y = 0; y < brick.size[1]; ++y)
                        for (int x = 0; x < brick.size[0]; ++x, ++i) {
                            const std::size_t at = std::size_t((z * size.y + y) * size.x + x);
                            ASSERT_EQ(brick.present[i], field.present(at));
                            if (brick.present[i]) {
                                ASSERT_EQ(brick.values[i], field.value(at));
                            }
                        }
            }
}

TEST(Growing, WhatAKilledPackingLeftIsRemovedByTheNext) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    const pid_t killed = ::fork();
    if (killed == 0) {
        const GrowingFile begun(path);
        ::kill(::getpid(), SIGKILL);
    }
    ::waitpid(killed, nullptr, 0);
    const std::string left = path + ".part-" + std::to_string(killed);
    ASSERT_TRUE(std::filesystem::exists(left));
    volume::Dataset made = makeDataset({24, 24, 24}, {{"x", ScalarType::F32, 1, Texture::Smooth, true, false}}, 1);
    pack(made, {}, path);
    EXPECT_FALSE(std::filesystem::exists(left));
    EXPECT_EQ(timesOf(path), 1u);
    EXPECT_EQ(folder.files(), 1u);
}

} // namespace
} // namespace tessera::codec
