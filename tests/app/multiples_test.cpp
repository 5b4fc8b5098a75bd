#include "app/edits/multiples.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

TEST(SmallMultiples, TimesAreSpreadFromTheFirstToTheLast) {
    using Indices = std::vector<std::size_t>;
    EXPECT_EQ(spreadTimes(24, 9), (Indices{0, 3, 6, 9, 12, 14, 17, 20, 23}));
    EXPECT_EQ(spreadTimes(3, 9), (Indices{0, 1, 2}));
    EXPECT_EQ(spreadTimes(2, 2), (Indices{0, 1}));
    EXPECT_EQ(spreadTimes(1, 9), (Indices{0}));
    for (std::size_t count = 2; count < 60; ++count)
        for (std::size_t most = 2; most < 10; ++most) {
            const Indices all = spreadTimes(count, most);
            EXPECT_EQ(all.size(), std::min(count, most));
            EXPECT_EQ(all.front(), 0u);
            EXPECT_EQ(all.back(), count - 1);
            std::size_t least = count, widest = 0;
            for (std::size_t i = 1; i < all.size(); ++i) {
                least = std::min(least, all[i] - all[i - 1]);
                widest = std::max(widest, all[i] - all[i - 1]);
            }
            EXPECT_GE(least, 1u);
            EXPECT_LE(widest - least, 1u) << count << " " << most;
        }
}

/// No other number of columns shows an object of that shape larger.
TEST(SmallMultiples, ColumnsFitThePlaceAndTheObject) {
    EXPECT_EQ(gridColumns(1, 1.5, 1), 1);
    EXPECT_EQ(gridColumns(4, 1, 1), 2);
    EXPECT_EQ(gridColumns(9, 1.5, 1.5), 3);
    EXPECT_EQ(gridColumns(6, 1.5, 1), 3);
    EXPECT_EQ(gridColumns(3, 1, 3), 1) << "long objects above one another";
    EXPECT_EQ(gridColumns(3, 3, 0.9), 3);
    EXPECT_EQ(gridColumns(7, 1.5, 1.2), 3);
    for (int count = 1; count < 12; ++count)
        for (const double aspect : {0.5, 1.0, 1.6, 3.0})
            for (const double object : {0.5, 1.0, 2.5}) {
                const auto height = [&](int columns) {
                    return std::min(1.0 / ((count + columns - 1) / columns), aspect / columns / object);
                };
                const int chosen = gridColumns(count, aspect, object);
                for (int other = 1; other <= count; ++other)
                    EXPECT_GE(height(chosen) * 1.002, height(other)) << count << " " << aspect << " " << object;
            }
}

Session twoPanes() {
    Session session;
    session.views["volume"] = VolumeView{};
    session.views["slices"] = SlicesView{};
    session.views["layers"] = LayersView{};
    session.dock.root.id = 1;
    session.dock.root.tabs = {"volume"};
    insertPane(session.dock, "layers", 1, DockSide::Right);
    insertPane(session.dock, "slices", 1, DockSide::Right);
    return session;
}

TEST(SmallMultiples, TakeThePlaceOfAllThatShowsDataThere) {
    Session session = twoPanes();
    std::get<VolumeView>(session.views.at("volume")).camera = vis::Camera{.distance = 7};
    makeMultiples(session, "volume", viewsByTime(session, "volume", {0, 1, 2, 3}), 1, 1);
    EXPECT_EQ(session.camera.distance, 7) << "that of the view they take the place of";
    EXPECT_EQ(session.views.size(), 6u);
    EXPECT_NE(stackWith(session.dock.root, "layers"), 0);
    EXPECT_EQ(stackWith(session.dock.root, "slices"), stackWith(session.dock.root, "layers")) << "a tab elsewhere";
    DockTree checked = session.dock;
    repair(checked, paneKeys(session));
    EXPECT_TRUE(checked == session.dock) << "a sound tree";
    // A floating view has no place: the grid stands beside the rest.
    Session floating = twoPanes();
    floatPane(floating.dock, "volume", {});
    makeMultiples(floating, "volume", viewsByTime(floating, "volume", {0, 1}), 1, 1);
    EXPECT_TRUE(floating.dock.floating.empty());
    EXPECT_EQ(panesOf(floating.dock).size(), 4u);
    EXPECT_NE(stackWith(floating.dock.root, "slices"), 0);
}

TEST(SmallMultiples, EachParameterIsDrawnAsTheFirstLayerWas) {
    Session session = twoPanes();
    vis::VolumeLayer layer{.channel = "T", .density = 3};
    session.layers = {{"hidden", false, vis::SliceLayer{.channel = "T"}}, {"temperature", true, layer}};
    session.layers[1].transfer = "own";
    const auto views = viewsByParameter(session, "volume", {"O2", "p"});
    ASSERT_EQ(views.size(), 2u);
    for (const VolumeView& view : views) {
        ASSERT_EQ(view.layers->size(), 1u);
        const auto& made = std::get<vis::VolumeLayer>(view.layers->front().technique);
        EXPECT_EQ(made.density, 3);
        EXPECT_TRUE(view.layers->front().transfer.empty()) << "the function is that of the parameter";
        EXPECT_TRUE(view.multiple);
    }
    EXPECT_EQ(std::get<vis::VolumeLayer>(views[1].layers->front().technique).channel, "p");
    EXPECT_TRUE(views[0].showGizmo);
    EXPECT_FALSE(views[1].showGizmo);
}

} // namespace
} // namespace tessera::app
