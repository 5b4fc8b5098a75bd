// Error bounds are in the unit of the parameter, whatever number a sample is stored as: scales below and above 1,
// negative ones, offsets, and others at every time.
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/make_dataset.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

/// How the numbers of a time are to be read.
struct Stored {
    double scale = 1, offset = 0;
    double physical(double number) const { return offset + scale * number; }
};

/// One parameter; `readings` has one for every time.
volume::Dataset storedAs(ScalarType type, Texture texture, const std::vector<Stored>& readings, bool masked = false) {
    volume::Dataset made = makeDataset({20, 17, 18}, {{"T", type, 1, texture, masked, false}}, int(readings.size()));
    made.read = [read = made.read, readings](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        field.scale = readings[std::size_t(t)].scale;
        field.offset = readings[std::size_t(t)].offset;
        return field;
    };
    return made;
}

/// The times of a data set from `first` on, `count` of them.
volume::Dataset partOfTimes(const volume::Dataset& whole, int first, int count) {
    volume::Dataset some = whole;
    some.info.times.assign(whole.info.times.begin() + first, whole.info.times.begin() + first + count);
    some.read = [read = whole.read, first](int p, int c, int t) { return read(p, c, t + first); };
    return some;
}

std::vector<double> numbersOf(const volume::Field& field) {
    std::vector<double> numbers;
    volume::dispatch(field.type, [&]<class T>(T) {
        for (const T number : field.as<T>()) numbers.push_back(double(number));
    });
    return numbers;
}

struct ScaledErrors {
    double largest = 0; ///< in the unit of the parameter
    double rms = 0;     ///< of the worst time
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    double extent() const { return range.hi - range.lo; }
};

/// Errors of what an archive on the grid of its source gives back, sample for sample.
ScaledErrors scaledErrors(const Archive& archive, const volume::Dataset& made, const std::vector<Stored>& readings) {
    ScaledErrors errors;
    for (int t = 0; t < int(readings.size()); ++t) {
        const volume::Field was = made.read(0, 0, t), is = readField(archive, 0, 0, t);
        const std::vector<double> numbers = numbersOf(was), kept = numbersOf(is);
        EXPECT_EQ(numbers.size(), kept.size());
        double squares = 0, count = 0;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            EXPECT_EQ(is.present(i), was.present(i));
            if (!was.present(i)) continue;
            const double wanted = readings[std::size_t(t)].physical(numbers[i]);
            const double error = std::abs(is.offset + is.scale * kept[i] - wanted);
            errors.largest = std::max(errors.largest, error);
            errors.range.lo = std::min(errors.range.lo, wanted), errors.range.hi = std::max(errors.range.hi, wanted);
            squares += error * error, ++count;
        }
        errors.rms = std::max(errors.rms, std::sqrt(squares / count));
    }
    return errors;
}

/// Rounding of the sums above.
double slack(const ScaledErrors& errors) {
    return 1e-12 * std::max(std::abs(errors.range.lo), std::abs(errors.range.hi));
}

PackOptions scaledOptions() {
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 8;
    return options;
}

const std::vector<Stored> kReadings{{0.001, -40}, {0.37, 0}, {4, 1000}, {250, -3}, {-2.5, 8}, {-0.02, 1}};

TEST(StoredScales, AbsoluteBoundsAreInTheUnitOfTheParameterAndUsed) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::I32, ScalarType::F32})
        for (const Stored& reading : kReadings)
            for (const double steps : {0.4, 3.2, 10.3}) {
                SCOPED_TRACE(std::string(volume::name(type)) + " times " + std::to_string(reading.scale) + " within " +
                             std::to_string(steps));
                volume::Dataset made = storedAs(type, Texture::Noise, {reading}, true);
                PackOptions options = scaledOptions();
                options.absError = steps * std::abs(reading.scale);
                const PackSummary summary = pack(made, options, folder / "a.tsr");
                const Archive archive(folder / "a.tsr");
                const ScaledErrors errors = scaledErrors(archive, made, {reading});
                EXPECT_LE(errors.largest, options.absError + slack(errors));
                // What is allowed is used; of integers nothing below a stored number can be.
                const bool fine = type != ScalarType::F32 && steps < 1;
                EXPECT_GE(errors.largest, fine ? 0 : 0.8 * options.absError);
                EXPECT_EQ(fine, errors.largest == 0);
                EXPECT_GE(summary.maxError * errors.extent(), errors.largest - slack(errors));
                EXPECT_LE(summary.maxError * errors.extent(), options.absError + slack(errors));
            }
}

