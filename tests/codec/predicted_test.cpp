#include "codec/archive/archive.h"
#include "codec/archive/frame_coding.h"
#include "codec/blocks/join.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "tests/codec/plain_labels.h"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Frames that are stored as differences from the time before.
namespace tessera::codec {
namespace {

using namespace testing;
using volume::Field;
using volume::LatticeKind;
using volume::ScalarType;

constexpr double kBound = 1e-3; // of range

/// A rough field that changes slowly: what moves is smooth, what stays is not.
struct SlowSeries {
    glm::ivec3 size{40, 36, 33};
    int times = 12;
    LatticeKind kind = LatticeKind::CC;
    bool masked = false;     ///< some samples are absent, at all times
    int otherMaskAt = -1;    ///< from this time on others are
    bool partlyStill = true; ///< nothing changes in the upper half
    bool infinite = false;   ///< some samples are not finite
    int first = 0;           ///< number of the first time

    volume::Dataset dataset() const {
        volume::Dataset made =
            makeDataset(size, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, times, kind);
        for (double& time : made.info.times) time += 0.5 * first;
        made.info.parameters[0].ranges = {{290, 310}};
        const volume::Lattice lattice = made.info.lattice;
        made.read = [*this, lattice](int, int, int time) { return field(lattice, first + time); };
        return made;
    }

