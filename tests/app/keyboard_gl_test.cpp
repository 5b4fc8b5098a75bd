#include "app/session/session_json.h"
#include "tests/app/workbench_fixture.h"

#include <algorithm>
#include <imgui_internal.h>
#include <set>

/// Menus, panes and widgets by keyboard, and menus that are torn through with the mouse.
namespace tessera::app {
namespace {

class Keyboard : public DrawnWorkbench {
protected:
    void SetUp() override { show({"layers", "transfer"}); }

    /// Shows the small cell in the panes that the arrangement has by these names.
    void show(const std::vector<std::string>& panes, const ViewState* only = nullptr) {
        OpenRequest request;
        request.data.emplace();
        request.data->model = "fuel-cell";
        request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 3}};
        Opened opened = open(request);
        Session& session = opened.document.session;
        session.time = opened.source->info().times[1];
        session.render.samples = 1;
        if (only) {
            session.views.clear();
            session.views["pane"] = *only;
        } else {
            std::erase_if(session.views,
                          [&](const auto& view) { return std::ranges::find(panes, view.first) == panes.end(); });
        }
        session.dock = {};
        repair(session.dock, paneKeys(session));
        if (!only) insertPane(session.dock, panes.back(), session.dock.root.id, DockSide::Right);
        opened.document.history.reset(session);
        workbench.install(std::move(opened));
        settle();
    }
    void next(bool altKey = false) {
        frame([&](ImGuiIO& io) {
            io.MousePos = mouse;
            io.MouseDown[0] = down;
            feedModifiers(io, ctrl, shift, altKey);
        });
    }
    void key(int code) {
        for (const bool on : {true, false}) {
            feedKey(ImGui::GetIO(), code, on);
            next();
        }
        next();
    }
    void tapAlt() {
        next(true);
        next(true);
        next();
        next();
    }
    /// The menu that is open, by the letter its header begins with; 0: none.
    static std::string openMenu() {
        const auto& popups = GImGui->OpenPopupStack;
        if (popups.empty() || !popups[0].Window) return {};
        const ImGuiWindow* bar = ImGui::FindWindowByName("##MainMenuBar");
        for (const char* name : {"File", "Edit", "View", "Layout", "Help"}) {
            const ImGuiID own = ImHashStr(name, 0, ImHashStr("##menubar", 0, bar->ID));
            if (popups[0].PopupId == own) return name;
        }
        return "another";
    }
    std::string pane() const {
        const ImGuiWindow* at = GImGui->NavWindow;
        const std::string name = at ? at->RootWindow->Name : "";
        const auto found = name.find("###pane.");
        return found == std::string::npos ? "" : name.substr(found + 8);
    }
    static bool marked() { return ImGui::GetIO().NavVisible; }
    double time() { return workbench.session().time; }

    ImVec2 mouse{-1000, -1000};
    bool down = false, ctrl = false, shift = false;
};

TEST_F(Keyboard, AltAndF10OpenTheMenusAndArrowsWalkThem) {
    for (const bool byAlt : {true, false}) {
        byAlt ? tapAlt() : key(key::kF10);
        EXPECT_EQ(openMenu(), "File") << byAlt;
        for (const char* each : {"Edit", "View", "Layout"}) {
            key(key::kRight);
            next();
            next();
            EXPECT_EQ(openMenu(), each);
        }
        key(key::kLeft);
        next();
        next();
        EXPECT_EQ(openMenu(), "View");
        key(key::kEscape);
        EXPECT_EQ(openMenu(), "");
    }
    tapAlt();
    tapAlt();
    EXPECT_EQ(openMenu(), "") << "Alt again closes them";
}