TEST(StoredScales, NumbersAtTheEndsOfTheirTypeStayWithinTheBound) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::U8, ScalarType::I16, ScalarType::U16, ScalarType::I32})
        for (const Stored& reading : kReadings)
            for (const double steps : {3.0, 10.0, 100.0, 3000.0}) {
                SCOPED_TRACE(std::string(volume::name(type)) + " times " + std::to_string(reading.scale) + " within " +
                             std::to_string(steps));
                volume::Dataset made = storedAs(type, Texture::Nasty, {reading});
                PackOptions options = scaledOptions();
                options.absError = (steps + 0.1) * std::abs(reading.scale);
                pack(made, options, folder / "a.tsr");
                const ScaledErrors errors = scaledErrors(Archive(folder / "a.tsr"), made, {reading});
                EXPECT_LE(errors.largest, options.absError + slack(errors));
                EXPECT_GT(errors.largest, 0);
            }
}

TEST(StoredScales, BoundsOfTheRangeOfNoiseAndOfSizeHold) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::I16, ScalarType::U16, ScalarType::F32})
        for (const Stored& reading : kReadings) {
            SCOPED_TRACE(std::string(volume::name(type)) + " times " + std::to_string(reading.scale));
            volume::Dataset made = storedAs(type, Texture::Noise, {reading});
            PackOptions relative = scaledOptions();
            relative.maxError = 0.104;
            pack(made, relative, folder / "a.tsr");
            ScaledErrors errors = scaledErrors(Archive(folder / "a.tsr"), made, {reading});
            EXPECT_LE(errors.largest, 0.104 * errors.extent() + slack(errors));
            EXPECT_GE(errors.largest, 0.09 * errors.extent());

            PackOptions noise = scaledOptions();
            noise.psnr = 30;
            pack(made, noise, folder / "a.tsr");
            errors = scaledErrors(Archive(folder / "a.tsr"), made, {reading});
            const double reached = 20 * std::log10(errors.extent() / errors.rms);
            EXPECT_GE(reached, 30);
            EXPECT_LE(reached, 33);

            PackOptions size = scaledOptions();
            size.sizeMb = 0.75e-6 * double(pack(made, scaledOptions(), folder / "a.tsr").archiveBytes);
            const PackSummary summary = pack(made, size, folder / "a.tsr");
            errors = scaledErrors(Archive(folder / "a.tsr"), made, {reading});
            EXPECT_LE(double(summary.archiveBytes), 1e6 * size.sizeMb);
            EXPECT_LE(errors.largest, summary.maxError * errors.extent() + slack(errors));
            EXPECT_GT(errors.largest, 0);
        }
}

TEST(StoredScales, AThresholdKeepsTheBoundBesideIt) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::I16, ScalarType::F32})
        for (const Stored& reading : kReadings)
            for (const bool bounded : {true, false}) {
                SCOPED_TRACE(std::string(volume::name(type)) + " times " + std::to_string(reading.scale));
                volume::Dataset made = storedAs(type, Texture::Noise, {reading});
                PackOptions options = scaledOptions();
                options.threshold = {ThresholdChoice::Hard, 0.2, false};
                if (bounded) options.absError = 12 * std::abs(reading.scale);
                const PackSummary summary = pack(made, options, folder / "a.tsr");
                const ScaledErrors errors = scaledErrors(Archive(folder / "a.tsr"), made, {reading});
                if (bounded) {
                    EXPECT_LE(errors.largest, options.absError + slack(errors));
                }
                EXPECT_GT(errors.largest, 4 * std::abs(reading.scale));
                EXPECT_LE(errors.largest, summary.maxError * errors.extent() + slack(errors)) << "what is noted";
            }
}

TEST(StoredScales, OfEveryTimeMayBeOthersAndAppendedOnesToo) {
    const TemporaryFolder folder;
    const std::vector<Stored> readings{{0.25, 5}, {0.25, 5}, {0.25, 9}, {3, 9}, {-3, 9}, {0.01, 0}};
    for (const ScalarType type : {ScalarType::U8, ScalarType::I16, ScalarType::F32})
        for (const Texture texture : {Texture::Constant, Texture::Noise})
            for (const bool relative : {false, true}) {
                SCOPED_TRACE(std::string(volume::name(type)) + (relative ? " relative" : " absolute"));
                const volume::Dataset made = storedAs(type, texture, readings);
                PackOptions options = scaledOptions();
                (relative ? options.maxError : options.absError) = relative ? 0.03 : 1.3;
                volume::Dataset whole = partOfTimes(made, 0, 6), first = partOfTimes(made, 0, 2),
                                second = partOfTimes(made, 2, 3), third = partOfTimes(made, 5, 1);
                pack(whole, options, folder / "once.tsr");
                pack(first, options, folder / "grown.tsr");
                append(second, folder / "grown.tsr");
                const PackSummary summary = append(third, folder / "grown.tsr");
                for (const char* name : {"once.tsr", "grown.tsr"}) {
                    const Archive archive(folder / name);
                    const ScaledErrors errors = scaledErrors(archive, made, readings);
                    EXPECT_LE(errors.largest, (relative ? 0.03 * errors.extent() : 1.3) + slack(errors)) << name;
                    if (texture == Texture::Noise) {
                        EXPECT_GT(errors.largest, (relative ? 0.015 * errors.extent() : 0.6)) << name;
                    }
                    const Range known = archive.info().parameters[0].ranges[0];
                    EXPECT_LE(errors.largest, archive.metadata().maxError * (known.hi - known.lo) + slack(errors));
                }
                EXPECT_GT(summary.addedBytes, 0u);
            }
}

