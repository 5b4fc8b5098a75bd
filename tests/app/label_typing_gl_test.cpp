#include "tests/app/workbench_fixture.h"

#include "app/user_files/import_memory.h"
#include "volume/flow/flow_channels.h"

#include <cstdlib>
#include <filesystem>
#include <imgui_internal.h>
#include <optional>
#include <unistd.h>

/// Names of regions, typed into the list of the data by hand.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

struct LabelTyping : DrawnWorkbench {
    LabelTyping() {
        if (const char* now = std::getenv("XDG_CONFIG_HOME")) before = now;
        setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
    }
    ~LabelTyping() override {
        before ? setenv("XDG_CONFIG_HOME", before->c_str(), 1) : unsetenv("XDG_CONFIG_HOME");
        fs::remove_all(folder);
    }
    void SetUp() override {
        OpenRequest request;
        request.data.emplace();
        request.data->model = "fuel-cell";
        request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 9}, {"times", 1}};
        workbench.install(open(request));
        workbench.session().dock.maximised = "data";
        settle();
    }
    const volume::Parameter& label() const {
        const volume::DatasetInfo& info = workbench.source()->info();
        return volume::parameterOf(info, *volume::labelChannel(info));
    }
    std::string nameOf(int value) const { return volume::labelName(label(), value); }

    void mouse(ImVec2 at, bool down) {
        frame([&](ImGuiIO& io) {
            io.MousePos = at;
            io.MouseDown[0] = down;
        });
    }
    void click(ImVec2 at) {
        for (const bool down : {false, true, false}) mouse(at, down);
        frame([&](ImGuiIO& io) { io.MousePos = at; });
    }
    /// Moves the mouse down a line until it is over an item.
    std::optional<ImVec2> find(ImGuiID id, ImVec2 from, float to) {
        for (ImVec2 at = from; at.y < to; at.y += 4) {
            mouse(at, false);
            mouse(at, false);
            if (ImGui::GetHoveredID() == id) return at;
        }
        return std::nullopt;
    }
    /// The field of a value's name in the popup that a click on the label opens.
    void clickName(int value) {
        if (!ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId)) {
            ImGuiWindow* list = nullptr;
            for (ImGuiWindow* window : GImGui->Windows)
                if (window->Active && std::string(window->Name).find("/data_") != std::string::npos) list = window;
            ASSERT_NE(list, nullptr);
            ImGui::SetScrollY(list, list->ScrollMax.y);
            frame();
            const std::string& name = label().name;
            const ImGuiID id = ImHashStr(name.c_str(), 0, ImHashStr(name.c_str(), 0, list->GetID("parameters")));
            const auto row = find(id, {list->Pos.x + 30, list->Pos.y + 2}, list->Pos.y + list->Size.y);
            ASSERT_TRUE(row) << "the label's row";
            click(*row);
        }
        ASSERT_FALSE(GImGui->OpenPopupStack.empty());
        ImGuiWindow* popup = GImGui->OpenPopupStack.back().Window;
        ASSERT_NE(popup, nullptr);
        const ImGuiID id = ImHashStr("##name", 0, ImHashData(&value, sizeof value, popup->ID));
        const auto field =
            find(id, {popup->Pos.x + ImGui::GetFontSize() * 6, popup->Pos.y + 2}, popup->Pos.y + popup->Size.y);
        ASSERT_TRUE(field) << "the field of " << value;
        click(*field);
        ASSERT_EQ(ImGui::GetActiveID(), id);
    }
    void clear(std::size_t letters) {
        press(key::kEnd);
        for (std::size_t i = 0; i < letters; ++i) press(key::kBackspace);
    }

    std::optional<std::string> before;
    std::string folder = (fs::path(testing::TempDir()) / ("label_typing_" + std::to_string(::getpid()))).string();
};

TEST_F(LabelTyping, AnEmptyFieldBringsBackTheNameOfTheData) {
    const std::string own = nameOf(1);
    ASSERT_EQ(own, "anode channel");
    ASSERT_NO_FATAL_FAILURE(clickName(1));
    clear(own.size());
    ImGui::GetIO().AddInputCharactersUTF8("hydrogen");
    for (int i = 0; i < 3; ++i) frame();
    press(key::kEnter);
    settle();
    EXPECT_EQ(nameOf(1), "hydrogen");
    EXPECT_EQ(nameOf(2), "anode GDL");
    ASSERT_EQ(workbench.session().data.import.labels.size(), 1u);
    EXPECT_EQ(loadImportMemory().labels.size(), 1u) << "for these data opened later";

    ASSERT_NO_FATAL_FAILURE(clickName(1));
    clear(std::string("hydrogen").size());
    EXPECT_EQ(nameOf(1), "hydrogen") << "while it is typed";
    press(key::kEnter);
    settle();
    EXPECT_EQ(nameOf(1), own) << "not the one typed before";
    EXPECT_TRUE(workbench.session().data.import.labels.empty());
    EXPECT_TRUE(loadImportMemory().labels.empty()) << "nor the next time";
    // Typed anew in place of what was cleared.
    ASSERT_NO_FATAL_FAILURE(clickName(1));
    clear(own.size());
    ImGui::GetIO().AddInputCharactersUTF8("H2");
    for (int i = 0; i < 3; ++i) frame();
    press(key::kEnter);
    settle();
    EXPECT_EQ(nameOf(1), "H2");
}

} // namespace
} // namespace tessera::app
