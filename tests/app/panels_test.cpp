#include "app/drawing/panels.h"

#include "volume/base/error.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

using namespace shapes;

TEST(Panels, LieApartInRowsBelowTheirLettersInsideOfTheFigure) {
    const glm::ivec2 size(1000, 700);
    const std::vector<PanelPlace> places = panelPlaces(size, 5, 2, 20);
    ASSERT_EQ(places.size(), 5u);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const PanelPlace& a = places[i];
        EXPECT_EQ(a.hi - a.lo, places[0].hi - places[0].lo);
        EXPECT_GE(a.lo.x, 0);
        EXPECT_LE(a.hi.x, size.x);
        EXPECT_LE(a.hi.y, size.y);
        EXPECT_EQ(a.letter.x, a.lo.x);
        EXPECT_GE(a.letter.y, 20 * 0.75) << "letters are inside of the figure";
        EXPECT_LT(a.letter.y, a.lo.y);
        EXPECT_GE(a.letter.y, a.lo.y - 32);
        for (std::size_t k = 0; k < i; ++k) {
            const PanelPlace& b = places[k];
            EXPECT_TRUE(b.hi.x <= a.lo.x || a.hi.x <= b.lo.x || b.hi.y <= a.letter.y - 20 || a.hi.y <= b.letter.y - 20);
        }
    }
    EXPECT_EQ(places[1].lo.y, places[0].lo.y);
    EXPECT_GT(places[1].lo.x, places[0].lo.x);
    EXPECT_EQ(places[2].lo.x, 0);
    EXPECT_GT(places[4].lo.y, places[3].lo.y);
    EXPECT_GE(places[4].hi.y, size.y - 3) << "the figure is filled";
    EXPECT_THROW((void)panelPlaces({200, 100}, 9, 1, 12), Error);
}

TEST(Panels, HaveLettersAndAsManyColumnsAsSuit) {
    EXPECT_EQ(panelLetter(0), "a");
    EXPECT_EQ(panelLetter(25), "z");
    EXPECT_EQ(panelLetter(26), "aa");
    EXPECT_EQ(panelLetter(53), "bb");
    EXPECT_EQ(usualColumns(1), 1);
    EXPECT_EQ(usualColumns(2), 2);
    EXPECT_EQ(usualColumns(4), 2);
    EXPECT_EQ(usualColumns(5), 3);
}

TEST(Panels, MoveEveryShapeOfAPage) {
    VectorPage page;
    page.size = {100, 50};
    page.numbers = "as computed";
    page.marks = {{Stroke{{{0, 0}, {100, 50}}, 2}},
                  {Polygon{{{0, 0}, {100, 0}, {100, 50}}}},
                  {Rect{.box = {{0, 0}, {100, 50}}}},
                  {Circle{.center = {100, 50}, .radius = 3}},
                  {Words{.text = "w", .at = {100, 50}, .size = 8}},
                  {Picture{.box = {{0, 0}, {100, 50}}, .image = {}}}};
    const PanelPlace place{{20, 40}, {220, 140}, {20, 30}};
    const VectorPage figure = figureOfPanels({300, 200}, {place}, {page}, 0.5, 9, glm::vec4(1), {0, 0, 0, 1});
    EXPECT_EQ(figure.size, glm::dvec2(300, 200));
    EXPECT_EQ(figure.numbers, "as computed");
    ASSERT_EQ(figure.marks.size(), 8u);
    const glm::dvec2 lo(10, 20), hi(110, 70); // pixels of half a point: the page keeps its size
    EXPECT_EQ(std::get<Rect>(figure.marks[0].shape).box.hi, glm::dvec2(300, 200)) << "the ground";
    EXPECT_EQ(std::get<Stroke>(figure.marks[1].shape).points, (std::vector<glm::dvec2>{lo, hi}));
    EXPECT_EQ(std::get<Polygon>(figure.marks[2].shape).points[2], hi);
    EXPECT_EQ(std::get<Rect>(figure.marks[3].shape).box.lo, lo);
    EXPECT_EQ(std::get<Circle>(figure.marks[4].shape).center, hi);
    EXPECT_EQ(std::get<Circle>(figure.marks[4].shape).radius, 3);
    EXPECT_EQ(std::get<Words>(figure.marks[5].shape).at, hi);
    EXPECT_EQ(std::get<Picture>(figure.marks[6].shape).box.hi, hi);
    const Words letter = std::get<Words>(figure.marks[7].shape);
    EXPECT_EQ(letter.text, "a");
    EXPECT_EQ(letter.at, glm::dvec2(10, 15));
    EXPECT_EQ(letter.size, 9);
}

// Rows are read from the top, and red is not blue.
// A table that is longer than its place would cover the panel below.
TEST(Panels, ALongPageIsSmallerRatherThanOverOthers) {
    VectorPage page;
    page.size = {100, 200};
    page.marks = {{Rect{.box = {{0, 0}, {100, 200}}}}};
    const VectorPage figure =
        figureOfPanels({300, 200}, {{{20, 40}, {220, 140}, {20, 30}}}, {page}, 0.5, 9, glm::vec4(1), {0, 0, 0, 1});
    EXPECT_EQ(std::get<Rect>(figure.marks[1].shape).box.lo, glm::dvec2(10, 20));
    EXPECT_EQ(std::get<Rect>(figure.marks[1].shape).box.hi, glm::dvec2(35, 70));
}

TEST(Panels, ARasterPictureHasItsPixelsWhereTheyAre) {
    VectorPage page;
    page.size = {4, 2};
    page.marks = {{Rect{.box = {{0, 0}, {4, 2}}, .color = {0, 0, 1, 1}}},
                  {Rect{.box = {{2, 0}, {4, 1}}, .color = {1, 0, 0, 1}}}};
    const vis::Image image = imageOf(page, {8, 4});
    ASSERT_EQ(image.size, glm::ivec2(8, 4));
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            const std::uint8_t* p = &image.rgba[std::size_t(y * 8 + x) * 4];
            const bool red = x >= 4 && y < 2;
            EXPECT_EQ(p[0], red ? 255 : 0) << x << ' ' << y;
            EXPECT_EQ(p[2], red ? 0 : 255);
            EXPECT_EQ(p[3], 255);
        }
}

} // namespace
} // namespace tessera::app