TEST_F(Keyboard, EnterChoosesTheMarkedItemOfAMenu) {
    const Theme before = workbench.session().appearance.theme;
    const vis::Camera camera = workbench.session().camera;
    feedKey(ImGui::GetIO(), 'E', true);
    next(true);
    feedKey(ImGui::GetIO(), 'E', false);
    next(true);
    next();
    next();
    EXPECT_EQ(openMenu(), "Edit");
    key(key::kEscape);
    // The item Light theme of the menu View, however far down.
    feedKey(ImGui::GetIO(), 'V', true);
    next(true);
    feedKey(ImGui::GetIO(), 'V', false);
    next(true);
    next();
    ASSERT_EQ(openMenu(), "View");
    int items = 0;
    for (const Command& command : workbench.commands()) {
        if (command.menu != "View") continue;
        if (command.title() == "Light theme") break;
        ++items;
    }
    for (int i = 0; i < items; ++i) key(key::kDown);
    key(key::kEnter);
    next();
    EXPECT_NE(workbench.session().appearance.theme, before);
    EXPECT_EQ(workbench.session().camera, camera) << "Enter also resets it, elsewhere";
    EXPECT_EQ(openMenu(), "");
}

TEST_F(Keyboard, AltUsedForADragOrWithAKeyOpensNothing) {
    next(true);
    down = true;
    next(true);
    down = false;
    next(true);
    next();
    next();
    EXPECT_EQ(openMenu(), "");
    next(true);
    feedKey(ImGui::GetIO(), 'X', true);
    next(true);
    feedKey(ImGui::GetIO(), 'X', false);
    next(true);
    next();
    next();
    EXPECT_EQ(openMenu(), "");
    next(true);
    workbench.keyboard().lostWindow(); // Alt+Tab of the window system
    next();
    next();
    EXPECT_EQ(openMenu(), "");
}

TEST_F(Keyboard, TabGoesThroughEveryWidgetOfAPaneWithAMark) {
    key(key::kTab);
    EXPECT_TRUE(marked());
    EXPECT_FALSE(pane().empty());
    std::set<ImGuiID> seen;
    for (int i = 0; i < 8; ++i) {
        seen.insert(GImGui->NavId);
        key(key::kTab);
    }
    EXPECT_GT(seen.size(), 4u);
    EXPECT_FALSE(workbench.history().pending());
    key(key::kEscape);
    key(key::kEscape);
    EXPECT_FALSE(marked());
}

TEST_F(Keyboard, ArrowsAndSpaceAreForTheMarkedItemAndElseForTime) {
    const double start = time();
    key(key::kRight);
    EXPECT_GT(time(), start);
    EXPECT_FALSE(marked()) << "an arrow alone begins no walk";
    key(key::kLeft);
    EXPECT_EQ(time(), start);
    key(key::kF6);
    ASSERT_TRUE(marked());
    std::set<ImGuiID> marks;
    for (int part = 0; part < 4 && marks.size() < 2; ++part, key(key::kF6)) {
        marks = {GImGui->NavId};
        for (const int arrow : {key::kRight, key::kDown, key::kLeft, key::kUp, key::kEnd, key::kHome}) {
            key(arrow);
            marks.insert(GImGui->NavId);
        }
    }
    EXPECT_EQ(time(), start);
    EXPECT_GT(marks.size(), 1u);
    key(key::kEscape);
    key(key::kEscape);
    key(key::kRight);
    EXPECT_GT(time(), start);
    EXPECT_FALSE(workbench.session().animation.playing);
}

TEST_F(Keyboard, EscEndsTheWalkBeforeItClearsBrushes) {
    addBrush("a");
    settle();
    key(key::kF6);
    ASSERT_TRUE(marked());
    key(key::kEscape);
    EXPECT_EQ(workbench.session().selection.brushes.size(), 1u);
    for (int i = 0; i < 3; ++i) key(key::kEscape);
    EXPECT_TRUE(workbench.session().selection.brushes.empty());
}

