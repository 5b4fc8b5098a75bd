#include "app/platform/drawn_page.h"

#include "app/pane/plot.h"
#include "tests/app/fed_imgui.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {
namespace {

using namespace shapes;

constexpr ImU32 kRed = IM_COL32(255, 0, 0, 255), kHalfBlue = IM_COL32(0, 0, 255, 128);

class DrawnPage : public FedImGui {
protected:
    DrawnPage() : FedImGui({400, 300}) {
        ImGui::GetStyle().AntiAliasedLines = ImGui::GetStyle().AntiAliasedFill = false;
        fonts = loadFonts(1);
    }

    /// The page of what `body` draws, at two points per pixel.
    template <class Body> VectorPage pageWith(Body&& body) {
        feed([&] { body(*ImGui::GetBackgroundDrawList()); });
        return pageOf(*ImGui::GetDrawData(), fonts, 2,
                      [&](const std::vector<DrawnPart>& parts, glm::ivec2 lo, glm::ivec2 hi) {
                          boxes.push_back({glm::dvec2(lo), glm::dvec2(hi)});
                          unsigned indices = 0;
                          for (const DrawnPart& part : parts) indices += part.command.ElemCount;
                          triangles.push_back(indices / 3);
                          vis::Image image;
                          image.size = hi - lo;
                          image.rgba.assign(std::size_t(image.size.x) * std::size_t(image.size.y) * 4, 77);
                          return image;
                      });
    }

    template <class Shape> static std::vector<Shape> all(const VectorPage& page) {
        std::vector<Shape> found;
        for (const Mark& mark : page.marks)
            if (const auto* shape = std::get_if<Shape>(&mark.shape)) found.push_back(*shape);
        return found;
    }

