#include "app/data/plane_sources.h"
#include "app/drawing/drawing.h"
#include "app/session/session_json.h"
#include "app/user_files/state_dir.h"
#include "tests/app/open_fixture.h"
#include "vis/image/image_io.h"
#include "volume/base/error.h"
#include "volume/import/foreign.h"
#include "volume/synthetic/models.h"
#include "volume/system/atomic_file.h"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

// Before anything is allocated: the system may give memory that it does not have, and end the program later.
TEST_F(OpenTest, FilesLargerThanMemoryNameTheWayOut) {
    std::ofstream(folder / "vast.raw") << "x";
    std::error_code refused;
    fs::resize_file(folder / "vast.raw", std::uintmax_t(1) << 42, refused); // 4 TiB with nothing in it
    if (refused) GTEST_SKIP() << "no such large files here";
    OpenRequest request = rawRequest(in("vast.raw"));
    request.import->raw = "dims=16384x16384x16384,type=u8";
    try {
        open(request);
        FAIL() << "it was opened";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("vast.raw: needs 4.4 TB of memory, and "));
        EXPECT_THAT(error.what(), testing::HasSubstr("tessera pack"));
    }
}

TEST_F(OpenTest, ProgressRunsFromNoughtToOne) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 2}};
    for (const bool packed : {false, true}) {
        if (packed) request.data->packed.emplace();
        std::vector<double> told;
        Progress progress;
        progress.report = [&](double fraction, const std::string&) { told.push_back(fraction); };
        open(request, progress);
        ASSERT_GT(told.size(), 2u);
        EXPECT_TRUE(std::is_sorted(told.begin(), told.end())) << packed;
        EXPECT_GE(told.front(), 0);
        EXPECT_LE(told.back(), 1);
    }
}

TEST_F(OpenTest, ADataFileGetsTheDefaultSession) {
    const Opened opened = open(rawRequest(raw("a.raw")));
    ASSERT_TRUE(opened.source);
    EXPECT_EQ(opened.source->info().parameters.size(), 1u);
    EXPECT_EQ(opened.document.session.layers.size(), 2u);
    EXPECT_TRUE(opened.document.history.steps().empty());
    EXPECT_EQ(opened.document.session.data.files[0].bytes, 420);
}

TEST_F(OpenTest, AFirstPictureOfAScanLeavesTheBackgroundOut) {
    // Noise of 10..19 around a ball of 200; no unit of length is stated, so none is claimed.
    std::string bytes;
    for (int i = 0; i < 17 * 17 * 17; ++i) {
        const int x = i % 17 - 8, y = i / 17 % 17 - 8, z = i / 289 - 8;
        bytes += static_cast<char>(x * x + y * y + z * z < 25 ? 200 : 10 + i * 7 % 10);
    }
    std::ofstream(folder / "ball.raw", std::ios::binary) << bytes;
    OpenRequest request;
    request.paths = {in("ball.raw")};
    request.import.emplace();
    request.import->raw = "dims=17x17x17,type=u8,spacing=1x2x1";
    const Opened opened = open(request);
    EXPECT_EQ(opened.source->info().lengthUnit, "");
    const Session& session = opened.document.session;
    const std::vector<glm::vec2>& curve = session.transfer.begin()->second.opacity;
    ASSERT_EQ(curve.size(), 3u);
    EXPECT_EQ(curve[1].y, 0);
    EXPECT_GT(curve[1].x, 9.0 / 190);
    EXPECT_GT(curve[1].x, 9.0 / 190);
    EXPECT_LT(curve[1].x, 0.5) << "half of what lies between noise and ball";
    // Every corner of the box is in the picture.
    const vis::WorldFrame world = vis::worldFrame(opened.source->info(), session.stretch);
    const glm::dmat4 matrix = vis::projectionMatrix(session.camera, 1) * vis::viewMatrix(session.camera);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const glm::dvec4 clip = matrix * glm::dvec4(world.halfSize * sign, 1);
        EXPECT_LT(std::max(std::abs(clip.x), std::abs(clip.y)), clip.w);
    }
}

