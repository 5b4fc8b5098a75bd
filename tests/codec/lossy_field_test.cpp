#include "codec/archive/archive.h"
#include "codec/pack/error_bound.h"
#include "codec/pack/lossy_field.h"
#include "codec/pack/pack.h"
#include "tests/codec/compare_fields.h"
#include "tests/codec/make_dataset.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

TEST(InSteps, KeepsItsBoundAndNothingLeavesTheType) {
    std::mt19937 random(2);
    for (const ScalarType type : {ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::I32})
        for (const double bound : {0.5, 1.0, 2.9, 6.0, 31.0, 127.0, 20000.0}) {
            volume::Field field =
                volume::makeField({volume::LatticeKind::CC, {16, 16, 16}, {1, 1, 1}, {0, 0, 0}}, type);
            field.offset = -273.15, field.scale = 0.125;
            volume::dispatch(type, [&]<class T>(T) {
                auto samples = field.as<T>();
                for (T& sample : samples) sample = static_cast<T>(random());
                samples[0] = std::numeric_limits<T>::max(), samples[1] = std::numeric_limits<T>::lowest(),
                samples[2] = T(0);
            });
            const volume::Field stepped = inSteps(field, bound);
            EXPECT_LE(stepWithin(type, bound), 2 * bound + 1);
            for (std::size_t i = 0; i < field.count(); ++i)
                ASSERT_LE(std::abs(stepped.value(i) - field.value(i)), bound * 0.125 * (1 + 1e-12));
            EXPECT_EQ(stepped.value(2), field.value(2));
        }
}

std::vector<MadeParameter> boundedKinds() {
    return {{"a", ScalarType::U8, 1, Texture::Noise, true, false},
            {"b", ScalarType::U16, 1, Texture::Nasty, false, false},
            {"c", ScalarType::I16, 1, Texture::Nasty, true, false},
            {"d", ScalarType::I32, 1, Texture::Noise, false, false},
            {"e", ScalarType::F32, 2, Texture::Noise, true, false},
            {"f", ScalarType::F32, 1, Texture::Smooth, false, false},
            {"g", ScalarType::F32, 1, Texture::Constant, false, false},
            {"region", ScalarType::U8, 1, Texture::Noise, false, true}};
}

