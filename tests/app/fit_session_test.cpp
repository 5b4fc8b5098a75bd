#include "app/history/session_file.h"
#include "app/session/session.h"
#include "cell_info.h"
#include "formula_cell.h"
#include "vis/scene/camera.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>
#include <type_traits>

namespace tessera::app {
namespace {

TEST(SessionTest, TheLatticeWasOnceABool) {
    const SessionDocument old = parseSession(
        R"({"schema": 2, "data": {"model": "fuel-cell", "bcc": false},
            "views": {"compare": {"type": "compare", "variants": [{"name": "a", "changes": {"/data/bcc": "true"}},
                                                                  {"name": "b", "changes": {"/data/bcc": "false"}}]}}})",
        "old");
    EXPECT_TRUE(old.messages.empty()) << old.messages.front();
    EXPECT_EQ(old.session.data.lattice, PictureLattice::Grid);
    const auto& variants = std::get<CompareView>(old.session.views.at("compare")).variants;
    ASSERT_EQ(variants.size(), 2u);
    EXPECT_EQ(variants[0].changes, (std::map<std::string, std::string>{{"/data/lattice", "bodyCentred"}}));
    EXPECT_EQ(variants[1].changes, (std::map<std::string, std::string>{{"/data/lattice", "grid"}}));
    Json step = Json::parse(R"({"schema": 2, "history": [{"op": "replace", "value": "true",
        "path": "/views/compare/variants/0/changes/~1data~1bcc"}]})");
    migrate(step, "x");
    EXPECT_EQ(step["history"][0]["path"], "/views/compare/variants/0/changes/~1data~1lattice");
    EXPECT_EQ(step["history"][0]["value"], "bodyCentred");
    EXPECT_EQ(parseSession(R"({"schema": 2, "data": {"bcc": true}})", "x").session.data.lattice,
              PictureLattice::BodyCentred);
}

TEST(SessionTest, FitReplacesWhatIsNotThere) {
    Session session = defaultSession(cellInfo(), {});
    session.layers = {{"a", true, vis::VolumeLayer{.channel = "salt"}},
                      {"b", true, vis::IsoLayer{.channel = "sugar", .value = 1e9}},
                      {"c", true, vis::IsoLayer{.channel = "T", .value = 2}}};
    session.selection.brushes = {vis::rangeBrush({{.channel = "salt"}}, "x"), vis::rangeBrush({{.channel = "T"}}, "y")};
    session.cursor = {50, 1, 1};
    session.time = 77;
    std::vector<std::string> messages;
    fitSession(session, cellInfo(), messages);
    EXPECT_EQ(std::get<vis::VolumeLayer>(session.layers[0].technique).channel, "O2");
    EXPECT_EQ(std::get<vis::IsoLayer>(session.layers[1].technique).channel, "H2");
    EXPECT_EQ(std::get<vis::IsoLayer>(session.layers[1].technique).value, 3);
    EXPECT_EQ(std::get<vis::IsoLayer>(session.layers[2].technique).value, 2);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    EXPECT_EQ(session.selection.brushes[0].name, "y");
    EXPECT_EQ(session.cursor, glm::dvec3(0.5, 1, 1));
    EXPECT_EQ(session.time, 2);
    EXPECT_EQ(messages.size(), 3u);
}

TEST(SessionTest, FitGivesFlowAVectorOfTheData) {
    volume::DatasetInfo info = cellInfo();
    Session session = defaultSession(info, {});
    session.layers = {{"flow", true, vis::FlowLayer{.vector = "wind", .channel = "T", .weight = "salt"}}};
    std::vector<std::string> messages;
    info.parameters.push_back({});
    info.parameters.back().name = "V";
    info.parameters.back().components = 3;
    fitSession(session, info, messages);
    const auto& flow = std::get<vis::FlowLayer>(session.layers[0].technique);
    EXPECT_EQ(flow.vector, firstVector(info));
    EXPECT_NE(flow.vector, "");
    EXPECT_EQ(flow.channel, "T");
    EXPECT_EQ(flow.weight, "");
}

