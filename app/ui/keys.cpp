#include "app/ui/keys.h"

#include <imgui.h>

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

bool keyPressed(int code, bool repeat) {
    return ImGui::IsKeyPressed(static_cast<ImGuiKey>(code), repeat); // an enumeration from ImGui 1.87 on
}

bool typing() {
    return ImGui::GetIO().WantTextInput;
}

void mapKeys(ImGuiIO& io) {
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
#if IMGUI_VERSION_NUM >= 18700
    io.KeyMap[ImGuiKey_KeypadEnter] = key::kKeypadEnter;
#else
    io.KeyMap[ImGuiKey_KeyPadEnter] = key::kKeypadEnter;
#endif
    for (const auto& [imgui, letter] : {std::pair{ImGuiKey_A, 'A'},
                                        {ImGuiKey_C, 'C'},
                                        {ImGuiKey_V, 'V'},
                                        {ImGuiKey_X, 'X'},
                                        {ImGuiKey_Y, 'Y'},
                                        {ImGuiKey_Z, 'Z'}})
        io.KeyMap[imgui] = letter;
}

} // namespace tessera::app
