#include "app/history/history.h"
#include "app/history/session_file.h"
#include "randomise.h"
#include "volume/base/error.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <type_traits>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

class SessionFileTest : public ::testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("tessera-session-" + std::to_string(getpid()) + "-" +
                                              ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    std::string in(const std::string& name) const { return (folder / name).string(); }
    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder / name).parent_path());
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    fs::path folder;
};

volume::DatasetInfo cellInfo() {
    volume::DatasetInfo info;
    info.name = "cell";
    info.bounds = {{0, 0, 0}, {1, 2, 100}};
    for (const char* name : {"O2", "H2", "T"}) {
        volume::Parameter parameter;
        parameter.name = name;
        parameter.ranges = {{1, 5}};
        info.parameters.push_back(parameter);
    }
    info.times = {0, 1, 2};
    return info;
}

SessionDocument edited() {
    SessionDocument document;
    DataRef data;
    data.model = "fuel-cell";
    document.session = defaultSession(cellInfo(), data);
    document.history.reset(document.session);
    document.session.camera.distance = 3;
    document.history.observe(document.session, false, 0);
    document.session.selection.brushes.push_back({});
    document.history.observe(document.session, false, 10);
    return document;
}

TEST_F(SessionFileTest, SavesAndLoads) {
    const SessionDocument document = edited();
    saveSession(document, in("a.tessera.json"));
    const SessionDocument back = loadSession(in("a.tessera.json"));
    EXPECT_TRUE(back.session == document.session);
    EXPECT_TRUE(back.history == document.history);
    EXPECT_TRUE(back.messages.empty());
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "a temporary file was left";
}

TEST_F(SessionFileTest, KeepsBrushesOfEveryShape) {
    SessionDocument document = edited();
    std::vector<vis::Brush>& brushes = document.session.selection.brushes;
    const std::vector<vis::Region> regions{
        vis::RangeRegion{{{"T", 1, 2, 0.25}, {"O2", -1e-9, 1e9, 0}}},
        vis::EllipseRegion{"T", "O2", {1, 2}, {3, 4}, -0.5, 0.125},
        vis::LassoRegion{"O2", "T", {{0, 0}, {1, 0.1}, {0.3, 1e-7}}, 0.5},
        vis::SphereRegion{{1, 2, 3}, {4, 5, 6}, 1},
        vis::BoxRegion{{-1, -2, -3}, {1e-3, 2e-3, 3e-3}, 0},
        vis::LensRegion{"lens 2"},
    };
    ASSERT_EQ(regions.size(), std::variant_size_v<vis::Region>);
    brushes.clear();
    for (const vis::Region& region : regions)
        for (const auto combine : {vis::BrushCombine::And, vis::BrushCombine::Or, vis::BrushCombine::Minus})
            brushes.push_back({.name = "brush " + std::to_string(brushes.size()),
                               .color = {0.5f, 0.25f, 1},
                               .enabled = brushes.size() % 2 == 0,
                               .inverted = brushes.size() % 3 == 0,
                               .combine = combine,
                               .region = region});
    document.history.observe(document.session, false, 20);
    saveSession(document, in("brushes.tessera.json"));
    const SessionDocument back = loadSession(in("brushes.tessera.json"));
    EXPECT_TRUE(back.messages.empty());
    EXPECT_TRUE(back.session.selection == document.session.selection);
}

TEST_F(SessionFileTest, KeepsUnknownKeysAndReportsThem) {
    const SessionDocument document = edited();
    Json json = Json::parse(printSession(document, in("a.tessera.json")));
    json["camera"]["wobble"] = {{"x", 1}};
    json["future"] = Json::array({1, 2});
    write("a.tessera.json", json.dump());
    SessionDocument back = loadSession(in("a.tessera.json"));
    EXPECT_EQ(back.messages.size(), 2u);
    back.session.camera.distance = 5;
    const Json again = Json::parse(printSession(back, in("b.tessera.json")));
    EXPECT_EQ(again["camera"]["wobble"]["x"], 1);
    EXPECT_EQ(again["camera"]["distance"], 5);
    EXPECT_EQ(again["future"], Json::array({1, 2}));
}

