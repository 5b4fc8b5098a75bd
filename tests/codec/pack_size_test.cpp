#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "codec/pack/pack_size.h"
#include "tests/codec/least_memory.h"
#include "tests/codec/make_dataset.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <thread>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::ScalarType;

/// A wave with noise far below it: what a size buys is precision.
volume::Dataset waves(int times) {
    volume::Dataset made = makeDataset({40, 36, 32},
                                       {{"T", ScalarType::F32, 1, Texture::Smooth, true, false},
                                        {"U", ScalarType::F32, 2, Texture::Smooth, false, false}},
                                       times);
    made.read = [read = made.read](int p, int c, int t) {
        volume::Field field = read(p, c, t);
        std::mt19937 random(unsigned(100 * p + 10 * c + t));
        for (float& value : field.as<float>()) value += float(random() % 1000) * 1e-4f;
        return field;
    };
    return made;
}

TEST(PackSize, NeverAboveTheSizeAskedAndMostlyUsed) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    double before = 1;
    for (const double size : {0.05, 0.1, 0.3}) {
        volume::Dataset made = waves(3);
        PackOptions options;
        options.sizeMb = size;
        options.brickSize = 16;
        const PackSummary summary = pack(made, options, path);
        const Archive archive(path);
        EXPECT_LE(readFile(path).size(), size * 1e6);
        EXPECT_GE(readFile(path).size(), 0.94 * size * 1e6) << "after " << summary.trials << " trials";
        EXPECT_EQ(archive.fileBytes(), summary.archiveBytes);
        EXPECT_LT(archive.metadata().maxError, before); // more bytes, less error
        EXPECT_GT(archive.metadata().maxError, 0);
        before = archive.metadata().maxError;
        EXPECT_EQ(archive.metadata().options.sizeMb, 0);
        EXPECT_EQ(folder.files(), 1u);
    }
}

/// Whole numbers of 8 bits: a size between those of two odd steps is used as well.
TEST(PackSize, IsUsedAsFarAsStepsOfIntegersAllow) {
    const TemporaryFolder folder;
    const auto made = [] {
        return makeDataset({40, 36, 32}, {{"n", ScalarType::U8, 1, Texture::Noise, false, false}}, 1);
    };
    std::vector<double> bytes; // with each step, found by the PSNR that it alone gives
    const auto add = [&](double psnr) {
        volume::Dataset data = made();
        PackOptions options;
        options.lattice = StoredLattice::CC;
        options.psnr = psnr;
        bytes.push_back(double(pack(data, options, folder / "step.tsr").archiveBytes));
    };
    for (const double psnr : {43.0, 41.7, 38.2, 36.9, 34.9, 33.9}) add(psnr); // steps 2 to 7 of numbers up to 99
    for (std::size_t i = 1; i < bytes.size(); ++i) {
        EXPECT_LT(bytes[i], bytes[i - 1]) << i;
        volume::Dataset data = made();
        PackOptions options;
        options.lattice = StoredLattice::CC;
        options.sizeMb = (bytes[i] + 50) / 1e6;
        const PackSummary summary = pack(data, options, folder / "a.tsr");
        EXPECT_LE(double(summary.archiveBytes), bytes[i] + 50);
        EXPECT_GE(double(summary.archiveBytes), 0.99 * bytes[i]) << "step " << i + 2 << ", trials " << summary.trials;
    }
}

