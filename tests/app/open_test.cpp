#include "app/data/open.h"
#include "app/drawing/drawing.h"
#include "app/user_files/state_dir.h"
#include "codec/pack/pack.h"
#include "vis/image/image_io.h"
#include "volume/base/error.h"
#include "volume/synthetic/models.h"
#include "volume/system/atomic_file.h"

#include <algorithm>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

class OpenTest : public ::testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("tessera-open-" + std::to_string(getpid()) + "-" +
                                              ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    std::string in(const std::string& name) const { return (folder / name).string(); }
    std::string raw(const std::string& name) const {
        std::ofstream(folder / name, std::ios::binary) << std::string(5 * 6 * 7, '\x21') + std::string(210, '\x42');
        return in(name);
    }
    static OpenRequest rawRequest(const std::string& path) {
        OpenRequest request;
        request.paths = {path};
        request.import.emplace();
        request.import->raw = "dims=5x6x14,type=u8";
        return request;
    }
    fs::path folder;
};

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
    const vis::WorldFrame world = vis::worldFrame(opened.source->info().bounds, session.stretch);
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
    const double seconds = volume::timePerLength(along.source->info(), *data.timeAxis);
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
    vis::writePng(in("plain.png"), image);
    request.paths = {in("plain.png")};
    EXPECT_THROW(open(request), Error);
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

TEST_F(OpenTest, ALayoutFitsAnyData) {
    OpenRequest request = rawRequest(raw("a.raw"));
    for (const std::string& name : layoutNames()) {
        request.layout = name;
        const Opened opened = open(request);
        ASSERT_TRUE(opened.source) << name;
        const std::string only =
            opened.source->info().channel(0).name + (opened.document.session.data.originals ? " error" : "");
        ASSERT_FALSE(opened.document.session.layers.empty()) << name;
        for (const vis::Layer& layer : opened.document.session.layers)
            std::visit([&](const auto& technique) { EXPECT_EQ(technique.channel, only) << name; }, layer.technique);
        EXPECT_FALSE(opened.messages.empty()) << name << ": nobody is told that parameters were replaced";
        EXPECT_TRUE(opened.document.session.dock.root.children.size() == 2) << name;
    }
}

OpenRequest smallCell(int times) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 13}, {"nz", 20}, {"times", double(times)}};
    return request;
}

// Parameters of a simulation may be far from their overall range at one time: a surface must be looked for there.
TEST_F(OpenTest, ALayoutChosenKeepsTheTimeAndItsSurfacesExistThen) {
    const Opened opened = open(smallCell(5));
    const volume::DatasetInfo& info = opened.source->info();
    for (const char* name : {"evening", "charcoal", "compare_lattice", "gases"})
        for (std::size_t t = 0; t < info.times.size(); ++t) {
            Session shown = opened.document.session;
            shown.time = info.times[t];
            std::vector<std::string> messages;
            const Session session = changeLayout(loadSession(findLayout(name)), *opened.source, shown, messages);
            EXPECT_EQ(session.time, shown.time) << name;
            EXPECT_EQ(session.cursor, shown.cursor) << name;
            bool surface = false;
            for (const vis::Layer& layer : session.layers) {
                const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
                if (!iso) continue;
                surface = true;
                std::size_t below = 0, above = 0;
                const glm::ivec3 count = opened.source->grid().count();
                for (int z = 0; z < count.z; ++z)
                    for (int y = 0; y < count.y; ++y)
                        for (int x = 0; x < count.x; ++x) {
                            const volume::BrickSamples samples = opened.source->read(
                                {info.findChannel(iso->channel).value(), static_cast<int>(t), 0, {x, y, z}});
                            for (std::size_t i = 0; i < samples.values.size(); ++i)
                                if (samples.present.empty() || samples.present[i])
                                    ++(double(samples.values[i]) < iso->value ? below : above);
                        }
                EXPECT_GT(below, 0u) << name << " at " << shown.time << ": " << iso->channel << " = " << iso->value;
                EXPECT_GT(above, 0u) << name << " at " << shown.time << ": " << iso->channel << " = " << iso->value;
            }
            EXPECT_TRUE(surface) << name;
        }
}

// A surface of a parameter that the data do not have shows the strongest boundary of the one that takes its place.
TEST_F(OpenTest, ALayoutsSurfaceFollowsABoundaryOfOtherData) {
    std::string bytes;
    for (int z = 0; z < 14; ++z)
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 5; ++x) bytes += static_cast<char>(z < 4 ? 10 : z < 7 ? 40 * (z - 3) + 30 : 200);
    std::ofstream(folder / "step.raw", std::ios::binary) << bytes; // 10, then 70, 110, 150, then 200
    OpenRequest request = rawRequest(in("step.raw"));
    request.layout = "charcoal";
    const Session session = open(request).document.session;
    int surfaces = 0;
    for (const vis::Layer& layer : session.layers)
        if (const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique)) {
            ++surfaces;
            EXPECT_GT(iso->value, 60) << layer.name;
            EXPECT_LT(iso->value, 160) << layer.name;
            EXPECT_GT(std::abs(iso->value - 105), 2) << "the middle of the range is no boundary";
        }
    EXPECT_GT(surfaces, 0);
}

