#include "app/platform/gui.h"
#include "app/platform/headless.h"
#include "app/ui/keys.h"
#include "tests/app/workbench_fixture.h"
#include "vis/gl/driver.h"
#include "vis/gl/headless.h"
#include "volume/base/error.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <thread>
#include <unistd.h>

namespace tessera::app {
namespace {

Opened smallData() {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "marschner-lobb";
    request.data->settings = {{"nx", 24}, {"ny", 24}, {"nz", 24}};
    return open(request);
}

/// Largest share of pixels with a channel off by more than `tolerance`.
double difference(const vis::Image& a, const vis::Image& b, int tolerance) {
    if (a.size != b.size) return 1;
    std::size_t off = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(int(a.rgba[i + c]) - int(b.rgba[i + c])) > tolerance) {
                ++off;
                break;
            }
    return double(off) * 4 / double(a.rgba.size());
}

int colors(const vis::Image& image) {
    std::vector<std::uint32_t> seen;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        seen.push_back(std::uint32_t(image.rgba[i]) << 16 | std::uint32_t(image.rgba[i + 1]) << 8 | image.rgba[i + 2]);
    std::sort(seen.begin(), seen.end());
    return int(std::unique(seen.begin(), seen.end()) - seen.begin());
}

/// The status bar of a window says more than that of a picture.
vis::Image withoutStatusBar(vis::Image image) {
    image.size.y -= 30;
    image.rgba.resize(std::size_t(image.size.x) * std::size_t(image.size.y) * 4);
    return image;
}

TEST(WorkbenchGl, APictureIsWhatAWorkbenchFrameShows) {
    const Opened opened = smallData();
    PictureMaker maker;
    const PictureRequest request{.pane = "", .size = {900, 600}, .scale = 1};
    const vis::Image picture = maker.render(opened.document, opened.sources(), request);
    EXPECT_GT(colors(picture), 300) << "nothing was drawn";
    // Again: the same bytes.
    EXPECT_EQ(difference(picture, maker.render(opened.document, opened.sources(), request), 0), 0);

    // Frames of an interactive workbench, refined over time as in a window.
    const Gui gui;
    Workbench workbench({.renderer = nullptr, .render = {}, .headless = false, .onlyPane = {}, .stateFolder = {}});
    workbench.install(opened);
    const vis::Image window = drawUntilDone(workbench, {900, 600}, 1);
    EXPECT_LT(difference(withoutStatusBar(picture), withoutStatusBar(window), 6), 0.001);
}

TEST(WorkbenchGl, OneViewFillsThePicture) {
    const Opened opened = smallData();
    PictureMaker maker;
    for (const auto& [pane, view] : opened.document.session.views) {
        const vis::Image image =
            maker.render(opened.document, opened.sources(), {.pane = pane, .size = {400, 300}, .scale = 1});
        EXPECT_EQ(image.size, glm::ivec2(400, 300));
        EXPECT_GT(colors(image), 3) << pane;
    }
    EXPECT_THROW(maker.render(opened.document, opened.sources(), {.pane = "nothing", .size = {64, 64}, .scale = 1}),
                 Error);
}

TEST(WorkbenchGl, FramesWithoutDataAndWithOddSessions) {
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.renderer = nullptr, .render = {}, .headless = false, .onlyPane = {}, .stateFolder = {}});
    drawUntilDone(workbench, {300, 200}, 1);
    Opened opened = smallData();
    Session& session = opened.document.session;
    session.layers.push_back({"lost", true, vis::VolumeLayer{.channel = "no such"}});
    session.camera.distance = 0.01f;
    session.selection.brushes.push_back({});
    for (int i = 0; i < 2; ++i) addView(session, VolumeView{});
    workbench.install(std::move(opened));
    drawUntilDone(workbench, {300, 200}, 2);
    drawUntilDone(workbench, {17, 17}, 1);
    EXPECT_TRUE(workbench.source() != nullptr);
    workbench.session().views.clear();
    workbench.session().dock = {};
    drawUntilDone(workbench, {300, 200}, 1);
}