/// Sizes of whole numbers as measured of a scan: a finer step may take less than a coarser one.
TEST(PackSize, OfStepsThatTakeMoreThanFinerOnesTheFinestThatFitsIsTaken) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    const std::vector<std::pair<double, double>> sizes{
        // from a bound on, MB
        {0, 0.919},      {0.004, 0.548},  {0.008, 0.419},  {0.0118, 0.341}, {0.0157, 0.275}, {0.0196, 0.286},
        {0.0275, 0.154}, {0.0314, 0.156}, {0.0392, 0.165}, {0.0588, 0.195}, {0.1, 0.05}};
    const auto sizeAt = [&](double bound) {
        double size = 0;
        for (const auto& [from, megabytes] : sizes)
            if (bound >= from) size = megabytes * 1e6;
        return std::uint64_t(size);
    };
    const auto estimate = [&](const Progress&) {
        std::vector<SizeAtBound> curve{{0, 9.2e5}};
        for (int exponent = -26; exponent <= -2; ++exponent)
            curve.push_back({std::ldexp(1.0, exponent), std::min(9.2e5, 4e3 * std::ldexp(1.0, -exponent))});
        return curve;
    };
    const auto boundOf = [](const PackOptions& options) {
        return options.psnr > 0 ? std::sqrt(3.0) * std::pow(10.0, -options.psnr / 20) : 0;
    };
    const auto packed = [&](const PackOptions& options, const std::string& to, const Progress&) {
        PackSummary summary;
        summary.archiveBytes = sizeAt(boundOf(options));
        std::ofstream(to) << summary.archiveBytes;
        return summary;
    };
    const std::pair<double, double> wanted[] = {{0.35, 0.341}, {0.33, 0.275}, {0.29, 0.275}, {0.28, 0.275},
                                                {0.43, 0.419}, {0.2, 0.154},  {0.6, 0.548}};
    for (const auto& [asked, best] : wanted) {
        PackOptions options;
        options.sizeMb = asked;
        const PackSummary summary = packToSize(options, SizeControl::Psnr, path, estimate, packed, {});
        EXPECT_LE(double(summary.archiveBytes), asked * 1e6);
        EXPECT_NEAR(double(summary.archiveBytes), best * 1e6, best * 0.05e6) << asked << " after " << summary.trials;
        EXPECT_EQ(std::stoull(std::string(readFile(path).data(), readFile(path).size())), summary.archiveBytes);
        EXPECT_LE(summary.trials, 15);
    }
}

TEST(PackSize, AmpleSizesAreLosslessAndTinyOnesRefused) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tsr";
    volume::Dataset made = waves(1);
    PackOptions options;
    options.sizeMb = 10;
    pack(made, options, path);
    EXPECT_TRUE(Archive(path).metadata().lossless);
    const std::vector<char> before = readFile(path);
    options.sizeMb = 1e-4;
    EXPECT_THROW(pack(made, options, path), Error);
    EXPECT_EQ(readFile(path), before);
    EXPECT_EQ(folder.files(), 1u);
    options.psnr = 40;
    EXPECT_THROW(pack(made, options, path), Error);
}

TEST(PackMemory, ALimitThatCannotBeKeptIsAnError) {
    const TemporaryFolder folder;
    volume::Dataset made = waves(2);
    PackOptions options;
    options.memoryMb = 1;
    EXPECT_THROW(pack(made, options, folder / "a.tsr"), Error);
    EXPECT_EQ(folder.files(), 0u);
    options.memoryMb = 500;
    pack(made, options, folder / "a.tsr");
    EXPECT_EQ(folder.files(), 1u);
}

// Reading goes on while coding does; never more than one frame is read at a time, and a tight limit reads none ahead.
TEST(PackFeed, ReadsOneStepAheadOrNone) {
    const TemporaryFolder folder;
    const auto countThreads = [&](double memoryMb, const std::string& name) {
        volume::Dataset made = waves(3);
        std::atomic<int> inside = 0;
        std::set<std::thread::id> threads;
        made.read = [&, read = made.read](int p, int c, int t) {
            EXPECT_EQ(++inside, 1);
            threads.insert(std::this_thread::get_id());
            volume::Field field = read(p, c, t);
            --inside;
            return field;
        };
        PackOptions options;
        options.memoryMb = memoryMb;
        pack(made, options, folder / name);
        return threads.size();
    };
    EXPECT_GT(countThreads(1000, "ample.tsr"), 1u);
    const double least = leastMemory([&](double limit) { countThreads(limit, "trial.tsr"); });
    EXPECT_EQ(countThreads(least, "tight.tsr"), 1u);
    // The limit is no part of what is stored but among the options.
    const Archive ample(folder / "ample.tsr"), tight(folder / "tight.tsr");
    for (int t = 0; t < 3; ++t) EXPECT_EQ(readField(ample, 0, 0, t).samples, readField(tight, 0, 0, t).samples);
}