TEST(LossyIntegers, NoBoundIsViolated) {
    const TemporaryFolder folder;
    for (const double bound : {0.4, 3.0, 17.5}) {
        volume::Dataset made = makeDataset({20, 17, 15}, boundedKinds(), 2);
        PackOptions options;
        options.lattice = StoredLattice::CC;
        options.brickSize = 8;
        options.absError = bound;
        const PackSummary summary = pack(made, options, folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        EXPECT_GT(summary.maxError, 0);
        for (int p = 0; p < 7; ++p) EXPECT_LE(largestError(archive, made, p), bound) << p;
        EXPECT_EQ(largestError(archive, made, 7), 0);
        EXPECT_EQ(verifyArchive(archive).damaged, 0u);
        if (bound == 17.5) {
            EXPECT_GT(largestError(archive, made, 1), 1);
        }
    }
}

TEST(Thresholds, BoundsHoldAndWithoutOneTheErrorIsNoted) {
    const TemporaryFolder folder;
    for (const ThresholdChoice kind : {ThresholdChoice::Hard, ThresholdChoice::Soft, ThresholdChoice::Quantile})
        for (const bool byImportance : {false, true})
            for (const double bound : {0.0, 2.0}) {
                volume::Dataset made = makeDataset({20, 17, 15}, boundedKinds(), 1);
                PackOptions options;
                options.lattice = byImportance ? StoredLattice::BCC : StoredLattice::CC;
                options.brickSize = 8;
                options.absError = bound;
                options.threshold = {kind, kind == ThresholdChoice::Quantile ? 0.7 : 0.05, byImportance};
                const PackSummary summary = pack(made, options, folder / "a.tsr");
                const Archive archive(folder / "a.tsr");
                EXPECT_FALSE(archive.metadata().lossless);
                EXPECT_GT(summary.maxError, 0);
                if (byImportance) continue; // resampled
                for (int p = 0; p < 7; ++p) {
                    const auto& ranges = archive.info().parameters[std::size_t(p)].ranges;
                    double extent = 0;
                    for (int c = 0; c < archive.info().parameters[std::size_t(p)].components; ++c)
                        extent = std::max(extent, ranges[std::size_t(c)].hi - ranges[std::size_t(c)].lo);
                    const double limit = bound > 0 ? bound : archive.metadata().maxError * extent * (1 + 1e-6);
                    EXPECT_LE(largestError(archive, made, p), limit) << p << " " << int(kind);
                }
                EXPECT_EQ(largestError(archive, made, 7), 0);
                EXPECT_EQ(summary.weakenedBricks > 0, bound > 0);
            }
}

/// Waves that move a little from time to time, as floats and as integers; one parameter has gaps.
volume::Dataset driftingSeries(int times, double driftOfRange) {
    volume::Dataset made = makeDataset({24, 20, 18},
                                       {{"a", ScalarType::F32, 1, Texture::Smooth, false, false},
                                        {"b", ScalarType::U8, 1, Texture::Smooth, false, false},
                                        {"c", ScalarType::F32, 1, Texture::Smooth, true, false}},
                                       times);
    made.read = [inner = made.read, driftOfRange, types = made.info.parameters](int p, int c, int t) {
        constexpr double kRange = 160;
        volume::Field field = inner(p, c, 0);
        std::mt19937 random(7);
        volume::dispatch(types[std::size_t(p)].type, [&]<class T>(T) {
            for (T& sample : field.as<T>())
                sample = static_cast<T>(double(sample) + double(random() % 32) + kRange * driftOfRange * t);
        });
        return field;
    };
    return made;
}

/// The largest error of a parameter, measured against an exact archive of the same samples.
double largestBeside(const Archive& exact, const Archive& archive, int parameter) {
    double largest = 0;
    for (int t = 0; t < int(exact.info().times.size()); ++t) {
        const volume::Field wanted = readField(exact, parameter, 0, t), stored = readField(archive, parameter, 0, t);
        for (std::size_t i = 0; i < wanted.count(); ++i)
            if (wanted.present(i)) largest = std::max(largest, std::abs(wanted.value(i) - stored.value(i)));
    }
    return largest;
}

// What a brick repeats must not add to what its threshold has moved already.
TEST(Thresholds, BoundsAndReportedErrorsHoldInASeries) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4})
        for (const double drift : {0.0, 0.002, 0.01}) {
            if (drift == 0 && lattice != StoredLattice::CC) continue;
            PackOptions options;
            options.lattice = lattice;
            options.brickSize = 8;
            options.lossless = true;
            volume::Dataset made = driftingSeries(lattice == StoredLattice::D4 ? 8 : 4, drift);
            pack(made, options, folder / "exact.tsr");
            const Archive exact(folder / "exact.tsr");
            options.lossless = false;
            for (const ThresholdChoice kind :
                 {ThresholdChoice::None, ThresholdChoice::Hard, ThresholdChoice::Soft, ThresholdChoice::Quantile})
                for (const double bound : {0.0, 0.02}) {
                    if (kind == ThresholdChoice::None && bound == 0) continue;
                    SCOPED_TRACE(::testing::Message()
                                 << int(lattice) << " " << drift << " " << int(kind) << " " << bound);
                    options.maxError = bound;
                    options.threshold = {kind, kind == ThresholdChoice::Quantile ? 0.8 : 0.05, false};
                    const PackSummary summary = pack(made, options, folder / "a.tsr");
                    const Archive archive(folder / "a.tsr");
                    for (int p = 0; p < 3; ++p) {
                        const Range range = archive.info().parameters[std::size_t(p)].ranges[0];
                        const double error = largestBeside(exact, archive, p) / (range.hi - range.lo);
                        EXPECT_LE(error, summary.maxError * (1 + 1e-9)) << p;
                        EXPECT_LE(error, archive.metadata().maxError * (1 + 1e-9)) << p;
                        if (bound > 0) {
                            EXPECT_LE(error, bound * (1 + 1e-9)) << p;
                        }
                    }
                    if (drift == 0) {
                        EXPECT_EQ(summary.repeatedBricks, 3 * 3 * summary.bricks);
                    }
                }
        }
}

