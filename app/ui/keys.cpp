#include "app/ui/keys.h"

#include <algorithm>
#include <imgui.h>
#include <imgui_internal.h>
#include <utility>

namespace tessera::app {

std::string textOf(const Shortcut& shortcut) {
    if (shortcut.key == 0) return {};
    std::string text;
    if (shortcut.ctrl) text += "Ctrl+";
    if (shortcut.shift) text += "Shift+";
    if (shortcut.alt) text += "Alt+";
    switch (shortcut.key) {
    case key::kSpace:
        return text + "Space";
    case key::kEscape:
        return text + "Esc";
    case key::kEnter:
        return text + "Enter";
    case key::kTab:
        return text + "Tab";
    case key::kDelete:
        return text + "Del";
    case key::kLeft:
        return text + "Left";
    case key::kRight:
        return text + "Right";
    case key::kUp:
        return text + "Up";
    case key::kDown:
        return text + "Down";
    case key::kPageUp:
        return text + "Page up";
    case key::kPageDown:
        return text + "Page down";
    case key::kHome:
        return text + "Home";
    case key::kEnd:
        return text + "End";
    default:
        break;
    }
    if (shortcut.key >= key::kF1) return text + "F" + std::to_string(shortcut.key - key::kF1 + 1);
    return text + static_cast<char>(shortcut.key);
}

bool pressed(const Shortcut& shortcut, bool repeat) {
    if (shortcut.key == 0) return false;
    const ImGuiIO& io = ImGui::GetIO();
    return io.KeyCtrl == shortcut.ctrl && io.KeyShift == shortcut.shift && io.KeyAlt == shortcut.alt &&
           keyPressed(shortcut.key, repeat);
}

bool escapePressed() {
    return pressed({.key = key::kEscape}) && !mouseHeld();
}

bool mouseHeld() {
    return ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Right) ||
           ImGui::IsMouseDown(ImGuiMouseButton_Middle);
}

void hideMouseButtons() {
    ImGuiIO& io = ImGui::GetIO();
    for (bool* state : {io.MouseDown, io.MouseClicked, io.MouseReleased, io.MouseDoubleClicked})
        std::fill_n(state, ImGuiMouseButton_COUNT, false);
}

void letGoOfItems() {
    ImGui::ClearActiveID();
    ImGui::ClearDragDrop();
}

bool typing() {
    return ImGui::GetIO().WantTextInput;
}

bool keysNavigate(int code) {
    static constexpr int kKeys[] = {key::kSpace, key::kEnter, key::kKeypadEnter, key::kEscape,
                                    key::kLeft,  key::kRight, key::kUp,          key::kDown,
                                    key::kHome,  key::kEnd,   key::kPageUp,      key::kPageDown};
    return ImGui::GetIO().NavVisible && std::ranges::find(kKeys, code) != std::end(kKeys);
}

#if IMGUI_VERSION_NUM >= 19140

void showFocusMark() {
    ImGui::SetNavCursorVisible(true);
    GImGui->NavHighlightItemUnderNav = true;
}

bool focusMarkShown() {
    return GImGui->NavCursorVisible;
}

#else

void showFocusMark() {
    GImGui->NavDisableHighlight = false;
    GImGui->NavDisableMouseHover = true;
}

bool focusMarkShown() {
    return !GImGui->NavDisableHighlight;
}

#endif

#if IMGUI_VERSION_NUM >= 18900

namespace {

constexpr ImGuiKey after(ImGuiKey first, int count) {
    return static_cast<ImGuiKey>(static_cast<int>(first) + count);
}

/// ImGuiKey_None for a code that is not used.
ImGuiKey imguiKey(int code) {
    if (code >= 'A' && code <= 'Z') return after(ImGuiKey_A, code - 'A');
    if (code >= '0' && code <= '9') return after(ImGuiKey_0, code - '0');
    if (code >= key::kF1 && code <= key::kF12) return after(ImGuiKey_F1, code - key::kF1);
    switch (code) {
    case '=':
        return ImGuiKey_Equal;
    case '-':
        return ImGuiKey_Minus;
    case key::kSpace:
        return ImGuiKey_Space;
    case key::kEscape:
        return ImGuiKey_Escape;
    case key::kEnter:
        return ImGuiKey_Enter;
    case key::kTab:
        return ImGuiKey_Tab;
    case key::kBackspace:
        return ImGuiKey_Backspace;
    case key::kInsert:
        return ImGuiKey_Insert;
    case key::kDelete:
        return ImGuiKey_Delete;
    case key::kRight:
        return ImGuiKey_RightArrow;
    case key::kLeft:
        return ImGuiKey_LeftArrow;
    case key::kDown:
        return ImGuiKey_DownArrow;
    case key::kUp:
        return ImGuiKey_UpArrow;
    case key::kPageUp:
        return ImGuiKey_PageUp;
    case key::kPageDown:
        return ImGuiKey_PageDown;
    case key::kHome:
        return ImGuiKey_Home;
    case key::kEnd:
        return ImGuiKey_End;
    case key::kKeypadEnter:
        return ImGuiKey_KeypadEnter;
    default:
        return ImGuiKey_None;
    }
}

} // namespace

bool keyPressed(int code, bool repeat) {
    const ImGuiKey known = imguiKey(code);
    return known != ImGuiKey_None && ImGui::IsKeyPressed(known, repeat);
}

