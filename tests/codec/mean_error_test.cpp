#include "codec/archive/archive.h"
#include "codec/brick/quantum_search.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::Field;
using volume::LatticeKind;
using volume::ScalarType;

constexpr double kClose = 0.3; // dB

/// Errors of one component at one time, of samples that are present and finite, relative to the range of the parameter.
struct FrameErrors {
    double largest = 0, psnr = 0;
};

FrameErrors frameErrors(volume::Dataset& made, const Archive& archive, int parameter, int component, int time) {
    const Field a = made.read(parameter, component, time), b = readField(archive, parameter, component, time);
    double squares = 0, count = 0, largest = 0;
    for (std::size_t i = 0; i < a.count(); ++i) {
        EXPECT_EQ(a.present(i), b.present(i));
        if (!a.present(i)) continue;
        if (!std::isfinite(a.value(i))) {
            EXPECT_EQ(std::isnan(a.value(i)), std::isnan(b.value(i)));
            EXPECT_FALSE(std::isfinite(b.value(i)));
            continue;
        }
        const double error = std::abs(a.value(i) - b.value(i));
        squares += error * error;
        largest = std::max(largest, error);
        ++count;
    }
    const double extent = volume::extentOf(archive.info().parameters[std::size_t(parameter)]);
    return {largest / extent, 20 * std::log10(extent / std::sqrt(squares / count))};
}

PackOptions optionsFor(double psnr) {
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 32;
    options.psnr = psnr;
    return options;
}

/// A smooth field with a front; other ones in each component, which move.
float waves(glm::ivec3 at, int component, int time) {
    const double x = at.x + 0.3 * time, bend = 6 * std::sin(at.y * 0.09 + component) + 4 * std::cos(at.z * 0.12);
    const double front = std::tanh((std::fmod(x, 29) - 14 + bend) * 0.4);
    const double eddies =
        std::sin(x * 0.71 + bend) * std::cos(at.y * 0.53 - 0.02 * at.z * at.z) * std::sin(at.z * 0.37);
    return static_cast<float>(300 + 20 * std::sin(at.x * 0.11 + component + 0.2 * time) * std::cos(at.y * 0.13) +
                              9 * front + 0.7 * eddies);
}

/// A field without anything small.
float calm(glm::ivec3 at, int, int) {
    return static_cast<float>(300 + 20 * std::sin(at.x * 0.11) * std::cos(at.y * 0.13) +
                              9 * std::sin(at.z * 0.17 - at.x * 0.05));
}

/// One parameter of floats, sample by sample.
volume::Dataset floats(glm::ivec3 size, int components, int times, LatticeKind kind,
                       const std::function<float(glm::ivec3, int component, int time)>& sample,
                       const std::function<bool(glm::ivec3)>& present = {}) {
    volume::Dataset made =
        makeDataset(size, {{"T", ScalarType::F32, components, Texture::Smooth, false, false}}, times, kind);
    made.read = [lattice = made.info.lattice, sample, present](int, int component, int time) {
        Field field = volume::makeField(lattice, ScalarType::F32);
        volume::Mask mask(field.count(), 1);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const glm::ivec3 at(x, y, z);
                    mask[i] = !present || present(at) ? 1 : 0;
                    field.as<float>()[i] = mask[i] != 0 ? sample(at, component, time) : 0.f;
                }
        if (present) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    return made;
}

std::uint32_t hashOf(glm::ivec3 at) {
    std::uint32_t h =
        std::uint32_t(at.x) * 73856093u ^ std::uint32_t(at.y) * 19349663u ^ std::uint32_t(at.z) * 83492791u;
    h = (h ^ (h >> 15)) * 2246822519u;
    return h ^ (h >> 13);
}

/// Packs and checks every time of every component; how far above the PSNR the worst of them is.
double worstExcess(volume::Dataset& made, const PackOptions& options, const std::string& path) {
    const PackSummary summary = pack(made, options, path);
    const Archive archive(path);
    double excess = 0, largest = 0;
    for (int t = 0; t < int(made.info.times.size()); ++t)
        for (int c = 0; c < made.info.parameters[0].components; ++c) {
            const FrameErrors errors = frameErrors(made, archive, 0, c, t);
            EXPECT_GE(errors.psnr, options.psnr) << "component " << c << " time " << t;
            excess = std::max(excess, errors.psnr - options.psnr);
            largest = std::max(largest, errors.largest);
        }
    EXPECT_LE(largest, summary.maxError * (1 + 1e-6));
    EXPECT_EQ(summary.maxError, archive.metadata().maxError);
    EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    return excess;
}