TEST(SessionTest, FitGivesStrokesAVectorOfTheDataOrNone) {
    volume::DatasetInfo info = cellInfo();
    std::erase_if(info.parameters, [](const volume::Parameter& parameter) { return parameter.components == 3; });
    for (const bool any : {false, true}) {
        if (any) {
            info.parameters.push_back({});
            info.parameters.back().name = "V";
            info.parameters.back().components = 3;
        }
        Session session = defaultSession(info, {});
        session.layers = {{"stroked", true, vis::SliceLayer{.channel = "T", .strokes = {.vector = "wind"}}},
                          {"bare", true, vis::SliceLayer{.channel = "T"}}};
        SlicesView slices;
        slices.strokes.vector = "wind";
        session.views["slices"] = slices;
        session.views["oblique"] = ObliqueView{};
        std::vector<std::string> messages;
        fitSession(session, info, messages);
        const std::string wanted = any ? "V" : "";
        EXPECT_EQ(std::get<vis::SliceLayer>(session.layers[0].technique).strokes.vector, wanted);
        EXPECT_EQ(std::get<vis::SliceLayer>(session.layers[1].technique).strokes.vector, "");
        EXPECT_EQ(std::get<SlicesView>(session.views["slices"]).strokes.vector, wanted);
        EXPECT_EQ(std::get<ObliqueView>(session.views["oblique"]).strokes.vector, "");
    }
}

TEST(SessionTest, FitGivesGlyphsParametersOfTheData) {
    const volume::DatasetInfo info = cellInfo();
    Session session = defaultSession(info, {});
    vis::GlyphLayer glyphs{.channel = "T", .direction = "wind", .weight = "salt", .surface = "salt"};
    glyphs.place = vis::GlyphPlace::Surface;
    glyphs.parts = {{"spoke 1", "T", {1, 2}}, {"spoke 2", "salt", {1, 2}}};
    for (int i = 0; i < 9; ++i) glyphs.parts.push_back({"spoke 3", "unknown " + std::to_string(i), {0, 0}});
    session.layers = {{"glyphs", true, glyphs}};
    std::vector<std::string> messages;
    fitSession(session, info, messages);
    const auto& fitted = std::get<vis::GlyphLayer>(session.layers[0].technique);
    EXPECT_EQ(fitted.direction, "");
    EXPECT_EQ(fitted.weight, "");
    EXPECT_EQ(fitted.surface, "");
    EXPECT_EQ(fitted.place, vis::GlyphPlace::Plane) << "there is no such surface";
    ASSERT_GE(fitted.parts.size(), 2u);
    EXPECT_EQ(fitted.parts[0], glyphs.parts[0]) << "what is known stays";
    std::set<std::string> shown;
    for (const vis::GlyphPart& part : fitted.parts) {
        EXPECT_TRUE(info.findChannel(part.channel)) << part.channel;
        EXPECT_TRUE(shown.insert(part.channel).second) << part.channel << " is shown twice";
    }
    EXPECT_EQ(fitted.parts[1].range, (Range{0, 0})) << "values of another parameter mean nothing";
}

/// Calls `visit(name)` for every member of a view that names parameters, in the order of their descriptions.
template <class Owner> void eachName(Owner& owner, const std::function<void(std::string&)>& visit) {
    Owner::describe(owner, [&]<class Member>(Member& member, const FieldInfo& field) {
        const bool names = field.refersTo == "channel" || field.refersTo == "optionalChannel";
        if constexpr (Described<Member>) {
            eachName(member, visit);
        } else if constexpr (std::is_same_v<Member, std::string>) {
            if (names) visit(member);
        } else if constexpr (std::is_same_v<Member, std::vector<std::string>>) {
            if (!names) return;
            if (member.empty()) member.assign(2, "");
            for (std::string& name : member) visit(name);
        }
    });
}

TEST(SessionTest, FitLeavesNoViewANameThatIsNotThere) {
    int kinds = 0, members = 0;
    const auto tryKind = [&]<class View>(std::type_identity<View>) {
        Session session = defaultSession(cellInfo(), {});
        View view;
        eachName(view, [&](std::string& name) { name = "salt", ++members; });
        session.views = {{"view", view}};
        std::vector<std::string> messages;
        fitSession(session, cellInfo(), messages);
        eachName(std::get<View>(session.views.at("view")), [&](std::string& name) {
            EXPECT_TRUE(name.empty() || cellInfo().findChannel(name)) << View::kType << " keeps " << name;
        });
        ++kinds;
    };
    [&]<class... View>(std::type_identity<std::variant<View...>>) {
        (tryKind(std::type_identity<View>{}), ...);
    }(std::type_identity<ViewState>{});
    EXPECT_GT(kinds, 10);
    EXPECT_GT(members, 15);
}

