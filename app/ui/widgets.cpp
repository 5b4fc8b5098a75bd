#include "app/ui/widgets.h"

#include "app/described/key_words.h"
#include "app/ui/fitted_text.h"
#include "app/ui/number_field.h"
#include "app/ui/theme.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <imgui.h>
#include <imgui_internal.h> // CalcItemSize, ItemSize
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

/// A printf format with the digits that a slider over this range can resolve.
std::string numberFormat(std::optional<Range> range, bool logScale, bool integer) {
    std::string format = "%.4g";
    if (integer) {
        format = "%.0f";
    } else if (range && !logScale && range->hi > range->lo) {
        const int decimals = static_cast<int>(std::ceil(-std::log10((range->hi - range->lo) / 1500)));
        const double largest = std::max(std::abs(range->lo), std::abs(range->hi));
        if (decimals >= 0 && decimals <= 4 && largest < 1e6)
            format = "%." + std::to_string(decimals) + "f";
        else
            format = "%.5g";
    }
    return format;
}

std::string withUnit(std::string format, std::string_view unit) {
    if (unit.empty()) return format;
    format += ' ';
    for (const char c : prettyUnit(unit)) format += c == '%' ? "%%" : std::string(1, c);
    return format;
}

std::string printed(const std::string& format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format.c_str(), value);
    return text;
}

/// How numbers are written in a row of fields.
struct NumberRow {
    std::string format;
    bool stacked = false; ///< one below the other
    bool whole = true;    ///< with unit and all digits
};

/// The first way to write them that fits a row `room` wide, from the whole to two digits.
NumberRow numberRow(const std::string& format, std::string_view unit, const double* values, int count, bool integer,
                    float room) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float gaps = style.ItemInnerSpacing.x * static_cast<float>(count - 1);
    const float width = (room - gaps) / static_cast<float>(count) - 2 * style.FramePadding.x;
    const std::string whole = withUnit(format, unit);
    std::vector<std::string> formats{whole, format};
    if (!integer) formats.insert(formats.end(), {"%.3g", "%.2g"});
    for (const std::string& each : formats) {
        float widest = 0;
        for (int i = 0; i < count; ++i)
            widest = std::max(widest, ImGui::CalcTextSize(printed(each, values[i]).c_str()).x);
        if (widest <= width) return {each, false, each == whole};
    }
    return {whole, true, true};
}

std::string idOf(const FieldInfo& info) {
    return "##" + std::string(info.key);
}

/// Where the control beside a label begins.
float controlColumn(const WidgetContext& context) {
    return std::floor(ImGui::GetContentRegionAvail().x * context.labelShare);
}

} // namespace

std::string labelOf(std::string_view key) {
    std::string label = keyWords(key);
    if (!label.empty()) label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
    return label;
}