TEST(WorkbenchGl, UndoBringsBackTheSameSession) {
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.renderer = nullptr, .render = {}, .headless = false, .onlyPane = {}, .stateFolder = {}});
    workbench.install(smallData());
    drawUntilDone(workbench, {400, 300}, 1);
    const Session start = workbench.session();
    const auto command = [&](const std::string& name) -> const Command& {
        const auto found = std::find_if(workbench.commands().begin(), workbench.commands().end(),
                                        [&](const Command& each) { return each.title() == name; });
        EXPECT_TRUE(found != workbench.commands().end()) << name;
        return *found;
    };
    command("New: Volume").run();
    drawUntilDone(workbench, {400, 300}, 1);
    command("Light theme").run();
    drawUntilDone(workbench, {400, 300}, 1);
    const Session end = workbench.session();
    EXPECT_EQ(workbench.history().steps().size(), 2u);
    EXPECT_EQ(end.views.size(), start.views.size() + 1);
    while (command("Undo").available()) {
        command("Undo").run();
        drawUntilDone(workbench, {400, 300}, 1);
    }
    EXPECT_TRUE(workbench.session() == start);
    while (command("Redo").available()) {
        command("Redo").run();
        drawUntilDone(workbench, {400, 300}, 1);
    }
    EXPECT_TRUE(workbench.session() == end);
}

TEST(WorkbenchGl, DerivedParametersComeAndGo) {
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.renderer = nullptr, .render = {}, .headless = false, .onlyPane = {}, .stateFolder = {}});
    workbench.install(smallData());
    const auto settle = [&] { return drawUntilDone(workbench, {400, 300}, 1); };
    const auto known = [&](const std::string& name) {
        return workbench.source()->info().findChannel(name).has_value();
    };
    const auto run = [&](const std::string& name) {
        for (const Command& command : workbench.commands())
            if (command.title() == name && command.available()) {
                command.run();
                settle();
                return true;
            }
        return false;
    };
    settle();
    const Session start = workbench.session();
    ASSERT_FALSE(known("twice"));

    // Added: the data have it, and a layer can show it.
    workbench.session().data.derived = {{"twice", "kg", volume::ExpressionRecipe{"2*rho"}},
                                        {"slope", "", volume::GradientRecipe{"twice"}}};
    settle();
    ASSERT_TRUE(known("twice"));
    EXPECT_TRUE(known("|slope|"));
    workbench.session().layers = {{"twice", true, vis::VolumeLayer{.channel = "twice"}}};
    settle();
    EXPECT_EQ(std::get<vis::VolumeLayer>(workbench.session().layers[0].technique).channel, "twice");
    const Session derived = workbench.session();

    // A formula that cannot be computed takes the parameter away, and what showed it shows another.
    workbench.session().data.derived[0].recipe = volume::ExpressionRecipe{"2*nothing"};
    settle();
    EXPECT_FALSE(known("twice"));
    EXPECT_FALSE(known("|slope|"));
    EXPECT_EQ(std::get<vis::VolumeLayer>(workbench.session().layers[0].technique).channel, "rho");

    // Back and forth again.
    while (!(workbench.session() == derived)) ASSERT_TRUE(run("Undo"));
    EXPECT_TRUE(known("twice"));
    while (run("Undo")) {
    }
    EXPECT_TRUE(workbench.session() == start);
    EXPECT_FALSE(known("twice"));
    while (!(workbench.session() == derived)) ASSERT_TRUE(run("Redo"));
    EXPECT_TRUE(known("twice"));
}

/// A window draws its next frame at once where there is something to draw, and looks again a little later where views
/// wait for a job, samples or a program, which would otherwise share the processor with frames of the same picture.
TEST(WorkbenchGl, WaitingIsNotDrawing) {
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.renderer = nullptr, .render = {}, .headless = false, .onlyPane = {}, .stateFolder = {}});
    workbench.install(smallData());
    OffscreenFrames frames({900, 600});
    int atOnce = 0, later = 0;
    const auto begin = std::chrono::steady_clock::now();
    do {
        frames.draw(workbench, 1);
        if (!workbench.busy()) break;
        const double idle = workbench.idleSeconds();
        atOnce += idle == 0 ? 1 : 0;
        later += idle > 0 && idle <= 0.02 ? 1 : 0;
        std::this_thread::sleep_for(std::chrono::duration<double>(std::min(idle, 0.02)));
    } while (std::chrono::steady_clock::now() - begin < std::chrono::minutes(2));
    EXPECT_FALSE(workbench.busy());
    EXPECT_GT(atOnce, 0);
    if (vis::currentDriver().software) { // others may never wait that long
        EXPECT_GT(later, 0);
    }
}