// Between a bound that is too fine and one that is too coarse the next one is interpolated in the logarithm, by sizes,
// but not within a tenth of either.
TEST(PackSize, TheThirdTrialLiesBetweenTheFirstTwo) {
    const TemporaryFolder folder;
    const double wanted = 1e6, aim = 0.98 * wanted;
    const std::pair<double, double> sizes[] = {{2e6, 0.5e6}, {1.2e6, 0.2e6}, {1.001e6, 0.1e6}, {40e6, 0.95e6}};
    for (const auto& [tooLarge, tooSmall] : sizes) {
        std::vector<double> bounds;
        const auto estimate = [&](const Progress&) {
            std::vector<SizeAtBound> curve{{0, 9e6}};
            for (int exponent = -26; exponent <= -2; ++exponent)
                curve.push_back({std::ldexp(1.0, exponent), 2e5 * -exponent});
            return curve;
        };
        const auto packed = [&](const PackOptions& options, const std::string& to, const Progress&) {
            bounds.push_back(options.maxError);
            PackSummary summary;
            summary.archiveBytes = std::uint64_t(bounds.size() == 1   ? tooLarge
                                                 : bounds.size() == 2 ? tooSmall
                                                                      : 0.97e6);
            std::ofstream(to) << summary.archiveBytes;
            return summary;
        };
        PackOptions options;
        options.sizeMb = 1;
        packToSize(options, SizeControl::LargestError, folder / "a.tsr", estimate, packed, {});
        ASSERT_EQ(bounds.size(), 3u);
        EXPECT_LT(bounds[0], bounds[1]);
        const double part = std::clamp((tooLarge - aim) / (tooLarge - tooSmall), 0.1, 0.9);
        EXPECT_NEAR(std::log(bounds[2] / bounds[0]) / std::log(bounds[1] / bounds[0]), part, 1e-9) << tooLarge;
    }
}

TEST(PackSize, EstimatesTakeTheFirstTenthOfTheProgress) {
    const TemporaryFolder folder;
    volume::Dataset made = waves(2);
    std::vector<double> ranges, sizes;
    const Progress progress{[&](double fraction, const std::string& what) {
                                if (what == "ranges") ranges.push_back(fraction);
                                if (what == "sizes") sizes.push_back(fraction);
                            },
                            {}};
    PackOptions options;
    options.sizeMb = 0.3;
    pack(made, options, folder / "a.tsr", progress);
    ASSERT_EQ(ranges.size(), 4u); // two parameters at two times
    ASSERT_EQ(sizes.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(ranges[i], 0.05 * double(i) / 4, 1e-12);
        EXPECT_NEAR(sizes[i], 0.05 + 0.05 * double(i) / 4, 1e-12);
    }
}

TEST(PackFeed, AStopIsHeardBetweenSlices) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({8, 8, 64}, {{"n", ScalarType::U8, 1, Texture::Noise}}, 1);
    std::stop_source stop;
    int reads = 0;
    made.read = [&, read = made.read](int p, int c, int t, volume::SliceRange slices) {
        if (++reads == 2) stop.request_stop();
        return volume::slicesOf(read(p, c, t), slices);
    };
    FrameQueueOptions reading;
    reading.grid = {made.info.lattice, 8, 2, 0};
    reading.slices = {8, folder / ""};
    reading.slabLayers = 1;
    FrameQueue feed(made, reading, stop.get_token());
    EXPECT_THROW(feed.next(), Cancelled);
    EXPECT_EQ(reads, 2);
}

} // namespace
} // namespace tessera::codec
