#include "app/pane/tool_row.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

std::string placesOf(ToolPlaces places, const std::vector<float>& widths, float gap = 10) {
    std::string out;
    for (const float width : widths) {
        const ToolPlace place = places.next(width, gap);
        out += place == ToolPlace::SameRow ? ' ' : place == ToolPlace::NextRow ? '/' : '.';
    }
    return out;
}

TEST(ToolRow, ToolsTakeAThirdOfAPaneButOneRow) {
    EXPECT_EQ(toolRows(0, 29), 1);
    EXPECT_EQ(toolRows(108, 29), 1);
    EXPECT_EQ(toolRows(170, 29), 2);
    EXPECT_EQ(toolRows(420, 29), 5);
    for (float height = 90; height < 2000; height += 7)
        EXPECT_LE(float(toolRows(height, 29)) * 29, std::max(29.0f, height * 0.36f)) << height;
}

TEST(ToolRow, RowsAreFilledInTurn) {
    EXPECT_EQ(placesOf({200, 30, 9}, {90, 100, 60, 60, 60}), "/ /  ");
    EXPECT_EQ(placesOf({200, 30, 9}, {90, 101, 60}), "// ") << "one pixel too many";
    EXPECT_EQ(placesOf({200, 30, 9}, {500, 20}), "//") << "too wide for any row: alone in one";
}

TEST(ToolRow, WhatHasNoRowIsInTheMenu) {
    EXPECT_EQ(placesOf({200, 30, 1}, {90, 70, 60, 5}), "/ ..") << "what comes after the menu is in it";
    EXPECT_EQ(placesOf({200, 30, 1}, {90, 71}), "/.") << "the last row keeps room for the button of the menu";
    EXPECT_EQ(placesOf({200, 30, 2}, {90, 71, 160, 1}), "/ /.") << "others do not";
    EXPECT_EQ(placesOf({200, 30, 2}, {90, 171, 1}), "/..") << "nor does a tool take that room at the start of it";
    EXPECT_EQ(placesOf({20, 30, 1}, {90, 70}), "/.") << "the first is always there";
}

TEST(ToolRow, TheButtonOfTheMenuIsWithinThePane) {
    const auto beside = [](float first) {
        ToolPlaces places(200, 30, 2);
        places.next(first, 10);
        places.next(180, 10);
        return places.menuBeside();
    };
    EXPECT_TRUE(beside(170));
    EXPECT_FALSE(beside(171)) << "it begins the next row";
}

TEST(ToolRow, TheLastToolGrowsAsFarAsItsRowHasRoom) {
    ToolPlaces places(200, 30, 2);
    places.next(50, 10);
    EXPECT_EQ(places.grow(60), 60);
    EXPECT_EQ(places.grow(200), 90);
    EXPECT_EQ(places.grow(1), 0);
    EXPECT_EQ(places.next(10, 10), ToolPlace::NextRow);
    EXPECT_EQ(places.grow(500), 160) << "but for the button of the menu";
}

} // namespace
} // namespace tessera::app
