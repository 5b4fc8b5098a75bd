#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/make_dataset.h"
#include "tests/volume/regions.h"
#include "volume/field/part_masks.h"

#include <gtest/gtest.h>

/// Two regions of different constants through archives: nothing but what each region holds comes out.
namespace tessera::codec {
namespace {

using namespace testing;
using volume::BrickSamples;
using volume::Dataset;
using volume::Field;

Dataset regionsData(int times) {
    volume::test::TwoRegions regions;
    regions.place = 9;
    return volume::test::twoRegions(volume::test::ccLattice({25, 22, 21}), volume::test::constantIn, regions, times);
}

void expectPure(const volume::BrickSource& source, int time) {
    const volume::BrickGrid& grid = source.grid();
    const glm::ivec3 count = grid.count();
    const int label = *source.info().findChannel("region"), value = *source.info().findChannel("v");
    std::size_t seen[4] = {};
    for (int level = 0; level < grid.levels; ++level)
        for (int n = 0; n < count.x * count.y * count.z; ++n) {
            const glm::ivec3 at(n % count.x, n / count.x % count.y, n / (count.x * count.y));
            const BrickSamples values = source.read({value, time, level, at}),
                               labels = source.read({label, time, level, at});
            for (std::size_t i = 0; i < values.values.size(); ++i) {
                if (!values.isPresent(i)) continue;
                const int own = int(labels.values[i]);
                ++seen[own];
                ASSERT_NEAR(values.values[i], volume::test::constantIn(own, {}), 1e-5) << "level " << level;
            }
        }
    EXPECT_GT(seen[1], 100u);
    EXPECT_GT(seen[3], 100u);
}

void expectPure(const Dataset& dataset) {
    for (int t = 0; t < int(dataset.info.times.size()); ++t) {
        const Field values = dataset.read(0, 0, t), labels = dataset.read(1, 0, t);
        for (std::size_t i = 0; i < values.count(); ++i)
            if (values.present(i)) {
                ASSERT_NEAR(values.value(i), volume::test::constantIn(int(labels.value(i)), {}), 1e-5) << t;
            }
    }
}

TEST(RegionsInArchives, StayApartOnEveryLatticeAndLevel) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4})
        for (const WaveletChoice wavelet :
             {WaveletChoice::Auto, WaveletChoice::W22, WaveletChoice::W13, WaveletChoice::N4})
            for (const int brick : {8, 32})
                for (const bool slabs : {false, true}) {
                    SCOPED_TRACE(std::string(kStoredLatticeNames[std::size_t(lattice)]) + " " +
                                 std::string(kWaveletChoiceNames[std::size_t(wavelet)]) + " brick " +
                                 std::to_string(brick));
                    Dataset made = regionsData(lattice == StoredLattice::D4 ? 8 : 3);
                    PackOptions options;
                    options.lattice = lattice;
                    options.wavelet = wavelet;
                    options.brickSize = brick;
                    if (slabs) made = inParts(made);
                    const std::string path = folder / "regions.tsr";
                    pack(made, options, path, {}, {}, 1);
                    const auto source = openArchive(path);
                    EXPECT_EQ(source->info().parameters[0].parts, made.info.parameters[0].parts);
                    for (int t = 0; t < int(source->info().times.size()); ++t) expectPure(*source, t);
                    const auto archive = std::make_shared<const Archive>(path);
                    for (int level = 0; level < archive->grid().levels; ++level)
                        expectPure(gridDataset(archive, level));
                }
}

TEST(RegionsInArchives, WholeFramesAndSlabsAreTheSame) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::BCC, StoredLattice::D4}) {
        Dataset made = volume::test::twoRegions(volume::test::ccLattice({19, 18, 40}), volume::test::linearIn, {}, 8);
        PackOptions options;
        options.lattice = lattice;
        options.brickSize = 8;
        pack(made, options, folder / "whole.tsr");
        made = inParts(made);
        pack(made, options, folder / "slabs.tsr", {}, {}, 1);
        const Archive whole(folder / "whole.tsr"), slabs(folder / "slabs.tsr");
        for (int t = 0; t < int(whole.info().times.size()); ++t)
            EXPECT_EQ(readField(whole, 0, 0, t).samples, readField(slabs, 0, 0, t).samples) << t;
    }
}

TEST(RegionsInArchives, LosslessOnTheSourceGridStaysBitForBit) {
    const TemporaryFolder folder;
    Dataset made = volume::test::twoRegions(volume::test::ccLattice({19, 18, 17}), volume::test::linearIn);
    PackOptions options;
    options.lattice = StoredLattice::CC;
    pack(made, options, folder / "cc.tsr");
    const Archive archive(folder / "cc.tsr");
    EXPECT_EQ(readField(archive, 0, 0, 0).samples, made.read(0, 0, 0).samples);
}

TEST(RegionsInArchives, AFurtherParameterFindsTheLabelInTheArchive) {
    const TemporaryFolder folder;
    const auto labelOf = [](Dataset data) {
        data.info.parameters.erase(data.info.parameters.begin());
        data.read = [read = data.read](int, int c, int t) { return read(1, c, t); };
        return data;
    };
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4})
        for (const int layers : {0, 1}) {
            Dataset made = regionsData(lattice == StoredLattice::D4 ? 8 : 2), label = labelOf(made);
            PackOptions options;
            options.lattice = lattice;
            options.brickSize = 8;
            pack(label, options, folder / "grown.tsr");
            if (layers > 0) made = inParts(made);
            append(made, folder / "grown.tsr", 0, {}, {}, layers);
            const Archive archive(folder / "grown.tsr");
            ASSERT_EQ(archive.info().parameters.size(), 2u);
            EXPECT_EQ(archive.info().parameters[1].parts, made.info.parameters[0].parts);
            EXPECT_EQ(made.info.parameters[0].ranges.size(), 1u);
            for (int t = 0; t < int(archive.info().times.size()); ++t) expectPure(archive, t);
        }
    // Another label is refused, and nothing changes.
    volume::test::TwoRegions elsewhere;
    elsewhere.place = 12;
    Dataset other =
        volume::test::twoRegions(volume::test::ccLattice({25, 22, 21}), volume::test::constantIn, elsewhere, 2);
    Dataset label = labelOf(regionsData(2));
    pack(label, {}, folder / "label.tsr");
    try {
        append(other, folder / "label.tsr");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("another label region"), std::string::npos) << error.what();
    }
    EXPECT_EQ(Archive(folder / "label.tsr").info().parameters.size(), 1u);
}

} // namespace
} // namespace tessera::codec
