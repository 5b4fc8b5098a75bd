#include "app/edits/compare.h"
#include "app/views/compare/compare_layout.h"
#include "app/views/compare/compare_panes.h"
#include "tests/app/formula_cell.h"
#include "tests/app/hands_fixture.h"
#include "tests/app/views_fixture.h"

#include <gmock/gmock.h>

/// Views other than the 3D scene, once for each variant, and where their pictures and legends are.
namespace tessera::app {
namespace {

using testing::HasSubstr;

std::vector<CompareVariant> atTimes(const char* first, const char* second) {
    return {{"first", {{"/time", first}}}, {"second", {{"/time", second}}}};
}

class ComparedSlices : public Hands {
protected:
    void showSlices(const std::vector<CompareVariant>& variants) {
        CompareView compare;
        compare.shows = "slices";
        compare.showTable = false;
        compare.variants = variants;
        show(compare, {1000, 560}, [](Session& edited) {
            SlicesView slices;
            slices.channel = "T";
            slices.showReadout = false;
            edited.views["slices"] = slices;
        });
    }
};

TEST_F(ComparedSlices, AllFollowTheCrossHairThatAHandMovesInOne) {
    showSlices(atTimes("0", "2"));
    const std::vector<ImRect> planes = pictures();
    ASSERT_EQ(planes.size(), 6u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(planes[i].GetWidth(), planes[i + 3].GetWidth());
        EXPECT_EQ(planes[i].Min.y, planes[i + 3].Min.y);
        EXPECT_LT(planes[i].Max.x, 500) << "the first variant is on the left";
        EXPECT_GT(planes[i + 3].Min.x, 500);
    }
    const Session before = session();
    click(within(planes[3], 0.3, 0.6)); // x to the right, y upwards
    EXPECT_NEAR(session().cursor.x, across(planes[3], extent(0), mouse), 1e-9);
    EXPECT_NEAR(session().cursor.y, upwards(planes[3], extent(1), mouse), 1e-9);
    EXPECT_EQ(session().cursor.z, before.cursor.z);
    EXPECT_EQ(session().time, before.time) << "the time of a variant stays its own";
    EXPECT_EQ(view<CompareView>().variants, atTimes("0", "2"));
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(ComparedSlices, AClickOnACaptionOpensTheMenuOfItsVariant) {
    showSlices(atTimes("0", "2"));
    const std::vector<ImRect> planes = pictures();
    ASSERT_EQ(planes.size(), 6u);
    click(item(window(), {"pane", 1, "caption"}).GetCenter());
    ASSERT_TRUE(popup());
    click(item(popup(), {"Remove"}).GetCenter());
    settle();
    ASSERT_EQ(view<CompareView>().variants.size(), 1u);
    EXPECT_EQ(view<CompareView>().variants[0].name, "first");
    EXPECT_EQ(pictures().size(), 3u);
}

class ComparedText : public ViewsTest {
protected:
    std::string statisticsOf(const std::vector<CompareVariant>& variants) {
        CompareView compare;
        compare.shows = "statistics";
        compare.variants = variants;
        session.views["statistics"] = StatisticsView{};
        const auto body = [&] { draw("compare", compare, drawCompareView, {1200, 760}); };
        for (int i = 0; i < 3 || (busy && i < 200); ++i) {
            jobs.wait();
            frame(body);
        }
        return said(body);
    }
};

TEST_F(ComparedText, StatisticsAreThoseOfEachVariant) {
    show(volume::makeMemorySource(formula::makeCell(), {}));
    const formula::Place corner{7, 6, 8}; // the greatest T
    const auto greatest = [&](int time) {
        char text[32];
        std::snprintf(text, sizeof text, "%.2f", double(*formula::value("T", corner, time)));
        return std::string(text);
    };
    const std::string text = statisticsOf(atTimes("0", "2"));
    const auto first = text.find(greatest(0)), second = text.find(greatest(2));
    ASSERT_NE(first, std::string::npos) << text;
    ASSERT_NE(second, std::string::npos) << text;
    EXPECT_LT(first, second);
    EXPECT_THAT(statisticsOf(atTimes("0", "0")), testing::Not(HasSubstr(greatest(2))));
}

TEST_F(ComparedText, NumbersOfAPackedVariantAreThoseOfItsArchive) {
    DataRef data;
    data.model = "fuel-cell";
    data.settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 2}};
    std::vector<std::string> problems;
    show(openSource(data, problems));
    session.data = data;
    const std::string exact = statisticsOf({{"a", {}}, {"b", {}}});
    const auto packed = [&](const char* options) {
        return statisticsOf({{"a", {}}, {"b", {{"/data/packed", options}}}});
    };
    EXPECT_NE(packed(R"({"lossless": false, "maxError": 0.1})"), exact);
    EXPECT_THAT(messages, testing::IsEmpty());
}

TEST(ComparedViews, AreThoseThatShowData) {
    for (const ViewState& view : {ViewState(SlicesView{}), ViewState(HistogramView{}), ViewState(ScatterMatrixView{}),
                                  ViewState(StatisticsView{}), ViewState(TesseractView{})})
        EXPECT_TRUE(canBeCompared(view)) << traitsOf(view).title;
    for (const ViewState& view : {ViewState(CompareView{}), ViewState(VolumeView{}), ViewState(LayersView{}),
                                  ViewState(TransferView{}), ViewState(TimelineView{}), ViewState(LogView{})})
        EXPECT_FALSE(canBeCompared(view)) << traitsOf(view).title;
    CompareView compare;
    compare.mode = CompareMode::Swipe;
    EXPECT_EQ(modeOf(compare), CompareMode::Swipe);
    compare.shows = "slices";
    EXPECT_EQ(modeOf(compare), CompareMode::Grid);
    compare.mode = CompareMode::Blink;
    EXPECT_EQ(modeOf(compare), CompareMode::Blink);
}

class CompareLayouts : public FedImGui {
protected:
    CompareLayouts() : FedImGui({800, 600}) {}
    static LegendEntry bar(const char* title) {
        LegendEntry entry;
        entry.title = title;
        entry.range = entry.data = {0, 1};
        return entry;
    }
    CompareLayout layout(const CompareLegends& legends, int count, ImVec2 area = {700, 500}) {
        CompareLayout made;
        feedWindow([&] { made = compareLayout(legends, count, {10, 20}, area); });
        return made;
    }
};

/// Whether every rectangle lies in the area and none covers another.
void expectApart(const CompareLayout& layout) {
    std::vector<ImRect> all;
    for (const auto* boxes : {&layout.pictures, &layout.places})
        for (const PictureBox& box : *boxes) all.emplace_back(box.min, box.max());
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_TRUE(ImRect(10, 20, 710, 520).Contains(all[i])) << i;
        for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(all[i].Overlaps(all[k])) << i << " and " << k;
    }
}