TEST_F(OpenTest, ASurfaceThatCannotBeIsToldOf) {
    std::ofstream(folder / "flat.raw", std::ios::binary) << std::string(5 * 6 * 14, '\x21');
    const Opened opened = open(rawRequest(in("flat.raw")));
    std::vector<std::string> messages;
    changeLayout(loadSession(findLayout("evening")), *opened.source, opened.document.session, messages);
    EXPECT_TRUE(std::ranges::any_of(
        messages, [](const std::string& text) { return text.find("surface is empty") != std::string::npos; }));
}

TEST_F(OpenTest, ALayoutOfErrorsOnDataWithoutOriginalsIsToldOf) {
    const Opened opened = open(smallCell(2));
    Session shown = opened.document.session;
    for (const bool originals : {false, true}) {
        shown.data.originals = originals;
        std::vector<std::string> messages;
        changeLayout(loadSession(findLayout("compression_error")), *opened.source, shown, messages);
        EXPECT_EQ(std::ranges::count_if(
                      messages, [](const std::string& text) { return text.find("originals") != std::string::npos; }),
                  originals ? 0 : 1);
    }
}

TEST_F(OpenTest, ALayoutChosenKeepsTheBrushesOfTheUser) {
    const Opened opened = open(smallCell(3));
    const auto change = [&](const Session& from, const char* name, std::vector<std::string>& messages) {
        return changeLayout(loadSession(findLayout(name)), *opened.source, from, messages);
    };
    const auto names = [](const Session& session) {
        std::vector<std::string> all;
        for (const vis::Brush& brush : session.selection.brushes)
            all.push_back(brush.name + (brush.enabled ? "" : " off"));
        return all;
    };
    using Names = std::vector<std::string>;
    Session shown = opened.document.session;
    std::vector<std::string> messages;
    EXPECT_EQ(names(change(shown, "focus", messages)), Names{"hot and starved"});
    EXPECT_EQ(names(change(change(shown, "focus", messages), "statistics", messages)), Names{"little oxygen"})
        << "a brush that came from a layout goes with it";
    EXPECT_TRUE(change(change(shown, "focus", messages), "overview", messages).selection.brushes.empty());

    // As do those of a layout file of the user's own, whatever became of the file.
    SessionDocument own = loadSession(findLayout("focus"));
    own.session.selection.brushes[0].name = "hot";
    own.raw["selection"] = toJson(own.session)["selection"];
    Session brushed = changeLayout(own, *opened.source, shown, messages);
    ASSERT_EQ(names(brushed), Names{"hot"});
    brushed = sessionFromJson(toJson(brushed), {}); // as saved and opened again
    EXPECT_EQ(names(change(brushed, "statistics", messages)), Names{"little oxygen"});
    brushed.selection.brushes[0].inverted = true;
    EXPECT_EQ(names(change(brushed, "overview", messages)), Names{"hot"}) << "it is the user's once it was changed";

    shown.selection.brushes = {vis::rangeBrush({{"T", 340, 350, 0}}, "mine")};
    messages.clear();
    const Session plain = change(shown, "overview", messages);
    EXPECT_EQ(plain.selection.brushes, shown.selection.brushes);
    const Session focus = change(shown, "focus", messages);
    EXPECT_EQ(names(focus), (Names{"mine", "hot and starved off"})) << "the selection stays";
    EXPECT_THAT(messages, testing::Contains("the layout's brush hot and starved is switched off, beside yours"));
    EXPECT_EQ(names(change(focus, "overview", messages)), Names{"mine"});
    shown.selection.brushes[0].name = "hot and starved";
    messages.clear();
    EXPECT_EQ(change(shown, "focus", messages).selection.brushes, shown.selection.brushes);
    EXPECT_THAT(messages,
                testing::Contains("the layout's brush hot and starved is left out: yours of that name stays"));

    shown.selection.brushes[0].region = vis::LensRegion{.lens = "glass"};
    messages.clear();
    EXPECT_TRUE(change(shown, "overview", messages).selection.brushes.empty());
    EXPECT_THAT(messages, testing::Contains("brush hot and starved is removed: the layout has no lens glass"));
}

TEST_F(OpenTest, ADrawingOfAFieldHasItsBox) {
    const SessionDocument layout = loadSession(findLayout("charcoal"));
    const auto box = [](const Session& session) {
        const auto& view = std::get<VolumeView>(session.views.at("volume"));
        return view.showBox && view.drawingBox;
    };
    std::vector<std::string> messages;
    const Opened cell = open(smallCell(2));
    const Session drawn = changeLayout(layout, *cell.source, cell.document.session, messages);
    EXPECT_TRUE(box(drawn)) << "its surfaces float in the paper else";
    const Opened scan = open(rawRequest(raw("scan.raw")));
    const Session body = changeLayout(layout, *scan.source, scan.document.session, messages);
    EXPECT_FALSE(box(body));
    OpenRequest own;
    own.layout = "charcoal";
    EXPECT_FALSE(box(open(own).document.session)) << "with its own data a layout is as it was made";
}

