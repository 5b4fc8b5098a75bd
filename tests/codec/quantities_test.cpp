// Quantities over time in archives: as packed, appended, unpacked, and with D4*.
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::codec {
namespace {

volume::Dataset series(int first, int count) {
    volume::Dataset dataset;
    dataset.info.lattice.size = {6, 5, 7};
    dataset.info.bounds = {glm::dvec3(0), glm::dvec3(5, 4, 6)};
    dataset.info.parameters = {{"T", "K", 1, volume::ScalarType::F32, false, {}, {}}};
    dataset.info.timeName = "operating point";
    dataset.info.timeUnit = "";
    dataset.info.times.clear();
    dataset.info.quantities = {{"voltage", "V", {}}};
    for (int t = first; t < first + count; ++t) {
        dataset.info.times.push_back(t);
        dataset.info.quantities[0].values.push_back(t == 2 ? std::nan("") : 0.9 - 0.1 * t * t);
    }
    dataset.read = [lattice = dataset.info.lattice, first](int, int, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<float>()[i] = float(first + time) + 0.1f * float(i);
        return field;
    };
    return dataset;
}

void expectThose(const volume::DatasetInfo& info, int times) {
    EXPECT_EQ(info.timeName, "operating point");
    EXPECT_EQ(info.timeUnit, "");
    ASSERT_FALSE(info.quantities.empty());
    EXPECT_EQ(info.quantities[0].name, "voltage");
    EXPECT_EQ(info.quantities[0].unit, "V");
    ASSERT_EQ(info.quantities[0].values.size(), std::size_t(times));
    for (int t = 0; t < times; ++t) {
        const double value = info.quantities[0].values[std::size_t(t)];
        if (t == 2)
            EXPECT_TRUE(std::isnan(value));
        else
            EXPECT_EQ(value, 0.9 - 0.1 * t * t) << t;
    }
}

class QuantitiesInArchives : public ::testing::TestWithParam<StoredLattice> {
protected:
    std::string path_ = ::testing::TempDir() + "quantities_" + std::to_string(getpid()) + ".tsr";
    void TearDown() override { std::filesystem::remove(path_); }
};

class QuantitiesOnD4 : public ::testing::Test {
protected:
    std::string path_ = ::testing::TempDir() + "quantities_d4_" + std::to_string(getpid()) + ".tsr";
    void TearDown() override { std::filesystem::remove(path_); }
};

TEST_P(QuantitiesInArchives, AreKeptAndGrowWithTheTimes) {
    PackOptions options;
    options.lattice = GetParam();
    volume::Dataset first = series(0, 4);
    pack(first, options, path_);
    expectThose(gridDataset(std::make_shared<const Archive>(path_), 0).info, 4);
    expectThose(Archive(path_).info(), 4);
    // What is appended adds values, and may bring a quantity that is not known before.
    volume::Dataset more = series(4, 3);
    more.info.quantities.push_back({"pump", "W", std::vector<double>(more.info.times.size(), 3.5)});
    append(more, path_);
    const auto archive = std::make_shared<const Archive>(path_);
    const volume::DatasetInfo info = gridDataset(archive, 0).info;
    ASSERT_EQ(info.times, (std::vector<double>{0, 1, 2, 3, 4, 5, 6}));
    expectThose(info, 7);
    ASSERT_EQ(info.quantities.size(), 2u);
    EXPECT_EQ(info.quantities[1].unit, "W");
    EXPECT_TRUE(std::isnan(info.quantities[1].values[3]));
    EXPECT_EQ(info.quantities[1].values[4], 3.5);
}

TEST_F(QuantitiesOnD4, AreThoseOfTheSourceAndBetween) {
    volume::Dataset made = series(0, 8);
    made.info.timeName = "time";
    PackOptions options;
    options.lattice = StoredLattice::D4;
    pack(made, options, path_);
    const auto archive = std::make_shared<const Archive>(path_);
    EXPECT_EQ(gridDataset(archive, 0).info.quantities[0].values[3], made.info.quantities[0].values[3]);
    EXPECT_EQ(archive->info().quantities[0].values.size(), archive->info().times.size());
    made.info.timeName = "operating point";
    EXPECT_THROW(pack(made, options, path_), Error);
}

INSTANTIATE_TEST_SUITE_P(Lattices, QuantitiesInArchives, ::testing::Values(StoredLattice::CC, StoredLattice::BCC));

} // namespace
} // namespace tessera::codec