TEST_F(Keyboard, F6GoesToEveryPaneAndBack) {
    std::set<std::string> panes;
    std::vector<ImGuiWindow*> order;
    for (int i = 0; i < 8; ++i) {
        key(key::kF6);
        EXPECT_TRUE(marked());
        panes.insert(pane());
        order.push_back(GImGui->NavWindow);
    }
    EXPECT_EQ(panes, (std::set<std::string>{"layers", "transfer"}));
    shift = true;
    key(key::kF6);
    EXPECT_EQ(GImGui->NavWindow, order[order.size() - 2]);
}

TEST_F(Keyboard, CtrlPageDownGoesThroughTheTabs) {
    Session& session = workbench.session();
    session.views["more"] = HistoryView{};
    insertPane(session.dock, "more", 0, DockSide::Center);
    for (const char* each : {"layers", "transfer", "more"}) {
        const std::vector<std::string> tabs = tabsBeside(session.dock, each);
        EXPECT_TRUE(std::ranges::find(tabs, each) != tabs.end());
    }
    const std::vector<std::string> tabs = tabsBeside(session.dock, "more");
    ASSERT_GT(tabs.size(), 1u);
    workbench.panes().show(session, "more");
    settle();
    next();
    ctrl = true;
    key(key::kPageDown);
    ctrl = false;
    settle();
    EXPECT_NE(pane(), "more");
    EXPECT_TRUE(std::ranges::find(tabs, pane()) != tabs.end()) << pane();
}

TEST_F(Keyboard, HelpFindsKeysByWords) {
    const auto names = [&](const std::string& search) {
        std::vector<std::string> found;
        for (const KeyHelp& row : keyHelp(workbench.commands(), search)) found.push_back(row.name);
        return found;
    };
    EXPECT_GT(names("").size(), 40u);
    EXPECT_EQ(names("undo").front(), "Undo");
    EXPECT_TRUE(names("no such thing").empty());
    for (const Command& command : workbench.commands())
        if (command.shortcut.key != 0) {
            EXPECT_EQ(std::ranges::count(names(""), command.title()), 1) << command.title();
        }
    // No two commands have one key.
    std::set<std::string> keys;
    for (const Command& command : workbench.commands())
        for (const Shortcut& shortcut : {command.shortcut, command.alternative})
            if (shortcut.key != 0) {
                EXPECT_TRUE(keys.insert(textOf(shortcut)).second) << textOf(shortcut);
            }
}

/// A menu opened and given up over each kind of view changes nothing there.
TEST_F(Keyboard, MenusAreTornThroughWithoutAStrayClick) {
    forEachViewKind([&]<class Kind>(const Kind& kind) {
        SCOPED_TRACE(std::string(kind.traits.title));
        const ViewState view = typename Kind::State{};
        show({}, &view);
        ImGui::GetIO().MouseDoubleClickTime = 0;
        const ImVec2 menu{16, 8};
        for (const ImVec2 over : {ImVec2{420, 200}, ImVec2{300, 330}}) {
            const Json before = toJson(workbench.session());
            const auto unchanged = [&](const char* what) {
                EXPECT_EQ(Json::diff(before, toJson(workbench.session())).dump(), "[]") << what << " at " << over.x;
            };
            const auto to = [&](ImVec2 at, bool held) {
                mouse = at;
                down = held;
                next();
                next();
            };
            // Pressed on the menu, let go over the view.
            to(menu, false);
            to(menu, true);
            to({(menu.x + over.x) / 2, (menu.y + over.y) / 2}, true);
            to(over, true);
            to(over, false);
            unchanged("let go");
            // Opened by a click, closed by a press, drag and release over the view.
            if (openMenu().empty()) {
                to(menu, true);
                to(menu, false);
            }
            EXPECT_FALSE(openMenu().empty());
            to(over, false);
            to(over, true);
            to({over.x + 30, over.y + 20}, true);
            to({over.x + 30, over.y + 20}, false);
            EXPECT_EQ(openMenu(), "");
            unchanged("closed");
            to({-1000, -1000}, false);
        }
    });
}

} // namespace
} // namespace tessera::app
