#include "app/pane/view_parts.h"
#include "app/session/session.h"
#include "app/session/shown_scene.h"
#include "app/ui/ticks.h"

#include <gtest/gtest.h>

/// What the legends of a scene say.
namespace tessera::app {
namespace {

volume::DatasetInfo gasInfo() {
    volume::DatasetInfo info;
    for (const auto& [name, unit] : {std::pair{"O2", "mol/m3"}, {"H2O", "mol/m3"}, {"T", "K"}}) {
        volume::Parameter parameter;
        parameter.name = name;
        parameter.unit = unit;
        parameter.ranges = {{1, 9}};
        info.parameters.push_back(parameter);
    }
    return info;
}

/// Each legend as one line: title and unit, and what it shows.
std::vector<std::string> rows(const Session& session) {
    std::vector<std::string> out;
    for (const LegendEntry& entry : sceneLegends(session, gasInfo()))
        out.push_back(entry.swatch
                          ? entry.title + " = " + formatQuantity(entry.value, entry.unit, 0.01)
                          : titleWithUnit(entry.title, entry.unit) + (entry.opacity ? ", opacity" : ", colours"));
    return out;
}

using Rows = std::vector<std::string>;

TEST(LegendTest, OfALayerColouredByAnotherParameterShowsBoth) {
    Session session;
    session.layers = {{"", true, vis::VolumeLayer{.channel = "H2O", .colorBy = "T"}},
                      {"", true, vis::IsoLayer{.channel = "O2", .value = 5, .colorBy = "T"}}};
    const std::string opacity = titleWithUnit("opacity by H2O", "mol/m3") + ", opacity",
                      colors = titleWithUnit("T", "K") + ", colours",
                      surface = "O2 = " + formatQuantity(5, "mol/m3", 0.01);
    EXPECT_EQ(rows(session), (Rows{opacity, colors, surface})) << "T once";
    std::get<vis::IsoLayer>(session.layers[1].technique).method = vis::SurfaceMethod::Polygons;
    EXPECT_EQ(rows(session), (Rows{opacity, colors, surface})) << "as of rays";
    std::get<vis::VolumeLayer>(session.layers[0].technique).colorBy = "nowhere";
    EXPECT_EQ(rows(session), (Rows{titleWithUnit("H2O", "mol/m3") + ", colours", surface, colors}));
}

TEST(LegendTest, IsOfTheFunctionsInUse) {
    Session session;
    session.transfer["T"].colormap = "inferno";
    session.transfer["own"].colormap = "magma";
    session.transfer["own"].opacity = {{0, 1}, {1, 0}};
    session.layers = {{"", true, vis::VolumeLayer{.channel = "H2O", .colorBy = "T"}, "", "own"}};
    auto legends = sceneLegends(session, gasInfo());
    ASSERT_EQ(legends.size(), 2u);
    EXPECT_EQ(legends[0].function, session.transfer["own"]) << "a volume's own function gives the opacity";
    EXPECT_EQ(legends[1].function, session.transfer["T"]);
    session.layers = {{"", true, vis::IsoLayer{.channel = "O2", .value = 5, .colorBy = "T"}, "", "own"}};
    legends = sceneLegends(session, gasInfo());
    ASSERT_EQ(legends.size(), 2u);
    EXPECT_EQ(legends[1].function, session.transfer["own"]) << "a surface's the colours";
    EXPECT_EQ(legends[1].title, "T");
}

/// The colour of an X-ray is that of the share that is absorbed, and a gradient's that of a change: not of a value.
TEST(LegendTest, ShowsWhatItsColoursMean) {
    Session session;
    session.transfer["T"].gradientTop = 0.25f;
    session.transfer["T"].autoRange = false;
    session.transfer["T"].range = Range{2, 6};
    session.transfer["own"].colormap = "magma";
    vis::VolumeLayer plain{.channel = "T"}, xray = plain, steep = plain;
    xray.style = vis::RayStyle::XRay;
    steep.quantity = vis::Quantity::Gradient;
    session.layers = {
        {"", true, plain}, {"", true, xray}, {"", true, steep}, {"", true, plain}, {"", true, plain, "", "own"}};
    EXPECT_EQ(
        rows(session),
        (Rows{titleWithUnit("T", "K") + ", colours", titleWithUnit("absorption by T", "%") + ", colours",
              titleWithUnit("change of T over a cell", "K") + ", colours", titleWithUnit("T", "K") + ", colours"}))
        << "once for each function";
    const auto legends = sceneLegends(session, gasInfo());
    EXPECT_EQ(legends.at(0).range, (Range{2, 6}));
    EXPECT_EQ(legends.at(1).range, (Range{0, 100}));
    EXPECT_EQ(legends.at(1).data, (Range{0, 100}));
    EXPECT_EQ(legends.at(2).range, (Range{0, 1})) << "a quarter of the range over a cell";
    EXPECT_EQ(legends.at(2).data, (Range{0, 8})) << "more is possible";
    EXPECT_EQ(legends.at(3).function, session.transfer["own"]);
    steep.colorBy = "O2";
    session.layers = {{"", true, steep}};
    EXPECT_EQ(rows(session).at(0), titleWithUnit("opacity by change of T over a cell", "K") + ", opacity");
}

TEST(LegendTest, OfAVolumeByRegionsShowsTheirColours) {
    Session session;
    session.transfer["T"].kind = vis::TransferKind::Regions;
    session.layers = {{"", true, vis::VolumeLayer{.channel = "T"}}};
    EXPECT_TRUE(sceneLegends(session, gasInfo()).at(0).regions);
    session.transfer["T"].kind = vis::TransferKind::Curve;
    EXPECT_FALSE(sceneLegends(session, gasInfo()).at(0).regions);
    session.transfer["T"].kind = vis::TransferKind::Regions;
    session.layers = {{"", true, vis::SliceLayer{.channel = "T"}}};
    EXPECT_FALSE(sceneLegends(session, gasInfo()).at(0).regions) << "a slice has the colours of the map";
}

TEST(LegendTest, OnlyDrawingsAreThoseWithoutAnyOtherLayer) {
    Session session;
    EXPECT_FALSE(onlyDrawings(session)) << "nothing is drawn";
    session.layers = {{"", true, vis::IsoLayer{.channel = "O2", .look = *vis::Look::preset("pencil")}},
                      {"", true, vis::VolumeLayer{.channel = "T", .look = *vis::Look::preset("stipple")}}};
    EXPECT_TRUE(onlyDrawings(session));
    EXPECT_TRUE(sceneLegends(session, gasInfo()).empty());
    session.layers.push_back({"", true, vis::SliceLayer{.channel = "T"}});
    EXPECT_FALSE(onlyDrawings(session));
    session.layers.back().visible = false;
    EXPECT_TRUE(onlyDrawings(session));
    std::get<vis::VolumeLayer>(session.layers[1].technique).look = *vis::Look::preset("cartoon");
    EXPECT_FALSE(onlyDrawings(session)) << "a cartoon has the colours of its transfer function";
}

TEST(LegendTest, ParametersThatTheDataLackColourNothing) {
    Session session = defaultSession(gasInfo(), {});
    session.layers = {{"rays", true, vis::VolumeLayer{.channel = "O2", .colorBy = "salt"}},
                      {"shape", true, vis::IsoLayer{.channel = "O2", .value = 5, .colorBy = "T"}}};
    std::vector<std::string> messages;
    fitSession(session, gasInfo(), messages);
    EXPECT_EQ(vis::colorByOf(session.layers[0].technique), "");
    EXPECT_EQ(vis::colorByOf(session.layers[1].technique), "T");
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("salt"), std::string::npos);
}

} // namespace
} // namespace tessera::app