TEST_F(SessionFileTest, EveryTruncationIsAnError) {
    const std::string text = printSession(edited(), in("a.tessera.json"));
    const std::size_t end = text.rfind('}');
    for (std::size_t cut = 0; cut <= end; ++cut) {
        try {
            parseSession(std::string_view(text).substr(0, cut), "cut.tessera.json");
            FAIL() << "accepted " << cut << " of " << text.size() << " bytes";
        } catch (const Error& error) {
            ASSERT_EQ(error.file(), "cut.tessera.json");
        }
    }
}

TEST_F(SessionFileTest, FlippedBytesNeverCrash) {
    std::string text = printSession(edited(), in("a.tessera.json"));
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        std::string broken = text;
        for (int flips = 1 + int(random() % 3); flips-- > 0;) broken[random() % broken.size()] = char(random());
        try {
            SessionDocument document = parseSession(broken, "x");
            std::vector<std::string> messages;
            fitSession(document.session, cellInfo(), messages);
            while (document.history.canUndo()) document.history.undo();
        } catch (const Error&) {
        }
    }
}

TEST_F(SessionFileTest, RefusesNewerAndForeignDocuments) {
    EXPECT_THROW(parseSession("{\"schema\": 99}", "x"), Error);
    EXPECT_THROW(parseSession("{}", "x"), Error);
    EXPECT_THROW(parseSession("[1]", "x"), Error);
    EXPECT_THROW(parseSession("{\"schema\": \"1\"}", "x"), Error);
    EXPECT_FALSE(looksLikeSession("{\"dims\": [1, 2, 3]}"));
    EXPECT_TRUE(looksLikeSession(printSession(edited(), "x")));
}

TEST_F(SessionFileTest, EarlySchemasAreRefusedByName) {
    for (const int schema : {0, 1}) try {
            parseSession("{\"schema\": " + std::to_string(schema) + ", \"stretch\": [1, 1, 4]}", "x");
            FAIL() << "schema " << schema << " was read";
        } catch (const Error& error) {
            EXPECT_NE(error.reason().find("early version of Tessera (schema " + std::to_string(schema) + ")"),
                      std::string::npos)
                << error.reason();
        }
    EXPECT_EQ(parseSession("{\"schema\": 2}", "x").session.schema, kSessionSchema);
}

TEST_F(SessionFileTest, LayersOfALensThatIsMissingAreHidden) {
    volume::DatasetInfo info;
    info.bounds = {glm::dvec3(0), glm::dvec3(1)};
    info.parameters.resize(1);
    info.parameters[0].name = "T";
    Session session;
    session.lenses = {{.name = "here"}};
    session.layers = {{"a", true, vis::VolumeLayer{.channel = "T"}, "here", "mine"},
                      {"b", true, vis::VolumeLayer{.channel = "T"}, "gone"}};
    session.views["transfer"] = TransferView{.channel = "mine"};
    std::vector<std::string> messages;
    fitSession(session, info, messages);
    EXPECT_TRUE(session.layers[0].visible);
    EXPECT_FALSE(session.layers[1].visible);
    EXPECT_TRUE(session.layers[1].lens.empty());
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("gone"), std::string::npos);
    EXPECT_EQ(std::get<TransferView>(session.views["transfer"]).channel, "mine") << "a layer's own function";
}

TEST_F(SessionFileTest, FindsDataAfterTheFolderMoved) {
    write("one/data/cell.tsr", "12345");
    SessionDocument document = edited();
    document.session.data = {};
    document.session.data.files = {describeFile(in("one/data/cell.tsr"))};
    document.history.setData(document.session.data);
    saveSession(document, in("one/a.tessera.json"));
    EXPECT_EQ(Json::parse(readText(in("one/a.tessera.json")))["data"]["files"][0]["path"], "data/cell.tsr");
    fs::rename(folder / "one", folder / "two");
    SessionDocument moved = loadSession(in("two/a.tessera.json"));
    ResolvedData found = resolveData(moved.session.data, in("two"));
    EXPECT_TRUE(found.missing.empty());
    EXPECT_TRUE(found.warnings.empty());
    EXPECT_EQ(found.data.files[0].absolutePath, in("two/data/cell.tsr"));
    // Beside the session under its name alone.
    fs::rename(folder / "two/data/cell.tsr", folder / "two/cell.tsr");
    found = resolveData(moved.session.data, in("two"));
    EXPECT_TRUE(found.missing.empty());
    // Changed: found, with a warning that names the hash.
    write("two/cell.tsr", "1234x");
    found = resolveData(moved.session.data, in("two"));
    ASSERT_EQ(found.warnings.size(), 1u);
    EXPECT_NE(found.warnings[0].find("has changed"), std::string::npos);
    // Gone: reported with what is known of it.
    fs::remove(folder / "two/cell.tsr");
    found = resolveData(moved.session.data, in("two"));
    ASSERT_EQ(found.missing.size(), 1u);
    EXPECT_EQ(found.missing[0].wanted.bytes, 5);
}

