#include "app/dialogs/import_form.h"

#include "app/data/open.h"
#include "app/data/picture_session.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "codec/remote/address.h"
#include "volume/base/byte_text.h"
#include "volume/base/error.h"
#include "volume/base/trimmed.h"
#include "volume/import/files/raw.h"
#include "volume/import/import.h"
#include "volume/import/over_time.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <sstream>

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
         << (info.lengthUnit.empty() ? "(no unit of length stated)" : info.lengthUnit) << "\n";
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

/// Whether a file does not describe its own contents.
bool isHeaderless(const std::string& path) {
    const std::string ending = fs::path(path).extension().string();
    return ending == ".raw" || ending == ".bin" || ending == ".dat";
}

/// Advice for a file whose layout is not stated anywhere; "" for others.
std::string formMissing(const std::string& path, const volume::ImportOptions& import) {
    if (!lacksLayout(path, import)) return {};
    return "No sidecar " + fs::path(path).filename().replace_extension(".json").string() +
           " states the layout of this file.\n\nState it below in Raw layout, such as dims=64x64x64,type=u8";
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

std::string sessionSummary(const std::string& path) {
    const SessionDocument document = loadSession(path);
    const Session& session = document.session;
    std::string text = "Session: " + session.title + "\n\n";
    text += session.data.files.empty() ? "Built-in data: " + session.data.model : "";
    for (const DataFile& file : session.data.files) text += file.path + ", " + textOfBytes(file.bytes) + "\n";
    return text + "\n" + std::to_string(session.views.size()) + " views, " + std::to_string(session.layers.size()) +
           " layers, " + std::to_string(session.selection.brushes.size()) + " brushes, " +
           std::to_string(document.history.steps().size()) + " history steps";
}

std::string archiveSummary(const std::string& path, const Progress& progress) {
    std::vector<std::string> messages;
    DataRef data;
    data.files = {describeFile(path)};
    const auto source = openSource(data, messages, progress);
    return describe({"Tessera archive", source->info(), data.files[0].bytes, {}});
}

std::string dataSummary(const std::string& path, const volume::ImportOptions& stated, const Progress& progress) {
    if (const std::string why = formMissing(path, stated); !why.empty()) throw Error(why);
    volume::ImportPreview preview = volume::previewFiles({path}, stated, progress);
    if (!stated.raw.empty() && stated.raw == volume::rawOptionOfName(path))
        preview.notes.push_back("The raw layout was filled in from the name of the file.");
    return describe(preview);
}

/// Describes a file for the preview. Throws Error if it cannot be opened.
std::string summary(const std::string& path, const volume::ImportOptions& stated, const Progress& progress) {
    std::string name = fs::path(path).filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (opensAsPicture(path)) {
        sessionTextOfPicture(path);
        return "A picture that contains its session.";
    }
    if (name.ends_with(".json") && looksLikeSession(readText(path))) return sessionSummary(path);
    if (codec::namesArchive(path)) return archiveSummary(path, progress);
    return dataSummary(path, stated, progress);
}

/// "T=K  O2=mol/m3" as names with what is stated of them.
std::map<std::string, std::string> pairsIn(const std::string& text) {
    std::map<std::string, std::string> pairs;
    std::istringstream list(text);
    for (std::string word; list >> word;)
        if (const std::size_t equals = word.find('='); equals != std::string::npos && equals > 0)
            pairs[word.substr(0, equals)] = word.substr(equals + 1);
    return pairs;
}

} // namespace

bool lacksLayout(const std::string& path, const volume::ImportOptions& import) {
    std::error_code unknown;
    return fs::path(path).extension() == ".raw" && import.raw.empty() && !volume::hasSidecar(path) &&
           fs::file_size(path, unknown) > 0 && !unknown;
}