TEST_F(OpenTest, VariantsOfAnotherModelAreLeftOut) {
    OpenRequest request = smallCell(2);
    const Opened opened = open(request);
    std::vector<std::string> messages;
    const SessionDocument layout = loadSession(findLayout("compare_lattice"));
    const Session session = changeLayout(layout, *opened.source, opened.document.session, messages);
    const auto& compare = std::get<CompareView>(session.views.at("compare"));
    ASSERT_EQ(compare.variants.size(), 5u);
    EXPECT_EQ(compare.variants[0].name, "CC, trilinear");
    EXPECT_EQ(compare.reference, 0);
    EXPECT_TRUE(std::ranges::any_of(messages, [](const std::string& text) {
        return text.starts_with("this comparison uses the model marschner-lobb");
    }));
    // On the model itself all are there.
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 8}, {"ny", 8}, {"nz", 8}};
    const Opened own = open(request);
    const Session whole = changeLayout(layout, *own.source, own.document.session, messages);
    EXPECT_EQ(std::get<CompareView>(whole.views.at("compare")).variants.size(), 6u);
    // The truth is one of the signal shown, not of the layout's.
    const auto truth = [](const Session& from) {
        const auto& variants = std::get<CompareView>(from.views.at("compare")).variants;
        return Json::parse(variants.at(0).changes.at("/data/settings"));
    };
    EXPECT_EQ(truth(layout.session), (Json{{"fM", 3}, {"nx", 128}, {"ny", 128}, {"nz", 128}}));
    EXPECT_EQ(truth(whole), (Json{{"nx", 128}, {"ny", 128}, {"nz", 128}}));
    request.data->settings["fM"] = 5;
    const Opened other = open(request);
    EXPECT_EQ(truth(changeLayout(layout, *other.source, other.document.session, messages))["fM"], 5);
}

/// Data that are not packed are packed to show the errors of that; an archive has no originals.
TEST_F(OpenTest, TheLayoutOfErrorsPacksOtherData) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 12}, {"ny", 12}, {"nz", 12}};
    request.layout = "compression_error";
    const Opened opened = open(request);
    const Session& session = opened.document.session;
    EXPECT_TRUE(session.data.originals);
    ASSERT_TRUE(session.data.packed);
    const volume::DatasetInfo& info = opened.numbers->info();
    const auto error = info.findChannel("rho error");
    ASSERT_TRUE(error);
    EXPECT_FALSE(info.findChannel("T error"));
    EXPECT_EQ(std::get<vis::VolumeLayer>(session.layers.at(0).technique).channel, "rho error");
    EXPECT_EQ(std::get<HistogramView>(session.views.at("histogram")).channel, "rho error");
    EXPECT_TRUE(session.transfer.at("rho error").aboutZero);
    const Range errors = info.channelRange(info.channel(*error));
    EXPECT_GT(errors.hi - errors.lo, 0);
    const auto says = [](const Opened& what, const std::string& text) {
        return std::ranges::any_of(what.messages, [&](const std::string& each) { return each.find(text) + 1 > 0; });
    };
    EXPECT_TRUE(says(opened, "samples are within 1.0 % of each parameter's range"));
    EXPECT_TRUE(says(opened, "another lattice")) << "and these are not bounded";
    EXPECT_FALSE(says(opened, "an archive has no originals"));
    // A file of one's own, and as an archive.
    request = rawRequest(raw("own.raw"));
    request.layout = "compression_error";
    EXPECT_TRUE(open(request).document.session.data.originals);
    volume::Dataset signal = volume::makeModel("marschner-lobb", {{"nx", 12}, {"ny", 12}, {"nz", 12}});
    codec::pack(signal, {}, in("own.tsr"));
    request = {};
    request.paths = {in("own.tsr")};
    request.layout = "compression_error";
    const Opened archive = open(request);
    EXPECT_FALSE(archive.document.session.data.originals);
    EXPECT_TRUE(says(archive, "an archive has no originals"));
}

TEST_F(OpenTest, ShippedLayoutsAreValid) {
    const std::vector<std::string> names = layoutNames();
    EXPECT_TRUE(std::find(names.begin(), names.end(), "overview") != names.end());
    for (const char* shipped : {"gases", "starved", "statistics", "flow", "lens", "focus", "charcoal", "illustration",
                                "shadowcube", "tesseract", "animation"})
        EXPECT_TRUE(std::find(names.begin(), names.end(), shipped) != names.end()) << shipped;
    for (const std::string& name : names) {
        const SessionDocument layout = loadSession(findLayout(name));
        EXPECT_TRUE(layout.messages.empty()) << layout.messages.front();
        std::vector<std::string> panes = panesOf(layout.session.dock), keys = paneKeys(layout.session);
        std::sort(panes.begin(), panes.end());
        EXPECT_EQ(panes, keys) << name;
    }
    EXPECT_THROW(findLayout("no such layout"), Error);
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
