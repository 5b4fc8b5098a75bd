#include "app/drawing/drawing.h"

#include <gmock/gmock.h>

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

TEST(Drawing, TextsOfAnSvgStateTheirFontAndPlace) {
    VectorPage page;
    page.size = {100, 100};
    const auto text = [&](const shapes::Words& words) {
        page.marks = {{words}};
        const std::string svg = svgOf(page);
        const auto at = svg.find("<text ");
        return at == std::string::npos ? svg : svg.substr(at, svg.find("</text>") - at);
    };
    shapes::Words words{"O2", {50, 60}, 8};
    EXPECT_THAT(text(words),
                testing::MatchesRegex("<text x=\"50.00\" y=\"60.00\" font-family=\"[A-Z][^\"]*, Helvetica, "
                                      "Arial, sans-serif\" font-weight=\"[^\"]+\" font-size=\"8.00\" "
                                      "fill=\"[^\"]+\" xml:space=\"preserve\">O2"));
    words.middle = true; // half the height of capitals below its place
    EXPECT_THAT(text(words), testing::HasSubstr(" y=\"60.00\" dy=\"2.80\""));
    words.anchor = 0.5;
    EXPECT_THAT(text(words), testing::HasSubstr("text-anchor=\"middle\""));
    words.anchor = 1;
    EXPECT_THAT(text(words), testing::HasSubstr("text-anchor=\"end\""));
    words.angle = -90;
    EXPECT_THAT(text(words), testing::HasSubstr("transform=\"rotate(-90.00 50.00 60.00)\""));
}

TEST(Drawing, ARectangleCoversItsBox) {
    VectorPage page;
    page.size = {100, 100};
    page.marks = {{shapes::Rect{{{20, 30}, {60, 40}}, {1, 0, 0, 1}}}};
    const vis::Image image = imageOf(page, {100, 100});
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            const bool inside = x >= 20 && x < 60 && y >= 30 && y < 40;
            const std::uint8_t* pixel = &image.rgba[std::size_t(4 * (y * 100 + x))];
            ASSERT_EQ(pixel[0] > 128 && pixel[1] < 128 && pixel[3] > 128, inside) << x << ' ' << y;
        }
}

TEST(Drawing, APdfHasThePageAndIsTheSameEachTime) {
    const std::string pdf = pdfOf(drawnPage());
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    EXPECT_NE(pdf.find("240.94"), std::string::npos);
    EXPECT_EQ(pdf, pdfOf(drawnPage()));
}

} // namespace
} // namespace tessera::app
