#include "app/data/apply_layout.h"
#include "app/workbench/fit_box.h"
#include "app/workbench/workbench_commands.h"
#include "tests/app/drawn_text.h"
#include "workbench_fixture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <imgui_internal.h>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

/// The dialog for opening and the messages, as a user meets them: with the keyboard and the mouse.
struct WorkbenchOpening : DrawnWorkbench {
    void SetUp() override {
        fs::create_directories(folder);
        fs::current_path(folder);
    }
    void TearDown() override {
        fs::current_path(before);
        fs::remove_all(folder);
    }
    void write(const std::string& name, const std::string& bytes) { std::ofstream(folder / name) << bytes; }
    /// File > Open, the name and Enter.
    void openByName(const std::string& name) {
        ASSERT_TRUE(run("Open..."));
        for (int i = 0; i < 3; ++i) frame();
        ImGui::GetIO().AddInputCharactersUTF8(name.c_str());
        for (int i = 0; i < 3; ++i) frame();
        press(key::kEnter);
        settle();
    }
    std::string shown() const {
        const std::vector<DataFile>& files = workbench.session().data.files;
        return files.empty() ? "" : fs::path(files.front().path).filename().string();
    }
    static bool dialogOpen() { return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId); }
    std::size_t news() { return workbench.messages().news().size(); }
    fs::path before = fs::current_path();
    fs::path folder = fs::path(testing::TempDir()) / ("workbench_opening_" + std::to_string(::getpid()));
};

TEST_F(WorkbenchOpening, WhatCannotBeOpenedIsToldWhereTheDataWouldBe) {
    OpenRequest request;
    request.paths = {"lost.vti"};
    workbench.open(request);
    settle();
    int told = 0, below = 0;
    for (const DrawnText& text : drawnTexts())
        if (text.text.find("lost.vti: no such file") != std::string::npos) ++(text.min.y < 300 ? told : below);
    EXPECT_EQ(told, 1) << "for as long as nothing is open";
    EXPECT_EQ(below, 1) << "news in the status line";
}

TEST_F(WorkbenchOpening, WhyNothingIsOpenIsToldWhole) {
    OpenRequest request;
    for (int i = 0; i < 12; ++i)
        request.paths = {"a folder " + std::to_string(i) + "/" + (i ? request.paths[0] : "lost.vti")};
    workbench.open(request);
    settle();
    std::string told;
    for (const DrawnText& text : drawnTexts()) {
        if (text.min.y > 300) continue;
        EXPECT_LE(text.max.x, 600) << text.text;
        told += text.text + " ";
    }
    for (const char* word : {"folder 11", "folder 0", "no such file", "No data"})
        EXPECT_NE(told.find(word), std::string::npos) << word << " of " << told;
}

TEST_F(WorkbenchOpening, ABuiltInModelIsOpenedByItsName) {
    OpenRequest request;
    request.paths = {"marschner-lobb"};
    workbench.open(request);
    settle();
    EXPECT_EQ(workbench.session().data.model, "marschner-lobb");
    request.paths = {"no-model"};
    workbench.open(request);
    settle();
    EXPECT_EQ(news(), 1u) << "what is neither is told of";
    EXPECT_EQ(workbench.session().data.model, "marschner-lobb");
}

// The layout that the name of one raw file tells, or that was typed for it, is not asked of the next one.
TEST_F(WorkbenchOpening, ALayoutIsOfTheFileItWasStatedFor) {
    write("plain_5x6x7_uint8.raw", std::string(210, '\x21'));
    write("stated.raw", std::string(48, '\x42'));
    write("stated.json", R"({"dims":[4,4,3],"dtype":"uint8"})");
    openByName("plain_5x6x7_uint8.raw");
    EXPECT_EQ(shown(), "plain_5x6x7_uint8.raw");
    EXPECT_EQ(workbench.session().data.import.raw, "dims=5x6x7,type=uint8");
    // Both named in one dialog: the first fills the field.
    ASSERT_TRUE(run("Open..."));
    for (int i = 0; i < 3; ++i) frame();
    const std::string first = "plain_5x6x7_uint8.raw";
    ImGui::GetIO().AddInputCharactersUTF8(first.c_str());
    settle();
    for (std::size_t i = 0; i < first.size(); ++i) press(key::kBackspace);
    ImGui::GetIO().AddInputCharactersUTF8("stated.raw");
    settle();
    press(key::kEnter);
    settle();
    EXPECT_EQ(shown(), "stated.raw");
    EXPECT_EQ(workbench.session().data.import.raw, "");
}

