#include "app/pane/controls.h"

#include "app/pane/plot.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

bool iconButton(const ViewContext& context, const char* id, Icon icon, const char* help, bool enabled, bool lit) {
    const float height = ImGui::GetFrameHeight();
    const ImVec2 glyph = iconSize(context, icon);
    const ImVec2 size{iconButtonWidth(context, icon), height};
    ImGui::BeginDisabled(!enabled);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool pressed = ImGui::Button((std::string("##") + id).c_str(), size);
    if (lit) ImGui::PopStyleColor();
    ImGui::EndDisabled();
    if (help && *help && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) tooltip(help);
    const ImU32 color = ImGui::GetColorU32(enabled ? ImGuiCol_Text : ImGuiCol_TextDisabled);
    ImFont* font = context.iconFont ? context.iconFont : ImGui::GetFont();
    ImGui::GetWindowDrawList()->AddText(
        font, context.iconFont ? em() * 0.95f : em(),
        {std::round(at.x + (size.x - glyph.x) / 2), std::round(at.y + (size.y - glyph.y) / 2)}, color,
        context.iconFont ? icon.glyph : icon.word);
    return pressed;
}

float iconButtonWidth(const ViewContext& context, Icon icon) {
    return std::max(ImGui::GetFrameHeight(), iconSize(context, icon).x + em() * 0.5f);
}

ImVec2 iconSize(const ViewContext& context, Icon icon) {
    if (!context.iconFont) return ImGui::CalcTextSize(icon.word);
    return context.iconFont->CalcTextSizeA(em() * 0.95f, 1e6f, 0, icon.glyph);
}

void iconText(const ViewContext& context, Icon icon, ImU32 color) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = iconSize(context, icon);
    const float width = std::max(em() * 1.4f, size.x);
    ImFont* font = context.iconFont ? context.iconFont : ImGui::GetFont();
    ImGui::GetWindowDrawList()->AddText(
        font, context.iconFont ? em() * 0.95f : em(),
        {std::round(at.x + (width - size.x) / 2), std::round(at.y + (ImGui::GetFrameHeight() - size.y) / 2)}, color,
        context.iconFont ? icon.glyph : icon.word);
    ImGui::Dummy({width, ImGui::GetFrameHeight()});
}

float buttonWidth(const char* text) {
    return ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x;
}

float checkboxWidth(const char* text) {
    return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize(text).x;
}

void tooltip(const char* text) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(em() * 28);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

} // namespace tessera::app
