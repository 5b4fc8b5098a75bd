#include "app/edits/context_style.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

volume::DatasetInfo dataWithHulls() {
    volume::DatasetInfo info;
    info.parameters.resize(2);
    info.parameters[0].name = "a";
    info.parameters[0].ranges = {{0, 10}};
    info.parameters[1].name = "b";
    info.parameters[1].ranges = {{100, 200}};
    return info;
}

TEST(ContextStyles, HullsAreSurfacesOfWhatIsShown) {
    const volume::DatasetInfo info = dataWithHulls();
    Session session;
    session.layers = {{"hidden", false, vis::VolumeLayer{.channel = "a"}},
                      {"seen", true, vis::VolumeLayer{.channel = "b"}}};
    session.transfer["b"].opacity = {{0, 0}, {0.5f, 0}, {1, 1}};
    setContextStyle(session, info, ContextStyle::Silhouette);
    ASSERT_TRUE(hullLayer(session));
    const vis::Layer& layer = session.layers[*hullLayer(session)];
    const auto& hull = std::get<vis::IsoLayer>(layer.technique);
    EXPECT_EQ(hull.channel, "b");
    EXPECT_NEAR(hull.value, 155, 1) << "opacity comes to a tenth at 0.55 of the range";
    EXPECT_TRUE(hull.look.silhouette);
    EXPECT_EQ(layer.brushes, vis::BrushEffect::None) << "stays whole whatever is brushed";
    EXPECT_EQ(session.selection.contextOpacity, 0);
}

TEST(ContextStyles, TheHullAsksForATenthOfTheMostOpaqueValueEvenTheLast) {
    Session session;
    session.layers = {{"seen", true, vis::VolumeLayer{.channel = "a"}}};
    session.transfer["a"].opacity = {{0, 0}, {0.25f, 0}, {0.26f, 0.06f}, {0.996f, 0.06f}, {1, 1}};
    setContextStyle(session, dataWithHulls(), ContextStyle::Hull);
    EXPECT_EQ(std::get<vis::IsoLayer>(session.layers.at(1).technique).value, 5) << "0.06 is less: the middle";
}

TEST(ContextStyles, OneHullAtATimeThatKeepsItsPlace) {
    const volume::DatasetInfo info = dataWithHulls();
    Session session;
    session.layers = {{"seen", true, vis::VolumeLayer{.channel = "a"}}};
    setContextStyle(session, info, ContextStyle::Hull);
    std::get<vis::IsoLayer>(session.layers[1].technique).value = 3.25;
    setContextStyle(session, info, ContextStyle::Wire);
    ASSERT_EQ(session.layers.size(), 2u);
    const auto& hull = std::get<vis::IsoLayer>(session.layers[1].technique);
    EXPECT_EQ(hull.value, 3.25);
    EXPECT_TRUE(hull.look.wire && !hull.look.silhouette);
    for (const ContextStyle style :
         {ContextStyle::Faint, ContextStyle::Grey, ContextStyle::Blurred, ContextStyle::Hidden}) {
        setContextStyle(session, info, ContextStyle::Drawn);
        setContextStyle(session, info, style);
        EXPECT_EQ(session.layers.size(), 1u);
        EXPECT_EQ(session.selection.contextBlur > 0, style == ContextStyle::Blurred);
        EXPECT_EQ(session.selection.contextOpacity == 0, style == ContextStyle::Hidden);
    }
}

TEST(ContextStyles, AHullHasTheLookOfItsStyleAlone) {
    const auto lookOf = [](ContextStyle style) {
        Session session;
        session.layers = {{"seen", true, vis::VolumeLayer{.channel = "a"}}};
        setContextStyle(session, dataWithHulls(), style);
        return std::get<vis::IsoLayer>(session.layers.at(1).technique).look;
    };
    EXPECT_EQ(lookOf(ContextStyle::Hull), vis::Look{});
    EXPECT_EQ(lookOf(ContextStyle::Drawn), *vis::Look::preset("tone"));
    vis::Look wire, silhouette = lookOf(ContextStyle::Silhouette);
    wire.wire.emplace();
    EXPECT_EQ(lookOf(ContextStyle::Wire), wire);
    EXPECT_TRUE(silhouette.silhouette);
    silhouette.silhouette.reset();
    EXPECT_EQ(silhouette, vis::Look{});
}

} // namespace
} // namespace tessera::app
