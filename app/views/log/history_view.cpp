#include "app/history/history.h"
#include "app/pane/view_context.h"
#include "app/ui/fitted_text.h"
#include "app/ui/theme.h"

#include <imgui.h>
#include <optional>

namespace tessera::app {

void drawHistoryView(ViewContext& context, const std::string&, HistoryView&) {
    ImGui::TextDisabled("All edits; click one to go back to it.");
    ImGui::Separator();
    ImGui::BeginChild("##steps");
    std::optional<std::size_t> wanted;
    const std::size_t position = context.history ? context.history->position() : 0;
    if (ImGui::Selectable("As opened", position == 0)) wanted = 0;
    for (std::size_t i = 0; context.history && i < context.history->steps().size(); ++i) {
        const bool undone = i >= position;
        ImGui::PushID(static_cast<int>(i));
        if (undone) ImGui::PushStyleColor(ImGuiCol_Text, palette().muted);
        const std::string &name = context.history->steps()[i].name,
                          shown = fitText(name, ImGui::GetContentRegionAvail().x);
        if (ImGui::Selectable((shown + "###step").c_str(), i + 1 == position)) wanted = i + 1;
        if (shown != name && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", name.c_str());
        if (undone) ImGui::PopStyleColor();
        ImGui::PopID();
    }
    ImGui::EndChild();
    if (wanted && context.goToStep) context.goToStep(*wanted);
}

} // namespace tessera::app