TEST(MeanError, OfSmoothFloatsIsMetCloselyAtEveryTime) {
    const TemporaryFolder folder;
    for (const double wanted : {40.0, 60.0, 80.0, 95.0}) {
        volume::Dataset made = floats({70, 50, 40}, 2, 4, LatticeKind::CC, waves);
        EXPECT_LE(worstExcess(made, optionsFor(wanted), folder / "a.tsr"), kClose) << wanted;
    }
}

TEST(MeanError, OfNoiseIsMetClosely) {
    const TemporaryFolder folder;
    for (const double wanted : {30.0, 60.0}) {
        volume::Dataset made = floats({40, 40, 40}, 1, 2, LatticeKind::CC, [](glm::ivec3 at, int, int time) {
            return static_cast<float>(hashOf(at + time) % 100000) * 0.01031f;
        });
        EXPECT_LE(worstExcess(made, optionsFor(wanted), folder / "a.tsr"), kClose) << wanted;
    }
}

TEST(MeanError, HoldsWithoutAbsentSamplesAndThoseThatAreNotFinite) {
    const TemporaryFolder folder;
    const auto sample = [](glm::ivec3 at, int component, int time) {
        const std::uint32_t hash = hashOf(at);
        if (hash % 991 == 0) return std::numeric_limits<float>::quiet_NaN();
        if (hash % 991 == 1) return std::numeric_limits<float>::infinity();
        return waves(at, component, time);
    };
    const auto present = [](glm::ivec3 at) { return at.y < 20 || at.x > 30; };
    for (const double wanted : {50.0, 70.0}) {
        volume::Dataset made = floats({64, 40, 33}, 1, 2, LatticeKind::CC, sample, present);
        EXPECT_LE(worstExcess(made, optionsFor(wanted), folder / "a.tsr"), kClose) << wanted;
    }
}

TEST(MeanError, HoldsOnBcc) {
    const TemporaryFolder folder;
    for (const double wanted : {50.0, 75.0}) {
        volume::Dataset made = floats({40, 36, 48}, 1, 2, LatticeKind::BCC, waves);
        PackOptions options = optionsFor(wanted);
        options.lattice = StoredLattice::BCC;
        EXPECT_LE(worstExcess(made, options, folder / "a.tsr"), kClose) << wanted;
    }
}

// A part of the volume is at rest, another one drifts by less than the error, and another one moves.
TEST(MeanError, HoldsWithRepeatedBricks) {
    const TemporaryFolder folder;
    for (const float drift : {0.f, 0.01f}) {
        volume::Dataset made =
            floats({96, 32, 32}, 1, 6, LatticeKind::CC, [drift](glm::ivec3 at, int component, int time) {
                return waves(at, component, at.x < 32 ? time : 0) + (at.x < 64 ? drift * float(time) : 0);
            });
        const PackOptions options = optionsFor(55);
        EXPECT_LE(worstExcess(made, options, folder / "a.tsr"), kClose) << drift;
        EXPECT_GT(pack(made, options, folder / "b.tsr").repeatedBricks, 4u) << drift;
    }
}

// Background takes hardly a part of the error, so that nearly all of it is in a few bricks. It grows in jumps then,
// since all of the background is rounded alike.
TEST(MeanError, MayBeInAFewBricks) {
    const TemporaryFolder folder;
    volume::Dataset made = floats({96, 64, 64}, 1, 1, LatticeKind::CC, [](glm::ivec3 at, int component, int time) {
        return at.x < 20 && at.y < 20 ? waves(at, component, time) : 250.f;
    });
    for (const double wanted : {50.0, 80.0})
        EXPECT_LE(worstExcess(made, optionsFor(wanted), folder / "a.tsr"), 2 * kClose) << wanted;
}

// Rounded samples are as many integers, at a step of sqrt(12) times the mean error.
TEST(MeanError, OfSmoothFloatsTakesHalfTheBytesOfRoundedSamples) {
    const TemporaryFolder folder;
    for (const double wanted : {60.0, 80.0}) {
        volume::Dataset made = floats({64, 64, 64}, 1, 1, LatticeKind::CC, calm);
        const PackOptions options = optionsFor(wanted);
        const PackSummary summary = pack(made, options, folder / "a.tsr");
        const Range range = Archive(folder / "a.tsr").info().parameters[0].ranges[0];
        const double step = std::sqrt(12.0) * (range.hi - range.lo) * std::pow(10.0, -wanted / 20);
        volume::Dataset rounded =
            makeDataset({64, 64, 64}, {{"T", ScalarType::I32, 1, Texture::Smooth, false, false}}, 1);
        rounded.read = [&made, step](int, int, int) {
            const Field field = made.read(0, 0, 0);
            Field out = volume::makeField(field.lattice, ScalarType::I32);
            for (std::size_t i = 0; i < field.count(); ++i)
                out.as<std::int32_t>()[i] = static_cast<std::int32_t>(std::lround(field.value(i) / step));
            return out;
        };
        PackOptions exact = options;
        exact.psnr = 0;
        EXPECT_LE(2 * summary.archiveBytes, pack(rounded, exact, folder / "b.tsr").archiveBytes) << wanted;
    }
}