    Field field(const volume::Lattice& lattice, int time) const {
        Field out = volume::makeField(lattice, ScalarType::F32);
        volume::Mask mask(out.count(), 1);
        std::mt19937 random(3);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const double rough = double(random() % 1000) / 100,
                                 moving = partlyStill && z >= lattice.size.z / 2 ? 0 : std::sin(0.1 * x + 0.3 * time);
                    out.as<float>()[i] = static_cast<float>(295 + rough + 0.2 * moving);
                    if (infinite && i % 97 == 0) out.as<float>()[i] = std::numeric_limits<float>::infinity();
                    const bool others = otherMaskAt >= 0 && time >= otherMaskAt;
                    if (masked && (x + y + z) % 7 == (others ? 1 : 0)) mask[i] = 0;
                }
        if (masked) out.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return out;
    }
};

PackOptions boundedOptions(int mostPredicted = 7, StoredLattice lattice = StoredLattice::CC) {
    PackOptions options;
    options.lattice = lattice;
    options.maxError = kBound;
    options.brickSize = 16;
    options.mostPredicted = mostPredicted;
    return options;
}

std::uint64_t packedBytes(const SlowSeries& series, const PackOptions& options, const std::string& path) {
    volume::Dataset made = series.dataset();
    return pack(made, options, path).archiveBytes;
}

void expectWithinBound(const Archive& archive, const SlowSeries& series) {
    const volume::Lattice lattice = series.dataset().info.lattice;
    for (int time = 0; time < series.times; ++time) {
        const Field is = readField(archive, 0, 0, time), was = series.field(lattice, time);
        for (std::size_t i = 0; i < was.count(); ++i) {
            ASSERT_EQ(is.present(i), was.present(i)) << time;
            if (!was.present(i)) continue;
            const float wanted = was.as<float>()[i], got = is.as<float>()[i];
            if (std::isfinite(wanted))
                ASSERT_LE(std::abs(double(got) - double(wanted)), kBound * 20 * (1 + 1e-12)) << time;
            else
                ASSERT_EQ(got, wanted);
        }
    }
}

class Predicted : public ::testing::Test {
protected:
    TemporaryFolder folder;
    std::string path = folder / "a.tsr";
};

TEST_F(Predicted, ASlowSeriesCostsWhatChangesAndTheBoundHolds) {
    const SlowSeries series;
    const std::uint64_t each = packedBytes(series, boundedOptions(0), path);
    const std::uint64_t predicted = packedBytes(series, boundedOptions(), path);
    expectWithinBound(Archive(path), series);
    EXPECT_LT(2.5 * double(predicted), double(each));
    EXPECT_EQ(verifyArchive(Archive(path)).damaged, 0u);
}

TEST_F(Predicted, TheBoundHoldsForEveryKindOfSeries) {
    std::vector<SlowSeries> all(5);
    all[1].masked = true;
    all[2].masked = true;
    all[2].otherMaskAt = 4;
    all[3].infinite = true;
    all[3].partlyStill = false;
    all[4].kind = LatticeKind::BCC;
    for (const SlowSeries& series : all) {
        (void)packedBytes(
            series, boundedOptions(7, series.kind == LatticeKind::BCC ? StoredLattice::BCC : StoredLattice::CC), path);
        expectWithinBound(Archive(path), series);
        EXPECT_EQ(verifyArchive(Archive(path)).damaged, 0u);
    }
}

TEST_F(Predicted, NoBrickNeedsMoreThanTheStatedNumberOfOthers) {
    for (const int most : {1, 3, 15}) {
        SlowSeries series;
        series.times = 18;
        (void)packedBytes(series, boundedOptions(most), path);
        const plain::Decoder decoder(readFile(path));
        int deepest = 0;
        for (std::size_t frame = 0; frame < decoder.frames(); ++frame)
            for (int brick = 0; brick < 27; ++brick) deepest = std::max(deepest, decoder.depth(frame, brick));
        EXPECT_EQ(deepest, most);
    }
}

TEST_F(Predicted, TwoReadersAgreeAtEveryTimeAndLevel) {
    for (const bool masked : {false, true}) {
        SlowSeries series;
        series.times = 6;
        series.masked = masked;
        series.infinite = !masked;
        (void)packedBytes(series, boundedOptions(), path);
        const plain::Decoder decoder(readFile(path));
        // Latest first, so that nothing is at hand of what it is predicted from.
        for (int time = series.times - 1; time >= 0; --time)
            for (int level = 0; level < decoder.levels(); ++level)
                for (int number = 0; number < 27; ++number) {
                    const Archive archive(path);
                    const volume::BrickKey key{0, time, level, archive.grid().indexOf(std::size_t(number))};
                    const volume::BrickSamples expected = archive.read(key);
                    const volume::BrickStats stats = archive.stats(key);
                    const plain::Brick brick = decoder.brick(std::size_t(time), number, level);
                    for (std::size_t i = 0; i < brick.values.size(); ++i) {
                        const auto value = float(brick.values[i]);
                        if (!brick.present[i] || !std::isfinite(value)) continue;
                        ASSERT_EQ(level > 0 ? std::clamp(value, stats.min, stats.max) : value, expected.values[i])
                            << "time " << time << " level " << level << " brick " << number;
                    }
                }
    }
}

TEST_F(Predicted, AnyOrderOfReadingGivesTheSameSamples) {
    const SlowSeries series;
    (void)packedBytes(series, boundedOptions(), path);
    const Archive one(path);
    std::mt19937 random(1);
    for (int trial = 0; trial < 300; ++trial) {
        const volume::BrickKey key{0, int(random() % 12), int(random() % unsigned(one.grid().levels)),
                                   one.grid().indexOf(random() % 27)};
        ASSERT_EQ(one.read(key).values, Archive(path).read(key).values) << trial;
    }
}

TEST_F(Predicted, AppendedTimesHaveTheBytesOfASingleRun) {
    SlowSeries all;
    all.times = 11;
    (void)packedBytes(all, boundedOptions(), path);
    const std::string grown = folder / "grown.tsr";
    SlowSeries part;
    part.times = 5;
    (void)packedBytes(part, boundedOptions(), grown);
    part.first = 5;
    part.times = 6;
    volume::Dataset more = part.dataset();
    (void)append(more, grown, 0);
    const Archive one(path), two(grown);
    for (int time = 0; time < 11; ++time)
        ASSERT_EQ(readField(one, 0, 0, time).samples, readField(two, 0, 0, time).samples) << time;
    const plain::Decoder single(readFile(path)), appended(readFile(grown));
    for (std::size_t frame = 0; frame < 11; ++frame)
        for (int brick = 0; brick < 27; ++brick) ASSERT_EQ(single.depth(frame, brick), appended.depth(frame, brick));
}

TEST_F(Predicted, JoinedArchivesHaveTheSamplesOfBoth) {
    SlowSeries early, late;
    early.times = 4;
    late.times = 6;
    late.first = 4;
    const std::string more = folder / "more.tsr";
    (void)packedBytes(early, boundedOptions(), path);
    (void)packedBytes(late, boundedOptions(), more);
    const std::vector<Field> was = {readField(Archive(path), 0, 0, 3), readField(Archive(more), 0, 0, 0),
                                    readField(Archive(more), 0, 0, 5)};
    (void)join(path, more);
    const Archive joined(path);
    const std::vector<int> times = {3, 4, 9};
    for (std::size_t i = 0; i < times.size(); ++i)
        EXPECT_EQ(readField(joined, 0, 0, times[i]).samples, was[i].samples) << times[i];
    EXPECT_EQ(verifyArchive(joined).damaged, 0u);
}

TEST_F(Predicted, TimesUnderABoundOfTheMeanErrorArePredictedToo) {
    constexpr double kDecibels = 60;
    SlowSeries series;
    PackOptions options = boundedOptions();
    options.maxError = 0;
    options.psnr = kDecibels;
    const std::uint64_t predicted = packedBytes(series, options, path);
    EXPECT_GT(plain::Decoder(readFile(path)).depth(3, 4), 0);
    const Archive archive(path);
    for (int time = 0; time < series.times; ++time) {
        const Field is = readField(archive, 0, 0, time), was = series.field(is.lattice, time);
        double squares = 0;
        for (std::size_t i = 0; i < is.count(); ++i)
            squares += std::pow(double(is.as<float>()[i]) - double(was.as<float>()[i]), 2);
        const double reached = 20 * std::log10(20 / std::sqrt(squares / double(is.count())));
        EXPECT_GE(reached, kDecibels) << time;
        EXPECT_LT(reached, kDecibels + 1) << time;
    }
    options.mostPredicted = 0;
    EXPECT_LT(1.5 * double(predicted), double(packedBytes(series, options, path)));
}

// Where no quantum meets a mean error, samples are rounded, which are not predicted: readers refuse such frames.
TEST(FrameCoding, BeginsAgainWithRoundedSamplesAsIfNothingElseHadBeenTried) {
    const volume::BrickGrid grid{{LatticeKind::CC, {8, 8, 8}, {1, 1, 1}, {0, 0, 0}}, 8, 1, 0};
    volume::Field field = volume::makeField(grid.lattice, ScalarType::F32);
    field.scale = 3;
    const FrameSamples samples(field), finer(volume::makeField(grid.lattice, ScalarType::F32));
    const SeenFrame before, other;
    FrameCoding coding(grid);
    coding.samples = &finer;
    coding.before = &other;
    coding.rounded = {{}, &samples, &before, {1}};
    coding.frame.numbers = coding.rounded.frame.numbers = {NumberKind::Quantised, 1, 0.5};
    coding.rounded.frame.codeBits = 9;
    coding.steps.emplace();
    coding.steps->numbers = {NumberKind::Stepped, 1, 0.01};
    coding.steps->predicted = true;
    coding.steps->codeBits = 17;
    useSteps(*coding.steps, coding.frame);
    coding.frame.bricks.resize(1);
    coding.frame.segments.resize(1);
    coding.restartRounded(0.25);
    EXPECT_FALSE(coding.frame.predicted);
    EXPECT_EQ(coding.samples, &samples);
    EXPECT_EQ(coding.before, &before);
    EXPECT_EQ(coding.seen.field.scale, 3);
    EXPECT_EQ(coding.frame.numbers, coding.rounded.frame.numbers);
    EXPECT_EQ(coding.frame.codeBits, 9);
    EXPECT_EQ(coding.frame.bricks.size(), 1u);
    EXPECT_EQ(coding.frame.segments.size(), 1u);
    EXPECT_EQ(coding.repeated, std::vector<std::uint8_t>{1});
    EXPECT_FALSE(coding.steps);
}

TEST_F(Predicted, OnD4ThePredictionComesFromTheSameGrid) {
    SlowSeries series;
    series.times = 8;
    PackOptions options = boundedOptions(7, StoredLattice::D4);
    const std::uint64_t predicted = packedBytes(series, options, path);
    options.mostPredicted = 0;
    const std::string other = folder / "b.tsr";
    const std::uint64_t each = packedBytes(series, options, other);
    EXPECT_LT(predicted, each);
    const Archive one(path), two(other);
    const int times = int(one.info().times.size());
    ASSERT_EQ(times, int(two.info().times.size()));
    for (int time = 0; time < times; ++time) {
        const Field a = readField(one, 0, 0, time), b = readField(two, 0, 0, time);
        for (std::size_t i = 0; i < a.count(); ++i)
            ASSERT_NEAR(a.as<float>()[i], b.as<float>()[i], 2 * kBound * 20 * 1.001);
    }
}

TEST_F(Predicted, ADamagedBrickIsReportedWithThoseThatNeedIt) {
    SlowSeries series;
    series.partlyStill = false;
    (void)packedBytes(series, boundedOptions(), path);
    const plain::Decoder decoder(readFile(path));
    ASSERT_EQ(decoder.depth(1, 13), 1);
    std::vector<char> bytes = readFile(path);
    bytes[decoder.place(1, 13)] ^= 1; // the depth of brick 13 at time 1
    writeFile(path, bytes);
    const VerifyReport report = verifyArchive(Archive(path));
    EXPECT_EQ(report.damaged, 1u);
    EXPECT_EQ(report.damagedBricks, 7u); // times 1 to 7, and not the next that is coded by itself
    const Archive archive(path);
    EXPECT_NO_THROW((void)archive.read({0, 0, 0, archive.grid().indexOf(13)}));
    EXPECT_THROW((void)archive.read({0, 3, 0, archive.grid().indexOf(13)}), Error);
    EXPECT_NO_THROW((void)archive.read({0, 8, 0, archive.grid().indexOf(13)}));
}

} // namespace
} // namespace tessera::codec