// Opening something else, as a dropped file does, asks before it gives up what was not saved; so does the end, also
// after the same data have been shown in another way.
TEST(WorkbenchGl, WhatIsNotSavedIsNotGivenUpUnasked) {
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.renderer = nullptr, .render = {}, .headless = false, .onlyPane = {}, .stateFolder = {}});
    workbench.install(smallData());
    OffscreenFrames frames({400, 300});
    const auto settle = [&] { tessera::app::settle(workbench, frames); };
    settle();
    OpenRequest other;
    other.data.emplace();
    other.data->model = "marschner-lobb";
    other.data->settings = {{"nx", 16}, {"ny", 16}, {"nz", 16}};
    workbench.session().selection.brushes.push_back({});
    settle();
    const Session edited = workbench.session();
    workbench.open(other);
    settle();
    EXPECT_TRUE(workbench.session() == edited);
    // Esc is no answer: all stays, and the next time it is asked again.
    for (const bool down : {true, false})
        frames.draw(workbench, 1, [&](ImGuiIO& io) { feedKey(io, key::kEscape, down); });
    settle();
    EXPECT_TRUE(workbench.session() == edited);
    for (const Command& command : workbench.commands())
        if (command.title() == "Draw on the grid of the file") command.run();
    settle();
    ASSERT_NE(workbench.session().data.lattice, edited.data.lattice);
    workbench.requestQuit();
    settle();
    EXPECT_FALSE(workbench.finished());

    workbench.install(smallData());
    settle();
    workbench.open(other);
    settle();
    EXPECT_EQ(workbench.session().data.settings, other.data->settings) << "nothing to save, nothing asked";
}

class WorkbenchTimeline : public DrawnWorkbench {
protected:
    static Opened data(double times) {
        OpenRequest request;
        request.data.emplace();
        request.data->model = "marschner-lobb";
        request.data->settings = {{"nx", 12}, {"ny", 12}, {"nz", 12}, {"times", times}};
        return open(request);
    }
    bool shown() {
        settle();
        const ImGuiWindow* const window = ImGui::FindWindowByName("###pane.timeline");
        return window && window->WasActive;
    }
};

TEST_F(WorkbenchTimeline, HidesWhereThereIsOneTimeUnlessItIsAskedFor) {
    workbench.install(data(3));
    EXPECT_TRUE(shown());
    workbench.install(data(1));
    EXPECT_FALSE(shown());
    const std::size_t views = workbench.session().views.size();
    workbench.session().animation.tracks.push_back({.path = "/camera/distance", .keys = {{0, {1}}, {1, {2}}}});
    EXPECT_TRUE(shown()) << "keyframes are times";
    workbench.session().animation.tracks.clear();
    EXPECT_FALSE(shown());
    ASSERT_TRUE(run("New: Timeline"));
    EXPECT_TRUE(shown());
    EXPECT_EQ(workbench.session().views.size(), views) << "the hidden one, not a second one";
    workbench.install(data(1));
    EXPECT_FALSE(shown()) << "asked for in another session";
}

class WorkbenchMenus : public DrawnWorkbench {};

// The mouse is on the menu when an item is picked: the view it was on before is meant, or the only one.
TEST_F(WorkbenchMenus, CameraCommandsActOnAVolume) {
    workbench.install(smallData());
    settle();
    const auto facing = [&](vis::StandardView view) {
        return workbench.session().camera.orientation == vis::standardOrientation(view);
    };
    ASSERT_FALSE(facing(vis::StandardView::Right));
    ASSERT_TRUE(run("Look from the right"));
    settle();
    EXPECT_TRUE(facing(vis::StandardView::Right));
    ASSERT_TRUE(run("Look from the top"));
    settle();
    EXPECT_TRUE(facing(vis::StandardView::Top));
    ASSERT_TRUE(run("Parallel projection"));
    settle();
    EXPECT_EQ(workbench.session().camera.projection, vis::Projection::Orthographic) << "once, not twice";
    workbench.session().camera.distance = 50;
    ASSERT_TRUE(run("Reset the camera"));
    settle();
    EXPECT_LT(workbench.session().camera.distance, 20);
    workbench.session().dock.maximised = "layers";
    settle();
    EXPECT_FALSE(run("Look from the right")) << "no volume on screen";
}

