#include "app/dialogs/dialogs.h"

#include "app/ui/file_dialog.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <filesystem>
#include <imgui.h>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

/// Begins a centred modal dialog; `open` becomes false with Esc or the cross.
bool beginDialog(const char* title, bool& open, float width) {
    if (open && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({width, 0});
    if (!ImGui::BeginPopupModal(title, &open, ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoResize))
        return false;
    if (pressed({.key = key::kEscape})) open = false;
    return true;
}

void endDialog(bool open) {
    if (!open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

/// Buttons at the right end of a dialog; returns the index of the one pressed, -1 for none. Enter presses the last.
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
    // Ignore the Enter that has just closed the previous dialog.
    if (chosen < 0 && pressed({.key = key::kEnter}) && !ImGui::IsAnyItemActive() && !ImGui::IsWindowAppearing())
        chosen = static_cast<int>(names.size()) - 1;
    return chosen;
}

} // namespace

std::optional<Opened> MissingFilesDialog::draw(const Ask& ask) {
    if (!opened_) return {};
    if (opened_->missing.empty()) return std::exchange(opened_, {});
    bool open = true;
    if (!beginDialog("Data not found", open, ImGui::GetFontSize() * 40)) {
        if (!open) opened_.reset();
        return {};
    }
    ImGui::TextWrapped("Files of the session have moved. What is open now stays open until they are found.");
    ImGui::Spacing();
    for (std::size_t i = 0; i < opened_->missing.size(); ++i) drawFile(i, ask);
    if (dialogButtons({"Cancel"}) == 0) open = false;
    endDialog(open);
    if (!open) opened_.reset();
    return {};
}

void MissingFilesDialog::drawFile(std::size_t index, const Ask& ask) {
    const DataFile& wanted = opened_->missing[index].wanted;
    const auto& transfer = opened_->document.session.transfer;
    ImGui::PushID(static_cast<int>(index));
    ImGui::TextUnformatted(fs::path(wanted.path).filename().c_str());
    ImGui::TextDisabled("%s, previously at %s", wanted.bytes > 0 ? textOfBytes(wanted.bytes).c_str() : "size unknown",
                        wanted.absolutePath.empty() ? wanted.path.c_str() : wanted.absolutePath.c_str());
    if (opened_->missing.size() == 1 && !transfer.empty()) {
        std::string names;
        for (const auto& [name, function] : transfer) names += (names.empty() ? "with " : ", ") + name;
        ImGui::TextDisabled("%s", names.c_str());
    }
    if (ImGui::Button("Choose...")) {
        ImGui::CloseCurrentPopup();
        ask(index, "Where is " + fs::path(wanted.path).filename().string() + "?", opened_->folder);
    }
    ImGui::PopID();
    ImGui::Spacing();
}

void MissingFilesDialog::found(std::size_t index, const std::string& path) {
    if (!opened_ || index >= opened_->missing.size()) return;
    locate(opened_->document.session.data, opened_->missing[index], path);
    opened_->missing.erase(opened_->missing.begin() + static_cast<std::ptrdiff_t>(index));
}

std::optional<Recovery> RecoveryDialog::draw() {
    if (recoveries_.empty()) return {};
    bool open = true;
    if (!beginDialog("Recover the last session?", open, ImGui::GetFontSize() * 34)) return {};
    ImGui::TextWrapped("Tessera did not exit properly. The session of %s was saved automatically.",
                       recoveries_.front().when.c_str());
    const int button = dialogButtons({"Discard", "Later", "Recover"});
    std::optional<Recovery> chosen;
    if (button == 0) {
        Autosave::discard(recoveries_.front());
        recoveries_.erase(recoveries_.begin());
        open = !recoveries_.empty();
    } else if (button > 0 || !open) {
        if (button == 2) chosen = recoveries_.front();
        recoveries_.clear();
        open = false;
    }
    endDialog(open);
    return chosen;
}

void PictureDialog::show(const std::string& pane) {
    picture_.pane = pane;
    shown_ = true;
}

std::optional<PictureRequest> PictureDialog::draw(const Session& session) {
    if (!shown_ || !beginDialog("Save picture", shown_, ImGui::GetFontSize() * 30)) return {};
    const WidgetContext widgets{nullptr, 0.3f};
    drawLabel(widgets, "What", "The window, or one view");
    const char* const whole = "The whole window";
    if (ImGui::BeginCombo("##what", picture_.pane.empty() ? whole : paneTitle(session, picture_.pane).c_str())) {
        if (ImGui::Selectable(whole, picture_.pane.empty())) picture_.pane.clear();
        for (const std::string& pane : paneKeys(session))
            if (ImGui::Selectable(paneTitle(session, pane).c_str(), pane == picture_.pane)) picture_.pane = pane;
        ImGui::EndCombo();
    }
    drawLabel(widgets, "Size", "Size of the picture in pixels");
    ImGui::InputInt2("##size", &picture_.size.x);
    picture_.size = glm::clamp(picture_.size, glm::ivec2(64), glm::ivec2(8192));
    drawLabel(widgets, "", "");
    for (const auto& [name, size] : {std::pair{"1920x1080", glm::ivec2(1920, 1080)},
                                     {"3840x2160", glm::ivec2(3840, 2160)},
                                     {"1200x1200", glm::ivec2(1200, 1200)}}) {
        if (ImGui::SmallButton(name)) picture_.size = size;
        ImGui::SameLine();
    }
    ImGui::NewLine();
    drawLabel(widgets, "Text size", "Scale of text and lines, e.g. 2 for a picture of twice the size");
    ImGui::SliderFloat("##scale", &picture_.scale, 0.5f, 4.0f, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    ImGui::Spacing();
    ImGui::TextDisabled("The picture contains the session: open it in Tessera to continue from it.");
    const int button = dialogButtons({"Cancel", "Save..."});
    if (button >= 0) shown_ = false;
    endDialog(shown_);
    return button == 1 ? std::optional(picture_) : std::nullopt;
}

LeaveDialog::Answer LeaveDialog::draw(bool saved) {
    if (!go_) return Answer::None;
    bool open = true;
    if (!beginDialog("Save the session?", open, ImGui::GetFontSize() * 28)) {
        if (!open) go_ = nullptr;
        return Answer::None;
    }
    ImGui::TextWrapped("The session has changed since it was %s.", saved ? "saved" : "opened");
    const int button = dialogButtons({"Discard", "Cancel", "Save"});
    if (button >= 0) open = false;
    endDialog(open);
    if (button == 0) return Answer::Discard;
    if (button == 2) return Answer::Save;
    if (!open) go_ = nullptr;
    return Answer::None;
}

void HelpDialogs::draw(const std::vector<Command>& commands, const Fonts& fonts, const vis::ResidencyInfo& use) {
    if (shortcuts_ && beginDialog("Shortcuts", shortcuts_, ImGui::GetFontSize() * 48)) {
        ImGui::TextWrapped("In a volume: left drag rotates, wheel and right drag zoom, middle drag or Shift+drag pans, "
                           "Ctrl+drag rolls, double-click moves the cross-hair. In plots: drag to select (brush); "
                           "Shift adds, Ctrl removes; Esc clears.");
        ImGui::Spacing();
        drawShortcutHelp(commands);
        if (dialogButtons({"Close"}) == 0) shortcuts_ = false;
        endDialog(shortcuts_);
    }
    if (about_ && beginDialog("About Tessera", about_, ImGui::GetFontSize() * 30)) {
        ImGui::PushFont(fonts.bold);
        ImGui::TextUnformatted("Tessera " TESSERA_VERSION);
        ImGui::PopFont();
        ImGui::TextWrapped("A workbench for simulations with many values per point.");
        ImGui::Spacing();
        ImGui::TextDisabled(
            "Brick textures %s of %s, decoded bricks %s of %s", textOfBytes(double(use.textureBytes)).c_str(),
            textOfBytes(double(use.textureBudget)).c_str(), textOfBytes(double(use.memoryBytes)).c_str(),
            textOfBytes(double(use.memoryBudget)).c_str());
        if (dialogButtons({"Close"}) == 0) about_ = false;
        endDialog(about_);
    }
}

} // namespace tessera::app
