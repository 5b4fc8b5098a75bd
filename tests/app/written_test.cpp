#include "app/command/command.h"
#include "app/described/describe_json.h"
#include "app/edits/show_parameter.h"
#include "app/history/edit_titles.h"
#include "app/history/history.h"
#include "app/pane/plot.h"
#include "app/views/scatter/scatter_cells.h"
#include "app/views/tesseract/tesseract_wire.h"
#include "app/views/transfer/region_edit.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <chrono>
#include <gmock/gmock.h>
#include <thread>

/// Words and marks of plots, lists and files, read back as they are drawn or written.
namespace tessera::app {
namespace {

using testing::Contains;
using testing::ElementsAre;

class Drawn : public FedImGui {
protected:
    Drawn() : FedImGui({600, 400}) {}
    /// Texts of a frame in whose window `body` draws on a list.
    template <class Body> std::vector<DrawnText> texts(Body&& body) {
        for (int i = 0; i < 2; ++i) feedWindow([&] { body(*ImGui::GetWindowDrawList()); });
        return drawnTexts();
    }
};

TEST_F(Drawn, TextsAreReadBack) {
    const auto read = texts([](ImDrawList& draw) {
        draw.AddText({100, 50}, IM_COL32_WHITE, "two words, 1.5 K");
        draw.AddText({100, 90}, IM_COL32_WHITE, "below");
        addTextUpwards(draw, {60, 200}, IM_COL32_WHITE, "up");
    });
    ASSERT_EQ(drawnWords(), (std::vector<std::string>{"two words, 1.5 K", "below", "up"}));
    EXPECT_NEAR(read[0].min.x, 100, 2);
    EXPECT_NEAR(read[2].middle().y, 200, 3);
}

TEST_F(Drawn, NumbersOfAnAxisLeaveRoomForATitleBesideThem) {
    const PlotFrame frame{{100, 40}, {500, 300}, {0, 10}, {0, 1}};
    const auto axis = [&](bool inlineTitle) {
        return texts([&](ImDrawList& draw) {
            drawAxis(draw, frame, AxisSide::Bottom, "a rather long title", "K", 100, 500, {.inlineTitle = inlineTitle});
        });
    };
    auto read = axis(true);
    ASSERT_GE(read.size(), 3u);
    const DrawnText title = read.back();
    EXPECT_EQ(title.text, "a rather long title [K]");
    read.pop_back();
    for (const DrawnText& number : read) EXPECT_LT(number.max.x, title.min.x) << number.text;
    axis(false);
    EXPECT_THAT(drawnWords(), Contains("0"));
    EXPECT_THAT(drawnWords(), Contains("10")) << "below the numbers it takes none of their room";
}

TEST_F(Drawn, ATextIsCutToItsRoom) {
    feedWindow([] {
        EXPECT_EQ(fitText("temperature", 500), "temperature");
        for (float width = 120; width > -1; width -= 3) {
            const std::string text = fitText("temperature \u00b5\u00b5\u00b5", width);
            EXPECT_LE(ImGui::CalcTextSize(text.c_str()).x, std::max(0.0f, width)) << text;
            EXPECT_TRUE(text.empty() || text.ends_with("...") || text.ends_with("\u00b5")) << text;
        }
        EXPECT_TRUE(fitText("temperature", 60).ends_with("..."));
        EXPECT_EQ(fitText("temperature", 2), "");
    });
}

TEST_F(Drawn, TheMouseShowsWhatItWouldDoToARegion) {
    std::vector<vis::TransferRegion> regions(1);
    regions[0].centre = {0.5f, 0.5f};
    regions[0].size = {0.4f, 0.4f};
    RegionDrag drag;
    const PlotFrame plane{{50, 50}, {450, 350}, {0, 1}, {0, 1}};
    const auto cursorAt = [&](ImVec2 at) {
        mouse = at;
        texts([&](ImDrawList&) {
            surface(plane.min, plane.max);
            editRegions(drag, regions, plane);
        });
        return ImGui::GetMouseCursor();
    };
    EXPECT_EQ(cursorAt({250, 200}), ImGuiMouseCursor_Hand);
    EXPECT_EQ(cursorAt({170, 200}), ImGuiMouseCursor_ResizeEW);
    EXPECT_EQ(cursorAt({250, 140}), ImGuiMouseCursor_ResizeNS);
    EXPECT_EQ(cursorAt({170, 140}), ImGuiMouseCursor_ResizeAll);
    EXPECT_EQ(cursorAt({80, 70}), ImGuiMouseCursor_Arrow);
}

// A lonely bin and the corners of a crowd are dots; within it and where there are many samples none is needed.
TEST_F(Drawn, OutliersAreBinsWithFewSamplesAndEmptyOnesAround) {
    volume::JointHistogram joint;
    joint.bins = 6;
    joint.xRange = joint.yRange = {0, 6};
    joint.count.assign(36, 0);
    const auto bin = [](int x, int y) { return std::size_t(6 * y + x); };
    joint.count[bin(1, 1)] = 1;
    joint.count[bin(1, 4)] = 1000;
    for (int y = 3; y < 6; ++y)
        for (int x = 3; x < 6; ++x) joint.count[bin(x, y)] = 2;
    const PlotFrame frame{{50, 50}, {350, 350}, joint.xRange, joint.yRange};
    std::vector<std::size_t> dots;
    texts([&](ImDrawList& draw) {
        dots.clear();
        drawOutliers(draw, frame, joint, [&](std::size_t of) {
            dots.push_back(of);
            return IM_COL32(1, 2, 3, 255);
        });
    });
    EXPECT_THAT(dots, ElementsAre(bin(1, 1), bin(3, 3), bin(5, 3), bin(3, 5), bin(5, 5)));
    const ImVec2 at = frame.pixel(1.5, 1.5);
    EXPECT_TRUE(std::ranges::any_of(drawnIn(IM_COL32(1, 2, 3, 255)), [&](const ImVec2& corner) {
        return std::hypot(corner.x - at.x, corner.y - at.y) < em();
    }));
}

TEST_F(Drawn, TheCellOfNowLiesAtItsShareOfTheFourthAxis) {
    TesseractFrame frame;
    frame.min = {100, 50};
    frame.max = {500, 350};
    for (const double share : {0.0, 0.25, 0.9}) {
        const auto read = texts([&](ImDrawList& draw) { drawNowCell(draw, frame, share, "t = 3 s", {}); });
        ASSERT_EQ(read.size(), 1u);
        EXPECT_EQ(read[0].text, "t = 3 s");
        float left = 1e9f, right = -1e9f;
        for (int corner = 0; corner < 8; ++corner) {
            vis::PointN at = vis::cornerOf(corner, frame.half, 3);
            at[3] = frame.half[3] * (2 * share - 1);
            const float x = frame.pixel(frame.project(at).at).x;
            left = std::min(left, x), right = std::max(right, x);
        }
        float drawnLeft = 1e9f, drawnRight = -1e9f;
        for (const ImVec2& corner : drawnIn(plotColors().backdrop)) {
            if (corner.y > read[0].max.y + em()) // lines, not what lies behind the text
                drawnLeft = std::min(drawnLeft, corner.x), drawnRight = std::max(drawnRight, corner.x);
        }
        EXPECT_NEAR(drawnLeft, left, 4) << share;
        EXPECT_NEAR(drawnRight, right, 4) << share;
    }
}

TEST(Layers, NamesMadeOfTheParameterFollowIt) {
    const auto followed = [](std::string name, const std::string& before, const std::string& now) {
        followChannel(name, before, now);
        return name;
    };
    EXPECT_EQ(followed("O2", "O2", "T"), "T");
    EXPECT_EQ(followed("O2 slice", "O2", "T"), "T slice");
    EXPECT_EQ(followed("Volume of O2", "O2", "T"), "Volume of T");
    EXPECT_EQ(followed("O2x of air", "O2", "T"), "O2x of air");
    EXPECT_EQ(followed("mine", "", "T"), "mine");
    EXPECT_EQ(followed("O2 slice", "O2", "O2"), "O2 slice");
}

TEST(HistoryWords, SayWhatAStepChanged) {
    const auto said = [](std::initializer_list<const char*> paths, const char* operation = "replace") {
        Json patch = Json::array();
        for (const char* path : paths) patch.push_back({{"op", operation}, {"path", path}});
        return describePatch(patch);
    };
    EXPECT_EQ(said({}), "nothing");
    EXPECT_EQ(said({"/dock/root/ratio"}), "arrangement of panes");
    EXPECT_EQ(said({"/camera/zoom", "/camera/orientation"}), "camera");
    EXPECT_EQ(said({"/camera/zoom", "/time"}), "camera and time");
    EXPECT_EQ(said({"/cursor/0", "/cursor/1", "/layers/0", "/time"}), "cross-hair, layers and time");
    EXPECT_EQ(said({"/cursor/0", "/camera/zoom", "/layers/0", "/time"}), "several changes");
    EXPECT_EQ(said({"/time"}), "time");
    EXPECT_EQ(said({"/layers/1/technique/opacity"}), "layers 2: opacity");
    EXPECT_EQ(said({"/layers/2"}, "add"), "layers 3 added");
    EXPECT_EQ(said({"/layers/2"}, "remove"), "layers 3 removed");
    EXPECT_EQ(said({"/transfer/O2/colormap"}), "transfer O2: colour map");
    EXPECT_EQ(said({"/layers/0/technique/channel"}), "layers 1: parameter");
    EXPECT_EQ(said({"/transfer/channel/range"}), "transfer channel: range") << "names of parameters stay";
}

TEST(HistoryWords, CallThingsByTheirNames) {
    Session before, after;
    before.layers = {{"mine", true, vis::VolumeLayer{.channel = "T"}}, {"", true, vis::IsoLayer{.channel = "O2"}}};
    before.lenses = {{.name = "lens"}, {.name = "inlet"}};
    before.selection.brushes.resize(1);
    before.selection.brushes[0].name = "hot";
    before.views["scatterMatrix-2"] = ScatterMatrixView{};
    after = before;
    const auto said = [&](const char* path, const char* operation = "replace") {
        return editTitle(Json::array({{{"op", operation}, {"path", path}}}), before, after);
    };
    EXPECT_EQ(said("/layers/0/technique/density"), "mine: density");
    EXPECT_EQ(said("/layers/1/technique/value"), "O2 surface: value");
    EXPECT_EQ(said("/layers/1/technique/color/0"), "O2 surface: colour");
    EXPECT_EQ(said("/layers/1", "remove"), "O2 surface removed");
    EXPECT_EQ(said("/lenses/0/center/2"), "lens: centre");
    EXPECT_EQ(said("/lenses/1", "add"), "lens inlet added");
    EXPECT_EQ(said("/selection/brushes/0/region/intervals/1/lo"), "brush hot: region");
    EXPECT_EQ(said("/selection/brushes/0", "add"), "brush hot added");
    EXPECT_EQ(said("/views/scatterMatrix-2/bins"), "Scatterplots 2: bins");
    EXPECT_EQ(said("/views/scatterMatrix-2", "remove"), "Scatterplots 2 closed");
    EXPECT_EQ(said("/transfer/O2/colormap"), "transfer function of O2: colour map");
    EXPECT_EQ(said("/transfer/O2/opacity/1/0"), "transfer function of O2: opacity");
    EXPECT_EQ(said("/stretch/2"), "proportions");
    EXPECT_EQ(said("/time"), "time");
    const auto both = [&](const char* one, const char* other) {
        return editTitle(Json::array({{{"op", "replace"}, {"path", one}}, {{"op", "replace"}, {"path", other}}}),
                         before, after);
    };
    EXPECT_EQ(both("/transfer/O2/range/0", "/transfer/O2/range/1"), "transfer function of O2: range");
    EXPECT_EQ(both("/transfer/O2/range/0", "/transfer/T/range/0"), "transfer") << "of several";
    EXPECT_EQ(both("/lenses/0/center/2", "/lenses/1/center/2"), "lenses");
    const auto withPanes = [&](const char* operation, const Session& then) {
        return editTitle(Json::array({{{"op", "replace"}, {"path", "/dock/root/ratio"}},
                                      {{"op", operation}, {"path", "/views/scatterMatrix-2"}},
                                      {{"op", operation}, {"path", "/dock/root/tabs/1"}}}),
                         before, then);
    };
    EXPECT_EQ(withPanes("add", after), "Scatterplots 2 opened") << "panes move where one is opened";
    EXPECT_EQ(withPanes("remove", {}), "Scatterplots 2 closed");
    after.layers.pop_back();
    EXPECT_EQ(said("/layers/1", "remove"), "O2 surface removed") << "as it was called";
}

TEST(JsonText, ShortListsStandOnOneLine) {
    const Json json = {{"a", {1, {{"d", 2}}}}, {"b", {1, 2, 3}}, {"c", {{1, 2}, {3, 4}}}};
    EXPECT_EQ(printJson(json), R"({
  "a": [
    1,
    {
      "d": 2
    }
  ],
  "b": [1, 2, 3],
  "c": [[1, 2], [3, 4]]
}
)");
}

TEST(TimeLeft, IsToldOnceThereIsSomethingToGoBy) {
    using Clock = std::chrono::steady_clock;
    const auto since = [](Clock::time_point then) {
        return std::chrono::duration<double>(Clock::now() - then).count();
    };
    TimeLeft left;
    const auto before = Clock::now();
    EXPECT_FALSE(left.after(0.5)) << "it has just begun";
    const auto begun = Clock::now();
    std::this_thread::sleep_for(std::chrono::milliseconds(1010));
    EXPECT_FALSE(left.after(0.001));
    const double least = since(begun), half = left.after(0.5).value();
    EXPECT_GE(half, least) << "as long again";
    EXPECT_LE(half, since(before));
    EXPECT_GT(left.after(0.25).value(), 2.5);
    EXPECT_FALSE(left.after(1)) << "nothing is left";
}

} // namespace
} // namespace tessera::app
