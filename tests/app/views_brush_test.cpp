#include "app/tools/brush_edit.h"
#include "app/tools/brush_list.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include "app/tools/lens_list.h"
#include "volume/field/dataset.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace tessera::app {
namespace {

/// A colour in OKLab (B. Ottosson, 2020) as somebody sees it; `blindness` in linear sRGB, identity for none.
glm::dvec3 seen(glm::vec3 color, const glm::dmat3& blindness) {
    glm::dvec3 linear;
    for (int i = 0; i < 3; ++i) {
        const auto c = double(color[i]);
        linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    }
    linear = glm::clamp(blindness * linear, 0.0, 1.0);
    const glm::dmat3 toCones =
        glm::transpose(glm::dmat3{0.4122214708, 0.5363325363, 0.0514459929, 0.2119034982, 0.6806995451, 0.1073969566,
                                  0.0883024619, 0.2817188376, 0.6299787005});
    const glm::dmat3 toLab =
        glm::transpose(glm::dmat3{0.2104542553, 0.7936177850, -0.0040720468, 1.9779984951, -2.4285922050, 0.4505937099,
                                  0.0259040371, 0.7827717662, -0.8086757660});
    const glm::dvec3 cones = toCones * linear;
    return toLab * glm::dvec3(std::cbrt(cones.x), std::cbrt(cones.y), std::cbrt(cones.z));
}

/// Nothing, and protanopia, deuteranopia and tritanopia after Machado, Oliveira and Fernandes (2009), severity 1.
const std::array<glm::dmat3, 4>& eyes() {
    static const std::array<glm::dmat3, 4> all{
        glm::dmat3(1),
        glm::transpose(
            glm::dmat3{0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998}),
        glm::transpose(
            glm::dmat3{0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881}),
        glm::transpose(
            glm::dmat3{1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900})};
    return all;
}

TEST(BrushColors, AreToldApartByEveryEyeOnDarkAndLightGround) {
    vis::Selection selection;
    std::vector<glm::vec3> colors;
    for (int i = 0; i < 8; ++i) {
        selection.brushes.push_back({});
        selection.brushes.back().color = {};
        const glm::vec3 color = newBrushColor(selection);
        selection.brushes.back().color = color;
        colors.push_back(color);
    }
    volume::DatasetInfo info;
    info.bounds = {{0, 0, 0}, {1, 1, 1}};
    Session session;
    for (int i = 0; i < 4; ++i) addLens(session, info, vis::LensEffect::Replace);
    EXPECT_EQ(colors.front(), vis::Brush{}.color) << "a lone brush";
    for (const float ground : {1.0f, 0.7f}) { // as drawn on dark and on light ground
        const double share = ground < 1 ? 0.75 : 1;
        for (const glm::dmat3& eye : eyes()) {
            for (std::size_t a = 0; a < colors.size(); ++a) {
                const glm::dvec3 one = seen(colors[a] * ground, eye);
                for (std::size_t b = 0; b < a; ++b)
                    EXPECT_GT(glm::distance(one, seen(colors[b] * ground, eye)), 0.13 * share) << a << " and " << b;
                for (const vis::Lens& lens : session.lenses)
                    EXPECT_GT(glm::distance(one, seen(lens.color * ground, eye)), 0.08 * share) << a << ", a lens";
            }
        }
        for (const glm::vec3& color : colors) {
            const double lightness = seen(color * ground, eyes()[0]).x;
            if (ground < 1)
                EXPECT_LT(lightness, 0.75) << "seen on white";
            else
                EXPECT_GT(lightness, 0.57) << "seen on black";
        }
    }
}

/// One plot of 200 x 100 pixels with values 0..10 and 0..1, driven by a fed mouse. ImGui needs no GPU for it.
class BrushEdit : public FedImGui {
protected:
    BrushEdit() : FedImGui({400, 300}) {}
    void SetUp() override {
        frame();
        frame();
    }

