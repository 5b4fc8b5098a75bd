#pragma once

#include <span>
#include <string>

struct ImGuiIO;
struct ImGuiWindow;
struct ImVec2;

/// The keyboard, the only place that knows key codes: they are those of GLFW, since ImGui 1.86 has no names for most
/// keys. Here, too, is what differs between ImGui before 1.89, which reads states of keys, and after, which takes
/// events.
namespace tessera::app {

namespace key {
inline constexpr int kSpace = 32, kEscape = 256, kEnter = 257, kTab = 258, kBackspace = 259, kInsert = 260,
                     kDelete = 261, kRight = 262, kLeft = 263, kDown = 264, kUp = 265, kPageUp = 266, kPageDown = 267,
                     kHome = 268, kEnd = 269, kF1 = 290, kF5 = 294, kF6 = 295, kF10 = 299, kF11 = 300, kF12 = 301,
                     kKeypadEnter = 335;
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

/// True in the frame in which Esc closes what is open: no button of the mouse is held, whose drag it would give up.
bool escapePressed();

/// A button of the mouse is held down.
bool mouseHeld();

/// For the rest of the frame the mouse counts as resting, with no button down, pressed or let go.
void hideMouseButtons();

/// Whatever item is held is let go of as it is; what was dragged by it is dropped nowhere.
void letGoOfItems();

/// True while text is being typed somewhere: single keys are letters then.
bool typing();

/// True while arrows, Space, Enter, Home, End and Page keys move or press the item that has the keyboard's mark.
bool keysNavigate(int code);

/// Some key that is not a modifier is held down.
bool otherKeyHeld();

/// Shows the mark of the item that has the keyboard.
void showFocusMark();
bool focusMarkShown();

/// Gives the keyboard to the header of a menu in the menu bar, inside the bar, and shows its mark.
void focusInMenuBar(ImGuiWindow* bar, unsigned header);

/// Enter presses the item that has the keyboard's mark as Space does (ImGui before 1.89: it only begins to type).
void enterPresses();

/// Tab, pressed in this frame, goes to the next item of any kind (ImGui before 1.89: only to fields to type in).
void tabThroughAll();

/// Sets up a new context for `feedKey`, so that the next frame takes all keys fed to it.
void setUpKeys(ImGuiIO& io);

/// A key goes down or up in the next frame. Codes that ImGui has no key for do nothing.
void feedKey(ImGuiIO& io, int code, bool down);

/// The modifiers of the next frame, whichever keys are down.
void feedModifiers(ImGuiIO& io, bool ctrl, bool shift, bool alt, bool super = false);

/// The mouse of the next frame, replacing what the back end has reported; `buttons`: at most five, left first.
void feedMouse(ImGuiIO& io, ImVec2 at, std::span<const bool> buttons);

} // namespace tessera::app