TEST(Thresholds, LeaveWhatIsNotFinite) {
    const TemporaryFolder folder;
    volume::Dataset made = driftingSeries(2, 0.01);
    made.read = [inner = made.read](int p, int c, int t) {
        volume::Field field = inner(p, c, t);
        if (p == 0) field.as<float>()[5] = std::numeric_limits<float>::infinity();
        return field;
    };
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.threshold = {ThresholdChoice::Hard, 0.05, false};
    const PackSummary summary = pack(made, options, folder / "a.tsr");
    EXPECT_LT(summary.maxError, 1);
    EXPECT_EQ(readField(Archive(folder / "a.tsr"), 0, 0, 0).value(5), std::numeric_limits<double>::infinity());
}

TEST(Thresholds, GiveUpMoreForMoreAndSpareTheImportant) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({64, 32, 32}, {{"a", ScalarType::U8, 1, Texture::Smooth, false, false}}, 1);
    made.read = [lattice = made.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, ScalarType::U8);
        std::mt19937 random(8);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const double ball = 180 / (1 + std::exp(0.1 * (x - 16) * (x - 16) + 0.1 * (y - 16) * (y - 16) - 6));
                    field.as<std::uint8_t>()[i] = static_cast<std::uint8_t>(20 + ball + double(random() % 9));
                }
        return field;
    };
    const auto packed = [&](double value, bool byImportance) {
        PackOptions options;
        options.lattice = StoredLattice::CC;
        options.brickSize = 16;
        options.threshold = {ThresholdChoice::Hard, value, byImportance};
        volume::Dataset copy = made;
        return pack(copy, options, folder / "a.tsr").archiveBytes;
    };
    const auto little = packed(0.005, false), much = packed(0.05, false);
    EXPECT_LT(much, little / 2);
    EXPECT_GT(packed(0.05, true), much);
    const Archive archive(folder / "a.tsr"); // by importance
    const volume::Field stored = readField(archive, 0, 0, 0), wanted = made.read(0, 0, 0);
    double inside = 0, outside = 0;
    for (std::size_t i = 0; i < stored.count(); ++i) {
        const double error = std::abs(stored.value(i) - wanted.value(i));
        (i % 64 < 32 ? inside : outside) += error;
    }
    EXPECT_LT(inside, 0.7 * outside);
}

TEST(Discard, LeavesOutWhatShowsNothingInAnyParameter) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({48, 16, 16},
                                       {{"a", ScalarType::F32, 1, Texture::Smooth, false, false},
                                        {"b", ScalarType::U8, 1, Texture::Smooth, false, false}},
                                       2);
    made.read = [lattice = made.info.lattice](int p, int, int t) {
        volume::Field field = volume::makeField(lattice, p == 0 ? ScalarType::F32 : ScalarType::U8);
        for (std::size_t i = 0; i < field.count(); ++i) {
            const int x = int(i % 48), wave = int(i / 48 % 16) * 12;
            // a shows something on the left, b on the right at the second time; nothing in the middle
            if (p == 0) field.as<float>()[i] = x < 8 ? float(wave) : 3.0f;
            if (p == 1) field.as<std::uint8_t>()[i] = x >= 40 && t == 1 ? std::uint8_t(wave) : std::uint8_t(3);
        }
        return field;
    };
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 8;
    options.discard = 0.01;
    options.importance.neighbours = 0;
    volume::Dataset copy = made;
    const PackSummary summary = pack(copy, options, folder / "a.tsr");
    EXPECT_EQ(summary.bricks, 24u);
    EXPECT_GE(summary.discardedBricks, 8u);
    EXPECT_LE(summary.discardedBricks, 16u);
    const Archive archive(folder / "a.tsr");
    EXPECT_FALSE(archive.metadata().lossless);
    for (int p = 0; p < 2; ++p)
        for (int t = 0; t < 2; ++t) {
            const volume::Field stored = readField(archive, p, 0, t), wanted = made.read(p, 0, t);
            std::size_t absent = 0;
            for (std::size_t i = 0; i < stored.count(); ++i) {
                absent += stored.present(i) ? 0 : 1;
                if (i % 48 < 8 || i % 48 >= 40) {
                    EXPECT_TRUE(stored.present(i));
                    EXPECT_EQ(stored.value(i), wanted.value(i)); // what is kept is exact
                }
            }
            EXPECT_EQ(absent, summary.discardedBricks * 512);
        }
    options.discard = 1;
    EXPECT_THROW(pack(copy, options, folder / "b.tsr"), Error);
    EXPECT_FALSE(std::filesystem::exists(folder / "b.tsr"));
}

