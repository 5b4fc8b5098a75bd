#include "app/dialogs/dialogs.h"

#include "app/dialogs/file_dialog.h"
#include "app/dialogs/modal.h"
#include "app/drawing/panels.h"
#include "app/pane/pane_title.h"
#include "app/ui/fitted_text.h"
#include "app/ui/number_field.h"
#include "app/ui/parameter_widget.h"
#include "codec/container/json_text.h"
#include "volume/base/byte_text.h"
#include "volume/base/error.h"

#include <algorithm>
#include <filesystem>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

/// A part of a dialog that scrolls where the dialog, with `below` pixels under that part, is higher than the window.
class Scrolled {
public:
    explicit Scrolled(float below) : id_(ImGui::GetID("height")) {
        const ImGuiStyle& style = ImGui::GetStyle();
        const float room = ImGui::GetMainViewport()->Size.y - 2 * style.DisplaySafeAreaPadding.y -
                           ImGui::GetCursorPosY() - below - style.WindowPadding.y;
        child_ = ImGui::GetStateStorage()->GetFloat(id_) > room; // as high as in the last frame
        if (child_) {                                            // Tab goes through it and on to what is below
            ImGui::BeginChild("scrolled", {0, std::max(room, ImGui::GetFrameHeight())}, false,
                              ImGuiWindowFlags_NavFlattened);
            if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
        }
        from_ = ImGui::GetCursorPosY();
    }
    Scrolled(const Scrolled&) = delete;
    Scrolled& operator=(const Scrolled&) = delete;
    ~Scrolled() {
        const float height = ImGui::GetCursorPosY() - from_ - ImGui::GetStyle().ItemSpacing.y;
        if (child_) ImGui::EndChild();
        ImGui::GetStateStorage()->SetFloat(id_, height);
    }

private:
    ImGuiID id_;
    bool child_;
    float from_;
};

} // namespace