TEST_F(WorkbenchOpening, QuestionsForFilesBeginWhereTheDataLie) {
    fs::create_directories(folder / "run 7");
    write("run 7/plain_5x6x7_uint8.raw", std::string(210, '\x21'));
    OpenRequest request;
    request.paths = {"run 7/plain_5x6x7_uint8.raw"};
    request.import.emplace().raw = "dims=5x6x7,type=u8";
    workbench.open(request);
    settle();
    ASSERT_EQ(shown(), "plain_5x6x7_uint8.raw");
    ASSERT_TRUE(run("Save session as..."));
    EXPECT_EQ(fs::path(workbench.files().folder()), fs::canonical(folder / "run 7"));
    // Somebody who has gone elsewhere finds himself there again.
    press(key::kEscape);
    workbench.files().startIn(folder.string());
    ASSERT_TRUE(run("Open..."));
    EXPECT_EQ(fs::path(workbench.files().folder()), fs::canonical(folder));
}

// Else the program would draw frame after frame until the field is left, and never show the picture whole.
TEST_F(WorkbenchOpening, APictureIsFinishedWhileAFieldOfTextIsHeld) {
    workbench.install(smallData());
    ASSERT_TRUE(run("Open..."));
    for (int i = 0; i < 3; ++i) frame();
    ASSERT_TRUE(typing());
    settle();
    EXPECT_TRUE(typing());
    EXPECT_FALSE(workbench.busy());
}

// What cannot be opened is not opened, and nobody is asked to give up a session for it.
TEST_F(WorkbenchOpening, AFileThatFailedItsPreviewIsNotOpened) {
    workbench.install(smallData());
    settle();
    addBrush("not saved");
    settle();
    write("unknown.raw", "12345");
    write("empty.raw", "");
    for (const char* name : {"unknown.raw", "empty.raw"}) {
        openByName(name);
        EXPECT_TRUE(dialogOpen()) << name;
        const ImGuiWindow* const asked = ImGui::FindWindowByName("Save the session?");
        EXPECT_FALSE(asked && asked->Active) << name;
        press(key::kEscape);
        settle();
        EXPECT_FALSE(dialogOpen()) << "the dialog was the only one: " << name;
    }
    OpenRequest missing;
    missing.paths = {(folder / "missing.tsr").string()};
    workbench.open(missing);
    settle();
    EXPECT_FALSE(dialogOpen());
    EXPECT_EQ(news(), 1u);
    EXPECT_EQ(workbench.session().selection.brushes.back().name, "not saved");
}

// The layout of a raw file can be stated only in the dialog; files dropped on that are chosen in it.
TEST_F(WorkbenchOpening, ADroppedRawFileIsShownWhereItsLayoutIsStated) {
    write("plain.raw", std::string(210, '\x21'));
    write("told_4x4x3_uint8.raw", std::string(48, '\x42'));
    const auto path = [&](const char* name) { return (folder / name).string(); };
    dropFiles(workbench, {path("plain.raw")});
    settle();
    EXPECT_TRUE(workbench.files().asksData());
    EXPECT_EQ(news(), 0u);
    press(key::kEnter);
    settle();
    EXPECT_TRUE(dialogOpen()) << "its layout is not known yet";
    dropFiles(workbench, {path("told_4x4x3_uint8.raw")});
    settle();
    press(key::kEnter);
    settle();
    EXPECT_FALSE(dialogOpen());
    EXPECT_EQ(shown(), "told_4x4x3_uint8.raw");
}

