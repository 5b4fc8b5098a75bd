#include "app/dialogs/file_dialog.h"

#include "app/ui/fitted_text.h"
#include "app/ui/keys.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"
#include "codec/remote/address.h"
#include "volume/base/byte_text.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <imgui.h>
#include <imgui_internal.h> // ClearActiveID
#include <imgui_stdlib.h>
#include <sys/stat.h>
#include <utility>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRefused = "This file cannot be opened; the preview shows the reason.";

} // namespace

void FileDialog::show(FileMode mode, std::string title, std::string purpose, std::string folder, std::string name,
                      std::string suffix) {
    mode_ = mode;
    title_ = std::move(title);
    purpose_ = std::move(purpose);
    name_ = std::move(name);
    suffix_ = std::move(suffix);
    filter_.clear();
    opening_ = shown_ = selectStem_ = true;
    confirm_ = deciding_ = focusName_ = false;
    noticed_.clear();
    if (mode_ == FileMode::Open && filesChosen) filesChosen({});
    std::error_code problem;
    enter(folder.empty() || !fs::is_directory(folder, problem) ? fs::current_path(problem).string() : folder);
}

void FileDialog::choose(const std::vector<std::string>& paths) {
    if (paths.empty()) return;
    ImGui::ClearActiveID(); // a field that has the keyboard keeps its own text
    enter(fs::path(paths.front()).parent_path().string());
    for (const std::string& path : paths) chosen_.push_back(fs::path(path).filename().string());
    name_ = chosen_.front();
    filter_.clear();
    problem_.clear();
    confirm_ = deciding_ = false;
}

void FileDialog::enter(const std::string& folder) {
    std::error_code problem;
    const std::string absolute = fs::weakly_canonical(folder, problem).string();
    std::vector<Entry> entries;
    problem_.clear();
    for (fs::directory_iterator it(absolute, problem), end; !problem && it != end; it.increment(problem)) {
        Entry entry;
        entry.name = it->path().filename().string();
        if (entry.name.starts_with(".")) continue;
        struct stat status {};
        if (::stat(it->path().c_str(), &status) != 0) continue;
        entry.folder = S_ISDIR(status.st_mode);
        entry.bytes = static_cast<double>(status.st_size);
        entry.time = status.st_mtime;
        entries.push_back(std::move(entry));
    }
    if (problem) {
        problem_ = absolute + ": " + problem.message();
        if (!entries_.empty() || !folder_.empty()) return;
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.folder != b.folder ? a.folder : a.name < b.name; });
    folder_ = absolute;
    entries_ = std::move(entries);
    chosen_.clear();
}

/// The files that would be opened now: those chosen in the list, else the one whose name was typed.
std::vector<std::string> FileDialog::filesNamed() const {
    std::vector<std::string> paths;
    for (const std::string& name : chosen_) paths.push_back((fs::path(folder_) / name).string());
    if (paths.empty() && codec::isRemote(name_)) return {name_};
    std::error_code problem;
    if (const fs::path typed = fs::path(folder_) / name_;
        paths.empty() && !name_.empty() && fs::exists(typed, problem) && !fs::is_directory(typed, problem))
        paths = {typed.string()};
    return paths;
}

void FileDialog::noticeChoice() {
    if (mode_ != FileMode::Open) return;
    std::vector<std::string> paths = filesNamed();
    // Another machine is not asked for each letter of an address.
    if (paths.empty() || paths == noticed_ || codec::isRemote(paths.front())) return;
    noticed_ = std::move(paths);
    problem_.clear();
    deciding_ = false;
    if (filesChosen) filesChosen(noticed_);
}

/// Of the name without the ending that is added anyway, or without its last one.
std::size_t FileDialog::stemLength() const {
    if (!suffix_.empty() && name_.ends_with(suffix_)) return name_.size() - suffix_.size();
    const std::size_t dot = name_.rfind('.');
    return dot == std::string::npos || dot == 0 ? name_.size() : dot;
}

