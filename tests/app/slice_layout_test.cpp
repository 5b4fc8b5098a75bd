#include "app/views/slices/slice_layout.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

constexpr float kEm = 15;

void expectApart(const SliceLayout& layout, ImVec2 min, ImVec2 room) {
    std::vector<SliceArea> all(layout.planes.begin(), layout.planes.end());
    for (const SliceArea& each : {layout.numbers, layout.values})
        if (each.size().x > 0) all.push_back(each);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_GE(all[i].min.x, min.x);
        EXPECT_GE(all[i].min.y, min.y);
        EXPECT_LE(all[i].max.x, min.x + room.x + 0.5f);
        EXPECT_LE(all[i].max.y, min.y + room.y + 0.5f);
        EXPECT_GT(all[i].size().x, 0);
        EXPECT_GT(all[i].size().y, 0);
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_TRUE(all[i].min.x >= all[k].max.x || all[k].min.x >= all[i].max.x || all[i].min.y >= all[k].max.y ||
                        all[k].min.y >= all[i].max.y)
                << i << " over " << k;
    }
}

TEST(SliceLayout, ARoomyPaneHasQuartersWithNumbers) {
    for (const ImVec2 room : {ImVec2{520, 340}, ImVec2{300, 210}, ImVec2{1400, 400}, ImVec2{400, 1200}}) {
        const SliceLayout layout = sliceLayout({7, 9}, room, {1, 1, 1}, kEm);
        EXPECT_EQ(layout.order, SliceOrder::Quarters);
        EXPECT_TRUE(layout.axes);
        EXPECT_GT(layout.numbers.size().x, kEm * 5);
        expectApart(layout, {7, 9}, room);
    }
}

TEST(SliceLayout, ASmallPaneHasARowOrAColumn) {
    const SliceLayout wide = sliceLayout({0, 0}, {460, 150}, {1, 1, 1}, kEm);
    EXPECT_EQ(wide.order, SliceOrder::Row);
    EXPECT_EQ(wide.numbers.size().x, kEm * 8) << "there is room for numbers";
    EXPECT_EQ(sliceLayout({0, 0}, {600, 150}, {1, 1, 1}, kEm).numbers.size().x, 150) << "a quarter";
    EXPECT_EQ(sliceLayout({0, 0}, {900, 150}, {1, 1, 1}, kEm).numbers.size().x, kEm * 14) << "no more than they need";
    const SliceLayout narrow = sliceLayout({0, 0}, {290, 128}, {1, 1, 1}, kEm);
    EXPECT_EQ(narrow.order, SliceOrder::Row);
    EXPECT_EQ(narrow.numbers.size().x, 0) << "and here is none";
    EXPECT_FALSE(narrow.axes) << "they would take most of it";
    const SliceLayout tall = sliceLayout({0, 0}, {140, 420}, {1, 1, 1}, kEm);
    EXPECT_EQ(tall.order, SliceOrder::Column);
    expectApart(wide, {0, 0}, {460, 150});
    expectApart(narrow, {0, 0}, {290, 128});
    expectApart(tall, {0, 0}, {140, 420});
}

/// Pixels that the pictures of the slices cover, with axes of usual size.
double shown(const SliceLayout& layout, glm::dvec3 half) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const SliceMargins around = sliceMargins(layout, i, 3.2f, 1.45f);
        const ImVec2 size = layout.planes[std::size_t(i)].size();
        const SliceAxes& axes = layout.turned[std::size_t(i)];
        const double scale = std::min((size.x - (around.left + around.right) * kEm) / half[axes.right],
                                      (size.y - (around.top + around.bottom) * kEm) / half[axes.up]);
        sum += std::max(0.0, scale) * std::max(0.0, scale) * half[axes.right] * half[axes.up];
    }
    return sum;
}