    void frame() {
        feedWindow([&] {
            surface(plot.min, plot.max);
            changed = editBrushes(drag, selection, plot, channels, {tool, 0.1f});
            drawBrushes(*ImGui::GetWindowDrawList(), selection, plot, channels);
        });
    }
    void moveTo(double x, double y) {
        mouse = plot.pixel(x, y);
        frame();
    }
    void button(int which, bool down) {
        ImGui::GetIO().MouseDown[which] = down;
        frame();
    }
    void dragFromTo(double x0, double y0, double x1, double y1) {
        moveTo(x0, y0);
        button(0, true);
        moveTo((x0 + x1) / 2, (y0 + y1) / 2);
        moveTo(x1, y1);
        button(0, false);
    }
    const vis::BrushInterval& interval(std::size_t brush, std::size_t i) {
        return std::get<vis::RangeRegion>(selection.brushes[brush].region).intervals[i];
    }

    PlotFrame plot{{50, 50}, {250, 150}, {0, 10}, {0, 1}};
    PlotChannels channels{"T", "O2"};
    BrushDrag drag;
    vis::Selection selection;
    bool changed = false;
    BrushTool tool = BrushTool::Rectangle;
};

TEST_F(BrushEdit, DraggingMakesABrushWithSoftEdges) {
    dragFromTo(2, 0.8, 6, 0.2);
    ASSERT_EQ(selection.brushes.size(), 1u);
    ASSERT_EQ(std::get<vis::RangeRegion>(selection.brushes[0].region).intervals.size(), 2u);
    EXPECT_EQ(interval(0, 0).channel, "T");
    EXPECT_EQ(interval(0, 1).channel, "O2");
    EXPECT_NEAR(interval(0, 0).lo, 2, 0.1);
    EXPECT_NEAR(interval(0, 0).hi, 6, 0.1);
    EXPECT_NEAR(interval(0, 1).lo, 0.2, 0.02);
    EXPECT_NEAR(interval(0, 1).hi, 0.8, 0.02);
    EXPECT_NEAR(interval(0, 0).soft, 0.4, 0.02);
    EXPECT_FALSE(drag.active);
}

TEST_F(BrushEdit, AClickMakesNothing) {
    moveTo(5, 0.5);
    button(0, true);
    button(0, false);
    EXPECT_TRUE(selection.brushes.empty());
}

TEST_F(BrushEdit, DraggingInsideMovesAndKeepsTheSize) {
    dragFromTo(2, 0.2, 6, 0.8);
    const double width = interval(0, 0).hi - interval(0, 0).lo;
    dragFromTo(4, 0.5, 5, 0.6);
    ASSERT_EQ(selection.brushes.size(), 1u);
    EXPECT_NEAR(interval(0, 0).lo, 3, 0.1);
    EXPECT_NEAR(interval(0, 1).lo, 0.3, 0.02);
    EXPECT_NEAR(interval(0, 0).hi - interval(0, 0).lo, width, 1e-9);
    dragFromTo(5, 0.6, 30, 0.6); // stops at the edge of the plot
    EXPECT_NEAR(interval(0, 0).hi, 10, 1e-9);
    EXPECT_NEAR(interval(0, 0).hi - interval(0, 0).lo, width, 1e-9);
}

TEST_F(BrushEdit, EdgesAndCornersResize) {
    dragFromTo(2, 0.2, 6, 0.8);
    dragFromTo(6, 0.5, 8, 0.9); // right edge: height stays
    EXPECT_NEAR(interval(0, 0).hi, 8, 0.1);
    EXPECT_NEAR(interval(0, 1).hi, 0.8, 0.02);
    dragFromTo(2, 0.2, 1, 0.1); // lower left corner
    EXPECT_NEAR(interval(0, 0).lo, 1, 0.1);
    EXPECT_NEAR(interval(0, 1).lo, 0.1, 0.02);
    EXPECT_NEAR(interval(0, 0).soft, 0.7, 0.02) << "stays in proportion";
    dragFromTo(1, 0.5, 9.5, 0.5); // left edge over the right one
    EXPECT_LT(interval(0, 0).lo, interval(0, 0).hi);
}

TEST_F(BrushEdit, ANewBrushReplacesTheOldOneOfThePlotOnly) {
    selection.brushes.push_back(vis::rangeBrush({{.channel = "p", .lo = 0, .hi = 1}}));
    dragFromTo(1, 0.1, 3, 0.3);
    dragFromTo(6, 0.6, 9, 0.9);
    ASSERT_EQ(selection.brushes.size(), 2u);
    EXPECT_EQ(interval(0, 0).channel, "p");
    EXPECT_NEAR(interval(1, 0).lo, 6, 0.1);
}

TEST_F(BrushEdit, ShiftAddsAndCtrlSubtracts) {
    dragFromTo(1, 0.1, 3, 0.3);
    feedModifiers(ImGui::GetIO(), false, true, false);
    dragFromTo(6, 0.6, 9, 0.9);
    feedModifiers(ImGui::GetIO(), false, false, false);
    ASSERT_EQ(selection.brushes.size(), 2u);
    EXPECT_EQ(selection.brushes[1].combine, vis::BrushCombine::Or);
    EXPECT_NE(selection.brushes[0].color, selection.brushes[1].color);
    EXPECT_NE(selection.brushes[0].name, selection.brushes[1].name);
    feedModifiers(ImGui::GetIO(), true, false, false);
    dragFromTo(7, 0.7, 8, 0.8);
    feedModifiers(ImGui::GetIO(), false, false, false);
    ASSERT_EQ(selection.brushes.size(), 3u);
    EXPECT_EQ(selection.brushes[2].combine, vis::BrushCombine::Minus);
}

TEST_F(BrushEdit, EscapeTakesTheDragBack) {
    dragFromTo(2, 0.2, 6, 0.8);
    const vis::Selection before = selection;
    moveTo(4, 0.5);
    button(0, true);
    moveTo(8, 0.9);
    EXPECT_FALSE(selection == before);
    feedKey(ImGui::GetIO(), key::kEscape, true);
    frame();
    EXPECT_EQ(selection, before);
    feedKey(ImGui::GetIO(), key::kEscape, false);
    button(0, false);
    EXPECT_EQ(selection, before);
}

TEST_F(BrushEdit, RightClickRemovesTheBrushOrClearsAll) {
    dragFromTo(1, 0.1, 3, 0.3);
    selection.brushes.push_back(vis::rangeBrush({{.channel = "p", .lo = 0, .hi = 1}}));
    moveTo(8, 0.8);
    button(1, true);
    EXPECT_FALSE(drag.asksToClear);
    button(1, false);
    EXPECT_EQ(selection.brushes.size(), 2u);
    EXPECT_TRUE(drag.asksToClear) << "of several";
    frame();
    EXPECT_FALSE(drag.asksToClear) << "once";
    moveTo(2, 0.2);
    button(1, true);
    button(1, false);
    ASSERT_EQ(selection.brushes.size(), 1u);
    EXPECT_EQ(interval(0, 0).channel, "p");
    moveTo(8, 0.8);
    button(1, true);
    button(1, false);
    EXPECT_TRUE(selection.brushes.empty());
    button(1, true);
    button(1, false);
    EXPECT_FALSE(drag.asksToClear) << "there is nothing to remove";
}

TEST_F(BrushEdit, HistogramsBrushOneChannel) {
    channels = {"T", ""};
    dragFromTo(2, 0.5, 6, 0.9);
    ASSERT_EQ(selection.brushes.size(), 1u);
    ASSERT_EQ(std::get<vis::RangeRegion>(selection.brushes[0].region).intervals.size(), 1u);
    EXPECT_NEAR(interval(0, 0).hi, 6, 0.1);
    // The band is drawn, and can be held, in every plot with that channel on an axis.
    EXPECT_TRUE(brushFits(selection.brushes[0], {"T", "O2"}));
    EXPECT_TRUE(brushFits(selection.brushes[0], {"O2", "T"}));
    EXPECT_FALSE(brushFits(selection.brushes[0], {"O2", "p"}));
    channels = {"O2", "T"};
    plot.x = {0, 1};
    plot.y = {0, 10};
    dragFromTo(0.5, 4, 0.5, 6);
    EXPECT_NEAR(interval(0, 0).lo, 4, 0.1);
    EXPECT_NEAR(interval(0, 0).hi, 8, 0.1);
}

TEST_F(BrushEdit, EllipsesAreDrawnCornerToCornerAndHeldByTheirRim) {
    tool = BrushTool::Ellipse;
    dragFromTo(2, 0.2, 6, 0.8);
    ASSERT_EQ(selection.brushes.size(), 1u);
    const auto ellipse = [&] { return std::get<vis::EllipseRegion>(selection.brushes[0].region); };
    EXPECT_NEAR(ellipse().center.x, 4, 0.1);
    EXPECT_NEAR(ellipse().radius.y, 0.3, 0.02);
    EXPECT_NEAR(ellipse().soft, 0.2, 1e-6);
    dragFromTo(4, 0.5, 5, 0.5); // the middle moves it
    ASSERT_EQ(selection.brushes.size(), 1u);
    EXPECT_NEAR(ellipse().center.x, 5, 0.1);
    EXPECT_NEAR(ellipse().radius.x, 2, 0.1);
    dragFromTo(6.9, 0.5, 8.9, 0.5); // the right rim widens it
    EXPECT_NEAR(ellipse().center.x, 6, 0.1);
    EXPECT_NEAR(ellipse().radius.x, 3, 0.1);
    // Seen with the axes exchanged it is the same one.
    channels = {"O2", "T"};
    plot.x = {0, 1};
    plot.y = {0, 10};
    dragFromTo(0.5, 6, 0.5, 5);
    EXPECT_NEAR(ellipse().center.x, 5, 0.1);
    EXPECT_NEAR(ellipse().center.y, 0.5, 0.02);
}

TEST_F(BrushEdit, ALassoFollowsTheMouse) {
    tool = BrushTool::Lasso;
    moveTo(2, 0.2);
    button(0, true);
    for (const auto& [x, y] : {std::pair{6.0, 0.2}, {6.0, 0.8}, {2.0, 0.8}}) moveTo(x, y);
    button(0, false);
    ASSERT_EQ(selection.brushes.size(), 1u);
    const auto lasso = [&] { return std::get<vis::LassoRegion>(selection.brushes[0].region); };
    ASSERT_EQ(lasso().points.size(), 4u);
    EXPECT_NEAR(lasso().points[2].x, 6, 0.1);
    EXPECT_NEAR(lasso().points[2].y, 0.8, 0.02);
    dragFromTo(4, 0.5, 5, 0.6);
    ASSERT_EQ(selection.brushes.size(), 1u) << "moved, not drawn anew";
    EXPECT_NEAR(lasso().points[0].x, 3, 0.1);
    EXPECT_NEAR(lasso().points[0].y, 0.3, 0.02);
    // One of three corners at most holds nothing and cannot be held: a click beside it starts another.
    dragFromTo(8, 0.1, 9, 0.2);
    ASSERT_EQ(selection.brushes.size(), 1u);
}

TEST_F(BrushEdit, ALassoTakesACornerEveryThreePixels) {
    tool = BrushTool::Lasso;
    const auto corners = [&] { return std::get<vis::LassoRegion>(selection.brushes.at(0).region).points.size(); };
    const auto moveTo = [&](float x, float y) {
        mouse = {x, y};
        frame();
    };
    moveTo(100, 100);
    button(0, true);
    moveTo(120, 100); // far enough to be a drag
    EXPECT_EQ(corners(), 2u);
    moveTo(122, 100);
    EXPECT_EQ(corners(), 2u) << "two pixels on is no corner";
    moveTo(123, 100);
    EXPECT_EQ(corners(), 3u);
    moveTo(123, 103);
    EXPECT_EQ(corners(), 4u) << "in any direction";
    button(0, false);
}

TEST_F(BrushEdit, ASmallBrushHasAMiddleToMoveItBy) {
    selection.brushes = {
        vis::rangeBrush({{.channel = "T", .lo = 4, .hi = 4.4}, {.channel = "O2", .lo = 0.5, .hi = 0.58}})};
    dragFromTo(4.2, 0.54, 6.2, 0.74); // eight pixels wide and high
    ASSERT_EQ(selection.brushes.size(), 1u);
    EXPECT_NEAR(interval(0, 0).lo, 6, 0.06);
    EXPECT_NEAR(interval(0, 0).hi, 6.4, 0.06);
    EXPECT_NEAR(interval(0, 1).lo, 0.7, 0.012);
    EXPECT_NEAR(interval(0, 1).hi, 0.78, 0.012);
}

TEST_F(BrushEdit, TheMouseShowsWhichWayAnEdgeGoes) {
    dragFromTo(2, 0.2, 6, 0.8);
    const auto cursorAt = [&](double x, double y) {
        moveTo(x, y);
        frame();
        return ImGui::GetMouseCursor();
    };
    EXPECT_EQ(cursorAt(2, 0.8), ImGuiMouseCursor_ResizeNWSE) << "top left";
    EXPECT_EQ(cursorAt(6, 0.2), ImGuiMouseCursor_ResizeNWSE) << "bottom right";
    EXPECT_EQ(cursorAt(6, 0.8), ImGuiMouseCursor_ResizeNESW) << "top right";
    EXPECT_EQ(cursorAt(2, 0.2), ImGuiMouseCursor_ResizeNESW) << "bottom left";
    EXPECT_EQ(cursorAt(2, 0.5), ImGuiMouseCursor_ResizeEW) << "left";
    EXPECT_EQ(cursorAt(6, 0.5), ImGuiMouseCursor_ResizeEW) << "right";
    EXPECT_EQ(cursorAt(4, 0.8), ImGuiMouseCursor_ResizeNS) << "top";
    EXPECT_EQ(cursorAt(4, 0.2), ImGuiMouseCursor_ResizeNS) << "bottom";
    EXPECT_EQ(cursorAt(4, 0.5), ImGuiMouseCursor_ResizeAll) << "inside";
    EXPECT_EQ(cursorAt(9, 0.95), ImGuiMouseCursor_Arrow) << "elsewhere";
}

TEST(BrushList, SaysHowBrushesMeet) {
    vis::Selection selection;
    EXPECT_EQ(combinationText(selection), "");
    selection.brushes.resize(4);
    selection.brushes[1].combine = vis::BrushCombine::And;
    selection.brushes[2].combine = vis::BrushCombine::Or;
    selection.brushes[3].combine = vis::BrushCombine::Minus;
    selection.brushes[3].inverted = true;
    EXPECT_EQ(combinationText(selection), "((1 and 2) or 3) without not 4");
    selection.brushes[2].enabled = false;
    EXPECT_TRUE(combinationText(selection).starts_with("(1 and 2) without not 4;")) << "with a hint";
    selection.brushes[0].combine = vis::BrushCombine::Minus;
    selection.brushes[3].enabled = false;
    EXPECT_TRUE(combinationText(selection).starts_with("not 1 and 2;"));
    selection.brushes[1].enabled = false;
    EXPECT_EQ(combinationText(selection), "");
}

// An axis without limits has no edges: lines along the border of the plot would look like a range.
TEST_F(BrushEdit, ABrushOfOneParameterIsABandThroughThePlot) {
    for (const bool upright : {true, false}) {
        selection.brushes = {vis::rangeBrush({upright ? vis::BrushInterval{.channel = "T", .lo = 3, .hi = 6}
                                                      : vis::BrushInterval{.channel = "O2", .lo = 0.3, .hi = 0.6}})};
        frame();
        int edges = 0;
        ASSERT_EQ(drawnTexts().size(), 1u);
        const DrawnText number = drawnTexts()[0]; // of the brush, in its colour
        const auto isIn = [](float at, float lo, float hi) { return at > lo + 1 && at < hi - 1; };
        for (const ImVec2& corner : drawnIn(brushColor(selection.brushes[0]))) {
            if (corner.x < number.max.x + 1 && corner.x > number.min.x - 1 && corner.y < number.max.y + 1) continue;
            ++edges;
            if (upright)
                EXPECT_FALSE(isIn(corner.y, plot.min.y, plot.max.y)) << corner.x << ' ' << corner.y;
            else
                EXPECT_FALSE(isIn(corner.x, plot.min.x, plot.max.x)) << corner.x << ' ' << corner.y;
        }
        EXPECT_GT(edges, 0);
    }
}

} // namespace
} // namespace tessera::app