void drawLabel(const WidgetContext& context, std::string_view label, std::string_view help) {
    const float start = ImGui::GetCursorPosX();
    const float column = controlColumn(context);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    // A label that is slightly too long is drawn smaller instead of shortened.
    const float room = column - ImGui::GetStyle().ItemInnerSpacing.x;
    const char *begin = label.data(), *end = begin + label.size();
    const float scale = std::clamp(room / std::max(1.0f, ImGui::CalcTextSize(begin, end).x), 0.75f, 1.0f);
    const float size = std::floor(ImGui::GetFontSize() * scale);
    const std::string shown = fitText(label, room / scale + 0.5f);
    ImGui::GetWindowDrawList()->AddText(
        ImGui::GetFont(), size,
        {corner.x, std::round(corner.y + ImGui::GetStyle().FramePadding.y + (ImGui::GetFontSize() - size) / 2)},
        palette().muted, shown.c_str());
    ImGui::Dummy({std::max(1.0f, room), ImGui::GetFrameHeight()});
    if (const std::string told = shown == label ? std::string(help) : std::string(label) + "\n" + std::string(help);
        !told.empty() && ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", told.c_str());
    if (context.menu && !context.path.empty() && ImGui::BeginPopupContextItem(context.path.c_str())) {
        (*context.menu)(context.path);
        ImGui::EndPopup();
    }
    ImGui::SameLine(start + column, 0);
    ImGui::SetNextItemWidth(-FLT_MIN);
}

bool drawBool(const WidgetContext& context, const FieldInfo& info, bool& value) {
    drawLabel(context, labelOf(info.key), info.doc);
    return ImGui::Checkbox(idOf(info).c_str(), &value);
}

LengthUnit dataLength(const WidgetContext& context) {
    if (!context.info) return {"", 1};
    const glm::dvec3 size = context.info->bounds.size();
    return suitableLength(context.info->lengthUnit, std::max({size.x, size.y, size.z}));
}

bool drawNumber(const WidgetContext& context, const FieldInfo& info, std::optional<Range> scale, double* values,
                int count, bool integer) {
    std::optional<Range> range = info.range;
    if (!range && scale && scale->hi > scale->lo) range = scale;
    const std::string format = numberFormat(range, info.logScale, integer);
    NumberRow row{withUnit(format, info.unit)};
    if (count > 1)
        row = numberRow(format, info.unit, values, count, integer,
                        ImGui::GetContentRegionAvail().x - controlColumn(context));
    std::string label = labelOf(info.key);
    if (!row.whole && !info.unit.empty()) label = titleWithUnit(label, std::string(info.unit));
    drawLabel(context, label, info.doc);
    double largest = 0;
    for (int i = 0; i < count; ++i) largest = std::max(largest, std::abs(values[i]));
    const bool slides = info.range || (range && count == 1);
    const NumberStyle style{.format = row.format,
                            .range = slides ? range : std::nullopt,
                            .span = range ? range->hi - range->lo : std::max(largest, 1e-3),
                            .logScale = info.logScale,
                            .integer = integer};
    bool changed = false;
    const std::vector<double> before(values, values + count);
    if (row.stacked) {
        ImGui::BeginGroup();
        for (int i = 0; i < count; ++i) {
            ImGui::SetNextItemWidth(-FLT_MIN);
            changed |= numberFields((idOf(info) + std::to_string(i)).c_str(), values + i, 1, style);
        }
        ImGui::EndGroup();
    } else {
        changed = numberFields(idOf(info).c_str(), values, count, style);
    }
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_None) || ImGui::IsItemActive()) return changed;
    if (!row.whole) {
        std::string whole;
        for (const double value : before)
            whole += (whole.empty() ? "" : ", ") + printed(withUnit(format, info.unit), value);
        ImGui::SetTooltip("%s", whole.c_str());
    } else if (ImGui::GetIO().KeyCtrl) {
        ImGui::SetTooltip("Ctrl+wheel steps, Ctrl+click or a double click types; in a drag Ctrl snaps, Shift is finer");
    }
    return changed;
}

bool drawChoice(const WidgetContext& context, const FieldInfo& info, int& index) {
    drawLabel(context, labelOf(info.key), info.doc);
    bool changed = false;
    const auto shown = [&](int i) { return labelOf(info.names[static_cast<std::size_t>(i)]); };
    if (beginFittedCombo(idOf(info).c_str(), shown(index))) {
        for (int i = 0; i < static_cast<int>(info.names.size()); ++i) {
            if (ImGui::Selectable(shown(i).c_str(), i == index)) {
                changed = i != index;
                index = i;
            }
            if (i == index) ImGui::SetItemDefaultFocus();
        }
        ImGui::EndCombo();
    }
    return changed;
}