TEST(SessionTest, FitGivesTheFacesOfTheCubeOneStandInForOneName) {
    Session session = defaultSession(cellInfo(), {});
    ShadowCubeView cube;
    cube.left.channel = cube.back.channel = "salt";
    cube.top.channel = "T";
    StatisticsView statistics;
    statistics.balance = "salt";
    session.views = {{"cube", cube}, {"statistics", statistics}};
    std::vector<std::string> messages;
    fitSession(session, cellInfo(), messages);
    const auto& now = std::get<ShadowCubeView>(session.views.at("cube"));
    EXPECT_EQ(now.left.channel, "O2");
    EXPECT_EQ(now.back.channel, "O2");
    EXPECT_EQ(now.top.channel, "T");
    EXPECT_EQ(std::get<StatisticsView>(session.views.at("statistics")).balance, "") << "another balance is no stand-in";
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0], "parameter salt is not in the data; showing O2 instead");
}

// Data that are opened without a session are shown as they are: nothing of the default is missing in them.
TEST(SessionTest, DefaultFitsItsData) {
    const volume::DatasetInfo whole = formula::makeCell().info;
    std::vector<volume::DatasetInfo> infos{whole, cellInfo()};
    for (const char* model : {"fuel-cell", "marschner-lobb", "casting"})
        infos.push_back(volume::makeModel(model, {{"nx", 9}, {"ny", 9}, {"nz", 21}}).info);
    for (const std::size_t parameter : {0, 2, 3}) // a scalar, a vector, or a label alone
        infos.emplace_back(whole).parameters = {whole.parameters[parameter]};
    infos.emplace_back(whole).parameters.clear();
    infos.emplace_back(whole).times = {0};
    infos.emplace_back(whole).bounds.hi.z = whole.bounds.lo.z;
    for (std::size_t i = 0; i < infos.size(); ++i) {
        const Session made = defaultSession(infos[i], {});
        Session fitted = made;
        std::vector<std::string> messages;
        fitSession(fitted, infos[i], messages);
        EXPECT_TRUE(fitted == made) << i << Json::diff(toJson(made), toJson(fitted)).dump();
        EXPECT_TRUE(messages.empty()) << i;
    }
}

TEST(SessionTest, DefaultStretchesThinCells) {
    const Session session = defaultSession(cellInfo(), {});
    EXPECT_GT(session.stretch.x, 5);
    EXPECT_EQ(session.stretch.z, 1);
    Session copy = session;
    std::vector<std::string> messages;
    fitSession(copy, cellInfo(), messages);
    EXPECT_TRUE(messages.empty());
    EXPECT_TRUE(copy == session);
}

TEST(SessionTest, DefaultCameraSeesTheSphereAroundTheData) {
    const Session session = defaultSession(cellInfo(), {});
    const double radius = glm::length(vis::worldFrame(cellInfo(), session.stretch).halfSize);
    EXPECT_NEAR(session.camera.distance * std::sin(glm::radians(double(session.camera.fieldOfView)) / 2), radius, 1e-5);
}

TEST(SessionTest, DefaultMakesNoughtTheMiddleOfTheColoursOfASignedComponent) {
    volume::DatasetInfo info = cellInfo();
    volume::Parameter velocity;
    velocity.name = "U", velocity.components = 3;
    velocity.ranges = {{-8, 3}, {-2, 5}, {1, 4}, {0, 9}};
    info.parameters.push_back(velocity);
    const Session session = defaultSession(info, {});
    EXPECT_EQ(session.transfer.at("U.x").range, (Range{-8, 8}));
    EXPECT_EQ(session.transfer.at("U.y").range, (Range{-5, 5}));
    EXPECT_TRUE(session.transfer.at("U.z").autoRange);
    EXPECT_TRUE(session.transfer.at("|U|").autoRange);
}

TEST(SessionTest, FitNamesALayerAsWhatItShowsNow) {
    Session session = defaultSession(cellInfo(), {});
    session.layers = {{"salt", true, vis::VolumeLayer{.channel = "salt"}},
                      {"", true, vis::VolumeLayer{.channel = "sugar"}},
                      {"mine", true, vis::VolumeLayer{.channel = "T"}}};
    std::vector<std::string> messages;
    fitSession(session, cellInfo(), messages);
    EXPECT_EQ(session.layers[0].name, std::get<vis::VolumeLayer>(session.layers[0].technique).channel);
    EXPECT_EQ(session.layers[1].name, "");
    EXPECT_EQ(session.layers[2].name, "mine");
}

} // namespace
} // namespace tessera::app