TEST_F(WorkbenchMenus, ALayoutIsOneStepAndATabNone) {
    workbench.install(smallData());
    settle();
    ASSERT_TRUE(run("Lens"));
    settle();
    ASSERT_TRUE(run("Evening"));
    settle();
    const std::function<DockNode*(DockNode&)> stack = [&](DockNode& node) -> DockNode* {
        if (node.tabs.size() > 1) return &node;
        for (DockNode& child : node.children)
            if (DockNode* found = stack(child)) return found;
        return nullptr;
    };
    DockNode* tabs = stack(workbench.session().dock.root);
    ASSERT_TRUE(tabs);
    tabs->active = tabs->active == 0 ? 1 : 0;
    settle();
    ASSERT_EQ(workbench.history().steps().size(), 2u);
    EXPECT_EQ(workbench.history().steps()[0].name, "Layout: Lens");
    EXPECT_EQ(workbench.history().steps()[1].name, "Layout: Evening");
}

struct WorkbenchLeaving : DrawnWorkbench {
    void SetUp() override {
        std::filesystem::create_directories(folder);
        std::filesystem::current_path(folder);
    }
    void TearDown() override {
        std::filesystem::current_path(before);
        std::filesystem::remove_all(folder);
    }
    std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / ("workbench_leaving_" + std::to_string(::getpid()));
};

// Save, and then no place to save to: nothing is saved, nothing given up, and a later save is no more than that.
TEST_F(WorkbenchLeaving, ACancelledSaveLeavesEverythingAsItIs) {
    workbench.install(smallData());
    settle();
    addBrush("not saved");
    settle();
    const Session edited = workbench.session();
    OpenRequest other;
    other.data.emplace();
    other.data->model = "marschner-lobb";
    other.data->settings = {{"nx", 16}, {"ny", 16}, {"nz", 16}};
    workbench.open(other);
    settle();
    press(key::kEnter); // Save
    for (int i = 0; i < 3; ++i) frame();
    press(key::kEscape); // but nowhere
    settle();
    EXPECT_TRUE(workbench.session() == edited);
    EXPECT_NE(workbench.document().windowTitle().find('*'), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder));

    ASSERT_TRUE(run("Save session as..."));
    for (int i = 0; i < 3; ++i) frame();
    press(key::kEnter);
    settle();
    EXPECT_TRUE(std::filesystem::exists("session.tessera.json"));
    EXPECT_TRUE(workbench.session() == edited);
    EXPECT_EQ(workbench.document().windowTitle().find('*'), std::string::npos);

    // With a place the same answer saves, and what was waited for is done.
    addBrush("saved on leaving");
    settle();
    workbench.open(other);
    settle();
    press(key::kEnter);
    settle();
    EXPECT_EQ(workbench.session().data.settings, other.data->settings);
    EXPECT_EQ(loadSession("session.tessera.json").session.selection.brushes.size(), 2u);
}

TEST(WorkbenchGl, CommandNamesAndKeysAreUnique) {
    const vis::HeadlessContext gl;
    const Gui gui;
    const Workbench workbench(
        {.renderer = nullptr, .render = {}, .headless = false, .onlyPane = {}, .stateFolder = {}});
    std::vector<std::string> names, keys;
    for (const Command& command : workbench.commands()) {
        names.push_back(command.title());
        for (const Shortcut& shortcut : {command.shortcut, command.alternative})
            if (shortcut.key != 0) keys.push_back(textOf(shortcut));
        EXPECT_FALSE(command.help.empty()) << command.name;
    }
    for (auto* list : {&names, &keys}) {
        std::sort(list->begin(), list->end());
        const auto twice = std::adjacent_find(list->begin(), list->end());
        EXPECT_TRUE(twice == list->end()) << *twice << " is used twice";
    }
}

} // namespace
} // namespace tessera::app
