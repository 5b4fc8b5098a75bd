#include "app/ui/theme.h"
#include "app/ui/ticks.h"
#include "app/views/scatter/scatter_cells.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <limits>

/// What the cells of a scatterplot matrix draw, and what they say under the mouse.
namespace tessera::app {
namespace {

using testing::ElementsAre;

constexpr int kBins = 4;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class ScatterCells : public FedImGui {
protected:
    ScatterCells() : FedImGui({800, 600}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
        for (const char* name : {"a", "b"}) {
            volume::Parameter& parameter = info.parameters.emplace_back();
            parameter.name = name;
            parameter.ranges = {{0, 8}};
        }
        matrix.channels = {0, 1};
        matrix.infos = info.channels();
        matrix.ranges = matrix.whole = {{0, 8}, {0, 8}};
        result.statistics.channels.resize(2);
        for (volume::ChannelStatistics& channel : result.statistics.channels) {
            channel.histogram.range = {0, 8};
            channel.histogram.count = {1, 2, 4, 3};
            channel.histogram.focus = {0, 1, 4, 0};
            channel.all.samples = 10;
        }
        volume::JointHistogram& joint = result.statistics.joint.emplace_back();
        joint.x = 0, joint.y = 1;
        joint.xRange = joint.yRange = {0, 8};
        joint.bins = kBins;
        joint.samples = 40;
        joint.correlation = 0.25;
        for (std::size_t i = 0; i < kBins * kBins; ++i) {
            joint.count.push_back(i);
            joint.focus.push_back(double(i) / 2);
        }
    }
    /// What is said of the bin in a column and a row of a cell, both from the least values.
    std::vector<std::string> said(std::size_t column, std::size_t row, int x, int y, const std::string& colorBy = {}) {
        const PlotFrame frame{{100, 100}, {300, 300}, {0, 8}, {0, 8}};
        mouse = frame.pixel(x * 2 + 1, y * 2 + 1);
        for (int i = 0; i < 3; ++i)
            feedWindow([&] { hoverText(matrix, column, row, frame, result, info, colorBy, "starved"); });
        return drawnWords();
    }

    volume::DatasetInfo info;
    ScatterLayout matrix;
    StatisticsResult result;
};

TEST_F(ScatterCells, ABinSaysItsPlaceAndItsSamples) {
    EXPECT_THAT(said(0, 1, 0, 0), ElementsAre("a 1", "b 1", "0 samples, 0 %"));
    EXPECT_THAT(said(0, 1, 1, 0), ElementsAre("a 3", "b 1", "1 sample, 2.5 %"));
    EXPECT_THAT(said(0, 1, 3, 2), ElementsAre("a 7", "b 5", "11 samples, 28 %"));
    EXPECT_THAT(said(0, 0, 2, 0), ElementsAre("a 5", "4 samples, 40 %"));
    result.brushed = true;
    EXPECT_THAT(said(0, 1, 3, 2), ElementsAre("a 7", "b 5", "11 samples, 28 %", "50 % of them in starved"));
    EXPECT_THAT(said(0, 1, 0, 0), ElementsAre("a 1", "b 1", "0 samples, 0 %")) << "of none no share";
    EXPECT_THAT(said(0, 0, 1, 0), ElementsAre("a 3", "2 samples, 20 %", "50 % of them in starved"));
    result.statistics.joint[0].mean.assign(kBins * kBins, kNan);
    result.statistics.joint[0].mean.back() = 3.5;
    EXPECT_EQ(said(0, 1, 3, 3, "c").back(), "mean c 3.5");
    EXPECT_EQ(said(0, 1, 2, 3, "c").back(), "50 % of them in starved");
}

TEST_F(ScatterCells, AnUpperCellSaysTheCorrelation) {
    EXPECT_THAT(said(1, 0, 0, 0), ElementsAre("a and b", "correlation 0.250", "40 samples have both"));
    result.brushed = true;
    result.statistics.joint[0].focusCorrelation = kNan;
    EXPECT_THAT(said(1, 0, 0, 0),
                ElementsAre("a and b", "correlation 0.250", "in starved not defined", "40 samples have both"));
    result.statistics.level = 1;
    EXPECT_EQ(said(1, 0, 0, 0).back(), "(estimated from a coarser level)");
}

TEST_F(ScatterCells, BarsAreAsHighAsTheirShareOfTheHighest) {
    const PlotFrame frame{{100, 100}, {300, 300}, {0, 8}, {0, 8}};
    const ImU32 focus = IM_COL32(255, 0, 1, 255);
    const auto heights = [&](ImU32 color) {
        std::vector<double> tops(kBins, 0);
        for (const ImVec2 corner : drawnIn(color))
            for (std::size_t i = 0; i < kBins; ++i)
                if (corner.x > 100 + 50 * double(i) + 1 - 25 && corner.x < 100 + 50 * double(i) + 26)
                    tops[i] = std::max(tops[i], double(300 - corner.y)); // the left edge of a bar
        return tops;
    };
    const volume::Histogram& histogram = result.statistics.channels[0].histogram;
    feedWindow([&] { drawHistogram(*ImGui::GetWindowDrawList(), frame, histogram, true, false, focus); });
    const std::vector<double> all = heights(plotColors().bars);
    EXPECT_GT(all[2], 170) << "the highest nearly fills the plot";
    EXPECT_LE(all[2], 200);
    EXPECT_NEAR(all[0], all[2] / 4, 1);
    const std::vector<double> own = heights(focus);
    EXPECT_NEAR(own[1], all[2] / 4, 1);
    EXPECT_NEAR(own[2], all[2], 1) << "all of them in starved";
    feedWindow([&] { drawHistogram(*ImGui::GetWindowDrawList(), frame, histogram, false, true, focus); });
    EXPECT_TRUE(drawnIn(focus).empty());
    EXPECT_NEAR(heights(plotColors().bars)[0], all[2] * std::log(2.0) / std::log(5.0), 1);
}

TEST_F(ScatterCells, MeansHaveTheirColoursInTheirPlaces) {
    volume::JointHistogram& joint = result.statistics.joint[0];
    vis::TransferFunction function;
    function.colormap = "greys";
    const Range range{0, 1};
    std::vector<std::uint8_t> rgba;
    for (std::size_t at = 1; at < kBins * kBins; ++at) { // bin 0 has no sample
        joint.mean.assign(kBins * kBins, kNan);
        joint.mean[at] = 0.75;
        ASSERT_EQ(meanImage(joint, 1, function, range, rgba), kBins);
        const ImU32 expected = meanColor(function, range, 0.75);
        for (std::size_t i = 0; i < kBins * kBins; ++i) {
            const std::size_t pixel = 4 * ((kBins - 1 - i / kBins) * kBins + i % kBins);
            ASSERT_EQ(rgba[pixel + 3] > 0, i == at) << at << ' ' << i;
            if (i == at) {
                ASSERT_EQ(rgba[pixel], expected >> IM_COL32_R_SHIFT & 255);
            }
        }
    }
    joint.mean = std::vector<double>(kBins * kBins, kNan);
    joint.mean[14] = 1, joint.mean[11] = 0; // in one pixel of four bins: 14 and 11 samples
    ASSERT_EQ(meanImage(joint, 2, function, range, rgba), kBins / 2);
    EXPECT_EQ(rgba[4], meanColor(function, range, 14.0 / 25) >> IM_COL32_R_SHIFT & 255) << "weighted by samples";
}

/// Axes of the matrix in so much room, and what was drawn.
struct DrawnAxes {
    MatrixTitles titles;
    std::vector<DrawnText> texts;
    int count(const std::string& text) const {
        return int(std::count_if(texts.begin(), texts.end(), [&](const DrawnText& each) { return each.text == text; }));
    }
};

class ScatterTitles : public ScatterCells {
protected:
    DrawnAxes axesIn(ImVec2 room, double most = 1, bool logCounts = false) {
        DrawnAxes drawn;
        for (int i = 0; i < 3; ++i)
            feedWindow([&] {
                drawn.titles = matrixTitles(matrix, room, most, logCounts);
                const auto n = float(matrix.size());
                matrix.gap = em() * 0.35f;
                matrix.min = {20 + drawn.titles.left, 20};
                matrix.cellX = (room.x - drawn.titles.left) / n;
                matrix.cellY = (room.y - drawn.titles.bottom) / n;
                drawMatrixAxes(*ImGui::GetWindowDrawList(), matrix, drawn.titles);
            });
        drawn.texts = drawnTexts();
        for (const DrawnText& text : drawn.texts) {
            EXPECT_GE(text.min.x, 20 - 1) << text.text;
            EXPECT_LE(text.max.y, 20 + room.y + 1) << text.text;
        }
        return drawn;
    }
    void call(const std::string& first, const std::string& second, const std::string& unit) {
        matrix.infos[0].name = first;
        matrix.infos[1].name = second;
        matrix.infos[0].unit = matrix.infos[1].unit = unit;
    }
};

TEST_F(ScatterTitles, StandWithTheirUnitsOnOneLineWhereTheyHaveRoom) {
    call("H2", "H2O", "mol/m3");
    const DrawnAxes drawn = axesIn({700, 500});
    EXPECT_EQ(drawn.count("H2 [mol/m³]"), 1);
    EXPECT_EQ(drawn.count("H2O [mol/m³]"), 2);
    EXPECT_LT(drawn.titles.left, 4 * em());
}

TEST_F(ScatterTitles, KeepTheirUnitsOnASecondLineOrAcrossTheirCells) {
    call("H2", "H2O", "mol/m3");
    DrawnAxes drawn = axesIn({190, 230});
    EXPECT_EQ(drawn.titles.below, TitleWay::TwoLines);
    EXPECT_EQ(drawn.count("H2"), 1);
    EXPECT_EQ(drawn.count("H2O"), 2);
    EXPECT_EQ(drawn.count("[mol/m³]"), 3);
    drawn = axesIn({600, 140});
    EXPECT_EQ(drawn.titles.beside, TitleWay::Across);
    EXPECT_EQ(drawn.count("H2O"), 1);
    EXPECT_EQ(drawn.count("[mol/m³]"), 1);
}

TEST_F(ScatterTitles, AreLeftOutWhereTheyWouldLeaveNoPlots) {
    call("H2", "H2O", "mol/m3");
    for (const ImVec2 room : {ImVec2{130, 110}, ImVec2{150, 100}, ImVec2{110, 200}}) {
        const DrawnAxes drawn = axesIn(room);
        const bool narrow = matrix.cellX < em() * 2.6f || matrix.cellY < em() * 1.9f;
        EXPECT_FALSE(narrow) << room.x << ' ' << room.y;
        EXPECT_EQ(drawn.titles.shown, drawn.count("[mol/m³]") + drawn.count("H2O [mol/m³]") > 0);
    }
    EXPECT_FALSE(axesIn({110, 200}).titles.shown);
    EXPECT_TRUE(axesIn({190, 230}).titles.shown);
}

TEST_F(ScatterTitles, CutOffLongNamesAndLeaveMostOfTheRoomToThePlots) {
    const std::string name = "mean temperature of the cathode side of the channel";
    call(name, name, "K");
    const DrawnAxes drawn = axesIn({400, 360});
    EXPECT_EQ(drawn.titles.below, TitleWay::Across);
    EXPECT_EQ(drawn.titles.beside, TitleWay::Across);
    EXPECT_LT(drawn.titles.left, 400 * 0.35f);
    EXPECT_LT(drawn.titles.bottom, 360 * 0.4f);
    int upright = 0, level = 0, units = 0;
    for (const DrawnText& text : drawn.texts) {
        const bool turned = text.max.x - text.min.x < text.max.y - text.min.y;
        upright += turned && text.text.starts_with("mean") && text.text.ends_with("... [K]");
        level += !turned && text.text.starts_with("mean") && text.text.ends_with("...");
        units += text.text == "[K]";
    }
    EXPECT_EQ(upright, 2);
    EXPECT_EQ(level, 1);
    EXPECT_EQ(units, 1);
    for (const DrawnText& text : drawn.texts)
        if (text.text.starts_with("mean")) mouse = text.middle();
    for (int i = 0; i < 3; ++i) feedWindow([&] { drawMatrixAxes(*ImGui::GetWindowDrawList(), matrix, drawn.titles); });
    const std::string said = drawnWords().back();
    EXPECT_TRUE(said == name || said == name + " [K]") << said;
}

TEST_F(ScatterTitles, ATitleThatIsWiderThanItsColumnStandsUprightBelowItsNumbers) {
    call("mean temperature", "b", "");
    const DrawnAxes drawn = axesIn({220, 700});
    ASSERT_EQ(drawn.titles.below, TitleWay::Across);
    const PlotFrame last = matrix.cell(0, 1);
    int found = 0;
    for (const DrawnText& text : drawn.texts) {
        if (text.text != "mean temperature" || text.max.x - text.min.x > text.max.y - text.min.y) continue;
        ++found;
        EXPECT_NEAR(text.middle().x, (last.min.x + last.max.x) / 2, 3);
        EXPECT_GT(text.min.y, last.max.y + em()) << "below the numbers";
        EXPECT_LT(text.max.y, last.max.y + drawn.titles.bottom + 2) << "within the room that was asked for";
    }
    EXPECT_EQ(found, 1);
}

TEST_F(ScatterTitles, NumbersOfAxesAreReadWithTheOffsetWhateverWayTheTitlesStand) {
    call("p", "pressure of the air", "Pa");
    matrix.ranges = matrix.whole = {{1000000, 1000016}, {1000000, 1000016}};
    for (const ImVec2 room : {ImVec2{800, 560}, ImVec2{400, 300}}) {
        int notes = 0;
        for (const DrawnText& text : axesIn(room).texts) notes += text.text.find("+ 1000000") != std::string::npos;
        EXPECT_EQ(notes, 3) << room.x;
    }
}

TEST_F(ScatterTitles, ALoneHistogramHasAnAxisOfCounts) {
    matrix.channels = {0};
    matrix.infos.resize(1);
    matrix.ranges = matrix.whole = {{0, 8}};
    DrawnAxes drawn = axesIn({400, 300}, 4000);
    EXPECT_EQ(drawn.count("samples"), 1);
    EXPECT_EQ(drawn.count("2000"), 1);
    const PlotFrame cell = matrix.cell(0, 0);
    const float high = cell.max.y - float(2000 / drawn.titles.counts.hi) * cell.height();
    for (const DrawnText& text : drawn.texts) {
        if (text.text != "2000") continue;
        EXPECT_NEAR(text.middle().y, high, em() * 0.5f);
    }
    EXPECT_NEAR(4000 / drawn.titles.counts.hi, kHighestBar, 1e-9) << "as high as its bar";
    drawn = axesIn({400, 300}, 9999, true);
    EXPECT_EQ(drawn.count("log10(1 + samples)"), 1);
    EXPECT_NEAR(4 / drawn.titles.counts.hi, kHighestBar, 1e-9);
}

} // namespace
} // namespace tessera::app
