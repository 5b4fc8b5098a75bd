#include "app/queries/statistics_query.h"

#include "app/tools/brush_edit.h"
#include "tests/app/fed_imgui.h"

#include <cmath>

namespace tessera::app {
namespace {

volume::DatasetInfo bytesAndFloats() {
    volume::DatasetInfo info;
    info.lattice.size = glm::ivec3(8);
    info.bounds = {glm::dvec3(0), glm::dvec3(7)};
    info.parameters.resize(2);
    info.parameters[0].name = "v";
    info.parameters[0].type = volume::ScalarType::U8;
    info.parameters[1].name = "w";
    for (volume::Parameter& parameter : info.parameters) parameter.ranges = {{0, 255}};
    return info;
}

TEST(HistogramBins, OfWholeNumbersHoldEquallyMany) {
    const volume::DatasetInfo info = bytesAndFloats();
    for (const int most : {1, 7, 64, 192, 255, 256, 1000})
        for (const Range range : {Range{0, 255}, Range{-7.65, 262.65}, Range{3, 3}, Range{10.2, 20.7}}) {
            const HistogramBins bins = histogramBins(info, 0, range, most);
            const double each = (bins.range.hi - bins.range.lo) / bins.count;
            EXPECT_LE(bins.count, most);
            EXPECT_EQ(each, std::round(each)) << most;
            EXPECT_EQ(std::abs(std::fmod(bins.range.lo, 1.0)), 0.5) << "no number lies between two bins";
            EXPECT_LE(bins.range.lo, std::ceil(range.lo));
            EXPECT_GE(bins.range.hi, std::floor(range.hi));
            EXPECT_EQ(histogramBins(info, 1, range, most).count, most);
            EXPECT_EQ(histogramBins(info, 1, range, most).range, range);
        }
    EXPECT_EQ(histogramBins(info, 0, {0, 255}, 192).count, 128);
}

TEST(HistogramBins, OfScaledIntegersAreNoTwoBars) {
    volume::DatasetInfo info = bytesAndFloats();
    info.parameters[0].type = volume::ScalarType::U16; // stored from 0 to 65535
    info.parameters[0].ranges = {{0, 1}};
    const HistogramBins bins = histogramBins(info, 0, {-0.02, 1.02}, 192);
    EXPECT_EQ(bins.count, 192);
    EXPECT_EQ(bins.range, (Range{-0.02, 1.02}));
}

vis::Brush brush(const char* channel, glm::vec3 color) {
    vis::Brush out;
    out.color = color;
    out.region = vis::RangeRegion{{{.channel = channel, .lo = 1, .hi = 2, .soft = 0}}};
    return out;
}

// What a lens marks is selected in plots and tables while nothing is brushed; brushes have the word.
TEST(BrushedQuery, BrushesHaveTheWordOverLensesThatMark) {
    const volume::DatasetInfo info = bytesAndFloats();
    Session session;
    const auto query = [&] { return brushedQuery(session, info, {0}, {{0, 255}}, 8, false); };
    EXPECT_TRUE(query().selection.brushes.empty());

    session.lenses.resize(1);
    session.lenses[0].marks = false;
    EXPECT_TRUE(query().selection.brushes.empty());
    session.lenses[0].marks = true;
    ASSERT_EQ(query().selection.brushes.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<vis::LensRegion>(query().selection.brushes[0].region));
    EXPECT_EQ(query().lenses.lenses.size(), 1u);
    session.lenses[0].enabled = false;
    EXPECT_TRUE(query().selection.brushes.empty());
    session.lenses[0].enabled = true;

    session.selection.brushes = {brush("w", {1, 0, 0})};
    ASSERT_EQ(query().selection.brushes.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<vis::RangeRegion>(query().selection.brushes[0].region));
    EXPECT_TRUE(query().lenses.lenses.empty());
    EXPECT_EQ(query().channels, (std::vector<int>{0, 1})) << "what a brush names is read as well";
    session.selection.brushes[0].enabled = false;
    ASSERT_EQ(query().selection.brushes.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<vis::LensRegion>(query().selection.brushes[0].region));
}

class FocusColor : public FedImGui {
protected:
    FocusColor() : FedImGui({300, 200}) {}
};

// Plots show the focus in the colour of the one brush, or lens, that makes it; of several in the theme's.
TEST_F(FocusColor, IsThatOfTheOnlyBrush) {
    Session session;
    const ImU32 common = focusColor(session);
    session.lenses.resize(1);
    session.lenses[0].marks = true;
    session.lenses[0].color = {0, 0, 1};
    const ImU32 lens = focusColor(session);
    EXPECT_NE(lens, common);

    session.selection.brushes = {brush("v", {1, 0, 0})};
    const ImU32 red = focusColor(session);
    EXPECT_NE(red, common);
    EXPECT_NE(red, lens);
    session.selection.brushes.push_back(brush("w", {0, 1, 0}));
    EXPECT_EQ(focusColor(session), common) << "two select together";
    session.selection.brushes[1].combine = vis::BrushCombine::Minus;
    EXPECT_EQ(focusColor(session), red) << "one that takes away makes no focus";
    session.selection.brushes[0].enabled = false;
    session.selection.brushes[1].enabled = false;
    EXPECT_EQ(focusColor(session), lens);
}

} // namespace
} // namespace tessera::app
