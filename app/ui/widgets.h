#pragma once

#include "app/session/session_types.h"
#include "app/ui/ticks.h"
#include "volume/field/dataset.h"

#include <algorithm>
#include <functional>
#include <imgui.h>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Widgets for described structs: label to the left, control to the right, help as a tooltip, unit behind the number. A
/// widget function edits its value and returns whether it changed.
namespace tessera::app {

/// What widgets may offer as choices and scales.
struct WidgetContext {
    const volume::DatasetInfo* info = nullptr; ///< parameters to choose from; may be null
    float labelShare = 0.4f;                   ///< of the width
    std::string path = {};                     ///< of what is drawn, a JSON pointer into the session; "" = not in it
    const std::function<void(const std::string& path)>* menu =
        nullptr;                                   ///< called for a right click on a label with a path
    const std::function<void()>* browse = nullptr; ///< asks for a file for a text that names one

    WidgetContext at(std::string place) const {
        WidgetContext out = *this;
        out.path = std::move(place);
        return out;
    }
    WidgetContext under(std::string_view key) const {
        return at(path.empty() ? std::string() : path + "/" + std::string(key));
    }
};

/// A label in the left column with the help as a tooltip; the next item fills the rest of the line.
void drawLabel(const WidgetContext& context, std::string_view label, std::string_view help);

/// The unit for a setting in kUnitOfLengths: one in which the data are of handy size; none where they state none.
LengthUnit dataLength(const WidgetContext& context);

/// The label of a setting: keyWords with a capital, "contextOpacity" -> "Context opacity".
std::string labelOf(std::string_view key);

bool drawBool(const WidgetContext& context, const FieldInfo& info, bool& value);
/// A slider where a range is known, else a field to drag or type in. `scale`: range of the parameter it refers to.
/// Several numbers stand side by side, with the unit in the label or fewer digits where there is little room, else
/// below each other; the whole is in a tooltip.
bool drawNumber(const WidgetContext& context, const FieldInfo& info, std::optional<Range> scale, double* values,
                int count, bool integer);
bool drawChoice(const WidgetContext& context, const FieldInfo& info, int& index);
/// Free text, a choice of parameter or colour map, or a file.
bool drawText(const WidgetContext& context, const FieldInfo& info, std::string& value);
bool drawTexts(const WidgetContext& context, const FieldInfo& info, std::vector<std::string>& values);
bool drawColor(const WidgetContext& context, const FieldInfo& info, float* rgb);
/// A choice of parameter without label. `emptyName` is offered for "" where given.
bool chooseChannel(const char* id, const volume::DatasetInfo* info, std::string& value,
                   const char* emptyName = nullptr);
/// A choice of vector parameter without label. `none`: "" is offered too.
bool chooseVector(const char* id, const volume::DatasetInfo* info, std::string& value, bool none = false);
/// A choice of colour map, with a search and a strip of each, without label (app/ui/choose_colormap.cpp).
bool chooseColormap(const char* id, std::string& value, bool reversed = false);
bool beginSection(const char* id, std::string_view label, std::string_view help);
/// Unfolds a section beside this place, which may not be there yet, and with `come` scrolls to it when it is drawn.
void openSection(const char* id, bool come = false);
void endSection();
/// A small button that adds to a list or removes from it.
bool drawListButton(const char* label);
/// The text with line ends for a width in pixels, at spaces alone: ImGui would also break "a..b" between the dots. A
/// word wider than a line stays whole, as do the groups of digits of a number.
std::string wrappedAtSpaces(const std::string& text, float width);
/// ImGui::BeginTable for tables with ImGuiTableFlags_ScrollX or ScrollY, which begin with this alone. ImGui::EndTable()
/// follows where it is true; where nothing of the table is seen it takes its place and is false.
bool beginScrolledTable(const char* id, int columns, ImGuiTableFlags flags, ImVec2 size);

/// ImGui's invisible button, at least a pixel wide and high: ImGui ends the program at one of no size.
bool mouseArea(const char* id, ImVec2 size, ImGuiButtonFlags buttons = 0);

} // namespace tessera::app
