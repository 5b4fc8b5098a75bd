#include "app/dialogs/file_dialog.h"
#include "app/ui/keys.h"
#include "fed_imgui.h"

#include <filesystem>
#include <fstream>
#include <imgui_internal.h>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;

/// The dialog over an empty window, with a folder of its own.
class FileDialogTest : public FedImGui {
protected:
    FileDialogTest() : FedImGui({1200, 800}) { setUpKeys(ImGui::GetIO()); }
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }

    void frames(int count = 4) {
        for (int i = 0; i < count; ++i)
            feed([&] {
                if (auto answer = dialog.draw()) answers.push_back(*answer);
            });
    }
    void show(FileMode mode, const std::string& name = {}, const std::string& suffix = {}) {
        dialog.show(mode, "Test", "test", folder.string(), name, suffix);
        frames();
    }
    void type(const std::string& text) {
        ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
        frames();
    }
    void press(int key) {
        feedKey(ImGui::GetIO(), key, true);
        frames(1);
        feedKey(ImGui::GetIO(), key, false);
        frames();
    }
    std::string answered() {
        const std::string name = answers.empty() ? "" : fs::path(answers.back().paths.front()).filename().string();
        answers.clear();
        return name;
    }

    fs::path folder = fs::path(testing::TempDir()) / ("file_dialog_" + std::to_string(::getpid()));
    FileDialog dialog;
    std::vector<FileDialog::Answer> answers;
};

// What is typed takes the place of the name without its ending, each time, however long the name before was.
TEST_F(FileDialogTest, TheStemOfTheNameIsSelectedEachTime) {
    show(FileMode::Save, "session.tessera.json", ".tessera.json");
    press(key::kEnter);
    EXPECT_EQ(answered(), "session.tessera.json");
    for (int i = 0; i < 3; ++i) {
        show(FileMode::Save, "engine_crop_149x208x110_uint8.tsr", ".tsr");
        type("mine");
        press(key::kEnter);
        EXPECT_EQ(answered(), "mine.tsr") << i;
    }
    show(FileMode::Save, "surface.ply");
    type("bone");
    press(key::kEnter);
    EXPECT_EQ(answered(), "bone.ply");
}

// Its place is set after its list has been laid out: ImGui fails an assertion about tables in windows that move before.
TEST_F(FileDialogTest, DraggedOutOfTheWindowItComesBack) {
    std::ofstream(folder / "there.txt") << "x";
    show(FileMode::Open);
    const ImGuiWindow* window = ImGui::GetCurrentContext()->NavWindow->RootWindow;
    ASSERT_NE(std::string(window->Name).find("###files"), std::string::npos);
    for (const ImVec2 away : {ImVec2(-3000, 20), ImVec2(3000, 30), ImVec2(40, 3000), ImVec2(-2000, 2500)}) {
        ImGui::SetWindowPos(window->Name, away);
        frames(2);
        EXPECT_GE(window->Pos.x, 0);
        EXPECT_GE(window->Pos.y, 0);
        EXPECT_LE(window->Pos.x + window->Size.x, 1200);
        EXPECT_LE(window->Pos.y + window->Size.y, 800);
    }
}

// Its window shows no line then, in the midst of a list that is scrolled.
TEST_F(FileDialogTest, ScrolledAndDraggedOutBelowItComesBack) {
    ImGui::GetIO().DisplaySize = {588, 150};
    show(FileMode::Open);
    ImGuiWindow* const window = ImGui::GetCurrentContext()->NavWindow->RootWindow;
    ImGui::SetScrollY(window, 40);
    frames(2);
    ASSERT_GT(window->Scroll.y, 20) << "the window is too high for this test";
    ImGui::GetIO().DisplaySize = {1012, 385};
    for (int y = 200; y < 420; ++y) {
        ImGui::SetWindowPos(window->Name, {40, float(y)});
        frames(1);
        EXPECT_LE(window->Pos.y + window->Size.y, 385);
    }
}

