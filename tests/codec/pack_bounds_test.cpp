#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"
#include "volume/import/import.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::LatticeKind;
using volume::ScalarType;

struct Errors {
    double largest = 0, psnr = 0;
};

/// Errors of one time of a parameter of one component; the peak is its range over all times.
Errors errorsOf(volume::Dataset& made, const Archive& archive, int time) {
    const volume::Field a = made.read(0, 0, time), b = readField(archive, 0, 0, time);
    const Range range = archive.info().parameters[0].ranges[0];
    Errors errors;
    double squares = 0;
    for (std::size_t i = 0; i < a.count(); ++i) {
        const double error = std::abs(a.value(i) - b.value(i));
        errors.largest = std::max(errors.largest, error);
        squares += error * error;
    }
    errors.psnr = 20 * std::log10((range.hi - range.lo) / std::sqrt(squares / double(a.count())));
    return errors;
}

volume::Dataset twoTimes(Texture texture) {
    return makeDataset({33, 20, 18}, {{"T", ScalarType::F32, 1, texture, false, false}}, 2);
}

PackOptions gridOptions() {
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 16;
    return options;
}

TEST(PackBounds, AbsoluteErrorIsKept) {
    const TemporaryFolder folder;
    std::uint64_t before = ~std::uint64_t(0);
    for (const double bound : {1e-4, 0.01, 0.5}) {
        volume::Dataset made = twoTimes(Texture::Smooth);
        PackOptions options = gridOptions();
        options.absError = bound;
        const PackSummary summary = pack(made, options, folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        for (int t = 0; t < 2; ++t) EXPECT_LE(errorsOf(made, archive, t).largest, bound);
        EXPECT_LT(summary.archiveBytes, before) << bound;
        EXPECT_FALSE(archive.metadata().lossless);
        before = summary.archiveBytes;
    }
}

TEST(PackBounds, SignalToNoiseIsReachedAndNotWasted) {
    const TemporaryFolder folder;
    for (const Texture texture : {Texture::Smooth, Texture::Noise})
        for (const double wanted : {30.0, 60.0, 90.0}) {
            volume::Dataset made = twoTimes(texture);
            PackOptions options = gridOptions();
            options.psnr = wanted;
            pack(made, options, folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            for (int t = 0; t < 2; ++t) {
                const double reached = errorsOf(made, archive, t).psnr;
                EXPECT_GE(reached, wanted);
                EXPECT_LE(reached, wanted + 3);
            }
        }
}

// What moves with its range is coded ever as well; a brick of an earlier time, which is within the bound of every
// sample still, is further away on the whole.
TEST(PackBounds, SignalToNoiseIsReachedAtEveryTimeOfASeries) {
    const TemporaryFolder folder;
    for (const double drift : {0.0, 0.1, 1.6}) {
        volume::Dataset made = makeDataset({33, 20, 18}, {{"T", ScalarType::F32, 1, Texture::Smooth, false, false}}, 5);
        made.read = [lattice = made.info.lattice, drift](int, int, int t) {
            volume::Field field = volume::makeField(lattice, ScalarType::F32);
            const auto samples = field.as<float>();
            std::fill(samples.begin(), samples.end(), float(60 + drift * t));
            samples.front() -= 50, samples.back() += 50;
            return field;
        };
        PackOptions options = gridOptions();
        options.psnr = 40;
        const PackSummary summary = pack(made, options, folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        for (int t = 0; t < 5; ++t) EXPECT_GE(errorsOf(made, archive, t).psnr, 40) << drift << " " << t;
        if (drift == 0) {
            EXPECT_EQ(summary.repeatedBricks, 4 * summary.bricks);
        }
    }
}

/// A ball of noise in much background, of whole numbers up to `most`.
volume::Dataset ball(ScalarType type, int most) {
    volume::Dataset made = makeDataset({40, 36, 30}, {{"n", type, 1, Texture::Smooth, false, false}}, 1);
    made.read = [lattice = made.info.lattice, type, most](int, int, int) {
        volume::Field field = volume::makeField(lattice, type);
        std::mt19937 random(5u);
        volume::dispatch(type, [&]<class T>(T) {
            std::size_t i = 0;
            for (int z = 0; z < lattice.size.z; ++z)
                for (int y = 0; y < lattice.size.y; ++y)
                    for (int x = 0; x < lattice.size.x; ++x, ++i) {
                        const double r = std::hypot(x - 20, y - 18, z - 15);
                        if (r < 9)
                            field.as<T>()[i] = static_cast<T>(most * (0.5 + 0.4 * std::sin(r)) + int(random() % 9));
                    }
        });
        return field;
    };
    return made;
}

/// The PSNR of a frame whose numbers become multiples of a step.
double psnrOfStep(const volume::Field& field, const Range& range, int step) {
    double squares = 0;
    for (std::size_t i = 0; i < field.count(); ++i) {
        const double apart = std::remainder(field.value(i), double(step));
        squares += apart * apart;
    }
    return 20 * std::log10((range.hi - range.lo) / std::sqrt(squares / double(field.count())));
}

/// Packs with a PSNR; within half a decibel of it, or no step comes nearer.
void expectClose(volume::Dataset& made, double wanted, const std::string& path) {
    PackOptions options = gridOptions();
    options.psnr = wanted;
    pack(made, options, path);
    const Archive archive(path);
    const double reached = errorsOf(made, archive, 0).psnr;
    EXPECT_GE(reached, wanted);
    if (reached <= wanted + 0.5) return;
    const volume::Field field = made.read(0, 0, 0);
    const Range range = archive.info().parameters[0].ranges[0];
    const double end = made.info.parameters[0].type == ScalarType::U8 ? 255 : 1e9;
    for (int step = 1; step < 256; ++step) {
        if (step * std::floor((range.hi + double(step / 2)) / step) > end) continue; // beyond the type
        const double psnr = psnrOfStep(field, range, step);
        if (psnr < wanted - 10) break; // larger steps are no better
        EXPECT_FALSE(psnr >= wanted && psnr < reached - 1e-9)
            << wanted << ": step " << step << " gives " << psnr << " in place of " << reached;
    }
}

TEST(PackBounds, SignalToNoiseOfIntegersIsAsCloseAsStepsAllow) {
    const TemporaryFolder folder;
    for (const auto& [type, most] : {std::pair(ScalarType::U8, 200), std::pair(ScalarType::I16, 3000),
                                     std::pair(ScalarType::U16, 60000), std::pair(ScalarType::I32, 3000000)})
        for (const double wanted : {28.0, 40.0, 47.0, 52.0}) {
            SCOPED_TRACE(std::string(volume::name(type)) + " " + std::to_string(wanted));
            volume::Dataset made = ball(type, most);
            expectClose(made, wanted, folder / "a.tsr");
        }
}

TEST(PackBounds, SignalToNoiseOfFloatsInMuchBackgroundIsClose) {
    const TemporaryFolder folder;
    for (const double wanted : {20.0, 40.0, 80.0}) {
        volume::Dataset made = ball(ScalarType::F32, 1000);
        PackOptions options = gridOptions();
        options.psnr = wanted;
        pack(made, options, folder / "a.tsr");
        const double reached = errorsOf(made, Archive(folder / "a.tsr"), 0).psnr;
        EXPECT_GE(reached, wanted);
        EXPECT_LE(reached, wanted + 0.5);
    }
}

TEST(PackBounds, SignalToNoiseOfScansIsAsCloseAsStepsAllow) {
    const char* asked = std::getenv("TESSERA_DATA");
    const std::filesystem::path folder = std::filesystem::path(asked ? asked : TESSERA_TEST_DATA) / "volumes";
    const TemporaryFolder out;
    for (const char* name : {"lobster", "tooth"}) {
        std::string file;
        std::error_code missing;
        for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
            if (entry.path().extension() == ".json" && entry.path().stem().string().starts_with(name))
                file = entry.path().string();
        if (file.empty()) GTEST_SKIP() << "no " << name << " under $TESSERA_DATA";
        volume::Dataset made = volume::openFiles({file}, {});
        SCOPED_TRACE(file);
        expectClose(made, 40, out / "a.tsr");
    }
}

TEST(PackBounds, TheStrictestOfSeveralHolds) {
    const TemporaryFolder folder;
    volume::Dataset made = twoTimes(Texture::Smooth);
    PackOptions options = gridOptions();
    options.maxError = 0.1;
    options.absError = 0.02;
    pack(made, options, folder / "a.tsr");
    EXPECT_LE(errorsOf(made, Archive(folder / "a.tsr"), 0).largest, 0.02);
    options.maxError = 1e-4;
    options.absError = 50;
    pack(made, options, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    const Range range = archive.info().parameters[0].ranges[0];
    EXPECT_LE(errorsOf(made, archive, 0).largest, 1e-4 * (range.hi - range.lo));
}

TEST(PackPresets, AreOfKnownNames) {
    EXPECT_EQ(PackOptions::preset("none"), PackOptions());
    EXPECT_EQ(PackOptions::preset("lossless")->lattice, StoredLattice::CC);
    EXPECT_EQ(PackOptions::preset("visual")->maxError, 1e-3);
    EXPECT_EQ(PackOptions::preset("small")->maxError, 1e-2);
    EXPECT_EQ(PackOptions::preset("thesis")->brickSize, 16);
    EXPECT_FALSE(PackOptions::preset("best"));
    for (const std::string_view name : PackOptions::kPresetNames) {
        ASSERT_TRUE(PackOptions::preset(name)) << name;
        if (!PackOptions::presetHasLattice(name)) {
            EXPECT_EQ(PackOptions::preset(name)->lattice, PackOptions().lattice) << name;
        }
    }
}

TEST(PackPresets, EachPacksWhatItPromises) {
    const TemporaryFolder folder;
    for (const std::string_view preset : PackOptions::kPresetNames) {
        SCOPED_TRACE(preset);
        volume::Dataset made = twoTimes(Texture::Smooth);
        pack(made, *PackOptions::preset(preset), folder / "a.tsr");
        const Archive archive(folder / "a.tsr");
        const bool grid = preset != "thesis";
        EXPECT_EQ(archive.info().lattice.kind, grid ? LatticeKind::CC : LatticeKind::BCC);
        if (preset == "lossless" || preset == "none") {
            EXPECT_EQ(errorsOf(made, archive, 1).largest, 0);
        }
        EXPECT_EQ(verifyArchive(archive).damaged, 0u);
    }
}

// A field at rest says nothing about the filter of what follows.
TEST(PackSeries, AFlatBeginningDoesNotSettleTheFilter) {
    const TemporaryFolder folder;
    const auto series = [](int flat) { // of two times, so that no brick is mixed; without a flat one the second repeats
        volume::Dataset made = makeDataset({48, 48, 32}, {{"u", ScalarType::U8, 1, Texture::Smooth, false, false}}, 2);
        made.read = [inner = made.read, flat](int p, int c, int t) {
            volume::Field field = inner(p, c, 0);
            if (t < flat) std::fill(field.samples.begin(), field.samples.end(), std::byte{7});
            return field;
        };
        return made;
    };
    volume::Dataset alone = series(0), after = series(1);
    pack(alone, gridOptions(), folder / "alone.tsr");
    pack(after, gridOptions(), folder / "after.tsr");
    const Archive a(folder / "alone.tsr"), b(folder / "after.tsr");
    for (int level = 0; level < a.grid().levels; ++level)
        EXPECT_LE(double(b.levelBytes(level)), 1.02 * double(a.levelBytes(level)) + 200) << level;
}

// What is not used is not stored: header, shape and a few bytes a brick.
TEST(PackSeries, AnEmptyVolumeIsAlmostNothing) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({64, 64, 64}, {{"u", ScalarType::U8, 1, Texture::Sparse, false, false}}, 1);
    const PackSummary summary = pack(made, gridOptions(), folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    std::uint64_t bricks = 0;
    for (int level = 0; level < archive.grid().levels; ++level) bricks += archive.levelBytes(level);
    const std::uint64_t index = 64 * (8 + 12 + 12 * std::uint64_t(archive.grid().levels)) + 200;
    EXPECT_LE(summary.archiveBytes, bricks + index + 1000);
    EXPECT_EQ(readField(archive, 0, 0, 0).samples, made.read(0, 0, 0).samples);
}

} // namespace
} // namespace tessera::codec
