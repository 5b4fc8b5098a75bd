#pragma once

#include <imgui.h>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

/// Lines of text that end with "..." where they have no room, and show the whole under the mouse.
namespace tessera::app {

/// A line of text cut off with "..." so that it is at most `width` pixels wide. Where not even one letter and the dots
/// have room, nothing.
std::string fitText(std::string_view text, float width);

/// The first of the texts, which say ever less, that is at most `width` pixels wide; else the last one, cut off.
std::string firstThatFits(std::initializer_list<std::string> texts, float width);

/// A name and what says more than its last letters, " 3.8 mol": where both have no room, the name is cut off before
/// `end`. Where not even one letter has room beside it, nothing.
std::string fitBefore(std::string_view name, std::string_view end, float width);

/// The text as an item of a window, at most `width` pixels wide (0: up to the right end of the window). What was cut
/// off stands in a tooltip.
void fittedText(std::string_view text, float width = 0);

/// The same in the faint colour of hints, up to the right end of the window.
void faintText(std::string_view text);

/// A list of choices as wide as the next item; ImGui::EndCombo() follows where it is true.
bool beginFittedCombo(const char* id, std::string_view chosen);

/// A line that unfolds; `id` tells it apart. `unfold`: it does, or folds, now. ImGui::TreePop() follows where it is
/// true.
bool fittedTreeNode(std::string_view text, const char* id, std::optional<bool> unfold = {});

/// The line of a list of lines that unfold that is shown next: it unfolds and comes into view.
struct NextEntry {
    std::optional<std::size_t> entry = {};
    bool alone = false; ///< the others fold

    /// Whether the line `i` is to unfold (true) or to fold (false) now.
    std::optional<bool> unfolds(std::size_t i) const {
        if (!entry || (!alone && i != *entry)) return {};
        return i == *entry;
    }
};

/// Shows the whole of a text under the mouse where `shown`, drawn from `min` to `max` in the window being made, is
/// less.
void tellWhole(ImVec2 min, ImVec2 max, std::string_view whole, std::string_view shown);

/// The same, drawn at a place of the window being made. Returns the width in pixels.
float addFittedText(ImDrawList& draw, ImVec2 at, ImU32 color, std::string_view text, float width);

} // namespace tessera::app
