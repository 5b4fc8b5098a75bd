#include "app/platform/headless.h"
#include "codec/pack/pack.h"
#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <set>
#include <unistd.h>

/// Tasks whose answer is a picture: the same after saving and loading, and on another machine.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

class ScenariosGl : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("tessera-scenarios-" + std::to_string(getpid()));
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    std::string in(const std::string& name) const { return (folder / name).string(); }
    fs::path folder;
};

std::size_t countDiffering(const vis::Image& a, const vis::Image& b) {
    if (a.size != b.size) return a.rgba.size();
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) count += a.rgba[i] != b.rgba[i];
    return count;
}

// A drawing made by hand is the same picture, byte for byte, after it was saved and opened again; its grain turns with
// the object.
TEST_F(ScenariosGl, ADrawingIsTheSameAfterSavingAndOpening) {
    OpenRequest request;
    request.paths = {TESSERA_SOURCE_DIR "/tests/sessions/illustration.tessera.json"};
    Opened opened = open(request);
    const PictureRequest picture{.pane = "volume", .size = {240, 160}, .scale = 1};
    opened.document.session.render.samples = 1;
    opened.document.history.reset(opened.document.session);
    PictureMaker maker;
    const vis::Image first = maker.render(opened.document, opened.sources(), picture);
    saveSession(opened.document, in("drawing.tessera.json"));
    request.paths = {in("drawing.tessera.json")};
    const Opened again = open(request);
    EXPECT_EQ(again.document.session, opened.document.session);
    PictureMaker other;
    EXPECT_EQ(countDiffering(first, other.render(again.document, again.sources(), picture)), 0u);
    SessionDocument turned = again.document;
    vis::orbit(turned.session.camera, {0, 0}, {0.2f, 0});
    EXPECT_GT(countDiffering(first, maker.render(turned, again.sources(), picture)), 1000u);
}

// A session in a folder with its data: moved as a whole, then with the data renamed, then changed.
TEST_F(ScenariosGl, ASessionOpensOnAnotherMachine) {
    fs::create_directories(folder / "one");
    volume::Dataset cell = volume::makeModel("planted", {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 2}});
    codec::pack(cell, {}, in("one/cell.tsr"));
    // Recorded by hand on such a file elsewhere; a lens is added.
    SessionDocument recorded = loadSession(TESSERA_SOURCE_DIR "/tests/sessions/portable.tessera.json");
    recorded.session.data.files = {describeFile(in("one/cell.tsr"))};
    recorded.session.lenses = {{.name = "here", .center = recorded.session.cursor}};
    recorded.session.render.samples = 1;
    recorded.history.reset(recorded.session);
    saveSession(recorded, in("one/figure.tessera.json"));
    OpenRequest request;
    request.paths = {in("one/figure.tessera.json")};
    const Opened opened = open(request);
    ASSERT_TRUE(opened.missing.empty());
    const Session& session = opened.document.session;
    EXPECT_FALSE(session.selection.brushes.empty());
    PictureMaker maker;
    const PictureRequest picture{.pane = "", .size = {480, 320}, .scale = 1};
    const vis::Image first = maker.render(opened.document, opened.sources(), picture);

    fs::rename(folder / "one", folder / "two");
    request.paths = {in("two/figure.tessera.json")};
    Opened moved = open(request);
    EXPECT_TRUE(moved.missing.empty()) << "data beside the session are found without a question";
    EXPECT_TRUE(moved.messages.empty());
    EXPECT_EQ(moved.document.session.selection, session.selection);
    EXPECT_EQ(moved.document.session.lenses, session.lenses);
    EXPECT_EQ(moved.document.session.camera, session.camera);
    EXPECT_EQ(moved.document.session.dock, session.dock);
    EXPECT_EQ(countDiffering(first, maker.render(moved.document, moved.sources(), picture)), 0u);

    // Renamed: the chooser knows what to ask for.
    const double bytes = double(fs::file_size(folder / "two/cell.tsr"));
    fs::rename(folder / "two/cell.tsr", folder / "two/other.tsr");
    const Opened lost = open(request);
    ASSERT_EQ(lost.missing.size(), 1u);
    EXPECT_EQ(fs::path(lost.missing[0].wanted.path).filename(), "cell.tsr");
    EXPECT_EQ(lost.missing[0].wanted.bytes, bytes);
    EXPECT_FALSE(lost.missing[0].wanted.hash.empty());

    // Other data under the name: opened, with a warning that names both hashes.
    volume::Dataset other = volume::makeModel("planted", {{"nx", 9}, {"ny", 9}, {"nz", 25}, {"times", 2}});
    codec::pack(other, {}, in("two/cell.tsr"));
    const Opened changed = open(request);
    ASSERT_FALSE(changed.warnings.empty());
    EXPECT_NE(changed.warnings[0].find("cell.tsr has changed"), std::string::npos) << changed.warnings[0];
    EXPECT_NE(changed.warnings[0].find(lost.missing[0].wanted.hash), std::string::npos);
    EXPECT_NE(changed.warnings[0].find(describeFile(in("two/cell.tsr")).hash), std::string::npos);
}

// The first look at data never seen before: every parameter with its range and unit, a picture of several views.
TEST_F(ScenariosGl, AFirstLook) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "planted";
    request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 2}};
    const Opened opened = open(request);
    for (const volume::Parameter& parameter : opened.source->info().parameters) {
        EXPECT_FALSE(parameter.ranges.empty()) << parameter.name;
        EXPECT_TRUE(parameter.categorical || !parameter.unit.empty()) << parameter.name;
    }
    const Session& session = opened.document.session;
    EXPECT_GE(session.views.size(), 4u);
    EXPECT_GT(session.stretch.y, session.stretch.z) << "a thin cell is stretched";
    PictureMaker maker;
    for (const char* pane : {"volume", "slices", "scatterMatrix", "data"}) {
        ASSERT_TRUE(session.views.contains(pane)) << pane;
        const vis::Image image =
            maker.render(opened.document, opened.sources(), {.pane = pane, .size = {400, 300}, .scale = 1});
        std::set<std::uint32_t> colors;
        for (std::size_t i = 0; i < image.rgba.size(); i += 4)
            colors.insert(std::uint32_t(image.rgba[i]) << 16 | std::uint32_t(image.rgba[i + 1]) << 8 |
                          image.rgba[i + 2]);
        EXPECT_GT(colors.size(), 40u) << pane;
    }
}

} // namespace
} // namespace tessera::app
