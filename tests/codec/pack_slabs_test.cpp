#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"
#include "volume/base/error.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <map>
#include <tuple>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

/// A data set that is read in parts; counts the most slices asked for at once.
struct PartReader {
    std::shared_ptr<int> most = std::make_shared<int>(0);
    volume::Dataset inParts(volume::Dataset made) const {
        using Frames = std::map<std::tuple<int, int, int>, volume::Field>; // that were made
        made.read = [read = made.read, most = most, frames = std::make_shared<Frames>()](int p, int c, int t,
                                                                                         volume::SliceRange slices) {
            const auto [frame, isNew] = frames->try_emplace({p, c, t});
            if (isNew) frame->second = read(p, c, t);
            *most = std::max(*most, slices.of(frame->second.lattice).count);
            return volume::slicesOf(frame->second, slices);
        };
        return made;
    }
};

PackOptions slabOptions(StoredLattice lattice) {
    PackOptions options;
    options.lattice = lattice;
    options.brickSize = 8;
    return options;
}

std::vector<PackOptions> everyWayToPack() {
    std::vector<PackOptions> all;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4}) {
        const PackOptions plain = slabOptions(lattice);
        all.push_back(plain);
        all.push_back(plain), all.back().absError = 0.7;
        all.push_back(plain), all.back().maxError = 0.01;
        all.push_back(plain), all.back().psnr = 40;
        all.push_back(plain), all.back().threshold = {ThresholdChoice::Soft, 0.01, true};
        all.push_back(plain), all.back().discard = 0.3;
    }
    for (const StoredLattice lattice : {StoredLattice::BCC, StoredLattice::D4}) {
        PackOptions filtered = slabOptions(lattice);
        filtered.resample.filter = volume::ResampleFilter::BSpline5;
        all.push_back(filtered);
        filtered.resample.filter = volume::ResampleFilter::Sinc;
        filtered.resample.sharpen = 0.5;
        all.push_back(filtered);
    }
    return all;
}

void expectSameFrames(const Archive& a, const Archive& b) {
    ASSERT_EQ(a.info(), b.info());
    for (int p = 0; p < int(a.info().parameters.size()); ++p)
        for (int t = 0; t < int(a.info().times.size()); ++t)
            expectSame(readField(a, p, 0, t), readField(b, p, 0, t), true);
}

// In whatever slabs a frame goes through, the archive is the same to the byte.
TEST(PackSlabs, GiveTheArchiveThatWholeFramesGive) {
    const TemporaryFolder folder;
    int number = 0;
    for (const PackOptions& way : everyWayToPack()) {
        std::vector<MadeParameter> kinds = everyKind();
        if (way.lattice != StoredLattice::CC) // which bits a NaN has is not settled where it is a sum
            std::erase_if(kinds, [](const MadeParameter& kind) {
                return kind.type == ScalarType::F32 && kind.texture == Texture::Nasty;
            });
        const int times = way.lattice == StoredLattice::D4 ? 8 : 1;
        PackOptions options = way;
        options.mostPredicted = 0; // slabs are not compared with the time before
        volume::Dataset whole = makeDataset({11, 9, 29}, kinds, times), parts = PartReader{}.inParts(whole);
        const PackSummary expected = pack(whole, options, folder / "whole.tsr");
        const int layers = 1 + number++ % 3;
        const PackSummary summary = pack(parts, options, folder / "parts.tsr", {}, {}, layers);
        if (way.lattice == StoredLattice::D4) { // in slabs, what repeats an earlier time is not found
            if (isExact(options)) expectSameFrames(Archive(folder / "whole.tsr"), Archive(folder / "parts.tsr"));
        } else
            EXPECT_TRUE(readFile(folder / "whole.tsr") == readFile(folder / "parts.tsr"))
                << number << " layers " << layers;
        EXPECT_EQ(summary.maxError, expected.maxError);
        EXPECT_EQ(summary.sourceBytes, expected.sourceBytes);
        EXPECT_EQ(summary.storedBytes, expected.storedBytes);
        EXPECT_EQ(summary.discardedBricks, expected.discardedBricks);
        EXPECT_EQ(whole.info.parameters, parts.info.parameters);
        ASSERT_FALSE(summary.notes.empty());
        EXPECT_NE(summary.notes.back().find("slabs"), std::string::npos);
    }
}

volume::Dataset timesFrom(const volume::Dataset& all, int first, int count) {
    volume::Dataset some = all;
    some.info.times.assign(all.info.times.begin() + first, all.info.times.begin() + first + count);
    some.read = all.read.through([first](const volume::FrameReader& read, int p, int c, int t,
                                         volume::SliceRange slices) { return read(p, c, first + t, slices); });
    return some;
}