// Else what a dialog asks about would be gone from under it.
TEST_F(WorkbenchOpening, FilesDroppedBesideADialogAreNotOpened) {
    workbench.install(smallData());
    write("told_4x4x3_uint8.raw", std::string(48, '\x42'));
    write("told_4x4x3_uint8.json", R"({"dims":[4,4,3],"dtype":"uint8"})");
    settle();
    ASSERT_TRUE(run("Save session as..."));
    settle();
    dropFiles(workbench, {(folder / "told_4x4x3_uint8.raw").string()});
    settle();
    EXPECT_EQ(shown(), "");
    EXPECT_EQ(news(), 1u);
    press(key::kEscape);
    settle();
    dropFiles(workbench, {(folder / "told_4x4x3_uint8.raw").string()});
    settle();
    EXPECT_EQ(shown(), "told_4x4x3_uint8.raw");
    EXPECT_EQ(news(), 0u) << "what is told of former data is no news of these";
}

// What is dropped beside an open menu is meant for the window: the menu closes.
TEST_F(WorkbenchOpening, ADroppedFileClosesAMenuAndIsOpened) {
    write("told_4x4x3_uint8.raw", std::string(48, '\x42'));
    write("told_4x4x3_uint8.json", R"({"dims":[4,4,3],"dtype":"uint8"})");
    workbench.install(smallData());
    settle();
    press(key::kF10);
    for (int i = 0; i < 3; ++i) frame();
    ASSERT_TRUE(dialogOpen()) << "the first menu";
    dropFiles(workbench, {(folder / "told_4x4x3_uint8.raw").string()});
    settle();
    EXPECT_FALSE(dialogOpen());
    EXPECT_EQ(shown(), "told_4x4x3_uint8.raw");
    EXPECT_EQ(news(), 0u);
}

// The dialog that asks for moved files takes them when they are dropped on it: by their names, the only one by any.
TEST_F(WorkbenchOpening, MissingFilesAreDroppedOnTheDialogThatAsksForThem) {
    for (const char* name : {"a_4x4x3_uint8", "b_4x4x3_uint8"}) {
        write(name + std::string(".raw"), std::string(48, '\x42'));
        write(name + std::string(".json"), R"({"dims":[4,4,3],"dtype":"uint8"})");
    }
    OpenRequest request;
    request.paths = {(folder / "a_4x4x3_uint8.raw").string(), (folder / "b_4x4x3_uint8.raw").string()};
    workbench.open(request);
    settle();
    ASSERT_EQ(workbench.session().data.files.size(), 2u);
    workbench.document().save("kept.tessera.json");
    fs::create_directories(folder / "moved");
    for (const char* name : {"a_4x4x3_uint8", "b_4x4x3_uint8"})
        for (const char* ending : {".raw", ".json"})
            fs::rename(folder / (name + std::string(ending)), folder / "moved" / (name + std::string(ending)));
    workbench.install(smallData());
    request.paths = {(folder / "kept.tessera.json").string()};
    workbench.open(request);
    settle();
    ASSERT_TRUE(workbench.missingFiles().shown());
    ASSERT_TRUE(dialogOpen());
    write("other.raw", "other");
    dropFiles(workbench, {(folder / "other.raw").string()});
    settle();
    EXPECT_EQ(news(), 1u) << "neither of the two";
    dropFiles(workbench, {(folder / "gone.raw").string()});
    settle();
    ASSERT_EQ(news(), 2u);
    EXPECT_NE(workbench.messages().news().front()->text.find("gone.raw: no such file"), std::string::npos);
    EXPECT_TRUE(workbench.missingFiles().shown());
    dropFiles(workbench, {(folder / "moved" / "b_4x4x3_uint8.raw").string()});
    settle();
    EXPECT_TRUE(workbench.missingFiles().shown()) << "one more";
    fs::rename(folder / "moved" / "a_4x4x3_uint8.raw", folder / "moved" / "renamed_4x4x3_uint8.raw");
    fs::rename(folder / "moved" / "a_4x4x3_uint8.json", folder / "moved" / "renamed_4x4x3_uint8.json");
    dropFiles(workbench, {(folder / "moved" / "renamed_4x4x3_uint8.raw").string()});
    settle();
    EXPECT_FALSE(workbench.missingFiles().shown());
    EXPECT_FALSE(dialogOpen());
    EXPECT_EQ(shown(), "renamed_4x4x3_uint8.raw");
}

