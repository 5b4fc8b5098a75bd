#include "app/dialogs/modal.h"

#include "app/dialogs/file_dialog.h"
#include "app/ui/keys.h"

#include <algorithm>
#include <imgui.h>

namespace tessera::app {

namespace {

/// Whether a widget of the dialog had the keyboard when its frame began: then Enter was for that.
constexpr const char* kHadKeyboard = "hadKeyboard";

} // namespace

bool beginDialog(const char* title, bool& open, float width) {
    if (open && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({width, 0});
    if (!ImGui::BeginPopupModal(title, &open, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoResize))
        return false;
    ImGui::GetStateStorage()->SetBool(ImGui::GetID(kHadKeyboard), ImGui::IsAnyItemActive());
    if (escapePressed() && !ImGui::IsWindowAppearing()) open = false; // not by the key that asked
    return true;
}

void endDialog(bool open) {
    if (!open) ImGui::CloseCurrentPopup();
    keepInView();
    ImGui::EndPopup();
}

int dialogButtons(std::initializer_list<const char*> names) {
    const float width = ImGui::GetFontSize() * 7, gap = ImGui::GetStyle().ItemSpacing.x;
    const float total = static_cast<float>(names.size()) * (width + gap) - gap;
    ImGui::Spacing();
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - total));
    int chosen = -1, index = 0;
    for (const char* name : names) {
        if (index > 0) ImGui::SameLine();
        const bool last = index + 1 == static_cast<int>(names.size());
        if (last) {
            ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(ImGuiCol_SliderGrab));
            ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(255, 255, 255, 255));
        }
        if (ImGui::Button(name, {width, 0})) chosen = index;
        if (last) ImGui::PopStyleColor(2);
        ++index;
    }
    // Ignore the Enter that has just closed the previous dialog, and that which ends typing in a field.
    const bool typed = ImGui::GetStateStorage()->GetBool(ImGui::GetID(kHadKeyboard));
    if (chosen < 0 && pressed({.key = key::kEnter}) && !typed && !ImGui::IsWindowAppearing())
        chosen = static_cast<int>(names.size()) - 1;
    return chosen;
}

} // namespace tessera::app