bool otherKeyHeld() {
    for (int code = static_cast<int>(ImGuiKey_NamedKey_BEGIN); code < static_cast<int>(ImGuiKey_NamedKey_END); ++code) {
        const ImGuiKey each = static_cast<ImGuiKey>(code);
        const bool modifier = each >= ImGuiKey_LeftCtrl && each <= ImGuiKey_RightSuper;
        const bool mouse = each >= ImGuiKey_MouseLeft; // the last ones, with the modifiers as ImGui keeps them
        if (!modifier && !mouse && ImGui::IsKeyDown(each)) return true;
    }
    return false;
}

void focusInMenuBar(ImGuiWindow* bar, unsigned header) {
    ImGui::FocusWindow(bar);
    ImGui::SetNavID(header, ImGuiNavLayer_Menu, bar->NavRootFocusScopeId, ImRect());
    showFocusMark();
}

void enterPresses() {} // it does by itself

void tabThroughAll() {}

void setUpKeys(ImGuiIO& io) {
    io.ConfigInputTrickleEventQueue = false; // InputQueue spreads events over frames
}

void feedKey(ImGuiIO& io, int code, bool down) {
    if (const ImGuiKey known = imguiKey(code); known != ImGuiKey_None) io.AddKeyEvent(known, down);
}

void feedModifiers(ImGuiIO& io, bool ctrl, bool shift, bool alt, bool super) {
    io.AddKeyEvent(ImGuiMod_Ctrl, ctrl);
    io.AddKeyEvent(ImGuiMod_Shift, shift);
    io.AddKeyEvent(ImGuiMod_Alt, alt);
    io.AddKeyEvent(ImGuiMod_Super, super);
}

void feedMouse(ImGuiIO& io, ImVec2 at, std::span<const bool> buttons) {
    io.AddMousePosEvent(at.x, at.y);
    for (std::size_t i = 0; i < buttons.size(); ++i) io.AddMouseButtonEvent(static_cast<int>(i), buttons[i]);
}

#else

bool keyPressed(int code, bool repeat) {
    return ImGui::IsKeyPressed(code, repeat);
}

bool otherKeyHeld() {
    constexpr int kFirstModifier = 340, kLastModifier = 347;
    const auto& down = ImGui::GetIO().KeysDown;
    for (int code = 0; code < IM_ARRAYSIZE(down); ++code)
        if (down[code] && (code < kFirstModifier || code > kLastModifier)) return true;
    return false;
}

void focusInMenuBar(ImGuiWindow* bar, unsigned header) {
    ImGui::FocusWindow(bar);
    ImGui::SetNavID(header, ImGuiNavLayer_Menu, 0, ImRect());
    showFocusMark();
}

void enterPresses() {
    ImGuiContext& g = *GImGui;
    if (g.NavActivateInputId != 0)
        g.NavActivateId = g.NavActivateDownId = g.NavActivatePressedId = g.NavActivateInputId;
}

void tabThroughAll() {
    ImGuiContext& g = *GImGui;
    if (!g.NavMoveSubmitted || (g.NavMoveFlags & ImGuiNavMoveFlags_Tabbing) == 0) return;
    g.NavMoveFlags |= ImGuiNavMoveFlags_FocusApi;
    if (g.NavTabbingDir == 0 && g.NavId != 0) g.NavTabbingDir = 1;
}

void setUpKeys(ImGuiIO& io) {
    io.KeyMap[ImGuiKey_Tab] = key::kTab;
    io.KeyMap[ImGuiKey_LeftArrow] = key::kLeft;
    io.KeyMap[ImGuiKey_RightArrow] = key::kRight;
    io.KeyMap[ImGuiKey_UpArrow] = key::kUp;
    io.KeyMap[ImGuiKey_DownArrow] = key::kDown;
    io.KeyMap[ImGuiKey_PageUp] = key::kPageUp;
    io.KeyMap[ImGuiKey_PageDown] = key::kPageDown;
    io.KeyMap[ImGuiKey_Home] = key::kHome;
    io.KeyMap[ImGuiKey_End] = key::kEnd;
    io.KeyMap[ImGuiKey_Insert] = key::kInsert;
    io.KeyMap[ImGuiKey_Delete] = key::kDelete;
    io.KeyMap[ImGuiKey_Backspace] = key::kBackspace;
    io.KeyMap[ImGuiKey_Space] = key::kSpace;
    io.KeyMap[ImGuiKey_Enter] = key::kEnter;
    io.KeyMap[ImGuiKey_Escape] = key::kEscape;
    io.KeyMap[ImGuiKey_KeyPadEnter] = key::kKeypadEnter;
    for (const auto& [imgui, letter] : {std::pair<ImGuiKey_, int>{ImGuiKey_A, 'A'},
                                        {ImGuiKey_C, 'C'},
                                        {ImGuiKey_V, 'V'},
                                        {ImGuiKey_X, 'X'},
                                        {ImGuiKey_Y, 'Y'},
                                        {ImGuiKey_Z, 'Z'}})
        io.KeyMap[imgui] = letter;
}

void feedKey(ImGuiIO& io, int code, bool down) {
    if (code >= 0 && code < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[code] = down;
}

void feedModifiers(ImGuiIO& io, bool ctrl, bool shift, bool alt, bool super) {
    io.KeyCtrl = ctrl;
    io.KeyShift = shift;
    io.KeyAlt = alt;
    io.KeySuper = super;
}

void feedMouse(ImGuiIO& io, ImVec2 at, std::span<const bool> buttons) {
    io.MousePos = at;
    std::copy(buttons.begin(), buttons.end(), io.MouseDown);
}

#endif

} // namespace tessera::app