bool chooseChannel(const char* id, const volume::DatasetInfo* info, std::string& value, const char* emptyName) {
    bool changed = false;
    if (!beginFittedCombo(id, value.empty() ? (emptyName ? emptyName : "-") : value)) return false;
    if (emptyName && ImGui::Selectable(emptyName, value.empty())) {
        changed = !value.empty();
        value.clear();
    }
    if (info) {
        for (const volume::Channel& channel : info->channels()) {
            const bool chosen = channel.name == value;
            if (ImGui::Selectable(channel.name.c_str(), chosen)) {
                changed = !chosen;
                value = channel.name;
            }
            if (chosen) ImGui::SetItemDefaultFocus();
            if (!channel.unit.empty()) {
                const float width = ImGui::CalcTextSize(channel.unit.c_str()).x;
                ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
                ImGui::TextDisabled("%s", channel.unit.c_str());
            }
        }
    }
    ImGui::EndCombo();
    return changed;
}

bool chooseVector(const char* id, const volume::DatasetInfo* info, std::string& value, bool none) {
    bool changed = false;
    if (!beginFittedCombo(id, value.empty() ? "none" : value)) return false;
    if (none && ImGui::Selectable("none", value.empty())) {
        changed = !value.empty();
        value.clear();
    }
    if (info)
        for (const volume::Parameter& parameter : info->parameters)
            if (parameter.components == 3 && ImGui::Selectable(parameter.name.c_str(), parameter.name == value)) {
                changed = parameter.name != value;
                value = parameter.name;
            }
    ImGui::EndCombo();
    return changed;
}

bool drawText(const WidgetContext& context, const FieldInfo& info, std::string& value) {
    drawLabel(context, labelOf(info.key), info.doc);
    if (info.refersTo == "channel") return chooseChannel(idOf(info).c_str(), context.info, value, "as first layer");
    if (info.refersTo == "vector" || info.refersTo == "optionalVector")
        return chooseVector(idOf(info).c_str(), context.info, value, info.refersTo == "optionalVector");
    if (info.refersTo == "colorChannel")
        return chooseChannel(idOf(info).c_str(), context.info, value, "own transfer function");
    if (info.refersTo == "optionalChannel") return chooseChannel(idOf(info).c_str(), context.info, value, "none");
    if (info.refersTo == "colormap") return chooseColormap(idOf(info).c_str(), value);
    if (info.refersTo != "path" || !context.browse) return ImGui::InputText(idOf(info).c_str(), &value);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - ImGui::GetFrameHeight() -
                            ImGui::GetStyle().ItemInnerSpacing.x);
    const bool changed = ImGui::InputText(idOf(info).c_str(), &value);
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button(("..." + idOf(info)).c_str(), {ImGui::GetFrameHeight(), 0})) (*context.browse)();
    return changed;
}