TEST_F(SessionFileTest, OtherDataAreFoundAndMissedAsTheFirst) {
    write("one/a.tsr", "12345");
    write("one/more/b.tsr", "123");
    SessionDocument document = edited();
    document.session.data = {};
    document.session.data.files = {describeFile(in("one/a.tsr"))};
    document.session.data.other =
        OtherData{.files = {describeFile(in("one/more/b.tsr"))}, .model = {}, .settings = {}, .import = {}};
    document.history.setData(document.session.data);
    saveSession(document, in("one/s.tessera.json"));
    EXPECT_EQ(Json::parse(readText(in("one/s.tessera.json")))["data"]["other"]["files"][0]["path"], "more/b.tsr");
    fs::rename(folder / "one", folder / "two");
    SessionDocument moved = loadSession(in("two/s.tessera.json"));
    ResolvedData found = resolveData(moved.session.data, in("two"));
    EXPECT_TRUE(found.missing.empty());
    EXPECT_EQ(found.data.other->files[0].absolutePath, in("two/more/b.tsr"));
    write("two/more/b.tsr", "12x");
    found = resolveData(moved.session.data, in("two"));
    ASSERT_EQ(found.warnings.size(), 1u);
    fs::remove(folder / "two/more/b.tsr");
    found = resolveData(moved.session.data, in("two"));
    ASSERT_EQ(found.missing.size(), 1u);
    EXPECT_TRUE(found.missing[0].other);
    EXPECT_EQ(found.missing[0].index, 0u);
    EXPECT_EQ(found.missing[0].wanted.bytes, 3);
    locate(moved.session.data, found.missing[0], in("two/a.tsr"));
    EXPECT_TRUE(resolveData(moved.session.data, in("two")).missing.empty());
}

TEST_F(SessionFileTest, ThePictureOfTheSurroundingsMovesWithTheSession) {
    write("one/pictures/sky.hdr", "#?RADIANCE");
    SessionDocument document;
    document.session.lighting.environment.kind = vis::Environment::Picture;
    document.session.lighting.environment.picture = in("one/pictures/sky.hdr");
    saveSession(document, in("one/a.tessera.json"));
    EXPECT_EQ(Json::parse(readText(in("one/a.tessera.json")))["lighting"]["environment"]["picture"],
              "pictures/sky.hdr");
    fs::rename(folder / "one", folder / "two");
    EXPECT_EQ(loadSession(in("two/a.tessera.json")).session.lighting.environment.picture, in("two/pictures/sky.hdr"));
}

TEST(HistoryTest, UndoAllAndRedoAllOfRandomEdits) {
    std::mt19937 random(5);
    Session session = defaultSession(cellInfo(), {});
    session.animation.playing = false; // what plays is no edit
    session.animation.position = 0;
    History history;
    history.reset(session);
    std::vector<Session> states{session};
    for (int i = 0; i < 60; ++i) {
        Session next = i % 7 == 0 ? randomValue<Session>(random) : session;
        next.schema = kSessionSchema;
        next.animation.playing = false;
        next.animation.position = 0;
        if (i % 7 != 0) {
            next.camera.distance = 1 + float(i) / 10;
            if (i % 3 == 0) next.layers.push_back(randomValue<vis::Layer>(random));
            if (i % 5 == 0 && !next.layers.empty()) next.layers.erase(next.layers.begin());
        }
        if (next == session) continue;
        ASSERT_TRUE(history.observe(next, false, i * 10.0)) << i;
        session = next;
        states.push_back(session);
    }
    ASSERT_EQ(history.steps().size() + 1, states.size());
    for (std::size_t i = states.size(); i-- > 1;) ASSERT_TRUE(history.undo() == states[i - 1]) << i;
    EXPECT_FALSE(history.canUndo());
    for (std::size_t i = 1; i < states.size(); ++i) ASSERT_TRUE(history.redo() == states[i]) << i;
    EXPECT_FALSE(history.canRedo());
    EXPECT_TRUE(history.seek(3) == states[3]);
    const History again = History::fromJson(history.toJson(), states[3]);
    EXPECT_TRUE(again == history);
    EXPECT_THROW(History::fromJson(history.toJson(), states[4]), Error);
    // Forty copies of the document into itself would be a million million of them.
    Json bomb = history.toJson();
    bomb["steps"][0]["forward"] = Json::parse(R"([{"op":"copy","from":"","path":"/more"}])");
    EXPECT_THAT([&] { History::fromJson(bomb, states[3]); },
                testing::ThrowsMessage<Error>(testing::HasSubstr("not a JSON patch")));
}