TEST_F(FileDialogTest, EnterOpensWhatAClickChoseInTheList) {
    std::ofstream(folder / "there.txt") << "x";
    show(FileMode::Open);
    for (float y = 215; y < 330 && answers.empty(); y += 6) {
        mouse = {300, y};
        frames(1);
        for (const bool down : {true, false}) {
            ImGui::GetIO().MouseDown[0] = down;
            frames(1);
        }
        frames(40); // no double click
        EXPECT_TRUE(answers.empty()) << "one click opens nothing";
        press(key::kEnter);
    }
    EXPECT_EQ(answered(), "there.txt");
}

TEST_F(FileDialogTest, WhatIsWrongWithANameStandsUnderItUntilItChanges) {
    std::ofstream(folder / "there.txt") << "x";
    show(FileMode::Open);
    type("missing");
    press(key::kEnter);
    EXPECT_EQ(dialog.problem(), "missing: no such file");
    for (int i = 0; i < 7; ++i) press(key::kBackspace);
    EXPECT_EQ(dialog.problem(), "");
    type("there.txt");
    press(key::kEnter);
    EXPECT_EQ(answered(), "there.txt");
}

// A file is opened when its preview has been read and tells nothing against it; Enter may come before.
TEST_F(FileDialogTest, OneFileIsLookedAtBeforeItIsOpened) {
    std::ofstream(folder / "a.raw") << "x";
    FilePreview seen;
    std::vector<std::vector<std::string>> chosen;
    dialog.preview = [&](const std::string&) { return seen; };
    dialog.filesChosen = [&](const std::vector<std::string>& paths) { chosen.push_back(paths); };
    show(FileMode::Open);
    type("a.raw");
    const std::vector<std::string> file = {(folder / "a.raw").string()};
    EXPECT_EQ(chosen, (std::vector<std::vector<std::string>>{{}, file}));
    press(key::kEnter);
    EXPECT_EQ(answered(), "") << "it is still being read";
    seen = {"no good", true};
    frames();
    EXPECT_EQ(answered(), "");
    EXPECT_TRUE(dialog.shown());
    EXPECT_NE(dialog.problem(), "");
    seen = {"good", false};
    frames();
    EXPECT_EQ(answered(), "") << "the decision before was answered";
    EXPECT_EQ(dialog.problem(), "");
    press(key::kEnter);
    EXPECT_EQ(answered(), "a.raw");
    EXPECT_FALSE(dialog.shown());

    seen = {};
    show(FileMode::Open);
    type("a.raw");
    press(key::kEnter);
    seen = {"good", false};
    frames();
    EXPECT_EQ(answered(), "a.raw");
    EXPECT_EQ(chosen.size(), 4u) << "told again when shown again";
}

// Files that are dropped on the dialog stand in its list as chosen, whatever was typed before.
TEST_F(FileDialogTest, ChosenFilesReplaceWhatWasTyped) {
    fs::create_directories(folder / "run");
    std::ofstream(folder / "typed.txt") << "x";
    for (const char* name : {"a.txt", "b.txt"}) std::ofstream(folder / "run" / name) << "x";
    std::vector<std::string> chosen;
    dialog.filesChosen = [&](const std::vector<std::string>& paths) { chosen = paths; };
    show(FileMode::Open);
    type("typed.txt");
    const std::string a = (folder / "run/a.txt").string(), b = (folder / "run/b.txt").string();
    dialog.choose({a, b});
    frames();
    EXPECT_EQ(chosen, (std::vector<std::string>{a, b}));
    EXPECT_EQ(fs::path(dialog.folder()), fs::canonical(folder / "run"));
    press(key::kEnter);
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].paths, (std::vector<std::string>{a, b}));
}

// Another machine is not asked for a preview of each address that is typed.
TEST_F(FileDialogTest, AnAddressIsOpenedAsItIsTyped) {
    int asked = 0, noticed = 0;
    dialog.preview = [&](const std::string&) { return ++asked, FilePreview{}; };
    dialog.filesChosen = [&](const std::vector<std::string>& paths) { noticed += paths.empty() ? 0 : 1; };
    const std::string address = "https://data.example.org/runs//run.tsr?key=1";
    show(FileMode::Open);
    type(address);
    press(key::kEnter);
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].paths, std::vector<std::string>{address});
    EXPECT_EQ(asked, 0);
    EXPECT_EQ(noticed, 0);
}

} // namespace
} // namespace tessera::app