TEST(MeanError, HoldsTogetherWithALargestError) {
    const TemporaryFolder folder;
    for (const double bound : {5e-4, 1.2e-3, 2e-3, 4e-3, 0.1}) { // the mean error is 1e-3
        volume::Dataset made = floats({64, 48, 40}, 1, 2, LatticeKind::CC, waves);
        PackOptions options = optionsFor(60);
        options.maxError = bound;
        worstExcess(made, options, folder / "a.tsr");
        for (int t = 0; t < 2; ++t)
            EXPECT_LE(frameErrors(made, Archive(folder / "a.tsr"), 0, 0, t).largest, bound * (1 + 1e-6)) << bound;
    }
}

// What is appended is coded as it would be in one run, since the quantum of the time before is in the archive.
TEST(MeanError, IsTheSameWhenTimesAreAppended) {
    const TemporaryFolder folder;
    const auto series = [](int first, int times) {
        volume::Dataset made =
            floats({48, 40, 32}, 1, times, LatticeKind::CC,
                   [first](glm::ivec3 at, int component, int time) { return waves(at, component, first + time); });
        for (int t = 0; t < times; ++t) made.info.times[std::size_t(t)] = first + t;
        made.info.parameters[0].ranges = {{260, 340}};
        return made;
    };
    volume::Dataset all = series(0, 4), begin = series(0, 2), rest = series(2, 2);
    pack(all, optionsFor(60), folder / "all.tsr");
    pack(begin, optionsFor(60), folder / "grown.tsr");
    append(rest, folder / "grown.tsr");
    const Archive one(folder / "all.tsr"), other(folder / "grown.tsr");
    for (int t = 0; t < 4; ++t) EXPECT_EQ(readField(one, 0, 0, t).samples, readField(other, 0, 0, t).samples) << t;
}

/// Trials of a search for errors that grow as `squares` says.
int trialsOf(QuantumSearch search, double first, const std::function<double(double)>& squares, double fixed = 0) {
    int trials = 0;
    for (std::optional<double> next = first; next; ++trials) next = search.next(*next, squares(*next), fixed);
    const double reached = squares(search.best()) + fixed;
    EXPECT_LE(reached, 1);
    EXPECT_GE(reached, std::pow(10.0, -0.03));
    return trials;
}

TEST(QuantumSearch, FindsTheLargestThatIsAllowed) {
    for (const double first : {1e-3, 0.3, 1.0, 20.0})
        for (const double power : {0.7, 1.0, 2.0}) {
            const auto squares = [power](double quantum) { return std::pow(quantum / 3, power); };
            EXPECT_LE(trialsOf(QuantumSearch(1, 20), first, squares), 9) << first << " " << power;
            EXPECT_LE(trialsOf(QuantumSearch(1, 20), first, squares, 0.9), 9) << first << " " << power;
        }
    // In steps.
    EXPECT_LE(trialsOf(QuantumSearch(1, 30), 1, [](double q) { return 0.05 * std::floor(q * q); }), 12);
}

TEST(QuantumSearch, EndsWhereNothingIsToBeFound) {
    QuantumSearch flat(1, 100);
    int trials = 0;
    for (std::optional<double> next = 1; next && trials < 100; ++trials) next = flat.next(*next, 0.5);
    EXPECT_LE(trials, 3);
    EXPECT_GT(flat.best(), 0);
    QuantumSearch tooMuch(1, 100);
    EXPECT_FALSE(tooMuch.next(1, 0.1, 1.5)); // what is not coded alone is too much
    EXPECT_EQ(tooMuch.best(), 0);
    QuantumSearch limited(1, 100, 2);
    for (std::optional<double> next = 1; next;) next = limited.next(*next, 0.01 * *next);
    EXPECT_EQ(limited.best(), 2);
}

} // namespace
} // namespace tessera::codec
