#pragma once

#include <string>

struct ImGuiIO;

/// The keyboard, the only place that knows key codes: ImGui 1.86 has no names for most keys, so codes are those of
/// GLFW, in the window and without one.
namespace tessera::app {

namespace key {
inline constexpr int kSpace = 32, kEscape = 256, kEnter = 257, kTab = 258, kBackspace = 259, kInsert = 260,
                     kDelete = 261, kRight = 262, kLeft = 263, kDown = 264, kUp = 265, kPageUp = 266, kPageDown = 267,
                     kHome = 268, kEnd = 269, kF1 = 290, kF5 = 294, kF11 = 300, kF12 = 301, kKeypadEnter = 335;
} // namespace key

/// A key with modifiers; letters and digits by their upper-case character.
struct Shortcut {
    int key = 0; ///< 0 = none
    bool ctrl = false, shift = false, alt = false;
    bool operator==(const Shortcut&) const = default;
};

/// "Ctrl+Shift+P", "" for none.
std::string textOf(const Shortcut& shortcut);

/// True in the frame the shortcut is pressed with exactly its modifiers (again while held, if `repeat`).
bool pressed(const Shortcut& shortcut, bool repeat = false);

/// True in the frame a key goes down, whatever the modifiers (again while held, if `repeat`).
bool keyPressed(int code, bool repeat = false);

/// True while text is being typed somewhere: single keys are letters then.
bool typing();

/// Tells ImGui which codes its own keys have; done by the GLFW back end in the window, by this without one.
void mapKeys(ImGuiIO& io);

} // namespace tessera::app