    Fonts fonts;
    std::vector<PageBox> boxes; ///< pixels of the raster pictures asked for
    std::vector<unsigned> triangles;
};

TEST_F(DrawnPage, AreasAreWhereTheyWereDrawnInTheirColour) {
    const VectorPage page = pageWith([](ImDrawList& list) {
        list.AddRectFilled({10, 20}, {110, 60}, kRed);
        list.AddTriangleFilled({200, 100}, {260, 100}, {200, 160}, kHalfBlue);
    });
    EXPECT_EQ(page.size, glm::dvec2(800, 600));
    ASSERT_EQ(page.marks.size(), 2u);
    const Rect rect = all<Rect>(page).at(0);
    EXPECT_EQ(rect.box.lo, glm::dvec2(20, 40));
    EXPECT_EQ(rect.box.hi, glm::dvec2(220, 120));
    EXPECT_EQ(rect.color, glm::vec4(1, 0, 0, 1));
    const Polygon polygon = all<Polygon>(page).at(0);
    EXPECT_EQ(polygon.points, (std::vector<glm::dvec2>{{400, 200}, {520, 200}, {400, 320}}));
    EXPECT_NEAR(polygon.color.a, 128 / 255.0f, 1e-4f);
}

TEST_F(DrawnPage, WhatIsClippedIsCutOff) {
    const VectorPage page = pageWith([](ImDrawList& list) {
        list.PushClipRect({50, 50}, {100, 100});
        list.AddRectFilled({10, 20}, {70, 80}, kRed);                       // a corner is left
        list.AddRectFilled({200, 200}, {300, 250}, kRed);                   // nothing is left
        list.AddTriangleFilled({80, 40}, {140, 100}, {80, 160}, kHalfBlue); // a corner is cut off
        list.AddText(ImVec2{20, 60}, kRed, "outside");
        list.PopClipRect();
    });
    ASSERT_EQ(all<Rect>(page).size(), 1u);
    EXPECT_EQ(all<Rect>(page)[0].box.lo, glm::dvec2(100, 100));
    EXPECT_EQ(all<Rect>(page)[0].box.hi, glm::dvec2(140, 160));
    const Polygon cut = all<Polygon>(page).at(0);
    double area = 0; // by the shoelace formula
    for (std::size_t i = 0; i < cut.points.size(); ++i) {
        const glm::dvec2 a = cut.points[i], b = cut.points[(i + 1) % cut.points.size()];
        area += (a.x * b.y - b.x * a.y) / 2;
        EXPECT_GE(a.x, 100);
        EXPECT_LE(a.x, 200);
        EXPECT_GE(a.y, 100);
        EXPECT_LE(a.y, 200);
    }
    // x from 80 and y up to 100 lie inside of the triangle but for the corner above its side y = x - 40.
    EXPECT_NEAR(std::abs(area), 4 * (20 * 50 - 10 * 10 / 2), 1e-6);
    EXPECT_LE(all<Words>(page).size(), 1u);
    for (const Words& words : all<Words>(page))
        EXPECT_NE(words.text, "outside") << "letters left of the clip rectangle";
}

TEST_F(DrawnPage, LinesAreStrokesAndClosedOnesEndWhereTheyBegan) {
    const VectorPage page = pageWith([](ImDrawList& list) {
        const ImVec2 points[] = {{10, 10}, {60, 40}, {110, 20}};
        list.AddPolyline(points, 3, kRed, ImDrawFlags_None, 1.5f);
        list.AddRect({200, 100}, {260, 140}, kHalfBlue, 0, ImDrawFlags_None, 2);
    });
    const std::vector<Stroke> strokes = all<Stroke>(page);
    ASSERT_EQ(strokes.size(), 2u);
    ASSERT_EQ(strokes[0].points.size(), 3u);
    EXPECT_NEAR(strokes[0].width, 3, 1e-3);
    for (const auto& [i, at] :
         {std::pair{0u, glm::dvec2(20, 20)}, {1u, glm::dvec2(120, 80)}, {2u, glm::dvec2(220, 40)}})
        EXPECT_LT(glm::length(strokes[0].points[i] - at), 1.01 * std::sqrt(2.0)) << i << ": half a pixel";
    ASSERT_EQ(strokes[1].points.size(), 5u);
    EXPECT_EQ(strokes[1].points.front(), strokes[1].points.back());
}

TEST_F(DrawnPage, TextsAreWholeWithTheirPlaceSizeAndFont) {
    const VectorPage page = pageWith([&](ImDrawList& list) {
        list.AddText(ImVec2{30, 40}, kRed, "T [K] \xce\xb1  = 3.5");
        list.AddText(fonts.bold, fonts.bold->FontSize * 2, ImVec2{30, 90}, kHalfBlue, "Bold");
        ImGui::PushFont(fonts.text);
        addTextUpwards(list, {200, 150}, kRed, "upwards");
        ImGui::PopFont();
    });
    const std::vector<Words> words = all<Words>(page);
    ASSERT_EQ(words.size(), 3u);
    EXPECT_EQ(words[0].text, "T [K] \xce\xb1  = 3.5");
    EXPECT_EQ(words[0].face, Face::Text);
    EXPECT_EQ(words[0].angle, 0);
    EXPECT_NEAR(words[0].size, 2 * textPixels(1), 0.1);
    EXPECT_NEAR(words[0].at.x, 60, 0.5);
    EXPECT_NEAR(words[0].at.y, 2 * (40 + std::round(double(fonts.text->Ascent))), 0.5);
    EXPECT_EQ(words[0].color, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(words[1].text, "Bold");
    EXPECT_LT(glm::distance(words[1].color, glm::vec4(0, 0, 1, 128 / 255.0f)), 1e-3f) << "each in its own colour";
    EXPECT_EQ(words[1].face, fonts.bold == fonts.text ? Face::Text : Face::Bold);
    EXPECT_NEAR(words[1].size, 2 * words[0].size, 0.2);
    EXPECT_EQ(words[2].text, "upwards");
    EXPECT_NEAR(words[2].angle, -90, 1e-3);
    // The base line runs upwards, right of the middle of the letters.
    EXPECT_NEAR(words[2].at.x, 400, words[2].size);
    EXPECT_GT(words[2].at.x, 400);
    EXPECT_GT(words[2].at.y, 300);
}

TEST_F(DrawnPage, TexturesAndGradientsBecomePicturesInOrder) {
    const VectorPage page = pageWith([](ImDrawList& list) {
        list.AddRectFilled({0, 0}, {50, 50}, kRed);
        list.AddImage((ImTextureID)(std::intptr_t)5, {10.5f, 20}, {110, 60.2f});
        list.AddText(ImVec2{30, 100}, kRed, "above");
        list.AddRectFilledMultiColor({200, 100}, {300, 120}, kRed, kHalfBlue, kHalfBlue, kRed);
        list.AddRectFilledMultiColor({300, 100}, {340, 120}, kHalfBlue, kRed, kRed, kHalfBlue);
    });
    ASSERT_EQ(page.marks.size(), 4u);
    EXPECT_TRUE(std::holds_alternative<Rect>(page.marks[0].shape));
    EXPECT_TRUE(std::holds_alternative<Picture>(page.marks[1].shape));
    EXPECT_TRUE(std::holds_alternative<Words>(page.marks[2].shape));
    EXPECT_TRUE(std::holds_alternative<Picture>(page.marks[3].shape));
    EXPECT_EQ(triangles, (std::vector<unsigned>{2, 4})) << "neighbours share a picture";
    EXPECT_EQ(boxes.at(0).lo, glm::dvec2(10, 20));
    EXPECT_EQ(boxes.at(0).hi, glm::dvec2(110, 61));
    EXPECT_EQ(boxes.at(1).lo, glm::dvec2(200, 100));
    EXPECT_EQ(boxes.at(1).hi, glm::dvec2(340, 120));
    EXPECT_EQ(std::get<Picture>(page.marks[3].shape).box.hi, glm::dvec2(680, 240));
}

} // namespace
} // namespace tessera::app