TEST_F(OpenTest, TheFirstCursorLiesWhereThereAreSamples) {
    // Present in the upper part only: the middle of the box is empty.
    std::ofstream file(folder / "half.raw", std::ios::binary);
    for (int i = 0; i < 9 * 9 * 9; ++i) {
        const float value = i / 81 > 5 ? static_cast<float>(i) : -1.0f;
        file.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
    file.close();
    std::ofstream(folder / "half.json") << R"({"dims":[9,9,9],"dtype":"float32","missing_value":-1})";
    OpenRequest request;
    request.paths = {in("half.raw")};
    const Session session = open(request).document.session;
    EXPECT_GT(session.cursor.z, 5.4);
    EXPECT_NEAR(session.cursor.x, 4, 1);
    EXPECT_NEAR(session.cursor.y, 4, 1);
}

TEST_F(OpenTest, DataOfOneSampleThicknessIsShownAsASlice) {
    OpenRequest request = rawRequest(raw("a.raw"));
    request.import->raw = "dims=20x1x21,type=u8";
    const Session session = open(request).document.session;
    ASSERT_EQ(session.layers.size(), 2u);
    EXPECT_FALSE(session.layers[0].visible);
    EXPECT_TRUE(session.layers[1].visible);
    EXPECT_EQ(std::get<vis::SliceLayer>(session.layers[1].technique).orientation, vis::SliceOrientation::Y);
}

TEST_F(OpenTest, ASessionBringsItsDataAndItsImportOptions) {
    Opened opened = open(rawRequest(raw("a.raw")));
    opened.document.session.camera.distance = 4;
    saveSession(opened.document, in("s.tessera.json"));
    OpenRequest request;
    request.paths = {in("s.tessera.json")};
    const Opened again = open(request);
    ASSERT_TRUE(again.source);
    EXPECT_TRUE(again.document.session == opened.document.session);
    EXPECT_EQ(again.sessionPath, in("s.tessera.json"));
    // Without the data: told, not thrown, so that the window can ask.
    fs::remove(folder / "a.raw");
    const Opened lost = open(request);
    EXPECT_FALSE(lost.source);
    ASSERT_EQ(lost.missing.size(), 1u);
    EXPECT_EQ(lost.missing[0].wanted.path, "a.raw");
    // Found by the user under another name.
    DataRef data = dataOf({raw("b.raw")}, lost.document.session.data.import);
    const Opened found = openWith(lost, data);
    EXPECT_TRUE(found.source);
    EXPECT_EQ(found.document.session.camera.distance, 4);
}

TEST_F(OpenTest, TimeAlongAnAxisTakesTheTimeWithItAndBack) {
    OpenRequest request;
    request.data = DataRef{};
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 4}};
    Opened opened = open(request);
    const volume::DatasetInfo info = opened.source->info();
    Session& session = opened.document.session;
    session.time = info.times[2];
    session.cursor = info.bounds.lo + glm::dvec3(0.5, 0.25, 0.75) * info.bounds.size();
    const Session before = session;
    DataRef data = session.data;
    data.timeAxis = {volume::SpaceAxis::Z, 0.75};
    Opened along = openWith(opened, data);
    const double seconds = along.source->info().plane->timePerLength;
    EXPECT_NEAR(along.document.session.cursor.z * seconds, info.times[2], 1e-12);
    EXPECT_EQ(along.document.session.cursor.y, before.cursor.y);
    const auto origin = [](const Opened& of) { return originText(of.origin, of.numbers->info()); };
    EXPECT_EQ(origin(along), origin(opened) + ", interpolated along time") << "its numbers say so";

    const Opened back = openWith(along, before.data);
    EXPECT_EQ(back.document.session.time, before.time);
    EXPECT_NEAR(back.document.session.cursor.z, before.cursor.z, 1e-12);
    // A cross-hair that was moved there goes to its time.
    along.document.session.cursor.z = 0.4 * info.times[1] / seconds;
    EXPECT_NEAR(openWith(along, before.data).document.session.time, 0.4 * info.times[1], 1e-9);
}

TEST_F(OpenTest, TheCrossHairStaysInSpaceAndTimeWhileAPlaneIsTurned) {
    OpenRequest request;
    request.data = DataRef{};
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 4}};
    Opened opened = open(request);
    const volume::DatasetInfo info = opened.source->info();
    Session& session = opened.document.session;
    session.time = info.times[2];
    session.cursor = info.bounds.lo + glm::dvec3(0.5, 0.25, 0.75) * info.bounds.size();
    const Session before = session;
    DataRef data = session.data;
    const double share = (session.time - info.times.front()) / (info.times.back() - info.times.front());
    for (const double degrees : {20.0, -70.0, 45.0, 0.0, 90.0}) {
        data.timeAxis = {volume::SpaceAxis::Z, 0.75, degrees, share};
        opened = openWith(opened, data);
        const volume::DatasetInfo& shown = opened.source->info();
        ASSERT_TRUE(shown.plane) << degrees;
        const glm::dvec4 point = shown.pointAt(opened.document.session.cursor, 0);
        EXPECT_NEAR(glm::distance(glm::dvec3(point), before.cursor), 0, 1e-9) << degrees;
        EXPECT_NEAR(point.w, before.time, 1e-9) << degrees;
    }
    opened = openWith(opened, before.data);
    EXPECT_EQ(opened.document.session.time, before.time);
    EXPECT_NEAR(glm::distance(opened.document.session.cursor, before.cursor), 0, 1e-9);
}

