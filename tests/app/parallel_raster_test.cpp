#include "app/views/parallel/gap_raster.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

/// The picture between two axes against the lines of every sample.
namespace tessera::app {
namespace {

constexpr int kGapBins = 24, kWidth = 31, kHeight = 200;
constexpr PlaceRows kLeft{160, false, 175, 195}, kRight{160, true, 175, 195};

/// A sample: shares of both axes, below 0 where absent.
struct Line {
    double left, right;
    bool focus;
};

std::vector<Line> someLines(int count) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(0, 1);
    std::vector<Line> lines;
    for (int i = 0; i < count; ++i) {
        const double a = any(random), b = std::clamp(a * a + 0.1 * any(random), 0.0, 0.999);
        lines.push_back({any(random) < 0.1 ? -1 : a, any(random) < 0.2 ? -1 : b, any(random) < 0.3});
    }
    return lines;
}

volume::PlaceCounts counted(const std::vector<Line>& lines) {
    const std::size_t places = volume::placesOf(kGapBins);
    volume::PlaceCounts out{std::vector<std::uint64_t>(places * places), {std::vector<double>(places * places)}};
    const auto place = [](double share) {
        return std::size_t(share < 0 ? volume::absentPlace(kGapBins) : int(share * kGapBins));
    };
    for (const Line& line : lines) {
        const std::size_t at = place(line.left) * places + place(line.right);
        ++out.all[at];
        if (line.focus) out.selected[0][at] += 0.5;
    }
    return out;
}

/// Row of a sample on an axis; of an absent one the middle of the mark.
double rowOn(const PlaceRows& rows, double share) {
    if (share < 0) return (rows.markFrom + rows.markTo) / 2;
    return rows.axis * (rows.flipped ? share : 1 - share);
}

TEST(GapRaster, EveryColumnHoldsAllSamplesAtTheirRows) {
    const std::vector<Line> lines = someLines(3000);
    const GapDensity density = rasterGap(counted(lines), kGapBins, kLeft, kRight, kWidth, kHeight);
    double shown = 0, focus = 0;
    for (const Line& line : lines)
        if (line.left >= 0 || line.right >= 0) ++shown, focus += line.focus ? 0.5 : 0;
    ASSERT_LT(shown, double(lines.size())) << "some lack both";
    const double reach = 20; // rows: the mark, and more than a bin
    for (int column = 0; column < kWidth; ++column) {
        const double u = (column + 0.5) / kWidth;
        double sum = 0, selected = 0;
        for (int row = 0; row < kHeight; ++row) {
            const auto at = std::size_t(row * kWidth + column);
            // As many samples above this row as the lines themselves have, but for those within a bin of it.
            double least = 0, most = 0;
            for (const Line& line : lines) {
                if (line.left < 0 && line.right < 0) continue;
                const double y = rowOn(kLeft, line.left) * (1 - u) + rowOn(kRight, line.right) * u;
                least += y < row - reach ? 1 : 0, most += y < row + reach ? 1 : 0;
            }
            EXPECT_GE(sum, least - 1e-6) << column << " " << row;
            EXPECT_LE(sum, most + 1e-6) << column << " " << row;
            sum += density.all[at];
            selected += density.selected[0][at];
            EXPECT_LE(density.selected[0][at], density.all[at] + 1e-9);
        }
        EXPECT_NEAR(sum, shown, shown * 1e-6);
        EXPECT_NEAR(selected, focus, shown * 1e-6);
    }
}

TEST(GapRaster, ALoneSampleIsABandOfItsBins) {
    volume::PlaceCounts counts{std::vector<std::uint64_t>(volume::placesOf(4) * volume::placesOf(4)), {}};
    counts.all[0 * volume::placesOf(4) + 3] = 6; // from the lowest bin to the highest
    const PlaceRows rows{40, false, 0, 0};
    const GapDensity density = rasterGap(counts, 4, rows, rows, 2, 40);
    // At a quarter of the way the band lies at rows 30 - 30/4 .. 40 - 30/4.
    for (int row = 0; row < 40; ++row) {
        const double expected = std::clamp(std::min(row + 1.0, 32.5) - std::max(double(row), 22.5), 0.0, 1.0) * 6 / 10;
        EXPECT_NEAR(density.all[std::size_t(row * 2)], expected, 1e-12) << row;
    }
}

TEST(GapRaster, SamplesBeyondTheEndsOfAnAxisHaveNoBand) {
    const std::size_t places = volume::placesOf(4);
    volume::PlaceCounts counts{std::vector<std::uint64_t>(places * places), {}};
    for (const int place : {volume::belowPlace(4), volume::abovePlace(4)}) {
        counts.all[std::size_t(place) * places + 1] = 5;
        counts.all[1 * places + std::size_t(place)] = 5;
    }
    counts.all[std::size_t(volume::absentPlace(4)) * (places + 1)] = 9; // lack both
    EXPECT_EQ(greatestDensity(rasterGap(counts, 4, kLeft, kRight, 5, 200)), 0);
}

TEST(GapRaster, BinsThinnerThanARowAreDrawnTogether) {
    EXPECT_EQ(binsTogether(24, 160), 1);
    EXPECT_EQ(binsTogether(24, 24), 1);
    EXPECT_EQ(binsTogether(512, 400), 2);
    EXPECT_EQ(binsTogether(512, 100), 6);
    EXPECT_EQ(binsTogether(512, 0), 512);
    const volume::PlaceCounts counts = counted(someLines(3000));
    const std::size_t places = volume::placesOf(kGapBins), half = volume::placesOf(kGapBins / 2);
    volume::PlaceCounts joined{std::vector<std::uint64_t>(half * half), {std::vector<double>(half * half)}};
    const auto place = [](std::size_t of) {
        return of < std::size_t(kGapBins) ? of / 2 : of - std::size_t(kGapBins) / 2;
    };
    for (std::size_t i = 0; i < counts.all.size(); ++i) {
        const std::size_t to = place(i / places) * half + place(i % places);
        joined.all[to] += counts.all[i], joined.selected[0][to] += counts.selected[0][i];
    }
    const PlaceRows left{12, false, 14, 16}, right{12, true, 14, 16}; // a row for two bins
    const GapDensity found = rasterGap(counts, kGapBins, left, right, 7, 16);
    const GapDensity wanted = rasterGap(joined, kGapBins / 2, left, right, 7, 16);
    for (std::size_t i = 0; i < wanted.all.size(); ++i) {
        EXPECT_NEAR(found.all[i], wanted.all[i], 1e-9) << i;
        EXPECT_NEAR(found.selected[0][i], wanted.selected[0][i], 1e-9) << i;
    }
}

TEST(GapRaster, JoinedBinsKeepAllSamples) {
    const std::vector<Line> lines = someLines(3000);
    const volume::PlaceCounts counts = counted(lines);
    double shown = 0, focus = 0;
    for (const Line& line : lines)
        if (line.left >= 0 || line.right >= 0) ++shown, focus += line.focus ? 0.5 : 0;
    for (const double rows : {10.0, 5.0, 3.5, 1.0}) { // 24 bins by 3, 5, 7 and 24: some leave a rest
        const PlaceRows left{rows, false, rows + 1, rows + 3}, right{rows, true, rows + 1, rows + 3};
        const int height = int(rows) + 4;
        const GapDensity density = rasterGap(counts, kGapBins, left, right, 5, height);
        for (int column = 0; column < 5; ++column) {
            double sum = 0, selected = 0;
            for (int row = 0; row < height; ++row) {
                sum += density.all[std::size_t(row * 5 + column)];
                selected += density.selected[0][std::size_t(row * 5 + column)];
            }
            EXPECT_NEAR(sum, shown, shown * 1e-6) << rows << " " << column;
            EXPECT_NEAR(selected, focus, shown * 1e-6) << rows << " " << column;
        }
    }
}

TEST(GapRaster, WhereNoSampleIsNothingIsPainted) {
    const GapDensity density{2, 2, {0, 8, 1, 0}, {{0, 0, 1, 0}}};
    GapLook look{.logDensity = false,
                 .most = 8,
                 .unit = 1,
                 .plain = {10, 20, 30},
                 .context = {40, 50, 60},
                 .focus = {{200, 100, 0}}};
    const std::vector<std::uint8_t> pixels = gapPixels(density, look);
    EXPECT_EQ(pixels[3], 0);
    EXPECT_EQ(pixels[15], 0);
    EXPECT_EQ((std::vector<int>{pixels[4], pixels[5], pixels[6]}), (std::vector<int>{40, 50, 60})) << "not selected";
    EXPECT_EQ((std::vector<int>{pixels[8], pixels[9], pixels[10]}), (std::vector<int>{200, 100, 0})) << "all selected";
    EXPECT_GT(pixels[7], pixels[11]) << "denser is more opaque";
    GapDensity plain = density;
    plain.selected.clear();
    look.logDensity = true;
    const std::vector<std::uint8_t> all = gapPixels(plain, look);
    EXPECT_EQ(all[4], 10);
    EXPECT_EQ(all[7], 255) << "the greatest density is opaque";
    EXPECT_GT(int(all[11]), int(255 * 0.12 + 255 * 0.88 / 8)) << "logarithmic densities lift few samples";
}

} // namespace
} // namespace tessera::app
