#include "workbench_fixture.h"

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
    static std::vector<ImGuiWindow*> toasts() {
        std::vector<ImGuiWindow*> active;
        for (int i = 0; i < 10; ++i)
            if (ImGuiWindow* window = ImGui::FindWindowByName(("###toast" + std::to_string(i)).c_str());
                window && window->Active)
                active.push_back(window);
        return active;
    }
    fs::path before = fs::current_path();
    fs::path folder = fs::path(testing::TempDir()) / ("workbench_opening_" + std::to_string(::getpid()));
};

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
    EXPECT_EQ(toasts().size(), 1u);
    EXPECT_EQ(workbench.session().selection.brushes.back().name, "not saved");
}

TEST_F(WorkbenchOpening, MessagesCoverLittleAndAreClosedByTheirCross) {
    workbench.install(smallData());
    settle();
    for (int i = 0; i < 6; ++i)
        workbench.message("a.raw: has no layout: state dims=..,type=.. in its field, number " + std::to_string(i),
                          true);
    for (int i = 0; i < 3; ++i) frame();
    ASSERT_EQ(toasts().size(), 3u);
    const ImGuiWindow& newest = *toasts().front();
    EXPECT_GT(newest.Pos.y, toasts()[1]->Pos.y);
    const ImVec2 cross(newest.Pos.x + newest.Size.x - ImGui::GetStyle().WindowPadding.x - 4,
                       newest.Pos.y + ImGui::GetStyle().WindowPadding.y + ImGui::GetFontSize() / 2);
    const auto mouse = [&](bool down) {
        frame([&](ImGuiIO& io) {
            io.MousePos = cross;
            io.MouseDown[0] = down;
        });
    };
    mouse(false);
    mouse(true);
    mouse(false);
    frame();
    EXPECT_EQ(toasts().size(), 2u) << "older ones do not come back";
}

} // namespace
} // namespace tessera::app
