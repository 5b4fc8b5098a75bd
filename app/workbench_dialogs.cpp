#include "app/workbench.h"

#include "app/ui/widgets.h"
#include "volume/error.h"
#include "volume/import/import.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <sstream>

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
    if (chosen < 0 && pressed({.key = key::kEnter}) && !ImGui::IsAnyItemActive())
        chosen = static_cast<int>(names.size()) - 1;
    return chosen;
}

std::string describe(const volume::ImportPreview& preview) {
    std::ostringstream text;
    const volume::DatasetInfo& info = preview.info;
    const glm::dvec3 size = info.bounds.size();
    text << preview.format << "\n"
         << info.lattice.size.x << " x " << info.lattice.size.y << " x " << info.lattice.size.z << " samples, "
         << textOfBytes(preview.bytes) << "\n"
         << size.x << " x " << size.y << " x " << size.z << " " << info.lengthUnit << "\n";
    if (info.times.size() > 1)
        text << info.times.size() << " times, " << info.times.front() << " to " << info.times.back() << " "
             << info.timeUnit << "\n";
    text << "\n";
    for (const volume::Parameter& parameter : info.parameters) {
        text << parameter.name;
        if (parameter.components > 1) text << " (vector)";
        if (!parameter.unit.empty()) text << " [" << parameter.unit << "]";
        text << "  " << volume::name(parameter.type) << "\n";
    }
    if (!preview.notes.empty()) text << "\n";
    for (const std::string& note : preview.notes) text << note << "\n";
    return text.str();
}

} // namespace

std::string Workbench::previewOf(const std::string& path) {
    const auto known = previews_.find(path);
    if (known != previews_.end()) return known->second;
    if (jobs_.running("preview:" + path)) return {};
    const volume::ImportOptions import = import_;
    jobs_.start(
        "preview:" + path, "",
        [this, path, import](const Progress& progress) -> Jobs::Finish {
            std::string text;
            try {
                const std::string name = fs::path(path).filename().string();
                if (name.ends_with(".png")) {
                    sessionTextOfPicture(path);
                    text = "A picture that carries its session.";
                } else if (name.ends_with(".json") && looksLikeSession(readText(path))) {
                    const SessionDocument document = loadSession(path);
                    text = "Session: " + document.session.title + "\n\n";
                    text += document.session.data.files.empty() ? "Built-in data: " + document.session.data.model : "";
                    for (const DataFile& file : document.session.data.files)
                        text += file.path + ", " + textOfBytes(file.bytes) + "\n";
                    text += "\n" + std::to_string(document.session.views.size()) + " views, " +
                            std::to_string(document.session.layers.size()) + " layers, " +
                            std::to_string(document.session.selection.brushes.size()) + " brushes, " +
                            std::to_string(document.history.steps().size()) + " steps of history";
                } else if (name.ends_with(".tsr")) {
                    std::vector<std::string> messages;
                    DataRef data;
                    data.files = {describeFile(path)};
                    const auto source = openSource(data, messages, progress);
                    text = describe({"Tessera archive", source->info(), data.files[0].bytes, {}});
                } else {
                    text = describe(volume::previewFiles({path}, import, progress));
                }
            } catch (const Error& error) {
                text = error.reason();
            }
            return [this, path, text] { previews_[path] = text; };
        },
        true);
    return {};
}

void Workbench::drawImportOptions() {
    const float em = ImGui::GetFontSize();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Raw layout");
    ImGui::SameLine(em * 7);
    ImGui::SetNextItemWidth(em * 22);
    bool changed = ImGui::InputTextWithHint("##raw", "dims=64x64x64,type=u8 (only for files without a header)",
                                            &import_.raw, ImGuiInputTextFlags_EnterReturnsTrue);
    changed |= ImGui::IsItemDeactivatedAfterEdit();
    ImGui::SameLine(em * 31);
    ImGui::TextDisabled("Absent");
    ImGui::SameLine(em * 35);
    ImGui::SetNextItemWidth(-FLT_MIN);
    changed |= ImGui::InputTextWithHint("##absent", "O2=region:0,3  T=nan", &importAbsent_,
                                        ImGuiInputTextFlags_EnterReturnsTrue);
    changed |= ImGui::IsItemDeactivatedAfterEdit();
    const auto pairs = [&](const char* title, float at, float width, const char* hint, std::string& text) {
        if (at > 0) ImGui::SameLine(em * at);
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%s", title);
        ImGui::SameLine(em * (at + (at > 0 ? 4 : 7)));
        ImGui::SetNextItemWidth(width);
        changed |= ImGui::InputTextWithHint((std::string("##") + title).c_str(), hint, &text,
                                            ImGuiInputTextFlags_EnterReturnsTrue);
        changed |= ImGui::IsItemDeactivatedAfterEdit();
    };
    pairs("Units", 0, em * 22, "O2=mol/m3  T=K (remembered)", importUnits_);
    pairs("Names", 31, -FLT_MIN, "O2.air=O2  wO2=O2", importNames_);
    ImGui::Spacing();
    if (changed) {
        std::istringstream words(importAbsent_);
        import_.absent.clear();
        for (std::string word; words >> word;) import_.absent.push_back(word);
        const auto read = [](const std::string& text, std::map<std::string, std::string>& into) {
            into.clear();
            std::istringstream list(text);
            for (std::string word; list >> word;)
                if (const std::size_t equals = word.find('='); equals != std::string::npos && equals > 0)
                    into[word.substr(0, equals)] = word.substr(equals + 1);
        };
        read(importUnits_, import_.units);
        read(importNames_, import_.rename);
        previews_.clear();
    }
}

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

void Workbench::drawToasts() {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    float y = viewport.Pos.y + viewport.Size.y - ImGui::GetFontSize() * 2.4f;
    int number = 0;
    for (auto each = messages_.rbegin(); each != messages_.rend() && number < 4; ++each) {
        if (each->gone) continue;
        if (!each->failure && now() - each->born > kToastSeconds) {
            each->gone = true;
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
        ImGui::PushTextWrapPos(width - ImGui::GetStyle().WindowPadding.x);
        if (each->failure && fonts_.icons) {
            ImGui::PushStyleColor(ImGuiCol_Text, palette().failure);
            ImGui::TextUnformatted(icon::kWarning);
            ImGui::PopStyleColor();
            ImGui::SameLine();
        }
        ImGui::TextUnformatted(each->text.c_str());
        ImGui::PopTextWrapPos();
        if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) each->gone = true;
        y -= ImGui::GetWindowSize().y + 6 * scale_;
        ImGui::End();
    }
}

} // namespace tessera::app