bool drawTexts(const WidgetContext& context, const FieldInfo& info, std::vector<std::string>& values) {
    drawLabel(context, labelOf(info.key), info.doc);
    if (info.refersTo != "channel" || !context.info) {
        ImGui::TextDisabled("%d", static_cast<int>(values.size()));
        return false;
    }
    std::string shown = values.empty() ? "all" : "";
    for (const std::string& value : values) shown += (shown.empty() ? "" : ", ") + value;
    bool changed = false;
    if (!ImGui::BeginCombo(idOf(info).c_str(), shown.c_str(), ImGuiComboFlags_HeightLarge)) return false;
    if (ImGui::Selectable("all", values.empty(), ImGuiSelectableFlags_DontClosePopups)) {
        changed = !values.empty();
        values.clear();
    }
    for (const volume::Channel& channel : context.info->channels()) {
        const auto found = std::find(values.begin(), values.end(), channel.name);
        bool chosen = found != values.end();
        if (ImGui::Checkbox(channel.name.c_str(), &chosen)) {
            if (chosen)
                values.push_back(channel.name);
            else
                values.erase(found);
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

bool drawColor(const WidgetContext& context, const FieldInfo& info, float* rgb) {
    drawLabel(context, labelOf(info.key), info.doc);
    const bool changed = ImGui::ColorEdit3(idOf(info).c_str(), rgb, ImGuiColorEditFlags_PickerHueWheel);
    if (changed)
        for (int i = 0; i < 3; ++i) rgb[i] = std::clamp(rgb[i], 0.0f, 1.0f);
    return changed;
}

namespace {

/// Where it is kept that a section is to be scrolled to.
ImGuiID comingOf(const char* id) {
    return ImGui::GetID((std::string("comes ") + id).c_str());
}

} // namespace

bool beginSection(const char* id, std::string_view label, std::string_view help) {
    const std::string text = std::string(label) + "###" + id;
    if (bool* const comes = ImGui::GetStateStorage()->GetBoolRef(comingOf(id)); *comes) {
        *comes = false;
        ImGui::SetScrollHereY(0.1f);
    }
    const bool open =
        ImGui::TreeNodeEx(text.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth | ImGuiTreeNodeFlags_FramePadding);
    if (!help.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%.*s", int(help.size()), help.data());
    return open;
}

void openSection(const char* id, bool come) {
    if (come) ImGui::GetStateStorage()->SetBool(comingOf(id), true);
    ImGui::GetStateStorage()->SetInt(ImGui::GetID(("###" + std::string(id)).c_str()), 1);
}

bool drawListButton(const char* label) {
    return ImGui::SmallButton(label);
}

void endSection() {
    ImGui::TreePop();
}

std::string wrappedAtSpaces(const std::string& text, float width) {
    const auto isDigit = [&](std::size_t at) { return text[at] >= '0' && text[at] <= '9'; };
    std::string out;
    float used = 0;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = text.find_first_not_of(' ', at); // a word with the spaces before it
        end = std::min(text.find_first_of(" \n", end), text.size());
        while (end > at && end + 1 < text.size() && isDigit(end - 1) && text[end] == ' ' && isDigit(end + 1))
            end = std::min(text.find_first_of(" \n", end + 1), text.size()); // of a number of several groups
        const char* const begin = text.c_str() + at;
        float wide = ImGui::CalcTextSize(begin, text.c_str() + end).x;
        if (used > 0 && used + wide > width && text[at] == ' ') {
            out += '\n';
            at = std::min(text.find_first_not_of(' ', at), end);
            used = 0;
            wide = ImGui::CalcTextSize(text.c_str() + at, text.c_str() + end).x;
        }
        out.append(text, at, end - at);
        used += wide;
        at = end;
        if (at < text.size() && text[at] == '\n') {
            out += '\n';
            used = 0;
            ++at;
        }
    }
    return out;
}

// ImGui has two opinions on whether such a table is seen. The table itself is where its place overlaps what its window
// shows. The window made inside for its rows is where both have pixels in common, once its place is cut to whole
// pixels. If the first says yes and the second no, ImGui fails an assertion: where only a fraction of a pixel is left
// of a table that is scrolled away, or where the window shows no line at all, as one dragged out below does.
bool beginScrolledTable(const char* id, int columns, ImGuiTableFlags flags, ImVec2 size) {
    const ImGuiWindow* const window = ImGui::GetCurrentWindow();
    const ImVec2 room = ImGui::GetContentRegionAvail(), at = window->DC.CursorPos;
    const ImVec2 own = ImGui::CalcItemSize(size, std::max(room.x, 1.0f), std::max(room.y, 1.0f));
    const float top = std::floor(at.y), bottom = top + std::floor(own.y);
    const bool seen = std::max(top, window->ClipRect.Min.y) < std::min(bottom, window->ClipRect.Max.y);
    if (!seen && !GImGui->LogEnabled) { // what is logged as text is all of it
        ImGui::ItemSize(own);
        return false;
    }
    return ImGui::BeginTable(id, columns, flags, size);
}

bool mouseArea(const char* id, ImVec2 size, ImGuiButtonFlags buttons) {
    return ImGui::InvisibleButton(id, {std::max(1.0f, size.x), std::max(1.0f, size.y)}, buttons);
}

} // namespace tessera::app
