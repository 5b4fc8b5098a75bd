#pragma once

struct ImGuiWindow;

/// Menus, panes and widgets by keyboard. Alt (pressed and let go alone), F10, and Alt with the first letter of a menu
/// open the menu bar. Tab, F6 and Ctrl+Tab begin a walk through widgets and panes, with a visible mark, which a click
/// or Esc ends. Arrows, Space and Enter belong to ImGui during a walk and in menus and dialogs; otherwise they are
/// shortcuts.
namespace tessera::app {

class KeyboardFocus {
public:
    /// At the start of a frame, before the shortcuts.
    void begin();
    /// In the menu bar, before a menu is begun.
    void offerMenu(const char* name);
    /// Opens the first menu, or closes what is open of the menu bar.
    void openMenus();
    /// Goes to the next (or previous) pane or list on screen, in the order of reading.
    void nextPart(int direction);
    /// Closes menus and lists that are open; false where a dialog is.
    static bool closeMenus();
    /// The window has lost the keyboard: letting go of Alt elsewhere opens nothing.
    void lostWindow() { altAlone_ = false; }
    /// At the end of a frame: draws the mark.
    void end();

private:
    void watchAlt();
    void place(ImGuiWindow* window);

    bool walking_ = false;
    bool altAlone_ = false, altHeld_ = false;
    bool wanted_ = false;           ///< the menu bar is to be opened
    char letter_ = 0;               ///< of the menu that is to be opened; 0: the first
    ImGuiWindow* before_ = nullptr; ///< had the keyboard before the menu bar
};

} // namespace tessera::app
