#include "app/drawing/drawing.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

VectorPage drawnPage() {
    VectorPage made;
    made.size = {240.94, 181.42}; // 85 x 64 mm
    made.marks = {{shapes::Stroke{{{10, 20}, {30, 40.5}}, 0.5}},
                  {shapes::Words{"T [K] < 3", {50, 60}, 8}},
                  {shapes::Picture{{{100, 100}, {140, 120}}, {{2, 1}, {255, 0, 0, 255, 0, 0, 255, 255}}, false}}};
    return made;
}

TEST(Drawing, AnSvgHasLinesAndTextsWhereTheyAre) {
    const std::string svg = svgOf(drawnPage());
    EXPECT_NE(svg.find("width=\"240.94pt\" height=\"181.42pt\""), std::string::npos) << svg;
    EXPECT_NE(svg.find("<line x1=\"10.00\" y1=\"20.00\" x2=\"30.00\" y2=\"40.50\""), std::string::npos) << svg;
    EXPECT_NE(svg.find(">T [K] &lt; 3</text>"), std::string::npos) << svg;
}

TEST(Drawing, APdfHasThePageAndIsTheSameEachTime) {
    const std::string pdf = pdfOf(drawnPage());
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    EXPECT_NE(pdf.find("240.94"), std::string::npos);
    EXPECT_EQ(pdf, pdfOf(drawnPage()));
}

} // namespace
} // namespace tessera::app
