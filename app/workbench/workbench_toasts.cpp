#include "app/ui/widgets.h"
#include "app/workbench/workbench.h"

#include <algorithm>
#include <imgui.h>

/// Messages that stand over the views for a while, the newest at the bottom.
namespace tessera::app {

void Workbench::drawToasts() {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    float y = viewport.Pos.y + viewport.Size.y - ImGui::GetFontSize() * 2.4f;
    int number = 0;
    for (auto each = messages_.rbegin(); each != messages_.rend(); ++each) {
        if (each->gone) continue;
        if (number == kToasts || now() - each->born > each->toastSeconds()) {
            each->gone = true; // the pane Messages keeps it
            continue;
        }
        const std::string id = "###toast" + std::to_string(number++);
        const float width = std::min(ImGui::GetFontSize() * 28, viewport.Size.x * 0.5f);
        ImGui::SetNextWindowPos({viewport.Pos.x + viewport.Size.x - 12 * scale_, y}, ImGuiCond_Always, {1, 1});
        ImGui::SetNextWindowSizeConstraints({ImGui::GetFontSize() * 12, 0}, {width, viewport.Size.y / 2});
        ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
        ImGui::PushStyleColor(ImGuiCol_Border, each->failure ? palette().failure : palette().line);
        ImGui::Begin(id.c_str(), nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                         ImGuiWindowFlags_NoNav);
        ImGui::PopStyleColor(2);
        const float em = ImGui::GetFontSize();
        if (each->failure && fonts_.icons) {
            ImGui::PushStyleColor(ImGuiCol_Text, palette().failure);
            ImGui::TextUnformatted(icon::kWarning);
            ImGui::PopStyleColor();
            ImGui::SameLine();
        }
        const float right = width - ImGui::GetStyle().WindowPadding.x - em * 1.8f; // where the cross begins
        ImGui::PushTextWrapPos(right);
        ImGui::TextUnformatted(wrappedAtSpaces(each->text, right - ImGui::GetCursorPosX()).c_str());
        ImGui::PopTextWrapPos();
        ImGui::SameLine();
        ImGui::PushStyleColor(ImGuiCol_Button, 0);
        if (ImGui::SmallButton(fonts_.icons ? icon::kCross : "x")) each->gone = true;
        ImGui::PopStyleColor();
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("Close; the pane Messages keeps it");
        if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) each->gone = true;
        y -= ImGui::GetWindowSize().y + 6 * scale_;
        ImGui::End();
    }
}

} // namespace tessera::app
