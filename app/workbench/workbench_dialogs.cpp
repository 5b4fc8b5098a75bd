#include "app/workbench/workbench.h"

#include "app/ui/widgets.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <imgui.h>

/// Dialogs of the workbench. Each is drawn every frame and shows itself when its state says so; Esc closes it.
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
    // Not with the Enter that has just answered the dialog before.
    if (chosen < 0 && pressed({.key = key::kEnter}) && !ImGui::IsAnyItemActive() && !ImGui::IsWindowAppearing())
        chosen = static_cast<int>(names.size()) - 1;
    return chosen;
}

} // namespace

void Workbench::drawDialogs() {
    if (const auto answer = files_.draw()) answerFile(*answer);
    if (!files_.shown()) {
        afterSave_ = nullptr; // no place was chosen
        drawMissing();
        drawRecovery();
        drawExport();
        drawLeaving();
        drawHelp();
    }
}

void Workbench::drawMissing() {
    if (!missing_) return;
    if (missing_->missing.empty()) { // everything was found: open it
        auto opened = std::make_shared<Opened>(std::move(*missing_));
        missing_.reset();
        jobs_.start("open", "Opening the session", [this, opened](const Progress& progress) -> Jobs::Finish {
            const ResolvedData found = resolveData(opened->document.session.data, opened->folder);
            auto done = std::make_shared<Opened>(openWith(*opened, found.data, progress));
            done->messages.insert(done->messages.end(), found.warnings.begin(), found.warnings.end());
            return [this, done] { install(std::move(*done)); };
        });
        return;
    }
    bool open = true;
    if (!beginDialog("Data not found", open, ImGui::GetFontSize() * 40)) {
        if (!open) missing_.reset();
        return;
    }
    ImGui::TextWrapped(
        "The session shows files that are not where they were. What is open stays until they are found.");
    ImGui::Spacing();
    for (std::size_t i = 0; i < missing_->missing.size(); ++i) {
        const DataFile& wanted = missing_->missing[i].wanted;
        ImGui::PushID(static_cast<int>(i));
        ImGui::TextUnformatted(fs::path(wanted.path).filename().c_str());
        ImGui::TextDisabled("%s, was at %s", wanted.bytes > 0 ? textOfBytes(wanted.bytes).c_str() : "size not known",
                            wanted.absolutePath.empty() ? wanted.path.c_str() : wanted.absolutePath.c_str());
        if (missing_->missing.size() == 1 && !missing_->document.session.transfer.empty()) {
            std::string names;
            for (const auto& [name, function] : missing_->document.session.transfer)
                names += (names.empty() ? "with " : ", ") + name;
            ImGui::TextDisabled("%s", names.c_str());
        }
        if (ImGui::Button("Choose...")) {
            locating_ = i;
            ImGui::CloseCurrentPopup();
            files_.show(FileMode::Open, "Where is " + fs::path(wanted.path).filename().string() + "?", "locate",
                        missing_->folder);
        }
        ImGui::PopID();
        ImGui::Spacing();
    }
    if (dialogButtons({"Cancel"}) == 0) open = false;
    endDialog(open);
    if (!open) missing_.reset();
}

void Workbench::drawRecovery() {
    if (recoveries_.empty()) return;
    bool open = true;
    if (!beginDialog("Recover the last session?", open, ImGui::GetFontSize() * 34)) return;
    ImGui::TextWrapped("Tessera did not end by itself. What was open at %s has been kept.",
                       recoveries_.front().when.c_str());
    const int button = dialogButtons({"Discard", "Later", "Recover"});
    if (button == 0) {
        Autosave::discard(recoveries_.front());
        recoveries_.erase(recoveries_.begin());
        open = !recoveries_.empty();
    } else if (button == 1 || !open) {
        recoveries_.clear();
        open = false;
    } else if (button == 2) {
        const Recovery recovery = recoveries_.front();
        recoveries_.clear();
        open = false;
        jobs_.start("open", "Recovering", [this, recovery](const Progress& progress) -> Jobs::Finish {
            OpenRequest request;
            request.paths = {recovery.path};
            auto opened = std::make_shared<Opened>(app::open(request, progress));
            return [this, opened, recovery] {
                opened->sessionPath.clear();    // the kept file is no place to save to
                if (!opened->missing.empty()) { // kept until its data are found
                    missing_ = std::move(*opened);
                    return;
                }
                install(std::move(*opened));
                saved_ = Session{}; // it has never been saved
                unsavedEdits_ = true;
                lastAutosave_ = -1e9; // kept again at once
                Autosave::discard(recovery);
            };
        });
    }
    endDialog(open);
}

