#include "app/history/history.h"
#include "app/history/session_file.h"
#include "cell_info.h"
#include "volume/base/error.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>
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

TEST_F(SessionFileTest, ATruncatedFileIsAnError) {
    const std::string text = printSession(edited(), in("a.tessera.json"));
    const std::size_t end = text.rfind('}');
    constexpr std::size_t kEach = 1500; // every cut near either end, every 17th between
    for (std::size_t cut = 0; cut <= end; cut += cut < kEach || end - cut <= kEach + 17 ? 1 : 17) {
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

/// Sessions of the fuel cell as it was before its layers had cells of their own still show that one.
TEST_F(SessionFileTest, TheFuelCellOfEarlierSessionsIsTheEvenOne) {
    const auto settings = [](const std::string& text) { return parseSession(text, "x").session.data.settings; };
    using Settings = std::map<std::string, double>;
    EXPECT_EQ(settings(R"({"schema": 4, "data": {"model": "fuel-cell", "settings": {"nz": 20}}})"),
              (Settings{{"even", 1}, {"nz", 20}}));
    EXPECT_EQ(settings(R"({"schema": 2, "data": {"model": "fuel-cell"}})"), (Settings{{"even", 1}}));
    EXPECT_EQ(settings(R"({"schema": 4, "data": {"model": "casting"}})"), Settings());
    EXPECT_EQ(settings(R"({"schema": 5, "data": {"model": "fuel-cell"}})"), Settings());
    const auto other =
        parseSession(R"({"schema": 4, "data": {"model": "casting", "other": {"model": "fuel-cell"}}})", "x")
            .session.data.other;
    ASSERT_TRUE(other);
    EXPECT_EQ(other->settings, (Settings{{"even", 1}}));
}

TEST_F(SessionFileTest, BrushesOfEarlierSessionsLeaveTheirPicturesAsTheyWere) {
    const auto least = [](const std::string& text) { return parseSession(text, "x").session.selection.focusOpacity; };
    EXPECT_EQ(least(R"({"schema": 4, "selection": {"contextOpacity": 0.1}})"), 0);
    EXPECT_EQ(least(R"({"schema": 5, "selection": {"contextOpacity": 0.1}})"), vis::Selection().focusOpacity);
    EXPECT_EQ(least(R"({"schema": 4})"), vis::Selection().focusOpacity) << "brushes to come";
}

TEST_F(SessionFileTest, PathsOfEarlierVersionsKeepTheirSpeed) {
    const auto layer = [](const std::string& schema, const std::string& kind) {
        const Session session =
            parseSession(R"({"schema": )" + schema +
                             R"(, "layers": [{"technique": {"type": "flow", "vector": "U", "channel": "T", "kind": ")" +
                             kind + R"(", "speed": 1000}}]})",
                         "x")
                .session;
        return std::get<vis::FlowLayer>(session.layers.at(0).technique);
    };
    EXPECT_TRUE(layer("5", "pathlines").ignoreUnits) << "1 length per time, times the speed";
    EXPECT_EQ(layer("5", "pathlines").speed, 1000);
    EXPECT_FALSE(layer("6", "pathlines").ignoreUnits);
    EXPECT_FALSE(layer("5", "tubes").ignoreUnits);
    const std::string path = R"({"technique": {"type": "flow", "vector": "U", "channel": "T", "kind": "pathlines"}})";
    const Session own =
        parseSession(R"({"schema": 5, "views": {"v": {"type": "volume", "layers": [)" + path + "]}}}", "x").session;
    const vis::Layer& shown = std::get<VolumeView>(own.views.at("v")).layers.value().at(0);
    EXPECT_TRUE(std::get<vis::FlowLayer>(shown.technique).ignoreUnits) << "layers of one view";
    Json step = Json::parse(R"({"schema": 5, "history": [{"op": "add", "path": "/layers/0", "value": )" + path + "}]}");
    migrate(step, "x");
    EXPECT_EQ(step["history"][0]["value"]["technique"]["ignoreUnits"], true) << "what can be undone";
    // Layers that become paths by keyframes, a variant or a step of the history.
    const std::string tubes =
        R"({"technique": {"type": "flow", "vector": "U", "channel": "T", "kind": "tubes", "speed": 1000}})";
    const auto becoming = [&](const std::string& schema, const std::string& rest) {
        Json json = Json::parse(R"({"schema": )" + schema + R"(, "layers": [)" + tubes + "]" + rest + "}");
        migrate(json, "x");
        return json["layers"][0]["technique"].value("ignoreUnits", false);
    };
    const std::string keys =
        R"(, "animation": {"tracks": [{"path": "/layers/0/technique/kind", "keys": [{"at": 0, "value": [5]}]}]})";
    EXPECT_TRUE(becoming("5", keys));
    EXPECT_FALSE(becoming("6", keys));
    EXPECT_TRUE(becoming("5", R"(, "views": {"c": {"type": "compare", "variants": [
        {"changes": {"/layers/0/technique/kind": "\"pathlines\""}}]}})"));
    EXPECT_TRUE(becoming(
        "5", R"(, "history": [[{"op": "replace", "path": "/layers/0/technique/kind", "value": "pathlines"}]])"));
    EXPECT_FALSE(
        becoming("5", R"(, "history": [[{"op": "replace", "path": "/layers/0/technique/kind", "value": "arrows"}]])"));
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

TEST(SessionMessages, SayFilePlaceAndReasonInThisOrder) {
    const auto reason = [](const std::string& text) -> std::string {
        try {
            parseSession(text, "mine.tessera.json");
        } catch (const Error& error) {
            return error.what();
        }
        return "read";
    };
    const std::string file = "mine.tessera.json";
    EXPECT_EQ(reason(R"({"schema": 999})"),
              Error("written by a newer version of Tessera (schema 999, this one reads up to " +
                        std::to_string(kSessionSchema) + ")",
                    file, "/schema")
                  .what());
    EXPECT_THAT(reason("[]"), testing::HasSubstr(file));
    EXPECT_THAT(reason(R"({"schema": 999})"), testing::HasSubstr(file));
    EXPECT_THAT(reason("{\n \"schema\": 3,\n ]"), testing::HasSubstr("line 3, column 2"));
    const SessionDocument document =
        parseSession("{\"schema\": " + std::to_string(kSessionSchema) + ", \"render\": {\"glitter\": 1}}", file);
    EXPECT_THAT(document.messages, testing::ElementsAre("mine.tessera.json: /render/glitter: unknown key, kept"));
    EXPECT_THAT(reason("{\"schema\": " + std::to_string(kSessionSchema) + ", \"render\": {\"filter\": \"sharp\"}}"),
                testing::HasSubstr("unknown name \"sharp\"; known are "));
}

} // namespace
} // namespace tessera::app