TEST_F(OpenTest, APlaneSavedBeforeItCouldBeTurnedIsTimeAlongAnAxis) {
    const Json saved = Json::parse(R"({"schema":5,"data":{"model":"fuel-cell","timeAxis":{"axis":"y","place":0.25}}})");
    const volume::TimeAxis plane = sessionFromJson(saved, {}).data.timeAxis.value();
    EXPECT_EQ(plane, (volume::TimeAxis{volume::SpaceAxis::Y, 0.25}));
    EXPECT_EQ(plane.degrees, 90);
}

TEST_F(OpenTest, ALayoutBringsItsPlaneToDataThatHaveTheTimes) {
    OpenRequest request;
    request.layout = "hyperplane";
    request.data = DataRef{};
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 4}};
    const Opened cut = open(request);
    ASSERT_TRUE(cut.numbers->info().plane);
    EXPECT_TRUE(cut.document.session.data.timeAxis);
    EXPECT_EQ(cut.origin.spaceOfPlane->info().times.size(), 4u);
    request.data->settings["times"] = 1;
    const Opened whole = open(request);
    EXPECT_FALSE(whole.numbers->info().plane);
    EXPECT_FALSE(whole.document.session.data.timeAxis);
    EXPECT_NE(std::ranges::find(whole.messages, kNoTimesToCut), whole.messages.end()) << "it says why";
}

// The panel lets a plane be typed that does not meet the data; a session that was saved then must open again.
TEST_F(OpenTest, ASessionWhosePlaneDoesNotMeetTheDataOpens) {
    DataRef data;
    data.model = "fuel-cell";
    data.settings = {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 4}};
    data.timeAxis = volume::TimeAxis{.equation = volume::PlaneEquation{.d = 1, .e = -77}};
    std::vector<std::string> messages;
    const Sources sources = openSources(data, messages);
    EXPECT_EQ(sources.numbers->info().times.size(), 4u);
    EXPECT_FALSE(sources.numbers->info().plane);
    ASSERT_FALSE(messages.empty());
    EXPECT_THAT(messages.back(), testing::HasSubstr("does not meet the data")) << "it says why";
    data.timeAxis->equation->e = -sources.numbers->info().times[1];
    EXPECT_TRUE(openSources(data, messages).numbers->info().plane);
}

TEST_F(OpenTest, ThePlaneOfALayoutFitsOtherData) {
    volume::DatasetInfo flat;
    flat.bounds = {glm::dvec3(0), glm::dvec3(2, 3, 0)};
    flat.times = {0, 1};
    Session layout;
    layout.data.timeAxis = volume::TimeAxis{volume::SpaceAxis::Z, 0.5, 30};
    std::vector<std::string> messages;
    const auto fitted = planeOfLayout(layout, flat, messages);
    ASSERT_TRUE(fitted);
    EXPECT_EQ(*fitted, (volume::TimeAxis{volume::SpaceAxis::Y, 0.5, 30})) << "they have no z";
    EXPECT_TRUE(messages.empty());
    layout.data.timeAxis->equation = volume::PlaneEquation{.d = 1, .e = -7};
    EXPECT_FALSE(planeOfLayout(layout, flat, messages)) << "a time that they do not have";
    EXPECT_EQ(messages.size(), 1u) << "it says why";
}

TEST_F(OpenTest, APictureCarriesItsSession) {
    const Opened opened = open(rawRequest(raw("a.raw")));
    vis::Image image;
    image.size = {2, 3};
    image.rgba.assign(24, 200);
    vis::writePng(in("p.png"), image, {{vis::kSessionTextKey, printSession(opened.document, in("p.png"))}});
    OpenRequest request;
    request.paths = {in("p.png")};
    const Opened again = open(request);
    EXPECT_TRUE(again.document.session == opened.document.session);
    EXPECT_EQ(again.sessionPath, "") << "a picture is no place to save a session to";
    vis::writePng(in("damaged.png"), image, {{vis::kSessionTextKey, "no session"}});
    request.paths = {in("damaged.png")};
    EXPECT_THROW(open(request), Error) << "is not taken for a picture without one";
    vis::writePng(in("plain.png"), image);
    request.paths = {in("plain.png")};
    if (volume::findImporter().empty()) return;
    const Opened plain = open(request);
    const auto numbers = plain.numbers ? plain.numbers : plain.source;
    EXPECT_EQ(numbers->info().lattice.size, glm::ivec3(2, 3, 1)) << "is a slice of data";
}

