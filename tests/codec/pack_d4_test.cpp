#include "codec/unpack/unpack.h"

#include "codec/pack/pack.h"
#include "volume/bricks/magnitude.h"
#include "volume/resample/series_dataset.h"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::codec {
namespace {

using volume::Field;

constexpr glm::ivec3 kSize{22, 19, 17};
constexpr int kTimes = 9;

double valueAt(glm::dvec3 p, double t, int component) {
    return std::sin(0.2 * p.x + 0.6 * t) + 0.02 * p.y * (component + 1) - 0.03 * p.z;
}

/// A scalar and a vector that change smoothly, and a label.
volume::Dataset smoothDataset() {
    volume::Dataset dataset;
    dataset.info.name = "smooth";
    dataset.info.lattice = {volume::LatticeKind::CC, kSize, {1, 1, 1}, {0, 0, 0}};
    dataset.info.bounds = {glm::dvec3(0), glm::dvec3(kSize - 1)};
    dataset.info.times.clear();
    for (int t = 0; t < kTimes; ++t) dataset.info.times.push_back(0.5 * t);
    volume::Parameter scalar, vector, label;
    scalar.name = "T";
    vector.name = "U";
    vector.components = 3;
    label.name = "region";
    label.type = volume::ScalarType::U8;
    label.categorical = true;
    dataset.info.parameters = {scalar, vector, label};
    dataset.read = [lattice = dataset.info.lattice, times = dataset.info.times](int p, int c, int t) {
        Field field = volume::makeField(lattice, p == 2 ? volume::ScalarType::U8 : volume::ScalarType::F32);
        for (int k = 0; k < kSize.z; ++k)
            for (int j = 0; j < kSize.y; ++j)
                for (int i = 0; i < kSize.x; ++i) {
                    const std::size_t at = lattice.index({i, j, k});
                    if (p == 2)
                        field.as<std::uint8_t>()[at] = i < 8 + t ? 1 : 4;
                    else
                        field.as<float>()[at] = float(valueAt({i, j, k}, times[std::size_t(t)], c));
                }
        return field;
    };
    return dataset;
}

class PackD4 : public ::testing::Test {
protected:
    void SetUp() override {
        path_ = ::testing::TempDir() + "d4_" + std::to_string(getpid()) + ".tsr";
        volume::Dataset made = smoothDataset();
        PackOptions options;
        options.lattice = StoredLattice::D4;
        options.brickSize = 8;
        summary_ = pack(made, options, path_);
        archive_ = std::make_shared<const Archive>(path_);
    }
    void TearDown() override {
        archive_.reset();
        std::filesystem::remove(path_);
    }
    std::string path_;
    PackSummary summary_;
    std::shared_ptr<const Archive> archive_;
};

TEST_F(PackD4, HalfTheSamplesAreStoredFrameByFrame) {
    EXPECT_EQ(archive_->info().lattice.size, glm::ivec3(15, 13, 12));
    ASSERT_EQ(archive_->info().times.size(), 15u);
    EXPECT_TRUE(archive_->metadata().alternating);
    EXPECT_EQ(archive_->metadata().sourceTimes, smoothDataset().info.times);
    EXPECT_EQ(summary_.sourceSamples, std::uint64_t(22 * 19 * 17) * kTimes * 5);
    EXPECT_LT(double(summary_.storedSamples), 0.6 * double(summary_.sourceSamples)); // with frames beyond the ends
    // Bit for bit what the resampling gives, on the moved grid where the frame is odd.
    const volume::Dataset wanted = volume::toD4(smoothDataset(), {});
    for (const int t : {0, 3, 14})
        for (int p = 0; p < 3; ++p) {
            const Field stored = readField(*archive_, p, 0, t), made = wanted.read(p, 0, t);
            EXPECT_EQ(stored.lattice, made.lattice);
            EXPECT_EQ(stored.samples, made.samples);
        }
    EXPECT_EQ(verifyArchive(*archive_).damaged, 0u);
}

TEST_F(PackD4, SeriesAreThoseOfTheirParameter) {
    for (int p = 0; p < 3; ++p) {
        const volume::Series series = storedSeries(archive_, p, 0);
        EXPECT_EQ(series.frame(3)->samples, readField(*archive_, p, 0, 3).samples) << p;
    }
}

TEST_F(PackD4, OpensAsBccFieldsOfBothParities) {
    const auto source = openArchive(path_);
    ASSERT_EQ(source->info().lattice.kind, volume::LatticeKind::BCC);
    EXPECT_EQ(source->info().lattice.size, glm::ivec3(15, 13, 24));
    const volume::BrickGrid& grid = source->grid();
    const volume::Series series = storedSeries(archive_, 0, 0);
    for (const int time : {0, 1, 6, 14}) {
        const Field whole = volume::atTime(series, time, volume::TimeFilter::Cubic);
        ASSERT_EQ(whole.lattice, grid.lattice);
        const glm::ivec3 brick(1, 0, 1);
        const volume::BrickSamples samples = source->read({0, time, 0, brick});
        const glm::ivec3 begin = grid.begin(brick);
        ASSERT_EQ(samples.size, grid.end(brick) - begin);
        std::size_t i = 0;
        const volume::BrickStats stats = source->stats({0, time, 0, brick});
        for (int z = 0; z < samples.size.z; ++z)
            for (int y = 0; y < samples.size.y; ++y)
                for (int x = 0; x < samples.size.x; ++x, ++i) {
                    const double wanted = whole.value(whole.lattice.index(begin + glm::ivec3(x, y, z)));
                    ASSERT_NEAR(samples.values[i], wanted, 1e-6);
                    ASSERT_GE(samples.values[i], stats.min);
                    ASSERT_LE(samples.values[i], stats.max);
                }
        // Coarse levels have the size that readers expect, the magnitude is that of the blended vector.
        EXPECT_EQ(source->read({0, time, 1, brick}).size, grid.brickSamples(brick, 1));
        const volume::BrickSamples u = source->read({1, time, 0, brick}), v = source->read({2, time, 0, brick}),
                                   w = source->read({3, time, 0, brick}), length = source->read({4, time, 0, brick});
        EXPECT_EQ(length.values, volume::magnitude(u, v, w).values);
    }
    const volume::BrickSamples labels = source->read({5, 4, 0, {0, 0, 0}});
    for (const float label : labels.values) EXPECT_TRUE(label == 1 || label == 4);
}

/// Largest difference of the first parameter away from the faces of the box, at all times.
double worstInside(const volume::Dataset& shown, const volume::Dataset& truth) {
    double worst = 0;
    for (int t = 0; t < kTimes; ++t) {
        const Field back = shown.read(0, 0, t), wanted = truth.read(0, 0, t);
        for (int k = 3; k < kSize.z - 3; ++k)
            for (int j = 3; j < kSize.y - 3; ++j)
                for (int i = 3; i < kSize.x - 3; ++i) {
                    const std::size_t at = back.lattice.index({i, j, k});
                    worst = std::max(worst, std::abs(back.value(at) - wanted.value(at)));
                }
    }
    return worst;
}

TEST_F(PackD4, ComesBackAtTheTimesAndOnTheGridItCameFrom) {
    for (const auto filter : {volume::TimeFilter::Linear, volume::TimeFilter::Cubic}) {
        const volume::Dataset grid = gridDataset(archive_, 0, filter);
        const volume::Dataset made = smoothDataset();
        ASSERT_EQ(grid.info.times, made.info.times);
        ASSERT_EQ(grid.info.lattice, made.info.lattice);
        EXPECT_LT(worstInside(grid, made),
                  filter == volume::TimeFilter::Cubic ? 0.05 : 0.12); // of a wave of one
        EXPECT_EQ(grid.read(2, 0, 2).type, volume::ScalarType::U8);
    }
    EXPECT_EQ(gridDataset(archive_, 1).read(0, 0, 2).lattice.size, glm::ivec3(11, 10, 9));
}

TEST_F(PackD4, LabelsAndFieldsThatAreLinearInTimeComeBackAtEveryTime) {
    const volume::Dataset grid = gridDataset(archive_, 0), made = smoothDataset();
    for (int t = 0; t < kTimes; ++t) EXPECT_EQ(grid.read(2, 0, t).samples, made.read(2, 0, t).samples) << t;
    volume::Dataset rising = made;
    rising.info.parameters.resize(1);
    rising.read = [lattice = made.info.lattice](int, int, int t) {
        Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (float& value : field.as<float>()) value = float(200 + 27 * t);
        return field;
    };
    PackOptions options;
    options.lattice = StoredLattice::D4;
    pack(rising, options, path_);
    const auto archive = std::make_shared<const Archive>(path_);
    const volume::Dataset back = gridDataset(archive, 0);
    EXPECT_EQ(archive->info().parameters[0].ranges.front(), (Range{200, 200 + 27 * (kTimes - 1)}));
    for (int t = 0; t < kTimes; ++t) {
        const Field field = back.read(0, 0, t);
        for (std::size_t i = 0; i < field.count(); ++i) ASSERT_NEAR(field.value(i), 200 + 27 * t, 1e-3) << t;
    }
}

TEST_F(PackD4, LaterTimesAreRefusedWithTheReason) {
    volume::Dataset later = smoothDataset();
    for (double& time : later.info.times) time += 100;
    try {
        append(later, path_);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(error.reason().find("later times cannot be appended to D4*"), std::string::npos) << error.reason();
    }
}

TEST(PackD4Errors, FewOrUnevenTimesAreRefusedWithTheReason) {
    const std::string path = ::testing::TempDir() + "d4_uneven_" + std::to_string(getpid()) + ".tsr";
    PackOptions options;
    options.lattice = StoredLattice::D4;
    const auto reasonFor = [&](const std::vector<double>& times) -> std::string {
        volume::Dataset made = smoothDataset();
        made.info.times = times;
        try {
            pack(made, options, path);
        } catch (const Error& error) {
            return error.reason();
        }
        return "";
    };
    EXPECT_NE(reasonFor({200, 227}).find("needs 8 times or more, not 2"), std::string::npos);
    EXPECT_NE(reasonFor({0, 1, 2, 10, 11, 30, 31, 32}).find("from 0 to 1 is not one of 7 equal steps"),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_EQ(reasonFor({0, 1.005, 2, 3, 4, 5, 6, 7}), ""); // within 1 %
    std::filesystem::remove(path);
}

TEST(PackD4Errors, OneTimeOrAnotherLatticeIsRefused) {
    volume::Dataset still = smoothDataset();
    still.info.times = {0};
    PackOptions options;
    options.lattice = StoredLattice::D4;
    const std::string path = ::testing::TempDir() + "d4_none_" + std::to_string(getpid()) + ".tsr";
    EXPECT_THROW(pack(still, options, path), Error);
    volume::Dataset bcc = smoothDataset();
    bcc.info.lattice = volume::bccFor(bcc.info.lattice);
    EXPECT_THROW(pack(bcc, options, path), Error);
    EXPECT_FALSE(std::filesystem::exists(path));
}

} // namespace
} // namespace tessera::codec
