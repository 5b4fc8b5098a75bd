#include "app/views/slices/slice_rooms.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

constexpr float kEm = 15;

void expectApart(const SliceRooms& rooms, ImVec2 min, ImVec2 room) {
    std::vector<SliceRoom> all(rooms.planes.begin(), rooms.planes.end());
    if (rooms.numbers.size().x > 0) all.push_back(rooms.numbers);
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

TEST(SliceRooms, ARoomyPaneHasQuartersWithNumbers) {
    for (const ImVec2 room : {ImVec2{520, 340}, ImVec2{300, 210}, ImVec2{1400, 400}, ImVec2{400, 1200}}) {
        const SliceRooms rooms = sliceRooms({7, 9}, room, {1, 1, 1}, kEm);
        EXPECT_EQ(rooms.order, SliceOrder::Quarters);
        EXPECT_TRUE(rooms.axes);
        EXPECT_GT(rooms.numbers.size().x, kEm * 5);
        expectApart(rooms, {7, 9}, room);
    }
}

TEST(SliceRooms, ASmallPaneHasARowOrAColumn) {
    const SliceRooms wide = sliceRooms({0, 0}, {460, 150}, {1, 1, 1}, kEm);
    EXPECT_EQ(wide.order, SliceOrder::Row);
    EXPECT_EQ(wide.numbers.size().x, kEm * 8) << "there is room for numbers";
    EXPECT_EQ(sliceRooms({0, 0}, {600, 150}, {1, 1, 1}, kEm).numbers.size().x, 150) << "a quarter";
    EXPECT_EQ(sliceRooms({0, 0}, {900, 150}, {1, 1, 1}, kEm).numbers.size().x, kEm * 14) << "no more than they need";
    const SliceRooms narrow = sliceRooms({0, 0}, {290, 128}, {1, 1, 1}, kEm);
    EXPECT_EQ(narrow.order, SliceOrder::Row);
    EXPECT_EQ(narrow.numbers.size().x, 0) << "and here is none";
    EXPECT_FALSE(narrow.axes) << "they would take most of it";
    const SliceRooms tall = sliceRooms({0, 0}, {140, 420}, {1, 1, 1}, kEm);
    EXPECT_EQ(tall.order, SliceOrder::Column);
    expectApart(wide, {0, 0}, {460, 150});
    expectApart(narrow, {0, 0}, {290, 128});
    expectApart(tall, {0, 0}, {140, 420});
}

TEST(SliceRooms, AFigureHasQuartersWithAxesAtAnySize) {
    const SliceRooms rooms = sliceRooms({0, 0}, {290, 128}, {1, 1, 1}, kEm, true);
    EXPECT_EQ(rooms.order, SliceOrder::Quarters);
    EXPECT_TRUE(rooms.axes);
}

TEST(SliceRooms, EverySliceHasItsPlaceWhateverTheBox) {
    for (const glm::dvec3 half : {glm::dvec3(1, 1, 1), glm::dvec3(0.02, 1, 0.3), glm::dvec3(1, 0, 1), glm::dvec3(0)})
        for (float x = 100; x < 700; x += 37)
            for (float y = 90; y < 500; y += 41) {
                SCOPED_TRACE(std::to_string(x) + " x " + std::to_string(y));
                expectApart(sliceRooms({3, 5}, {x, y}, half, kEm), {3, 5}, {x, y});
            }
}

} // namespace
} // namespace tessera::app