TEST(Thresholds, DoNotGoWithWhatTheyCannotPromise) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({8, 8, 8}, boundedKinds(), 1);
    PackOptions options;
    options.threshold.kind = ThresholdChoice::Hard;
    options.psnr = 40;
    EXPECT_THROW(pack(made, options, folder / "a.tsr"), Error);
    options.psnr = 0;
    options.sizeMb = 1;
    EXPECT_THROW(pack(made, options, folder / "a.tsr"), Error);
}

/// `number` rounded to a multiple of `step`, halves away from 0.
std::int64_t roundedTo(std::int64_t number, std::int64_t step) {
    const std::int64_t size = (std::abs(number) + step / 2) / step * step;
    return number < 0 ? -size : size;
}

TEST(InSteps, OnlyStepsThatStayWithinTheTypeFit) {
    for (const ScalarType type : {ScalarType::U8, ScalarType::I16, ScalarType::U16})
        volume::dispatch(type, [&]<class T>(T) {
            const auto least = std::int64_t(std::numeric_limits<T>::lowest()),
                       most = std::int64_t(std::numeric_limits<T>::max());
            for (std::int64_t step = 1; step < 400; ++step) {
                const bool low = roundedTo(least, step) >= least, high = roundedTo(most, step) <= most;
                EXPECT_EQ(stepFits(type, step, double(least), 1), low) << step;
                EXPECT_EQ(stepFits(type, step, 0, double(most)), high) << step;
                const std::int64_t taken = stepWithin(type, double(step));
                EXPECT_GE(roundedTo(least, taken), least) << step;
                EXPECT_LE(roundedTo(most, taken), most) << step;
                EXPECT_TRUE(taken == 2 * step + 1 || roundedTo(most, taken + 2) > most ||
                            roundedTo(least, taken + 2) < least)
                    << "a larger one would do for " << step;
                // Of a bound as well.
                volume::Field field =
                    volume::makeField({volume::LatticeKind::CC, {2, 1, 1}, {1, 1, 1}, {0, 0, 0}}, type);
                PackOptions options;
                options.absError = double(step);
                EXPECT_EQ(boundFor(options, {}, field).step, taken) << step;
            }
        });
}

// Of a brick whose details are all dropped nothing is left but its coarsest box.
TEST(Thresholds, LeaveTheCoarsestLevelAlone) {
    std::mt19937 random(5);
    volume::BrickGrid grid;
    grid.lattice = {volume::LatticeKind::CC, {8, 8, 8}, {1, 1, 1}, {0, 0, 0}};
    grid.brickSize = 8, grid.levels = 3;
    volume::Field field = volume::makeField(grid.lattice, ScalarType::I32);
    for (std::int32_t& sample : field.as<std::int32_t>()) sample = int(random() % 2000) - 1000;
    FrameSamples samples{volume::Field(field)};
    const std::vector<float> strength(1, 1);
    giveUpDetails(grid, samples, Wavelet::W22, Threshold::Hard, 1e6, strength, 0);
    const auto transformed = [](const volume::Field& of) {
        const auto numbers = of.as<std::int32_t>();
        std::vector<std::uint32_t> codes(numbers.begin(), numbers.end());
        forward(codes, {}, {8, 8, 8}, 2, Wavelet::W22, Arithmetic::Wide);
        return codes;
    };
    const std::vector<std::uint32_t> before = transformed(field), after = transformed(*samples.whole());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const bool coarsest = i % 8 < 2 && i / 8 % 8 < 2 && i / 64 < 2;
        EXPECT_EQ(after[i], coarsest ? before[i] : 0u) << i;
    }
}

TEST(Thresholds, AQuantileDropsThatPartOfTheSmallest) {
    std::vector<std::int32_t> all;
    for (int i = 1; i <= 100; ++i) all.push_back(i % 2 == 0 ? i : -i);
    std::shuffle(all.begin(), all.end(), std::mt19937(3));
    for (const double part : {-1.0, 0.0, 0.25, 0.5, 1.0, 2.0}) {
        std::vector<std::int32_t> details = all;
        applyThreshold(details, Threshold::Quantile, part);
        const int dropped = int(std::clamp(part, 0.0, 1.0) * 100);
        for (std::size_t i = 0; i < all.size(); ++i)
            EXPECT_EQ(details[i], std::abs(all[i]) <= dropped ? 0 : all[i]) << part;
    }
}

} // namespace
} // namespace tessera::codec
