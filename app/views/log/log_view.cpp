#include "app/pane/view_context.h"
#include "app/ui/messages.h"
#include "app/ui/theme.h"

#include <imgui.h>
#include <ranges>

namespace tessera::app {

void drawLogView(ViewContext& context, const std::string&, LogView&) {
    if (!context.log || context.log->list().empty()) {
        ImGui::TextDisabled("No messages.");
        return;
    }
    ImGui::PushTextWrapPos(0);
    for (const Messages::Message& each : std::views::reverse(context.log->list())) {
        ImGui::TextDisabled("%s", each.clock.c_str());
        ImGui::SameLine();
        if (each.failure) ImGui::PushStyleColor(ImGuiCol_Text, palette().failure);
        ImGui::TextUnformatted(each.text.c_str());
        if (each.failure) ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
}

} // namespace tessera::app
