#include "app/workbench/keyboard_focus.h"

#include "app/ui/keys.h"
#include "app/ui/theme.h"

#include <algorithm>
#include <imgui_internal.h> // focus of windows, and which item is marked
#include <string_view>
#include <vector>

namespace tessera::app {

namespace {

constexpr const char* kBar = "##MainMenuBar";

bool popupOpen() {
    return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
}

/// The innermost popup is a menu of the menu bar.
bool menuOpen() {
    const auto& open = GImGui->OpenPopupStack;
    return !open.empty() && open[0].Window && (open[0].Window->Flags & ImGuiWindowFlags_ChildMenu) != 0;
}

bool barFocused() {
    return GImGui->NavWindow && std::string_view(GImGui->NavWindow->Name) == kBar;
}

/// Panes on screen and the lists within them that hold widgets, in the order of reading.
std::vector<ImGuiWindow*> parts() {
    std::vector<ImGuiWindow*> found;
    for (ImGuiWindow* each : GImGui->Windows) {
        const bool ofPane = std::string_view(each->RootWindow->Name).find("###pane.") != std::string_view::npos;
        if (ofPane && each->WasActive && !each->Hidden && each->InnerClipRect.GetArea() > 0 &&
            (each->DC.NavLayersActiveMask & 1) != 0)
            found.push_back(each);
    }
    std::ranges::sort(found, {}, [](const ImGuiWindow* each) {
        return std::tuple(each->RootWindow->Pos.y, each->RootWindow->Pos.x, each->ParentWindow ? 1 : 0, each->Pos.y,
                          each->Pos.x);
    });
    return found;
}

} // namespace

/// Alt counts when it is let go with nothing done meanwhile.
void KeyboardFocus::watchAlt() {
    const ImGuiIO& io = ImGui::GetIO();
    const bool alone = io.KeyAlt && !io.KeyCtrl && !io.KeyShift && !io.KeySuper;
    const bool used = mouseHeld() || io.MouseWheel != 0 || !io.InputQueueCharacters.empty() || otherKeyHeld();
    if (alone && !altHeld_) altAlone_ = true;
    if (used || (io.KeyAlt && !alone)) altAlone_ = false;
    if (altHeld_ && !io.KeyAlt && altAlone_) openMenus();
    altHeld_ = io.KeyAlt;
}

void KeyboardFocus::openMenus() {
    if (menuOpen()) return ImGui::ClosePopupToLevel(0, true);
    wanted_ = !popupOpen();
    letter_ = 0;
}

bool KeyboardFocus::closeMenus() {
    const auto& open = GImGui->OpenPopupStack;
    if (open.empty()) return true;
    for (const ImGuiPopupData& each : open)
        if (!each.Window || (each.Window->Flags & ImGuiWindowFlags_Modal) != 0) return false;
    ImGui::ClosePopupToLevel(0, true);
    return true;
}

/// Puts the mark on the item of a window that was used last, or its first.
void KeyboardFocus::place(ImGuiWindow* window) {
    ImGui::NavMoveRequestCancel();
    ImGui::FocusWindow(window);
    ImGui::NavInitWindow(window, false);
    showFocusMark();
    walking_ = true;
}

void KeyboardFocus::nextPart(int direction) {
    const std::vector<ImGuiWindow*> all = parts();
    if (all.empty() || popupOpen()) return;
    const auto found = std::ranges::find(all, GImGui->NavWindow);
    const int count = int(all.size()), now = int(found - all.begin());
    const bool inside = found != all.end();
    place(all[std::size_t(inside ? (now + direction + count) % count : direction > 0 ? 0 : count - 1)]);
}

void KeyboardFocus::begin() {
    const ImGuiContext& g = *GImGui;
    if (mouseHeld()) walking_ = false;
    watchAlt();
    enterPresses();
    // From the menu bar back to where the keyboard was.
    if (before_ && !wanted_ && !popupOpen() && !(barFocused() && g.NavLayer == ImGuiNavLayer_Menu)) {
        if (barFocused() && before_->WasActive) ImGui::FocusWindow(before_);
        before_ = nullptr;
    }
    if (keyPressed(key::kEscape) && !popupOpen() && g.ActiveId == 0) walking_ = false;
    if (!keyPressed(key::kTab, true)) return;
    if (ImGui::GetIO().KeyCtrl) {
        walking_ = true;
    } else if (!popupOpen() && !walking_ && g.ActiveId == 0) {
        const std::vector<ImGuiWindow*> all = parts();
        if (const auto at = std::ranges::find(all, g.NavWindow); at != all.end())
            place(*at);
        else if (!all.empty())
            place(all.front());
    } else {
        walking_ = walking_ || !popupOpen();
        tabThroughAll();
    }
}

void KeyboardFocus::offerMenu(const char* name) {
    const ImGuiContext& g = *GImGui;
    ImGuiWindow* const bar = ImGui::GetCurrentWindow();
    const ImGuiID id = bar->GetID(name);
    if (!popupOpen() && !typing() && pressed({.key = *name, .alt = true})) {
        wanted_ = true;
        letter_ = *name;
    }
    if (wanted_ && (letter_ == 0 || letter_ == *name)) {
        if (!barFocused()) before_ = g.NavWindow;
        focusInMenuBar(bar, id);
        ImGui::OpenPopup(name);
        wanted_ = altAlone_ = false;
    } else if (barFocused() && g.NavJustMovedToId == id) {
        ImGui::OpenPopup(name); // the arrows go from an open menu to the next
    }
}

void KeyboardFocus::end() {
    ImGuiContext& g = *GImGui;
    const bool keys = walking_ || wanted_ || popupOpen() || barFocused() || g.NavWindowingTarget;
    const bool marked = g.NavWindow && g.NavId != 0 && g.NavIdIsAlive && focusMarkShown();
    int& flags = ImGui::GetIO().ConfigFlags;
    flags = keys ? flags | ImGuiConfigFlags_NavEnableKeyboard : flags & ~ImGuiConfigFlags_NavEnableKeyboard;
    if (!keys || !marked) return;
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const float thick = std::max(1.5f, ImGui::GetFontSize() * 0.12f);
    ImRect item = ImGui::WindowRectRelToAbs(g.NavWindow, g.NavWindow->NavRectRel[g.NavLayer]);
    item.Expand(thick);
    item.ClipWith(g.NavLayer == ImGuiNavLayer_Main ? g.NavWindow->InnerRect : g.NavWindow->Rect());
    if (!item.IsInverted()) list.AddRect(item.Min, item.Max, palette().accent, thick * 2, 0, thick);
}

} // namespace tessera::app