void FileDialog::answerWith(std::optional<Answer>& answer) {
    Answer result{purpose_, {}};
    problem_.clear();
    if (mode_ == FileMode::Save) {
        std::string name = name_;
        if (name.empty()) return;
        if (!suffix_.empty() && !name.ends_with(suffix_)) name += suffix_;
        const std::string path = name.starts_with("/") ? name : (fs::path(folder_) / name).string();
        std::error_code problem;
        if (fs::exists(path, problem) && !confirm_) {
            confirm_ = true;
            return;
        }
        result.paths = {path};
    } else {
        if (chosen_.empty() && !name_.empty() && !codec::isRemote(name_)) {
            const fs::path typed = fs::path(folder_) / name_; // which is name_ alone if it is absolute
            std::error_code problem;
            if (fs::is_directory(typed, problem)) {
                name_.clear();
                enter(typed.string());
                return;
            }
            if (!fs::exists(typed, problem)) {
                problem_ = name_ + ": no such file";
                return;
            }
        }
        noticeChoice();
        result.paths = filesNamed();
        if (result.paths.empty()) return;
        // Preview several files together: one alone may not show what they are.
        if (preview && result.paths.size() == 1 && !codec::isRemote(result.paths.front())) {
            const FilePreview seen = preview(result.paths.front());
            deciding_ = seen.text.empty() && !seen.failed;
            if (seen.failed) problem_ = kRefused;
            if (deciding_ || seen.failed) return;
        }
    }
    answer = std::move(result);
    shown_ = false;
    ImGui::CloseCurrentPopup();
}