void Workbench::drawExport() {
    if (!askPicture_) return;
    if (!beginDialog("Save picture", askPicture_, ImGui::GetFontSize() * 30)) return;
    const WidgetContext widgets{source_ ? &source_->info() : nullptr, 0.3f};
    drawLabel(widgets, "What", "The window, or one view alone");
    if (ImGui::BeginCombo("##what",
                          picture_.pane.empty() ? "The whole window" : paneTitle(session_, picture_.pane).c_str())) {
        if (ImGui::Selectable("The whole window", picture_.pane.empty())) picture_.pane.clear();
        for (const std::string& pane : paneKeys(session_))
            if (ImGui::Selectable(paneTitle(session_, pane).c_str(), pane == picture_.pane)) picture_.pane = pane;
        ImGui::EndCombo();
    }
    drawLabel(widgets, "Size", "Pixels of the picture");
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
    drawLabel(widgets, "Text size", "Pixels per design pixel: 2 for print at twice the size");
    ImGui::SliderFloat("##scale", &picture_.scale, 0.5f, 4.0f, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    ImGui::Spacing();
    ImGui::TextDisabled("The picture carries the session: open it here to go on.");
    const int button = dialogButtons({"Cancel", "Save..."});
    if (button == 0) askPicture_ = false;
    if (button == 1) {
        askPicture_ = false;
        const std::string name = picture_.pane.empty() ? "tessera" : picture_.pane;
        files_.show(FileMode::Save, "Save picture", "picture", files_.folder(), name + ".png", ".png");
    }
    endDialog(askPicture_);
}

void Workbench::drawLeaving() {
    if (!leaving_) return;
    bool open = true;
    if (!beginDialog("Save the session?", open, ImGui::GetFontSize() * 28)) {
        if (!open) leaving_ = nullptr;
        return;
    }
    ImGui::TextWrapped("The session has changed since it was %s.", sessionPath_.empty() ? "opened" : "saved");
    const int button = dialogButtons({"Discard", "Cancel", "Save"});
    if (button >= 0) open = false;
    if (button == 2) {
        afterSave_ = std::exchange(leaving_, nullptr);
        if (!sessionPath_.empty())
            save(sessionPath_);
        else
            files_.show(FileMode::Save, "Save session", "save", files_.folder(), "session.tessera.json",
                        ".tessera.json");
    }
    endDialog(open);
    if (open) return;
    if (const auto go = std::exchange(leaving_, nullptr); button == 0 && go) go();
}

void Workbench::drawHelp() {
    if (askHelp_ && beginDialog("Shortcuts", askHelp_, ImGui::GetFontSize() * 48)) {
        ImGui::TextWrapped(
            "In a volume: left drag turns, wheel and right drag zoom, middle drag or Shift+drag moves, "
            "Ctrl+drag rolls, double-click sets the cursor. In plots: drag to select (brush); Shift adds, "
            "Ctrl removes; Esc clears.");
        ImGui::Spacing();
        drawShortcutHelp(commands_);
        if (dialogButtons({"Close"}) == 0) askHelp_ = false;
        endDialog(askHelp_);
    }
    if (askAbout_ && beginDialog("About Tessera", askAbout_, ImGui::GetFontSize() * 30)) {
        ImGui::PushFont(fonts_.bold);
        ImGui::TextUnformatted("Tessera " TESSERA_VERSION);
        ImGui::PopFont();
        ImGui::TextWrapped("A workbench for simulations with many values per point.");
        const vis::ResidencyInfo use = renderer_->residency();
        ImGui::Spacing();
        ImGui::TextDisabled(
            "Brick textures %s of %s, decoded bricks %s of %s", textOfBytes(double(use.textureBytes)).c_str(),
            textOfBytes(double(use.textureBudget)).c_str(), textOfBytes(double(use.memoryBytes)).c_str(),
            textOfBytes(double(use.memoryBudget)).c_str());
        if (dialogButtons({"Close"}) == 0) askAbout_ = false;
        endDialog(askAbout_);
    }
}

} // namespace tessera::app