TEST(HistoryTest, ADragIsOneStepAndAWheelTurnIsOneStep) {
    Session session;
    History history;
    history.reset(session);
    for (int i = 0; i < 20; ++i) {
        session.camera.distance += 0.1f;
        EXPECT_FALSE(history.observe(session, true, i * 0.02));
    }
    EXPECT_TRUE(history.observe(session, false, 0.4));
    EXPECT_EQ(history.steps().size(), 1u);
    for (int i = 0; i < 5; ++i) {
        session.time += 1;
        history.observe(session, false, 10 + i * 0.1);
    }
    EXPECT_EQ(history.steps().size(), 2u);
    EXPECT_EQ(history.steps()[1].name, "time");
    EXPECT_EQ(history.undo().time, 0);
}

TEST(HistoryTest, PlayingIsNoEdit) {
    Session session;
    History history;
    history.reset(session);
    session.animation.playing = true;
    for (int i = 0; i < 5; ++i) {
        session.time += 1;
        EXPECT_FALSE(history.observe(session, false, i));
    }
    session.animation.playing = false;
    EXPECT_FALSE(history.observe(session, false, 9));
    session.camera.distance = 7;
    EXPECT_TRUE(history.observe(session, false, 20));
    EXPECT_EQ(history.steps().size(), 1u);
    EXPECT_EQ(history.undo().time, 5);
}

TEST(HistoryTest, WhichTabsAreInFrontIsNoEdit) {
    Session session;
    session.dock.root.id = 1;
    session.dock.root.tabs = {"a", "b", "c"};
    History history;
    history.reset(session);
    session.dock.root.active = 1;
    EXPECT_FALSE(history.observe(session, false, 1));
    EXPECT_FALSE(history.pending());
    // A pane that comes is one; what is undone and done again lets the tabs be.
    session.dock.root.tabs.push_back("d");
    session.dock.root.active = 3;
    EXPECT_TRUE(history.observe(session, false, 2));
    session.camera.distance = 7;
    EXPECT_TRUE(history.observe(session, false, 3));
    session.dock.root.active = 2;
    EXPECT_FALSE(history.observe(session, false, 4));
    EXPECT_EQ(history.steps().size(), 2u);
    EXPECT_TRUE(History::fromJson(history.toJson(), session).steps().size() == 2) << "as saved";
    EXPECT_EQ(history.undo().dock.root.active, 2);
    EXPECT_EQ(history.undo().dock.root.tabs.size(), 3u);
    EXPECT_EQ(history.redo().dock.root.tabs.size(), 4u);
    EXPECT_EQ(history.redo().camera.distance, 7);
}

TEST(HistoryTest, AStepMayHaveAName) {
    Session session;
    History history;
    history.reset(session);
    for (const char* name : {"Layout: Lens", "Layout: Flow"}) {
        history.nameNext(name);
        session.camera.distance += 1;
        session.time += 1;
        EXPECT_TRUE(history.observe(session, false, 1));
    }
    history.nameNext("Layout: Flow");
    EXPECT_FALSE(history.observe(session, false, 1)) << "it is shown already";
    session.camera.distance += 1;
    session.time += 1;
    EXPECT_TRUE(history.observe(session, false, 1));
    ASSERT_EQ(history.steps().size(), 3u) << "none joins the one before";
    EXPECT_EQ(history.steps()[0].name, "Layout: Lens");
    EXPECT_EQ(history.steps()[1].name, "Layout: Flow");
    EXPECT_EQ(history.steps()[2].name, "several changes");
}

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

} // namespace
} // namespace tessera::app
