#include "app/ui/commands.h"

#include "app/ui/theme.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cctype>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

std::vector<std::string> wordsOf(const std::string& text) {
    std::vector<std::string> words;
    bool inside = false;
    for (const char c : text) {
        const bool letter = std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
        if (letter && !inside) words.emplace_back();
        if (letter) words.back() += lower(c);
        inside = letter;
    }
    return words;
}

bool hasWord(const std::vector<std::string>& words, const std::string& beginning) {
    return std::ranges::any_of(words, [&](const std::string& word) { return word.starts_with(beginning); });
}

/// The name of a command in the palette.
std::string shownName(const Command& command) {
    return command.menu.empty() ? command.title() : command.menu + ": " + command.title();
}

/// What it does, or why it cannot now.
std::string helpOf(const Command& command) {
    if (command.available()) return command.help;
    return command.help + (command.needs.empty() ? " (not possible now)" : "\nNot now: it needs " + command.needs);
}

} // namespace

void runShortcuts(const std::vector<Command>& commands) {
    for (const Command& command : commands) {
        if (command.keyInView) continue;
        for (const Shortcut& shortcut : {command.shortcut, command.alternative}) {
            if (shortcut.key == 0) continue;
            const bool plain = !shortcut.ctrl && !shortcut.alt && shortcut.key < key::kF1;
            if (typing() &&
                (plain || shortcut.key == 'C' || shortcut.key == 'V' || shortcut.key == 'Z' || shortcut.key == 'Y'))
                continue;
            if (plain && (ImGui::IsAnyItemActive() || keysNavigate(shortcut.key))) continue;
            if (!pressed(shortcut, command.repeats) || !command.available()) continue;
            const std::function<void()> run = command.run; // a copy: running it may rebuild the table
            run();
            return;
        }
    }
}

const Command* drawMenu(const std::vector<Command>& commands, const std::string& menu) {
    const Command* chosen = nullptr;
    bool first = true;
    for (const Command& command : commands) {
        if (command.menu != menu) continue;
        if (command.name.starts_with("-") && !first) ImGui::Separator();
        first = false;
        const bool checked = command.checked && command.checked();
        if (ImGui::MenuItem(command.title().c_str(), textOf(command.shortcut).c_str(), checked, command.available()))
            chosen = &command;
        const bool hovered = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) && !ImGui::GetIO().NavVisible &&
                             ImGui::GetIO().MouseDelta.x == 0 && ImGui::GetIO().MouseDelta.y == 0;
        const std::string help = helpOf(command);
        if (hovered && !help.empty() && help != command.title()) ImGui::SetTooltip("%s", help.c_str());
    }
    return chosen;
}

int matchScore(const std::string& typed, const std::string& name, const std::string& words) {
    if (typed.empty()) return 1;
    std::string a, b;
    for (const char c : typed)
        if (c != ' ') a += lower(c);
    for (const char c : name) b += lower(c);
    std::string needle;
    for (const char c : typed) needle += lower(c);
    if (const auto at = b.find(needle); at != std::string::npos) return 1000 - static_cast<int>(at);
    const std::vector<std::string> wanted = wordsOf(typed), own = wordsOf(name), others = wordsOf(words);
    int byWords = kWholeWords;
    for (const std::string& word : wanted)
        byWords = byWords == 0 ? 0 : hasWord(own, word) ? byWords + 10 : hasWord(others, word) ? byWords + 1 : 0;
    if (!wanted.empty() && byWords > 0) return byWords;
    int score = 100;
    std::size_t at = 0;
    for (const char c : a) {
        const std::size_t found = b.find(c, at);
        if (found == std::string::npos) return 0;
        const bool wordStart = found == 0 || b[found - 1] == ' ' || b[found - 1] == ':';
        score += wordStart ? 10 : -static_cast<int>(found - at);
        at = found + 1;
    }
    return std::clamp(score, 1, kWholeWords - 1);
}