std::optional<Opened> MissingFilesDialog::draw(const Ask& ask) {
    if (!opened_) return {};
    const char* const title = "Data not found";
    if (opened_->missing.empty() && !ImGui::IsPopupOpen(title)) return std::exchange(opened_, {});
    bool open = true;
    if (!beginDialog(title, open, ImGui::GetFontSize() * 40)) {
        if (!open) opened_.reset();
        return {};
    }
    if (opened_->missing.empty()) { // the last one was dropped on the dialog
        endDialog(false);
        return std::exchange(opened_, {});
    }
    ImGui::TextWrapped(
        "Files of the session have moved: choose them, or drop them here. What is open now stays open until "
        "they are found.");
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
    fittedText(fs::path(wanted.path).filename().string());
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    fittedText((wanted.bytes > 0 ? textOfBytes(wanted.bytes) : "size unknown") + ", previously at " +
               (wanted.absolutePath.empty() ? wanted.path : wanted.absolutePath));
    ImGui::PopStyleColor();
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

bool MissingFilesDialog::found(const std::vector<std::string>& paths) {
    if (!opened_) return false;
    const auto nameOf = [](const std::string& path) { return fs::path(path).filename(); };
    const std::size_t before = opened_->missing.size();
    if (before == 1 && paths.size() == 1) {
        found(0, paths.front());
        return true;
    }
    for (const std::string& path : paths)
        for (std::size_t i = 0; i < opened_->missing.size(); ++i)
            if (nameOf(opened_->missing[i].wanted.path) == nameOf(path)) {
                found(i, path);
                break;
            }
    return opened_->missing.size() < before;
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
    pane_ = pane;
    several_ = false;
    shown_ = true;
}

namespace {

constexpr const char* kFormChoice = "picture";

/// What was chosen last, as far as it can still be read.
PictureForm rememberedForm(const std::string& stateFolder) {
    PictureForm form;
    const Json known = Json::parse(rememberedChoice(stateFolder, kFormChoice), nullptr, false);
    std::vector<JsonIssue> ignored;
    if (known.is_object()) fromJson(form, known, ignored);
    return form;
}

} // namespace

std::vector<std::string> panesForPictures(const Session& session) {
    std::vector<std::string> panes = paneKeys(session);
    std::ranges::stable_partition(panes, [&](const std::string& pane) {
        const ViewTraits& traits = traitsOf(session.views.at(pane));
        return traits.inSpace || traits.figure;
    });
    return panes;
}

PictureRequest PictureDialog::request() const {
    PictureRequest wanted = pictureRequest(*form_, several_ ? "" : pane_);
    if (!several_) return wanted;
    if (panels_.empty()) throw Error("Choose the views of the figure");
    wanted.panels = panels_;
    wanted.columns = columns_;
    const int count = int(panels_.size());
    (void)panelPlaces(wanted.size, count, columns_ > 0 ? columns_ : usualColumns(count), textPixels(wanted.scale));
    return wanted;
}

void PictureDialog::drawWhat(const Session& session, const volume::DatasetInfo& info) {
    drawLabel(WidgetContext{nullptr, 0.3f}, "What", "The window, one view, or several as panels a, b, c of a figure");
    const char* const whole = "The whole window";
    const char* const several = "Several views";
    if (ImGui::BeginCombo("##what", several_        ? several
                                    : pane_.empty() ? whole
                                                    : shownTitle(session, pane_, info).c_str())) {
        const auto choose = [&](bool panels, const std::string& pane) {
            several_ = panels;
            pane_ = pane;
        };
        if (ImGui::Selectable(whole, !several_ && pane_.empty())) choose(false, "");
        if (ImGui::Selectable(several, several_)) choose(true, pane_);
        ImGui::Separator();
        for (const std::string& pane : panesForPictures(session))
            if (ImGui::Selectable(shownTitle(session, pane, info).c_str(), !several_ && pane == pane_))
                choose(false, pane);
        ImGui::EndCombo();
    }
    std::erase_if(panels_, [&](const std::string& pane) { return !session.views.contains(pane); });
    if (several_) drawPanels(session, info);
}

void PictureDialog::drawPanels(const Session& session, const volume::DatasetInfo& info) {
    const WidgetContext widgets{nullptr, 0.3f};
    drawLabel(widgets, "Panels", "In the order in which they are chosen");
    if (ImGui::BeginChild("panels", {0, ImGui::GetFrameHeightWithSpacing() * 5}, true))
        for (const std::string& pane : panesForPictures(session)) {
            const auto at = std::find(panels_.begin(), panels_.end(), pane);
            bool chosen = at != panels_.end();
            const std::string letter = chosen ? panelLetter(int(at - panels_.begin())) + "   " : "";
            if (!ImGui::Checkbox((letter + shownTitle(session, pane, info) + "##" + pane).c_str(), &chosen)) continue;
            if (chosen)
                panels_.push_back(pane);
            else
                panels_.erase(at);
        }
    ImGui::EndChild();
    drawLabel(widgets, "Columns", "Panels side by side; 0: as many as suit");
    slider("##columns", columns_, 0, std::max(2, int(panels_.size())), columns_ == 0 ? "as many as suit" : "%d");
}

std::optional<PictureRequest> PictureDialog::drawForm(Session& session) {
    const WidgetContext widgets{nullptr, 0.3f};
    PictureForm& form = *form_;
    ImGui::PushID("size");
    drawPresets(widgets, form.size);
    drawDescribed(form.size, widgets);
    ImGui::PopID();
    std::optional<PictureRequest> request;
    std::string problem;
    try {
        request = this->request();
    } catch (const Error& error) {
        problem = error.what();
    }
    drawLabel(widgets, "", "");
    if (request)
        ImGui::TextDisabled("%d x %d pixels", request->size.x, request->size.y);
    else
        ImGui::TextWrapped("%s", problem.c_str());
    const auto row = [&](Value member, const FieldInfo& field) {
        std::optional<Range> scale;
        std::string unit;
        bool changed = false;
        MemberToWidget{widgets, changed, scale, unit}(member, field);
    };
    valueOf(form).visitMembers([&](Value member, const FieldInfo& field) {
        if (field.key == "decoration")
            valueOf(session.appearance).visitMembers([&](Value part, const FieldInfo& of) {
                if (of.key == "legends") row(part, of);
            });
        if (field.key != "size") row(member, field);
    });
    valueOf(session.figure).visitMembers(row);
    return request;
}

std::optional<PictureRequest> PictureDialog::draw(Session& session, const volume::DatasetInfo& info,
                                                  const std::string& stateFolder) {
    if (!shown_ || !beginDialog("Save picture", shown_, ImGui::GetFontSize() * 30)) return {};
    if (!form_) form_ = rememberedForm(stateFolder);
    const bool vectors = form_->format != PictureFormat::Png;
    std::optional<PictureRequest> request;
    {
        // Two gaps, the lines of text, a gap and the buttons.
        const Scrolled settings(3 * ImGui::GetStyle().ItemSpacing.y + ImGui::GetFrameHeight() +
                                (vectors ? 2 : 1) * ImGui::GetTextLineHeightWithSpacing());
        drawWhat(session, info);
        request = drawForm(session);
    }
    ImGui::Spacing();
    if (vectors) ImGui::TextDisabled("Texts and lines are vectors.");
    ImGui::TextDisabled("The picture contains the session: open it in Tessera to continue from it.");
    const int button = dialogButtons({"Cancel", "Save..."});
    const bool save = button == 1 && request;
    if (button == 0 || save) shown_ = false;
    if (save) rememberChoice(stateFolder, kFormChoice, jsonText(toJson(*form_)));
    endDialog(shown_);
    return save ? request : std::nullopt;
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

std::function<void()> QuestionDialog::draw() {
    if (!go_) return nullptr;
    bool open = true;
    if (beginDialog("Sure?", open, ImGui::GetFontSize() * 24)) {
        ImGui::TextWrapped("%s", text_.c_str());
        const int button = dialogButtons({"Cancel", yes_.c_str()});
        if (button >= 0) open = false;
        endDialog(open);
        if (button == 1) return std::exchange(go_, nullptr);
    }
    if (!open) go_ = nullptr;
    return nullptr;
}

void HelpDialogs::draw(const std::vector<Command>& commands, const Fonts& fonts, const vis::ResidencyInfo& use) {
    if (shortcuts_ && beginDialog("Shortcuts", shortcuts_, ImGui::GetFontSize() * 48)) {
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        ImGui::SetNextItemWidth(-FLT_MIN);
        ImGui::InputTextWithHint("##search", "Search", &search_);
        ImGui::Spacing();
        const std::vector<KeyHelp> rows = keyHelp(commands, search_);
        drawKeyHelp(rows);
        if (rows.empty()) ImGui::TextDisabled("Nothing found");
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
