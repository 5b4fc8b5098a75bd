#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"

#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

volume::Dataset madeOf(int times) {
    return makeDataset({20, 17, 16},
                       {{"T", ScalarType::F32, 1, Texture::Smooth, false, false},
                        {"n", ScalarType::U16, 1, Texture::Smooth, false, false},
                        {"region", ScalarType::U8, 1, Texture::Noise, false, true}},
                       times);
}

PackOptions within(StoredLattice lattice, double maxError) {
    PackOptions options;
    options.lattice = lattice;
    options.maxError = maxError;
    return options;
}

/// Packs the stored samples of an archive.
void packAgain(const std::string& from, const PackOptions& options, const std::string& to) {
    const auto archive = std::make_shared<const Archive>(from);
    volume::Dataset stored = storedDataset(archive);
    pack(stored, options, to, {}, packedBefore(archive));
}

TEST(PackAgain, SamplesOnBccKeepTheGridTheyCameFrom) {
    const TemporaryFolder folder;
    volume::Dataset made = madeOf(2);
    pack(made, within(StoredLattice::BCC, 0), folder / "a.tsr");
    packAgain(folder / "a.tsr", within(StoredLattice::BCC, 0), folder / "b.tsr");
    const auto a = std::make_shared<const Archive>(folder / "a.tsr");
    const auto b = std::make_shared<const Archive>(folder / "b.tsr");
    EXPECT_EQ(b->metadata().source, made.info.lattice);
    const volume::Dataset before = gridDataset(a, 0), after = gridDataset(b, 0);
    EXPECT_EQ(after.info.lattice, made.info.lattice);
    for (int p = 0; p < 3; ++p) expectSame(before.read(p, 0, 1), after.read(p, 0, 1), true);

    volume::Dataset late = madeOf(2);
    for (double& time : late.info.times) time += 100;
    append(late, folder / "b.tsr");
    EXPECT_EQ(Archive(folder / "b.tsr").info().times.size(), 4u);
}

TEST(PackAgain, ErrorsAddUp) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC}) {
        volume::Dataset made = madeOf(2);
        pack(made, within(lattice, 0), folder / "exact.tsr");
        pack(made, within(lattice, 0.01), folder / "a.tsr");
        packAgain(folder / "a.tsr", within(lattice, 0), folder / "b.tsr");
        packAgain(folder / "b.tsr", within(lattice, 0.02), folder / "c.tsr");
        const Archive b(folder / "b.tsr"), c(folder / "c.tsr");
        EXPECT_FALSE(b.metadata().lossless);
        EXPECT_DOUBLE_EQ(b.metadata().maxError, 0.01);
        EXPECT_FALSE(c.metadata().lossless);
        EXPECT_DOUBLE_EQ(c.metadata().maxError, 0.03);
        const Range range = c.info().parameters[0].ranges[0];
        const volume::Dataset exact = storedDataset(std::make_shared<const Archive>(folder / "exact.tsr"));
        EXPECT_LE(largestError(c, exact, 0), 0.03 * (range.hi - range.lo));
        EXPECT_EQ(largestError(c, exact, 2), 0); // labels
    }
    volume::Dataset made = madeOf(1);
    pack(made, {}, folder / "a.tsr");
    packAgain(folder / "a.tsr", {}, folder / "b.tsr");
    EXPECT_TRUE(Archive(folder / "b.tsr").metadata().lossless);
    EXPECT_EQ(Archive(folder / "b.tsr").metadata().maxError, 0);
}

// An archive appended to one of a wider range: its error is a smaller part of that.
TEST(PackAgain, ErrorsReferToTheRangeOfTheWhole) {
    const TemporaryFolder folder;
    const auto oneOf = [](double factor, double time) {
        volume::Dataset made = makeDataset({16, 16, 16}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 1);
        made.info.times = {time};
        made.read = [read = made.read, factor](int p, int c, int t) {
            volume::Field field = read(p, c, t);
            for (float& value : field.as<float>()) value = float(factor * (value - 400));
            return field;
        };
        return made;
    };
    volume::Dataset wide = oneOf(4, 0), narrow = oneOf(1, 1);
    pack(wide, within(StoredLattice::BCC, 0), folder / "wide.tsr");
    pack(narrow, within(StoredLattice::BCC, 0.02), folder / "narrow.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "narrow.tsr");
    volume::Dataset stored = storedDataset(archive);
    append(stored, folder / "wide.tsr", 0, {}, packedBefore(archive));
    const Archive grown(folder / "wide.tsr");
    EXPECT_FALSE(grown.metadata().lossless);
    EXPECT_NEAR(grown.metadata().maxError, 0.005, 1e-6);
}

TEST(PackAgain, AnotherFormOfAKnownLabelIsNamed) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    volume::Dataset first = makeDataset({9, 8, 7}, {{"region", ScalarType::U8, 1, Texture::Noise, false, true}}, 1);
    pack(first, {}, path);
    volume::Dataset more = makeDataset({9, 8, 7},
                                       {{"region", ScalarType::I16, 1, Texture::Noise, false, true},
                                        {"T", ScalarType::F32, 1, Texture::Smooth, false, false}},
                                       1);
    try {
        append(more, path);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.reason(), "region has the type int16, in the archive uint8");
    }
}

// A single volume of integers is one large brick; later times do not make it another grid.
TEST(PackAgain, BricksKeepTheSizeTheyBeganWith) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    const auto made = [](int times, double begin) {
        volume::Dataset data = makeDataset({80, 8, 7}, {{"n", ScalarType::U8, 1, Texture::Noise}}, times);
        for (double& time : data.info.times) time += begin;
        return data;
    };
    PackOptions options;
    options.lattice = StoredLattice::CC;
    volume::Dataset first = made(1, 0), later = made(2, 100);
    pack(first, options, path);
    EXPECT_EQ(Archive(path).grid().brickSize, 128);
    append(later, path);
    EXPECT_EQ(Archive(path).grid().brickSize, 128);
    EXPECT_EQ(Archive(path).info().times.size(), 3u);
}

} // namespace
} // namespace tessera::codec