TEST(StoredScales, ConvertedArchivesKeepBothBounds) {
    const TemporaryFolder folder;
    for (const ScalarType type : {ScalarType::I16, ScalarType::U8, ScalarType::F32})
        for (const Stored& reading : kReadings) {
            SCOPED_TRACE(std::string(volume::name(type)) + " times " + std::to_string(reading.scale));
            volume::Dataset made = storedAs(type, Texture::Noise, {reading, {2 * reading.scale, reading.offset}});
            const double unit = std::abs(reading.scale);
            PackOptions options = scaledOptions();
            options.absError = 3 * unit;
            pack(made, options, folder / "first.tsr");
            const auto archive = std::make_shared<const Archive>(folder / "first.tsr");
            volume::Dataset again = storedDataset(archive);
            options.absError = 8 * unit;
            const PackSummary summary = pack(again, options, folder / "second.tsr", {}, packedBefore(archive));
            const Archive second(folder / "second.tsr");
            const std::vector<Stored> readings{reading, {2 * reading.scale, reading.offset}};
            const ScaledErrors errors = scaledErrors(second, made, readings);
            EXPECT_LE(errors.largest, 11 * unit + slack(errors));
            EXPECT_GT(errors.largest, 4 * unit);
            EXPECT_LE(errors.largest, summary.maxError * errors.extent() + slack(errors)) << "both errors are noted";
            double own = 0;
            for (int t = 0; t < 2; ++t) {
                const volume::Field a = readField(*archive, 0, 0, t), b = readField(second, 0, 0, t);
                for (std::size_t i = 0; i < a.count(); ++i) own = std::max(own, std::abs(a.value(i) - b.value(i)));
            }
            EXPECT_LE(own, 8 * unit + slack(errors));
        }
}

// At the samples of the source, and at the stored ones beside those of the archive without loss.
TEST(StoredScales, BoundsHoldOnOtherLatticesToo) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::BCC, StoredLattice::D4})
        for (const ScalarType type : {ScalarType::I16, ScalarType::F32})
            for (const Stored& reading : kReadings) {
                SCOPED_TRACE(std::string(volume::name(type)) + " times " + std::to_string(reading.scale));
                volume::Dataset made = storedAs(type, Texture::Noise, std::vector<Stored>(8, reading));
                PackOptions options = scaledOptions();
                options.lattice = lattice;
                pack(made, options, folder / "exact.tsr");
                options.absError = 10.3 * std::abs(reading.scale);
                pack(made, options, folder / "a.tsr");
                const Archive exact(folder / "exact.tsr"), archive(folder / "a.tsr");
                double largest = 0, far = 0;
                for (int t = 0; t < int(exact.info().times.size()); ++t) {
                    const volume::Field a = readField(exact, 0, 0, t), b = readField(archive, 0, 0, t);
                    for (std::size_t i = 0; i < a.count(); ++i) {
                        largest = std::max(largest, std::abs(a.value(i) - b.value(i)));
                        far = std::max(far, std::abs(a.value(i)));
                    }
                }
                const volume::Dataset back = gridDataset(std::make_shared<const Archive>(folder / "a.tsr"), 0);
                for (int t = 0; t < int(back.info.times.size()); ++t) {
                    const volume::Field a = made.read(0, 0, t), b = back.read(0, 0, t);
                    for (std::size_t i = 0; i < a.count(); ++i)
                        ASSERT_LE(std::abs(a.value(i) - b.value(i)), options.absError + 1e-12 * far);
                }
                EXPECT_LE(largest, options.absError + 1e-12 * far);
                EXPECT_GE(largest, 0.8 * options.absError);
            }
}

} // namespace
} // namespace tessera::codec