namespace {

/// What a table over time adds to data.
std::string tableSummary(const std::string& path) {
    const volume::TimeTable table = volume::readTimeTable(path);
    std::string text = "Quantities over " + titleWithUnit(table.timeName, table.timeUnit) + ", " +
                       std::to_string(table.times.size()) + " rows:";
    for (const volume::Quantity& column : table.columns) text += "\n  " + titleWithUnit(column.name, column.unit);
    return text + "\nOpen adds them to the data shown.";
}

/// What the dialog says of a file. Throws Cancelled.
FilePreview readPreview(const std::string& path, const volume::ImportOptions& stated, const Progress& progress) {
    try {
        if (volume::isTimeTable(path)) return {tableSummary(path), false};
    } catch (const Error&) { // then it may be a table of samples
    }
    try {
        return {summary(path, stated, progress), false};
    } catch (const Error& error) {
        return {reasonHere(error), true};
    }
}

} // namespace

FilePreview ImportForm::previewOf(const std::string& path) {
    const auto known = previews_.find(path);
    if (known != previews_.end()) return known->second;
    if (jobs_.running("preview:" + path)) return {};
    jobs_.start(
        "preview:" + path, "",
        [this, path, stated = stated_](const Progress& progress) -> Jobs::Finish {
            const FilePreview preview = readPreview(path, stated, progress);
            return [this, path, stated, preview] {
                if (stated == stated_) previews_[path] = preview; // otherwise outdated: read again
            };
        },
        true);
    return {};
}

void ImportForm::filesChosen(const std::vector<std::string>& paths) {
    sidecar_ = std::any_of(paths.begin(), paths.end(), volume::hasSidecar);
    // A layout applies to the files it was stated for, and to further ones selected with them.
    if (sidecar_)
        stated_.raw.clear();
    else if (paths.size() <= 1)
        stated_.raw = paths.size() == 1 && isHeaderless(paths[0]) ? volume::rawOptionOfName(paths[0]) : "";
    previews_.clear();
}

void ImportForm::draw() {
    const float em = ImGui::GetFontSize();
    // A unit of lengths is of one file: that of the last one is not true of the next.
    if (ImGui::IsWindowAppearing() && !lengths_.empty()) lengths_.clear(), readFields();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Raw layout");
    ImGui::SameLine(em * 7);
    ImGui::SetNextItemWidth(em * 22);
    // At each letter, since the preview shows whether it is right, and Open waits for the preview.
    ImGui::BeginDisabled(sidecar_);
    bool changed = ImGui::InputTextWithHint("##raw",
                                            sidecar_ ? "stated by the sidecar of the file"
                                                     : "dims=64x64x64,type=u8 (only for files without a header)",
                                            &stated_.raw);
    ImGui::EndDisabled();
    const auto field = [&](const char* title, float at, float label, float width, const char* hint, std::string& text) {
        if (at > 0) ImGui::SameLine(em * at);
        if (at == 0) ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%s", title);
        ImGui::SameLine(em * (at + label));
        ImGui::SetNextItemWidth(width);
        changed |= ImGui::InputTextWithHint((std::string("##") + title).c_str(), hint, &text,
                                            ImGuiInputTextFlags_EnterReturnsTrue);
        changed |= ImGui::IsItemDeactivatedAfterEdit();
    };
    field("Absent", 31, 4, -FLT_MIN, "O2=region:0,3  T=nan", absent_);
    field("Units", 0, 7, em * 22, "O2=mol/m3  T=K (remembered)", units_);
    field("Names", 31, 4, -FLT_MIN, "O2.air=O2  wO2=O2", names_);
    field("Lengths in", 0, 7, em * 22, "mm, where the file states none (remembered)", lengths_);
    ImGui::SameLine(em * 31);
    if (ImGui::Checkbox("Files elsewhere", &stated_.allowOutside)) changed = true;
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", "Let files name others that lie neither beside them nor in folders below.\n"
                                "Only for files of people you trust: they could show any file that you may read.");
    ImGui::Spacing();
    if (changed) readFields();
}

/// Takes over the typed text.
void ImportForm::readFields() {
    std::istringstream words(absent_);
    stated_.absent.clear();
    for (std::string word; words >> word;) stated_.absent.push_back(word);
    stated_.units = pairsIn(units_);
    stated_.rename = pairsIn(names_);
    stated_.lengthUnit = std::string(volume::trimmed(lengths_));
    previews_.clear();
}

} // namespace tessera::app
