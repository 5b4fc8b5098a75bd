#include "app/ui/fitted_text.h"

namespace tessera::app {

std::string fitText(std::string_view text, float width) {
    std::string out(text);
    if (ImGui::CalcTextSize(out.c_str()).x <= width) return out;
    while (!out.empty()) {
        // Whole UTF-8 characters only.
        while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xc0) == 0x80) out.pop_back();
        if (!out.empty()) out.pop_back();
        if (ImGui::CalcTextSize((out + "...").c_str()).x <= width) return out.empty() ? out : out + "...";
    }
    return {};
}

std::string firstThatFits(std::initializer_list<std::string> texts, float width) {
    for (const std::string& text : texts)
        if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
    return texts.size() > 0 ? fitText(*(texts.end() - 1), width) : std::string();
}

std::string fitBefore(std::string_view name, std::string_view end, float width) {
    const std::string last(end);
    const std::string first = fitText(name, width - ImGui::CalcTextSize(last.c_str()).x);
    return first.empty() ? first : first + last;
}

void fittedText(std::string_view text, float width) {
    const std::string shown = fitText(text, width > 0 ? width : ImGui::GetContentRegionAvail().x);
    ImGui::TextUnformatted(shown.c_str());
    if (shown != text && ImGui::IsItemHovered()) ImGui::SetTooltip("%.*s", int(text.size()), text.data());
}

void faintText(std::string_view text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    fittedText(text);
    ImGui::PopStyleColor();
}

bool beginFittedCombo(const char* id, std::string_view chosen) {
    const float room = ImGui::CalcItemWidth() - ImGui::GetFrameHeight() - 2 * ImGui::GetStyle().FramePadding.x;
    std::string shown = fitText(chosen, room);
    if (shown.empty()) shown = chosen; // a cut letter says more than none
    const bool open = ImGui::BeginCombo(id, shown.c_str());
    if (!open && ImGui::CalcTextSize(chosen.data(), chosen.data() + chosen.size()).x > room && ImGui::IsItemHovered())
        ImGui::SetTooltip("%.*s", int(chosen.size()), chosen.data());
    return open;
}

bool fittedTreeNode(std::string_view text, const char* id, std::optional<bool> unfold) {
    if (unfold) ImGui::SetNextItemOpen(*unfold);
    const std::string shown = fitText(text, ImGui::GetContentRegionAvail().x - ImGui::GetTreeNodeToLabelSpacing());
    const bool open = ImGui::TreeNodeEx((shown + "###" + id).c_str(), ImGuiTreeNodeFlags_SpanAvailWidth);
    if (shown != text && ImGui::IsItemHovered()) ImGui::SetTooltip("%.*s", int(text.size()), text.data());
    return open;
}

void tellWhole(ImVec2 min, ImVec2 max, std::string_view whole, std::string_view shown) {
    if (shown != whole && ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(min, max))
        ImGui::SetTooltip("%.*s", int(whole.size()), whole.data());
}

float addFittedText(ImDrawList& draw, ImVec2 at, ImU32 color, std::string_view text, float width) {
    const std::string shown = fitText(text, width);
    const ImVec2 size = ImGui::CalcTextSize(shown.c_str());
    draw.AddText(at, color, shown.c_str());
    tellWhole(at, {at.x + size.x, at.y + size.y}, text, shown);
    return size.x;
}

} // namespace tessera::app
