#include "codec/pack/unpack.h"

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
    return std::sin(0.2 * p.x + 0.3 * t) + 0.02 * p.y * (component + 1) - 0.03 * p.z;
}

/// A scalar and a vector that change smoothly, and a label; times are not evenly spaced.
volume::Dataset smoothDataset() {
    volume::Dataset dataset;
    dataset.info.name = "smooth";
    dataset.info.lattice = {volume::LatticeKind::CC, kSize, {1, 1, 1}, {0, 0, 0}};
    dataset.info.bounds = {glm::dvec3(0), glm::dvec3(kSize - 1)};
    dataset.info.times.clear();
    for (int t = 0; t < kTimes; ++t) dataset.info.times.push_back(t < 5 ? t : 2 * t - 4);
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
    ASSERT_EQ(archive_->info().times.size(), 12u);
    EXPECT_TRUE(archive_->metadata().alternating);
    EXPECT_EQ(archive_->metadata().sourceTimes, smoothDataset().info.times);
    EXPECT_EQ(summary_.sourceSamples, std::uint64_t(22 * 19 * 17) * kTimes * 5);
    EXPECT_LT(double(summary_.storedSamples), 0.5 * double(summary_.sourceSamples));
    // Bit for bit what the resampling gives, on the moved grid where the frame is odd.
    const volume::Dataset wanted = volume::toD4(smoothDataset(), {});
    for (const int t : {0, 3, 11})
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
    for (const int time : {0, 1, 6, 11}) {
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

/// Largest difference of the first parameter away from the borders, at times [1, end).
double worstInside(const volume::Dataset& shown, const volume::Dataset& truth, int end) {
    double worst = 0;
    for (int t = 1; t < end; ++t) {
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
        EXPECT_LT(worstInside(grid, made, kTimes - 1),
                  filter == volume::TimeFilter::Cubic ? 0.05 : 0.12); // of a wave of one
        EXPECT_EQ(grid.read(2, 0, 2).type, volume::ScalarType::U8);
    }
    EXPECT_EQ(gridDataset(archive_, 1).read(0, 0, 2).lattice.size, glm::ivec3(11, 10, 9));
}

/// Times [first, end) of the smooth data.
volume::Dataset someTimes(std::size_t first, std::size_t end) {
    volume::Dataset some = smoothDataset();
    const std::vector<double> all = some.info.times;
    some.info.times.assign(all.begin() + std::ptrdiff_t(first), all.begin() + std::ptrdiff_t(end));
    some.read = [read = some.read, first](int p, int c, int t) { return read(p, c, t + int(first)); };
    return some;
}

TEST_F(PackD4, GrowsByLaterTimesAndIsReadMeanwhile) {
    const std::string path = path_ + ".grows.tsr";
    PackOptions options;
    options.lattice = StoredLattice::D4;
    options.brickSize = 8;
    volume::Dataset early = someTimes(0, 5);
    pack(early, options, path);
    const auto before = std::make_shared<const Archive>(path);
    const volume::Dataset had = storedDataset(before);
    volume::Dataset tooLate = someTimes(4, kTimes), late = someTimes(3, kTimes);
    EXPECT_THROW(append(tooLate, path), Error); // the cubic filter reaches back to the time before the last
    std::vector<std::size_t> seen;
    const Progress progress{[&](double, const std::string&) {
                                const auto source = openArchive(path);
                                const std::size_t times = source->info().times.size();
                                if (seen.empty() || seen.back() != times) seen.push_back(times);
                            },
                            {}};
    append(late, path, 0, progress);
    EXPECT_GT(seen.size(), 3u);

    const auto archive = std::make_shared<const Archive>(path);
    EXPECT_EQ(verifyArchive(*archive).damaged, 0u);
    const volume::Dataset made = smoothDataset(), now = storedDataset(archive);
    EXPECT_EQ(archive->metadata().sourceTimes, made.info.times);
    EXPECT_NEAR(double(archive->info().times.size()), double(archive_->info().times.size()), 1);
    const int known = int(had.info.times.size());
    for (const int p : {0, 1, 2}) { // what was there stays, what came is made of the data alone
        EXPECT_EQ(now.read(p, 0, known - 1).samples, had.read(p, 0, known - 1).samples);
        const auto wanted = volume::continueD4(someTimes(3, kTimes), early.info.times, had.info.times, {});
        for (int t = 0; t < int(wanted.frames.info.times.size()); ++t)
            EXPECT_EQ(now.read(p, 0, known + t).samples, wanted.frames.read(p, 0, t).samples);
    }
    // As good as when packed at once, but for the last interval: there is one frame less behind it.
    const volume::Dataset grid = gridDataset(archive, 0, volume::TimeFilter::Cubic);
    ASSERT_EQ(grid.info.times, made.info.times);
    EXPECT_LT(worstInside(grid, made, kTimes - 2), 0.05);
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