// At first a list has the keyboard, of which nobody wants a picture.
TEST_F(WorkbenchOpening, APictureIsProposedOfAViewThatShowsData) {
    workbench.install(smallData());
    settle();
    for (int i = 0; i < 3; ++i) frame([](ImGuiIO& io) { io.MousePos = {-FLT_MAX, -FLT_MAX}; });
    const std::string current = workbench.panes().current(workbench.session());
    ASSERT_FALSE(traitsOf(workbench.session().views.at(current)).inSpace) << current;
    ASSERT_TRUE(run("Save picture..."));
    for (int i = 0; i < 3; ++i) frame();
    std::string proposed;
    const std::vector<DrawnText> texts = drawnTexts();
    for (const DrawnText& label : texts)
        for (const DrawnText& text : texts)
            if (label.text == "What" && text.min.x > label.min.x && std::abs(text.min.y - label.min.y) < 3)
                proposed = proposed.empty() ? text.text : proposed;
    EXPECT_EQ(proposed, "Volume");
}

// On the cell as it is there are no errors to show.
TEST_F(WorkbenchOpening, TheLayoutOfErrorsOpensTheCellBesideItsOriginals) {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 5}, {"ny", 7}, {"nz", 9}, {"times", 2}};
    workbench.install(open(request));
    settle();
    ASSERT_TRUE(run("Compression error"));
    settle();
    EXPECT_TRUE(workbench.session().data.originals);
    EXPECT_TRUE(workbench.source()->info().findChannel("T error"));
    EXPECT_EQ(std::get<SlicesView>(workbench.session().views.at("slices")).channel, "T error");
    EXPECT_EQ(news(), 0u);
}

// Cameras of layouts were chosen in a large window.
TEST_F(WorkbenchOpening, CamerasOfLayoutsShowTheWholeBoxInTheirPanes) {
    const auto expectWhole = [&](const std::string& layout) {
        const Session& session = workbench.session();
        const vis::WorldFrame world = vis::worldFrame(workbench.source()->info(), session.stretch);
        for (const auto& [pane, view] : session.views) {
            if (!std::holds_alternative<VolumeView>(view)) continue;
            const ImGuiWindow* window = ImGui::FindWindowByName(("###pane." + pane).c_str());
            if (!window || !window->WasActive) continue;
            const VolumeView& shown = std::get<VolumeView>(view);
            const glm::dvec2 extent = boxExtent(shown.camera ? *shown.camera : session.camera, world);
            EXPECT_LE(extent.y, 1) << layout << ' ' << pane;
            EXPECT_LE(extent.x, double(window->Size.x / window->Size.y)) << layout << ' ' << pane;
        }
    };
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 5}, {"ny", 7}, {"nz", 21}, {"times", 2}};
    Json near = loadSession(findLayout("compressionError")).raw;
    near["camera"]["distance"] = 0.8;
    write("near.json", near.dump());
    for (const std::string layout : {"near.json", "overview", "gases"}) {
        request.layout = layout;
        const vis::Camera camera = loadSession(findLayout(layout)).session.camera;
        workbench.open(request);
        settle();
        expectWhole(layout);
        EXPECT_EQ(workbench.session().camera.orientation, camera.orientation) << "the direction stays";
        EXPECT_FALSE(workbench.document().dirty()) << "nobody has changed anything";
    }
    // A saved session is as it was.
    workbench.session().camera.distance = 0.7f;
    frame();
    workbench.document().save("near.tessera.json");
    request = {};
    request.paths = {"near.tessera.json"};
    workbench.open(request);
    settle();
    EXPECT_EQ(workbench.session().camera.distance, 0.7f);
    // By the menu, which takes it back as one step.
    ASSERT_TRUE(run("Gases"));
    settle();
    expectWhole("gases from the menu");
}