std::vector<const Command*> matchingCommands(const std::string& typed, const std::vector<Command>& commands) {
    constexpr int kNamed = 800; // less than any name that holds the text, more than one found by words
    struct Match {
        const Command* command;
        bool available;
        int score;
    };
    std::vector<Match> matches;
    int best = 0;
    for (const Command& command : commands) {
        const int score = matchScore(typed, shownName(command), command.words);
        best = std::max(best, score);
        if (score > 0) matches.push_back({&command, command.available(), score});
    }
    if (best >= kWholeWords) std::erase_if(matches, [](const Match& match) { return match.score < kWholeWords; });
    // What was typed as it is comes first even if it is not possible: Enter must not run something else.
    const auto named = [](const Match& match) { return match.score > kNamed; };
    const bool instead =
        std::ranges::none_of(matches, [&](const Match& each) { return each.available && named(each); });
    const auto rank = [&](const Match& match) { return match.available ? 1 : instead && named(match) ? 0 : 2; };
    std::ranges::stable_sort(matches, [&](const Match& a, const Match& b) {
        return rank(a) != rank(b) ? rank(a) < rank(b) : a.score > b.score;
    });
    std::vector<const Command*> found;
    for (const Match& match : matches) found.push_back(match.command);
    return found;
}

const Command* drawPalette(CommandPalette& palette, const std::vector<Command>& commands) {
    if (palette.open) {
        ImGui::OpenPopup("###palette");
        palette.open = false;
        palette.text.clear();
        palette.chosen = 0;
        palette.shown = true;
    }
    if (!palette.shown) return nullptr;
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    const float width = std::min(viewport.Size.x * 0.8f, ImGui::GetFontSize() * 36);
    ImGui::SetNextWindowPos({viewport.Pos.x + (viewport.Size.x - width) / 2, viewport.Pos.y + viewport.Size.y * 0.12f});
    ImGui::SetNextWindowSize({width, 0});
    const Command* chosen = nullptr;
    palette.shown = ImGui::BeginPopup("###palette", ImGuiWindowFlags_NoMove);
    if (!palette.shown) return nullptr;

    const std::vector<const Command*> matches = matchingCommands(palette.text, commands);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool enter =
        ImGui::InputTextWithHint("##search", "Search for a command", &palette.text,
                                 ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    if (enter) ImGui::SetKeyboardFocusHere(-1); // where that ran nothing, the next text replaces this one
    if (ImGui::IsItemEdited()) palette.chosen = 0;
    const int count = static_cast<int>(matches.size());
    if (pressed({.key = key::kDown}, true)) ++palette.chosen;
    if (pressed({.key = key::kUp}, true)) --palette.chosen;
    palette.chosen = count == 0 ? 0 : std::clamp(palette.chosen, 0, count - 1);
    ImGui::BeginChild("##list", {0, ImGui::GetFrameHeightWithSpacing() * std::min(12.0f, viewport.Size.y / 60)});
    for (int i = 0; i < count; ++i) {
        const Command& match = *matches[static_cast<std::size_t>(i)];
        const std::string keys = textOf(match.shortcut);
        const ImGuiSelectableFlags flags =
            match.available() ? ImGuiSelectableFlags_None : ImGuiSelectableFlags_Disabled;
        if (ImGui::Selectable(shownName(match).c_str(), i == palette.chosen, flags)) chosen = &match;
        if (i == palette.chosen && keyPressed(key::kDown, true)) ImGui::SetScrollHereY(0.7f);
        if (i == palette.chosen && keyPressed(key::kUp, true)) ImGui::SetScrollHereY(0.3f);
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) && !match.help.empty())
            ImGui::SetTooltip("%s", helpOf(match).c_str());
        if (!keys.empty()) {
            ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(keys.c_str()).x -
                            ImGui::GetStyle().ItemSpacing.x);
            ImGui::TextDisabled("%s", keys.c_str());
        }
    }
    if (count == 0) ImGui::TextDisabled("No such command");
    const bool possible = count > 0 && matches[static_cast<std::size_t>(palette.chosen)]->available();
    ImGui::EndChild();
    if (count > 0 && !possible)
        ImGui::TextDisabled("%s", helpOf(*matches[static_cast<std::size_t>(palette.chosen)]).c_str());
    if (enter && possible) chosen = matches[static_cast<std::size_t>(palette.chosen)];
    if (chosen || escapePressed()) {
        ImGui::CloseCurrentPopup();
        palette.shown = false;
    }
    ImGui::EndPopup();
    return chosen;
}