TEST_F(OpenTest, SoDoFiguresAsSvgAndPdf) {
    const Opened opened = open(rawRequest(raw("a.raw")));
    VectorPage page;
    page.size = {100, 80};
    for (const char* suffix : {"svg", "pdf"}) {
        const std::string path = in(std::string("figure.") + suffix);
        OpenRequest request;
        request.paths = {path};
        page.session = printSession(opened.document, path);
        writeAtomically(path, fileOf(page, suffix));
        const Opened again = open(request);
        EXPECT_TRUE(again.document.session == opened.document.session) << suffix;
        EXPECT_TRUE(again.source) << "with its data";
        EXPECT_EQ(again.sessionPath, "") << "a figure is no place to save a session to";
        page.session.clear();
        writeAtomically(path, fileOf(page, suffix));
        try {
            open(request);
            ADD_FAILURE() << suffix;
        } catch (const Error& error) {
            EXPECT_EQ(error.reason(), "this picture contains no session");
        }
    }
}

TEST_F(OpenTest, BadFilesAreErrors) {
    OpenRequest request;
    for (const auto& [name, text] : {std::pair{"a.tessera.json", "{"},
                                     {"b.tessera.json", "{\"schema\": 3, \"time\": []}"},
                                     {"c.png", "not a picture"},
                                     {"d.tsr", "not an archive"},
                                     {"e.json", "{}"}}) {
        std::ofstream(folder / name) << text;
        request.paths = {in(name)};
        EXPECT_THROW(open(request), Error) << name;
    }
    request.paths = {in("absent.vti")};
    EXPECT_THROW(open(request), Error);
    request.paths = {folder.string()};
    EXPECT_THROW(open(request), Error);
}

// A header may name samples elsewhere only where the user allows it, which no file says.
TEST_F(OpenTest, AnAutosaveOpensTheFilesElsewhereThatWereAllowed) {
    fs::create_directory(folder / "data");
    std::ofstream(folder / "samples.raw") << "01234567";
    std::ofstream(folder / "data/header.nhdr") << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\n"
                                                  "encoding: raw\ndata file: ../samples.raw\n";
    OpenRequest request;
    request.paths = {in("data/header.nhdr")};
    EXPECT_THROW(open(request), Error);
    request.import.emplace().allowOutside = true;
    const Opened shown = open(request);
    std::ofstream(folder / "autosave.tessera.json") << printSession(shown.document, in("autosave.tessera.json"));
    request.import.reset();
    request.paths = {in("autosave.tessera.json")};
    EXPECT_THROW(open(request), Error) << "as a session of somebody";
    const Opened again = open(recoveryRequest(in("autosave.tessera.json")));
    ASSERT_TRUE(again.numbers);
    EXPECT_EQ(again.numbers->info().lattice.size, glm::ivec3(2));
}

TEST_F(OpenTest, RecentFilesAndAutosave) {
    const std::string state = folder.string();
    EXPECT_TRUE(recentFiles(state).empty());
    std::ofstream(folder / "recent.json") << "broken; [";
    EXPECT_TRUE(recentFiles(state).empty());
    for (int i = 0; i < 20; ++i) addRecentFile(state, "/data/" + std::to_string(i) + ";odd name.tsr");
    addRecentFile(state, "/data/15;odd name.tsr");
    ASSERT_EQ(recentFiles(state).size(), 12u);
    EXPECT_EQ(recentFiles(state)[0], "/data/15;odd name.tsr");
    addRecentFile(state, "https://host//a/../b.tsr");
    EXPECT_EQ(recentFiles(state)[0], "https://host//a/../b.tsr") << "an address stays as it is";

    // Left by a run that is gone, and by one that still lives (holds its lock).
    std::ofstream(folder / "autosave-1.tessera.json") << "{}";
    std::ofstream(folder / "autosave-2.tessera.json") << "{}";
    const int lock = ::open(in("autosave-2.tessera.json.lock").c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
    std::string own;
    {
        Autosave autosave(state);
        EXPECT_EQ(autosave.save("text"), "");
        own = in("autosave-" + std::to_string(getpid()) + ".tessera.json");
        EXPECT_EQ(readText(own), "text");
        const std::vector<Recovery> left = autosave.abandoned();
        ASSERT_EQ(left.size(), 1u);
        EXPECT_EQ(left[0].path, in("autosave-1.tessera.json"));
        Autosave::discard(left[0]);
        EXPECT_TRUE(autosave.abandoned().empty());
    }
    EXPECT_FALSE(fs::exists(own));
    ::close(lock);
}

} // namespace
} // namespace tessera::app