/// Sizes of the pictures that a pane has drawn.
std::vector<ImVec2> pictureSizes(const std::string& pane) {
    std::vector<ImVec2> sizes;
    const ImGuiWindow* window = ImGui::FindWindowByName(("###pane." + pane).c_str());
    if (!window || !window->WasActive) return sizes;
    const ImDrawList& list = *window->DrawList;
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (command.TextureId == ImGui::GetIO().Fonts->TexID || command.ElemCount == 0) continue;
        ImVec2 lo{1e9f, 1e9f}, hi{-1e9f, -1e9f};
        for (unsigned i = 0; i < command.ElemCount; ++i) {
            const ImVec2 at = list.VtxBuffer[int(command.VtxOffset + list.IdxBuffer[int(command.IdxOffset + i)])].pos;
            lo = {std::min(lo.x, at.x), std::min(lo.y, at.y)};
            hi = {std::max(hi.x, at.x), std::max(hi.y, at.y)};
        }
        sizes.push_back({hi.x - lo.x, hi.y - lo.y});
    }
    return sizes;
}

// Pictures side by side are smaller than the pane, and tools, table and legends take some of it.
TEST_F(WorkbenchOpening, CamerasOfLayoutsShowTheWholeBoxInComparisons) {
    const auto expectWhole = [&](const std::string& layout, std::size_t variants) {
        const Session& session = workbench.session();
        const vis::WorldFrame world = vis::worldFrame(workbench.source()->info(), session.stretch);
        const glm::dvec2 extent = boxExtent(session.camera, world);
        const std::vector<ImVec2> pictures = pictureSizes("compare");
        EXPECT_EQ(pictures.size(), variants) << layout;
        for (const ImVec2 size : pictures) {
            EXPECT_LE(extent.y, 1) << layout;
            EXPECT_LE(extent.x, double(size.x / size.y)) << layout << ' ' << size.x << " x " << size.y;
            if (layout == "near.json") {
                EXPECT_GT(std::max(extent.y, extent.x / double(size.x / size.y)), 0.6) << "no farther than it must be";
            }
        }
    };
    for (const glm::ivec2 size : {glm::ivec2(600, 400), glm::ivec2(1100, 700)}) {
        OffscreenFrames window(size);
        const auto settleThere = [&] { tessera::app::settle(workbench, window); };
        settleThere();
        OpenRequest request;
        request.data.emplace();
        request.data->model = "fuel-cell";
        request.data->settings = {{"nx", 5}, {"ny", 7}, {"nz", 21}, {"times", 2}};
        Json near = loadSession(findLayout("compareCompression")).raw;
        near["camera"]["distance"] = 0.8;
        write("near.json", near.dump());
        request.layout = "near.json";
        workbench.install(open(request));
        settleThere();
        expectWhole("near.json", 7);
        EXPECT_FALSE(workbench.document().dirty()) << "nobody has changed anything";
        workbench.session().camera.distance = 0.7f;
        ASSERT_TRUE(run("Compare techniques"));
        settleThere();
        expectWhole("techniques compared, from the menu", 6);
    }
}