void FileDialog::drawList(std::optional<Answer>& answer, float height) {
    constexpr ImGuiTableFlags flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH;
    if (!beginScrolledTable("##files", 3, flags, {0, height})) return;
    const float em = ImGui::GetFontSize();
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("Name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("Size", ImGuiTableColumnFlags_WidthFixed, em * 5);
    ImGui::TableSetupColumn("Changed", ImGuiTableColumnFlags_WidthFixed, em * 8);
    ImGui::TableHeadersRow();
    std::string into;
    bool decided = false;
    for (const Entry& entry : entries_) {
        if (!filter_.empty() && entry.name.find(filter_) == std::string::npos) continue;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const bool selected = std::find(chosen_.begin(), chosen_.end(), entry.name) != chosen_.end();
        const std::string whole = std::string(entry.folder ? icon::kFolder : icon::kFile) + "  " + entry.name;
        const std::string fitted = fitText(whole, ImGui::GetContentRegionAvail().x),
                          label = fitted + "###" + entry.name;
        if (ImGui::Selectable(label.c_str(), selected,
                              ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick |
                                  ImGuiSelectableFlags_DontClosePopups)) {
            const bool twice = ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
            if (entry.folder) {
                if (twice || pressed({.key = key::kEnter})) into = (fs::path(folder_) / entry.name).string();
            } else if (ImGui::GetIO().KeyCtrl && mode_ == FileMode::Open) {
                if (selected)
                    std::erase(chosen_, entry.name);
                else
                    chosen_.push_back(entry.name);
            } else {
                chosen_ = {entry.name};
                name_ = entry.name;
                confirm_ = false;
                decided = twice;
            }
        }
        if (fitted != whole && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", entry.name.c_str());
        ImGui::TableNextColumn();
        if (!entry.folder) ImGui::TextDisabled("%s", textOfBytes(entry.bytes).c_str());
        ImGui::TableNextColumn();
        char text[32] = "";
        std::tm local{};
        const std::time_t time = static_cast<std::time_t>(entry.time);
        if (localtime_r(&time, &local)) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local);
        ImGui::TextDisabled("%s", text);
    }
    ImGui::EndTable();
    if (!into.empty()) enter(into);
    if (decided) answerWith(answer);
}

void FileDialog::drawPreview(float height) {
    ImGui::BeginChild("##preview", {0, height}, true);
    ImGui::PushTextWrapPos(0);
    if (const std::vector<std::string> paths = filesNamed(); paths.empty()) {
        ImGui::TextDisabled("Choose a file to see its contents.");
        ImGui::TextDisabled("Ctrl+click for several.");
    } else if (codec::isRemote(paths.front())) {
        ImGui::TextDisabled("An archive on another machine, which is asked when you open it.");
    } else if (const FilePreview seen = preview(paths.back()); seen.text.empty()) {
        ImGui::TextDisabled("Reading the header...");
    } else {
        if (seen.failed) ImGui::PushStyleColor(ImGuiCol_Text, palette().failure);
        ImGui::TextUnformatted(wrappedAtSpaces(seen.text, ImGui::GetContentRegionAvail().x).c_str());
        if (seen.failed) ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    ImGui::EndChild();
}

/// The field of the name with the buttons, and below it the problem with the name.
void FileDialog::drawName(std::optional<Answer>& answer, bool& open) {
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(-em * 13);
    if (ImGui::IsWindowAppearing() || std::exchange(focusName_, false)) ImGui::SetKeyboardFocusHere();
    // Else ImGui would keep the cursor and the selection from when the field was last shown.
    const auto selectStem = [](ImGuiInputTextCallbackData* data) {
        FileDialog& dialog = *static_cast<FileDialog*>(data->UserData);
        if (!std::exchange(dialog.selectStem_, false)) return 0;
        data->SelectionStart = 0;
        data->SelectionEnd = data->CursorPos =
            static_cast<int>(std::min(dialog.stemLength(), std::size_t(data->BufTextLen)));
        return 0;
    };
    const bool enterKey = ImGui::InputTextWithHint(
        "##name", mode_ == FileMode::Save ? "File name" : "File or folder", &name_,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackAlways, selectStem, this);
    if (ImGui::IsItemEdited()) {
        chosen_.clear();
        problem_.clear();
        confirm_ = deciding_ = false;
        noticeChoice();
    }
    bool refused = false;
    if (mode_ == FileMode::Open && preview)
        if (const std::vector<std::string> paths = filesNamed(); paths.size() == 1 && !codec::isRemote(paths.front()))
            refused = preview(paths.front()).failed;
    if (!refused && problem_ == kRefused) problem_.clear(); // the options entered meanwhile have fixed it
    ImGui::SameLine();
    const char* verb = confirm_ ? "Replace" : mode_ == FileMode::Save ? "Save" : "Open";
    ImGui::BeginDisabled(refused);
    const bool button = ImGui::Button(verb, {em * 6, 0});
    ImGui::EndDisabled();
    // After a click in the list Enter opens what is chosen; while the keyboard walks about it presses what is framed.
    const bool enterChosen = mode_ == FileMode::Open && !chosen_.empty() && !refused && !typing() &&
                             !ImGui::GetIO().NavVisible && pressed({.key = key::kEnter});
    if (button || enterKey || enterChosen || deciding_) {
        answerWith(answer);
        focusName_ = shown_ && !confirm_; // a held Enter must not confirm replacing a file
    }
    ImGui::SameLine();
    if (ImGui::Button("Cancel", {-FLT_MIN, 0}) || escapePressed()) open = false;
    const std::string told = confirm_ ? name_ + " exists. Press again to replace it." : problem_;
    ImGui::PushStyleColor(ImGuiCol_Text, confirm_ ? palette().warning : palette().failure);
    ImGui::TextUnformatted(told.c_str());
    ImGui::PopStyleColor();
}

std::optional<FileDialog::Answer> FileDialog::draw() {
    if (!shown_) return {};
    const std::string id = title_ + "###files";
    if (opening_) {
        ImGui::OpenPopup(id.c_str());
        opening_ = false;
    }
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    const float em = ImGui::GetFontSize();
    ImGui::SetNextWindowPos(viewport.GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(viewport.Size.x * 0.9f, em * 58), std::min(viewport.Size.y * 0.85f, em * 38)},
                             ImGuiCond_Appearing);
    std::optional<Answer> answer;
    bool open = true;
    if (!ImGui::BeginPopupModal(id.c_str(), &open, ImGuiWindowFlags_NoSavedSettings)) {
        shown_ = false;
        return {};
    }
    // The folders of the path as buttons.
    std::string into;
    fs::path walked;
    int part = 0;
    for (const fs::path& piece : fs::path(folder_)) {
        walked /= piece;
        if (part > 0) ImGui::SameLine(0, 2);
        ImGui::PushID(part++);
        if (ImGui::SmallButton(piece.c_str())) into = walked.string();
        ImGui::PopID();
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputTextWithHint("##filter", "Filter", &filter_);
    if (!into.empty()) enter(into);

    const float footer = ImGui::GetFrameHeightWithSpacing() * (options && mode_ == FileMode::Open ? 4.7f : 1.3f) +
                         ImGui::GetTextLineHeightWithSpacing();
    const bool previews = mode_ == FileMode::Open && preview;
    const float height = std::max(ImGui::GetContentRegionAvail().y - footer, em * 6);
    if (previews) {
        ImGui::Columns(2, "##parts", false);
        ImGui::SetColumnWidth(0, ImGui::GetWindowContentRegionMax().x * 0.62f);
    }
    drawList(answer, height);
    noticeChoice();
    if (previews) {
        ImGui::NextColumn();
        drawPreview(height);
        ImGui::Columns(1);
    }
    if (options && mode_ == FileMode::Open) options();

    drawName(answer, open);
    if (!open) {
        shown_ = false;
        ImGui::CloseCurrentPopup();
    }
    keepInView();
    ImGui::EndPopup();
    return answer;
}

void keepInView() {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const auto kept = [](float place, float own, float lo, float all) {
        return std::max(lo, std::min(place, lo + all - own));
    };
    const ImVec2 to{kept(at.x, size.x, viewport.Pos.x, viewport.Size.x),
                    kept(at.y, size.y, viewport.Pos.y, viewport.Size.y)};
    if (to.x != at.x || to.y != at.y) ImGui::SetWindowPos(to);
}

} // namespace tessera::app