TEST(SliceLayout, SlicesOfALongBoxLieAlongIt) {
    for (int longest = 0; longest < 3; ++longest) {
        SCOPED_TRACE(longest);
        glm::dvec3 half(0.14);
        half[longest] = 0.5;
        half[(longest + 1) % 3] = 0.2;
        const ImVec2 wide{446, 150}, tall{280, 600};
        const SliceLayout rows = sliceLayout({0, 0}, wide, half, kEm);
        EXPECT_EQ(rows.order, SliceOrder::Rows);
        EXPECT_TRUE(rows.axes);
        EXPECT_GT(rows.numbers.size().x, kEm * 5);
        expectApart(rows, {0, 0}, wide);
        EXPECT_GT(shown(rows, half), 2 * shown(sliceLayout({0, 0}, wide, half, kEm, true), half));
        int shared = 0, along = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_EQ(rows.turned[i].normal, kSlicePlanes[i].normal);
            EXPECT_EQ(rows.turned[i].right + rows.turned[i].up + rows.turned[i].normal, 3);
            EXPECT_EQ(rows.turned[i].right == longest, rows.turned[i].normal != longest);
            along += rows.turned[i].right == longest;
            shared += rows.shared[i];
        }
        EXPECT_EQ(along, 2);
        EXPECT_EQ(shared, 1) << "the lower one has the numbers of both";
        if (longest == 1) continue; // quarters have both upright as well
        const SliceLayout columns = sliceLayout({0, 0}, tall, half, kEm);
        EXPECT_EQ(columns.order, SliceOrder::Columns);
        expectApart(columns, {0, 0}, tall);
        for (const SliceAxes& axes : columns.turned) EXPECT_EQ(axes.up == longest, axes.normal != longest);
    }
    // As thin as the built-in cell is without stretch, also in a large pane; not where it is stretched.
    EXPECT_EQ(sliceLayout({0, 0}, {700, 420}, {0.14, 0.225, 0.5}, kEm).order, SliceOrder::Quarters);
    EXPECT_EQ(sliceLayout({0, 0}, {700, 420}, {0.055, 0.065, 0.505}, kEm).order, SliceOrder::Rows);
}

// What they leave of their column is for the values, and the slice across has all of its own but the legend.
TEST(SliceLayout, ThinSlicesTakeNoMoreRoomThanTheirPictures) {
    const glm::dvec3 half{0.065, 0.05, 1};
    for (const ImVec2 room : {ImVec2{320, 150}, ImVec2{460, 190}, ImVec2{500, 200}}) {
        SCOPED_TRACE(room.y);
        const SliceLayout layout = sliceLayout({0, 0}, room, half, kEm);
        ASSERT_EQ(layout.order, SliceOrder::Rows);
        EXPECT_GE(layout.values.size().y, 2.4f * kEm) << "two lines";
        EXPECT_EQ(layout.values.min.x, layout.planes[1].min.x);
        EXPECT_EQ(layout.values.max.y, room.y);
        EXPECT_NEAR(layout.numbers.size().y, 3.7f * kEm, 0.3f * kEm) << "a legend";
        expectApart(layout, {0, 0}, room);
        EXPECT_GT(shown(layout, half), 0);
    }
    // A box that is less thin leaves nothing.
    EXPECT_EQ(sliceLayout({0, 0}, {446, 150}, {0.2, 0.14, 0.5}, kEm).values.size().x, 0);
}

TEST(SliceLayout, AFigureHasQuartersWithAxesAtAnySize) {
    const SliceLayout layout = sliceLayout({0, 0}, {290, 128}, {1, 1, 1}, kEm, true);
    EXPECT_EQ(layout.order, SliceOrder::Quarters);
    EXPECT_TRUE(layout.axes);
}

TEST(SliceLayout, EverySliceHasItsPlaceWhateverTheBox) {
    for (const glm::dvec3 half : {glm::dvec3(1, 1, 1), glm::dvec3(0.02, 1, 0.3), glm::dvec3(1, 0, 1), glm::dvec3(0),
                                  glm::dvec3(1, 0.1, 0.2), glm::dvec3(0.055, 0.065, 0.5)})
        for (float x = 100; x < 700; x += 37)
            for (float y = 90; y < 500; y += 41) {
                SCOPED_TRACE(std::to_string(x) + " x " + std::to_string(y));
                expectApart(sliceLayout({3, 5}, {x, y}, half, kEm), {3, 5}, {x, y});
            }
}

} // namespace
} // namespace tessera::app