// A file of one's own is packed beside itself, in the layout as it is chosen in the menu.
TEST_F(WorkbenchOpening, TheLayoutOfErrorsPacksAFileOfOnesOwn) {
    std::string bytes;
    for (int z = 0; z < 8; ++z)
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 10; ++x) {
                const float value = std::sin(0.3f * float(x)) + std::cos(0.2f * float(y + z));
                bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
            }
    write("waves.raw", bytes);
    write("waves.json", R"({"dims":[10,9,8],"dtype":"float32"})");
    OpenRequest request;
    request.paths = {"waves.raw"};
    workbench.open(request);
    settle();
    ASSERT_EQ(shown(), "waves.raw");
    const std::string own = workbench.source()->info().parameters.at(0).name;
    ASSERT_TRUE(run("Compression error"));
    settle();
    EXPECT_EQ(shown(), "waves.raw");
    EXPECT_TRUE(workbench.session().data.originals);
    EXPECT_TRUE(workbench.session().data.packed);
    EXPECT_EQ(std::get<SlicesView>(workbench.session().views.at("slices")).channel, own + " error");
    const volume::DatasetInfo& info = workbench.source()->info();
    const auto error = info.findChannel(own + " error"), value = info.findChannel(own);
    ASSERT_TRUE(error);
    ASSERT_TRUE(value);
    const Range errors = info.channelRange(info.channel(*error)), values = info.channelRange(info.channel(*value));
    EXPECT_GT(errors.hi - errors.lo, 0) << "it was packed with loss";
    EXPECT_LT(errors.hi - errors.lo, 0.3 * (values.hi - values.lo));
}

// A session whose data are other ones now is not the one that was saved: that stands longer than what was done.
TEST_F(WorkbenchOpening, ChangedDataAreWarnedOf) {
    write("told.raw", std::string(48, '\x42'));
    write("told.json", R"({"dims":[4,4,3],"dtype":"uint8"})");
    OpenRequest request;
    request.paths = {(folder / "told.raw").string()};
    workbench.open(request);
    settle();
    workbench.document().save("kept.tessera.json");
    request.paths = {(folder / "kept.tessera.json").string()};
    workbench.open(request);
    settle();
    EXPECT_EQ(news(), 0u);
    write("told.raw", std::string(48, '\x43'));
    workbench.open(request);
    settle();
    ASSERT_EQ(news(), 1u);
    EXPECT_TRUE(workbench.messages().news().front()->failure);
    EXPECT_NE(workbench.messages().news().front()->text.find("told.raw has changed since the session was saved (xxh64"),
              std::string::npos);
}

// Over a view they would cover its axes or its legend.
TEST_F(WorkbenchOpening, MessagesStandInTheStatusLineAndAreClosedByTheirCross) {
    workbench.install(smallData());
    settle();
    std::vector<const ImGuiWindow*> windows;
    for (const ImGuiWindow* each : GImGui->Windows)
        if (each->WasActive) windows.push_back(each);
    for (int i = 0; i < 6; ++i)
        workbench.message("number " + std::to_string(i) + ": " + std::string(300, 'x') + " has no layout", true);
    for (int i = 0; i < 3; ++i) frame();
    EXPECT_EQ(news(), 3u);
    std::vector<const ImGuiWindow*> now;
    for (const ImGuiWindow* each : GImGui->Windows)
        if (each->WasActive) now.push_back(each);
    EXPECT_EQ(now, windows) << "no window of their own";
    const ImGuiWindow* const line = ImGui::FindWindowByName("###status");
    ASSERT_TRUE(line);
    const auto mouse = [&](ImVec2 at, bool down) {
        frame([&](ImGuiIO& io) {
            io.MousePos = at;
            io.MouseDown[0] = down;
        });
    };
    const ImVec2 text{line->Pos.x + 40, line->Pos.y + line->Size.y / 2};
    mouse(text, false);
    mouse(text, false);
    EXPECT_TRUE(std::ranges::any_of(GImGui->Windows, [](const ImGuiWindow* each) {
        return each->WasActive && (each->Flags & ImGuiWindowFlags_Tooltip);
    })) << "the whole text under the mouse";
    mouse(text, true);
    mouse(text, false);
    EXPECT_EQ(news(), 2u) << "older ones do not come back";
    EXPECT_LT(line->ContentSize.x, 600 - line->WindowPadding.x) << "nothing is cut off at the right";
}

} // namespace
} // namespace tessera::app