TEST_F(CompareLayouts, EqualLegendsStandOnceBelowAll) {
    const CompareLayout made = layout({{bar("T")}, {bar("T")}, {bar("T")}}, 3);
    ASSERT_EQ(made.pictures.size(), 3u);
    ASSERT_EQ(made.places.size(), 1u);
    EXPECT_EQ(made.legends.size(), 1u);
    expectApart(made);
    for (const PictureBox& picture : made.pictures) EXPECT_LE(picture.max().y, made.places[0].min.y);
    EXPECT_NEAR(made.places[0].max().y, 520, 1);
}

TEST_F(CompareLayouts, DifferentLegendsStandEachBelowItsPicture) {
    const CompareLayout made = layout({{bar("T")}, {bar("O2")}, {bar("T")}}, 3);
    ASSERT_EQ(made.places.size(), 3u);
    ASSERT_EQ(made.legends.size(), 3u);
    expectApart(made);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(made.places[i].min.x, made.pictures[i].min.x);
        EXPECT_EQ(made.places[i].min.y, made.pictures[i].max().y);
        EXPECT_EQ(made.pictures[i].size.y, made.pictures[0].size.y);
    }
}

// Of two files with one function; that of their difference has its own.
TEST_F(CompareLayouts, BarsOfTwoFilesAreOneBelowBoth) {
    LegendEntry other = bar("T (other)");
    other.data = {0.2, 3};
    const CompareLayout made = layout({{bar("T")}, {other}, {bar("T minus other")}}, 3, {700, 200});
    ASSERT_EQ(made.places.size(), 2u);
    ASSERT_EQ(made.legends.size(), 2u);
    expectApart(made);
    EXPECT_EQ(made.legends[0][0].title, "T");
    EXPECT_EQ(made.legends[0][0].data, (Range{0, 3}));
    EXPECT_EQ(made.places[0].min.x, made.pictures[0].min.x);
    EXPECT_GT(made.places[0].max().x, made.pictures[1].min.x + made.pictures[1].size.x / 2);
    EXPECT_EQ(made.places[1].min.x, made.pictures[2].min.x);
    other.range = {0, 3};
    EXPECT_EQ(layout({{bar("T")}, {other}}, 2).legends.size(), 2u) << "other colours for a value";
    EXPECT_EQ(layout({{bar("T")}, {bar("T (other)")}}, 2).legends.size(), 1u);
}

TEST_F(CompareLayouts, LegendsOfOnePictureStandBesideEachOther) {
    const CompareLayout made = layout({{bar("T")}, {bar("O2")}}, 1);
    ASSERT_EQ(made.pictures.size(), 1u);
    ASSERT_EQ(made.places.size(), 2u);
    expectApart(made);
    EXPECT_EQ(made.places[0].min.y, made.places[1].min.y);
}

TEST_F(CompareLayouts, WithoutLegendsPicturesHaveAllTheRoom) {
    const CompareLayout made = layout({}, 2);
    EXPECT_TRUE(made.places.empty());
    expectApart(made);
    float lowest = 0;
    for (const PictureBox& picture : made.pictures) lowest = std::max(lowest, picture.max().y);
    EXPECT_GT(lowest, 515);
}

TEST_F(CompareLayouts, LegendsLeaveHalfOfEachPicture) {
    const std::vector<LegendEntry> many(12, bar("T"));
    std::vector<LegendEntry> others = many;
    others[0] = bar("O2");
    const CompareLayout made = layout({many, others}, 2, {780, 180});
    ASSERT_EQ(made.places.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_GE(made.pictures[i].size.y, made.places[i].size.y - em());
}

} // namespace
} // namespace tessera::app
