#include "app/ui/file_dialog.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/workbench/workbench.h"
#include "volume/base/error.h"
#include "volume/import/files/raw.h"
#include "volume/import/import.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <sstream>

/// What the dialog for opening shows of files before they are opened, and what can be stated about them there.
namespace tessera::app {

namespace fs = std::filesystem;

namespace {

std::string describe(const volume::ImportPreview& preview) {
    std::ostringstream text;
    const volume::DatasetInfo& info = preview.info;
    const glm::dvec3 size = info.bounds.size();
    text << preview.format << "\n"
         << info.lattice.size.x << " x " << info.lattice.size.y << " x " << info.lattice.size.z << " samples, "
         << textOfBytes(preview.bytes) << "\n"
         << "extent " << size.x << " x " << size.y << " x " << size.z << " "
         << (info.lengthUnit.empty() ? "(no unit stated)" : info.lengthUnit) << "\n";
    if (info.times.size() > 1)
        text << info.times.size() << " times, " << timeText(info, info.times.front()) << " to "
             << timeValueText(info, info.times.back()) << "\n";
    for (const volume::Quantity& quantity : info.quantities)
        text << "over time: " << titleWithUnit(quantity.name, quantity.unit) << "\n";
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

/// Files that do not say themselves what is in them.
bool isHeaderless(const std::string& path) {
    const std::string ending = fs::path(path).extension().string();
    return ending == ".raw" || ending == ".bin" || ending == ".dat";
}

/// What to do about a file whose form is stated nowhere; "" for others.
std::string formMissing(const std::string& path, const volume::ImportOptions& import) {
    std::error_code unknown;
    if (fs::path(path).extension() != ".raw" || !import.raw.empty() || volume::hasSidecar(path) ||
        fs::file_size(path, unknown) == 0)
        return {};
    return "This file has no sidecar " + fs::path(path).filename().replace_extension(".json").string() +
           " that states its form.\n\nState it below in Raw layout, such as dims=64x64x64,type=u8";
}

/// The reason of a failure, with the name of its file and the fields of this dialog in place of options of the command
/// line.
std::string reasonHere(const Error& error) {
    std::string place = error.place();
    for (const auto& [option, field] :
         {std::pair<std::string, std::string>{"--raw", "Raw layout"}, {"--rename", "Names"}, {"--units", "Units"}})
        if (place.starts_with(option)) place.replace(0, option.size(), field);
    const std::string file = fs::path(error.file()).filename().string();
    if (!place.empty()) return (file.empty() ? "" : file + ": ") + place + ": " + error.reason();
    return (file.empty() ? "" : file + " ") + error.reason();
}

} // namespace

FilePreview Workbench::previewOf(const std::string& path) {
    const auto known = previews_.find(path);
    if (known != previews_.end()) return known->second;
    if (jobs_.running("preview:" + path)) return {};
    const volume::ImportOptions import = import_;
    jobs_.start(
        "preview:" + path, "",
        [this, path, import](const Progress& progress) -> Jobs::Finish {
            std::string text;
            bool failed = false;
            try {
                std::string name = fs::path(path).filename().string();
                std::transform(name.begin(), name.end(), name.begin(),
                               [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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
                    if (const std::string why = formMissing(path, import); !why.empty()) throw Error(why);
                    volume::ImportPreview preview = volume::previewFiles({path}, import, progress);
                    if (!import.raw.empty() && import.raw == volume::rawOptionOfName(path))
                        preview.notes.push_back("The raw layout is taken from the file's name.");
                    text = describe(preview);
                }
            } catch (const Error& error) {
                text = reasonHere(error);
                failed = true;
            }
            return [this, path, import, text, failed] {
                if (import == import_) previews_[path] = {text, failed}; // else it is made again
            };
        },
        true);
    return {};
}

void Workbench::filesChosen(const std::vector<std::string>& paths) {
    formStated_ = std::any_of(paths.begin(), paths.end(), volume::hasSidecar);
    // A layout is of the files it was stated for; further ones chosen with them are of the same.
    if (formStated_)
        import_.raw.clear();
    else if (paths.size() <= 1)
        import_.raw = paths.size() == 1 && isHeaderless(paths[0]) ? volume::rawOptionOfName(paths[0]) : "";
    previews_.clear();
}

void Workbench::drawImportOptions() {
    const float em = ImGui::GetFontSize();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Raw layout");
    ImGui::SameLine(em * 7);
    ImGui::SetNextItemWidth(em * 22);
    // At each letter: the preview is how the user sees whether it is right, and Open waits for that.
    ImGui::BeginDisabled(formStated_);
    bool changed = ImGui::InputTextWithHint("##raw",
                                            formStated_ ? "stated by the file's own sidecar"
                                                        : "dims=64x64x64,type=u8 (only for files without a header)",
                                            &import_.raw);
    ImGui::EndDisabled();
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

} // namespace tessera::app