// Times, too, of which each is appended: the masks of the archive so far are found again.
TEST(PackSlabs, AppendToo) {
    const TemporaryFolder folder;
    const std::vector<MadeParameter> kinds{{"a", ScalarType::U8, 1, Texture::Noise, true, false},
                                           {"f", ScalarType::F32, 1, Texture::Smooth, false, false}};
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        const volume::Dataset all = makeDataset({18, 20, 37}, kinds, 3);
        const PartReader reader;
        volume::Dataset whole = all, early = reader.inParts(timesFrom(all, 0, 2)),
                        late = reader.inParts(timesFrom(all, 2, 1));
        PackOptions options = slabOptions(lattice);
        options.absError = 0.3;
        options.mostPredicted = 0; // slabs are not compared with the time before
        pack(whole, options, folder / "whole.tsr");
        pack(early, options, folder / "parts.tsr", {}, {}, 1);
        append(late, folder / "parts.tsr", 0, {}, {}, 2);
        const Archive archive(folder / "whole.tsr"), grown(folder / "parts.tsr");
        expectSameFrames(archive, grown);
        EXPECT_EQ(grown.maskCount(), archive.maskCount());
        EXPECT_EQ(archive.maskCount(), 1);
        EXPECT_TRUE(verifyArchive(grown).damage.empty());
    }
}

// To a size, too: neither estimates nor trials read whole frames.
TEST(PackSlabs, MeetASize) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4}) {
        const PartReader reader;
        volume::Dataset made = reader.inParts(makeDataset({24, 20, 150},
                                                          {{"u", ScalarType::U16, 1, Texture::Noise, true, false},
                                                           {"f", ScalarType::F32, 2, Texture::Noise, false, false}},
                                                          lattice == StoredLattice::D4 ? 8 : 2));
        PackOptions options = slabOptions(lattice);
        options.brickSize = 16;
        const std::uint64_t size = lattice == StoredLattice::D4    ? 400000
                                   : lattice == StoredLattice::BCC ? 200000
                                                                   : 110000;
        options.sizeMb = double(size) * 1e-6;
        const PackSummary summary = pack(made, options, folder / "a.tsr", {}, {}, 1);
        EXPECT_LE(summary.archiveBytes, size);
        EXPECT_GE(summary.archiveBytes, size / 10 * 8);
        if (lattice == StoredLattice::CC) {
            EXPECT_LT(*reader.most, 110); // corrections need whole frames
        }
        EXPECT_EQ(folder.files(), 1u);
        EXPECT_TRUE(verifyArchive(Archive(folder / "a.tsr")).damage.empty());
    }
}

// Without a word about layers it is the memory that decides: frames that fit are read whole.
TEST(PackSlabs, AreTakenWhereFramesDoNotFit) {
    const TemporaryFolder folder;
    volume::Dataset made;
    made.info.lattice = {volume::LatticeKind::CC, {160, 160, 640}, {1, 1, 1}, {0, 0, 0}};
    made.info.bounds = {glm::dvec3(0), glm::dvec3(made.info.lattice.size - 1)};
    made.info.parameters = {{"v", "", 1, ScalarType::U8, false, {}, {}}};
    int wholes = 0, most = 0; // of parts
    made.read = [&, lattice = made.info.lattice](int, int, int, volume::SliceRange slices) {
        const int count = slices.of(lattice).count;
        if (count == lattice.size.z)
            ++wholes;
        else
            most = std::max(most, count);
        volume::Field field = volume::makeField(volume::slicesOf(lattice, slices), ScalarType::U8);
        std::size_t i = std::size_t(slices.first) * 160 * 160;
        for (std::uint8_t& sample : field.as<std::uint8_t>()) sample = std::uint8_t(i * i >> 16), ++i;
        return field;
    };
    PackOptions options;
    options.brickSize = 16;
    pack(made, options, folder / "whole.tsr");
    EXPECT_EQ(wholes, 1);
    EXPECT_EQ(most, 0);
    made.info.parameters[0].ranges.clear();
    options.memoryMb = 1;
    double least = 0;
    try {
        pack(made, options, folder / "parts.tsr");
        FAIL() << "packed with 1 MB";
    } catch (const Error& error) {
        std::sscanf(error.what(), "packing data of this size needs about %lf", &least);
    }
    options.memoryMb = least + 1;
    pack(made, options, folder / "parts.tsr");
    EXPECT_EQ(wholes, 1);
    EXPECT_GT(most, 0);
    EXPECT_LT(most, 320);
    EXPECT_TRUE(readFile(folder / "whole.tsr") == readFile(folder / "parts.tsr"));
    made.info.parameters[0].ranges.clear();
    made.read = [read = made.read](int p, int c, int t) { return read(p, c, t); };
    EXPECT_THROW(pack(made, options, folder / "parts.tsr"), Error); // whole frames need more
}

// Slices of an archive are those of its frames.
TEST(PackSlabs, ArchivesAreReadInSlices) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        volume::Dataset made = makeDataset({18, 11, 41}, everyKind(), 1);
        pack(made, slabOptions(lattice), folder / "a.tsr");
        const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
        const volume::Dataset stored = storedDataset(archive);
        EXPECT_TRUE(stored.read.inParts());
        const int size = archive->info().lattice.size.z;
        for (int p = 0; p < int(made.info.parameters.size()); ++p) {
            const volume::Field whole = readField(*archive, p, 0, 0);
            for (const auto& [first, count] :
                 std::vector<std::pair<int, int>>{{0, 1}, {2, 20}, {6, 9}, {size - 3, 3}, {0, size}}) {
                const volume::Field part = stored.read(p, 0, 0, {first - first % 2, count});
                const volume::Field wanted = volume::slicesOf(whole, first - first % 2, count);
                SCOPED_TRACE(std::to_string(p) + " from " + std::to_string(first));
                expectSame(part, wanted, true);
            }
        }
    }
}

} // namespace
} // namespace tessera::codec
