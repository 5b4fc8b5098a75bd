#pragma once

#include "app/ui/keys.h"

#include <functional>
#include <string>
#include <vector>

/// The table of all commands: it feeds the menus, the shortcuts, the command palette and the help.
namespace tessera::app {

struct Command {
    std::string menu;       ///< "File", "Edit", "View", "Layout", "Help"; "" = only in the palette
    std::string name;       ///< "Open...", with a leading "-" a separator goes before it
    std::string help;       ///< one line
    std::string words = {}; ///< others that people look for it by: "screenshot png"
    const char* icon = "";
    Shortcut shortcut = {}, alternative = {};
    std::function<void()> run = {};
    std::function<bool()> enabled = {}; ///< empty = always
    std::function<bool()> checked = {}; ///< empty = no check mark
    std::string needs = {};             ///< what is missing while it is not available, in words
    bool repeats = false;               ///< runs again while the key is held
    bool keyInView = false;             ///< the view under the mouse answers to the key itself

    bool available() const { return run && (!enabled || enabled()); }
    /// Name without separator mark.
    std::string title() const { return name.starts_with("-") ? name.substr(1) : name; }
};

/// Runs the command whose shortcut was pressed this frame. Keys without Ctrl or Alt are left alone while text is typed.
void runShortcuts(const std::vector<Command>& commands);

/// The items of one menu, inside ImGui::BeginMenu. Returns the command chosen, to be run when the frame is drawn.
const Command* drawMenu(const std::vector<Command>& commands, const std::string& menu);

/// The command palette: a search field and the commands that match, best first.
struct CommandPalette {
    bool open = false; ///< set to show it
    std::string text;
    int chosen = 0;
    bool shown = false;
};
const Command* drawPalette(CommandPalette& palette, const std::vector<Command>& commands);

/// How well a name matches what was typed: higher is better, 0 when it does not. First names that hold the text as it
/// is, then those whose words, or the further `words`, begin with all words typed, in any order (kWholeWords and
/// above); last names that hold its letters in order.
int matchScore(const std::string& typed, const std::string& name, const std::string& words = {});
inline constexpr int kWholeWords = 500; ///< the least score of a match by words

/// Commands that match, best first; those by letters alone only where none matches by words. What is not available now
/// comes after what is, but where only such names hold the text as it is, they come first.
std::vector<const Command*> matchingCommands(const std::string& typed, const std::vector<Command>& commands);

/// What keys and mouse do, for the help window.
struct KeyHelp {
    std::string keys, name, help;
};
/// Those of the commands, then those of the mouse and of moving about; only rows that hold every word searched for.
std::vector<KeyHelp> keyHelp(const std::vector<Command>& commands, const std::string& search = {});
void drawKeyHelp(const std::vector<KeyHelp>& rows);

} // namespace tessera::app