std::vector<KeyHelp> keyHelp(const std::vector<Command>& commands, const std::string& search) {
    std::vector<KeyHelp> rows;
    for (const Command& command : commands) {
        if (command.shortcut.key == 0) continue;
        std::string keys = textOf(command.shortcut);
        if (command.alternative.key != 0) keys += "  " + textOf(command.alternative);
        rows.push_back({keys, command.title(), command.help});
    }
    for (const auto& [keys, name, help] :
         {std::tuple{"Alt", "Menus", "Open the menus, or close them; arrows, Enter and Esc walk them"},
          {"Alt+F E V L H", "One menu", "Open File, Edit, View, Layout or Help"},
          {"Tab, Shift+Tab", "Next item", "Go to the next or previous control of a pane; a frame marks it"},
          {"Arrows", "Walk", "From the marked control to its neighbours; in a held slider, change it"},
          {"Space, Enter", "Press", "Press the marked control; Enter on a number types"},
          {"Ctrl+Tab", "Other pane", "Choose a pane from a list"},
          {"Esc", "Give up", "Give up a drag, close a menu or dialog, end the walk of the mark"},
          {"Left drag", "Volume: rotate", "Ctrl: roll, Shift: pan"},
          {"Middle drag", "Volume: pan", "A middle click makes the point the centre of rotation"},
          {"Wheel, right drag", "Volume: zoom", "Ctrl+wheel: to the mouse"},
          {"Double click", "Cross-hair", "Move it to the point under the mouse, in volumes; on a number: type"},
          {"Right click", "Menu", "Of the view, a brush, a layer or a setting under the mouse"},
          {"Alt+drag, Alt+wheel", "Lens: move, resize", "Alt+right drag turns it"},
          {"F", "Lens: follow", "The lens under the mouse follows it, or stays"},
          {"Drag of a dot", "Handle: move",
           "Shift: nearer or farther; the tip of an arrow tilts a plane, turns a light"},
          {"Drag in a slice", "Cross-hair", "The wheel steps along the normal; Shift: ten at a time"},
          {"Drag in a callout", "Callout: turn", "Ctrl: with the view; wheel: magnify; double click: as the view"},
          {"Drag in a plot", "Brush", "Shift adds, Ctrl removes; drag a brush to move it, its edges to resize"},
          {"Drag in a HyperSlice", "Cross-hair, time", "Shift: a box to zoom to; a double middle click shows all"},
          {"Wheel in a plot", "Zoom", "Middle drag pans"},
          {"Drag of a number", "Change it", "Shift: finer, Ctrl: round values"}})
        rows.push_back({keys, name, help});
    const std::vector<std::string> wanted = wordsOf(search);
    std::erase_if(rows, [&](const KeyHelp& row) {
        const std::vector<std::string> own = wordsOf(row.keys + " " + row.name + " " + row.help);
        return !std::ranges::all_of(wanted, [&](const std::string& word) { return hasWord(own, word); });
    });
    return rows;
}

void drawKeyHelp(const std::vector<KeyHelp>& rows) {
    const float height = std::min(ImGui::GetTextLineHeightWithSpacing() * float(rows.size() + 1),
                                  ImGui::GetMainViewport()->Size.y * 0.6f);
    if (!beginScrolledTable(
            "##keys", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollY, {0, height}))
        return;
    ImGui::TableSetupColumn("keys");
    ImGui::TableSetupColumn("name");
    ImGui::TableSetupColumn("help", ImGuiTableColumnFlags_WidthStretch);
    for (const KeyHelp& row : rows) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row.keys.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row.name.c_str());
        ImGui::TableNextColumn();
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s", row.help.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::EndTable();
}

} // namespace tessera::app
