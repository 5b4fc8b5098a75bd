#include "app/workbench/workbench.h"

#include "app/pane/view_parts.h"
#include "app/views/data/derived_list.h"
#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <filesystem>
#include <imgui.h>

/// The table of commands: the one place that says what the program can do, by which name and key. Those of the menus
/// View and Layout are in workbench_view_commands.cpp.
namespace tessera::app {

namespace fs = std::filesystem;

void Workbench::makeCommands() {
    addFileCommands();
    addEditCommands();
    addDifferenceCommands();
    addViewCommands();
    addLayoutCommands();
    addHelpCommands();
}

void Workbench::addFileCommands() {
    const auto loaded = [this] { return source_ != nullptr; };
    const auto add = [this](Command command) { commands_.push_back(std::move(command)); };
    add({.menu = "File",
         .name = "Open...",
         .help = "A session, an archive, a picture of ours or data files",
         .shortcut = {.key = 'O', .ctrl = true},
         .run = [this] { files_.show(FileMode::Open, "Open", "open", files_.folder()); }});
    add({.menu = "File",
         .name = "-Save session",
         .help = "Write the session to its file",
         .shortcut = {.key = 'S', .ctrl = true},
         .run =
             [this] {
                 if (!sessionPath_.empty())
                     save(sessionPath_);
                 else
                     files_.show(FileMode::Save, "Save session", "save", files_.folder(), "session.tessera.json",
                                 ".tessera.json");
             },
         .enabled = loaded});
    add({.menu = "File",
         .name = "Save session as...",
         .help = "Write the session to another file",
         .shortcut = {.key = 'S', .ctrl = true, .shift = true},
         .run =
             [this] {
                 files_.show(FileMode::Save, "Save session", "save", files_.folder(), "session.tessera.json",
                             ".tessera.json");
             },
         .enabled = loaded});
    add({.menu = "File",
         .name = "Pack into an archive...",
         .help = "Compress the data files shown into one .tsr file that opens at once, and show that",
         .run =
             [this] {
                 const std::string stem = fs::path(session_.data.files.front().absolutePath).stem().string();
                 files_.show(FileMode::Save, "Pack into an archive", "pack", files_.folder(), stem + ".tsr", ".tsr");
             },
         .enabled = [this] { return showsDataFiles(); }});
    add({.menu = "File",
         .name = "Compare with another file...",
         .help = "The parameters of another data set beside these, on the same grid, and how they differ",
         .run =
             [this] {
                 if (session_.data.other) return compareWith({});
                 files_.show(FileMode::Open, "Compare with", "compare", files_.folder());
             },
         .enabled = loaded,
         .checked = [this] { return session_.data.other.has_value(); }});
    add({.menu = "File",
         .name = "-Save picture...",
         .help = "The window or one view as PNG at any size; it carries the session",
         .shortcut = {.key = key::kF12},
         .run =
             [this] {
                 askPicture_ = true;
                 picture_.pane = currentPane();
             },
         .enabled = loaded});
    add({.menu = "File",
         .name = "Export surface...",
         .help = "The selected iso-surface layer at full resolution as PLY, STL, OBJ or VTP, by the ending",
         .run = [this] { files_.show(FileMode::Save, "Export surface", "surface", files_.folder(), "surface.ply"); },
         .enabled = [this] { return source_ && chosenSurface() >= 0; }});
    add({.menu = "File",
         .name = "Copy session",
         .help = "The session as text, for a colleague or an issue",
         .shortcut = {.key = 'C', .ctrl = true},
         .run =
             [this] {
                 const std::string folder = fs::current_path().string();
                 ImGui::SetClipboardText(printSession(document(), folder + "/clipboard").c_str());
                 message("Session copied");
             },
         .enabled = loaded});
    add({.menu = "File",
         .name = "Paste session",
         .help = "Open the session in the clipboard",
         .shortcut = {.key = 'V', .ctrl = true},
         .run = [this] {
             const char* text = ImGui::GetClipboardText();
             if (!text || !looksLikeSession(text)) return message("The clipboard holds no session");
             try {
                 auto opened = std::make_shared<Opened>();
                 opened->document = parseSession(text, "clipboard");
                 opened->folder = fs::current_path().string();
                 ResolvedData found = resolveData(opened->document.session.data, opened->folder);
                 opened->missing = found.missing;
                 opened->messages = found.warnings;
                 leave([this, opened, data = found.data] {
                     if (!opened->missing.empty()) {
                         missing_ = std::move(*opened);
                         return;
                     }
                     jobs_.start("open", "Opening the pasted session",
                                 [this, opened, data](const Progress& progress) -> Jobs::Finish {
                                     auto done = std::make_shared<Opened>(openWith(*opened, data, progress));
                                     return [this, done] { install(std::move(*done)); };
                                 });
                 });
             } catch (const Error& error) {
                 message(error.what(), true);
             }
         }});
    add({.menu = "File",
         .name = "-Quit",
         .help = "End the program",
         .shortcut = {.key = 'Q', .ctrl = true},
         .run = [this] { requestQuit(); }});
}

void Workbench::addEditCommands() {
    const auto loaded = [this] { return source_ != nullptr; };
    const auto add = [this](Command command) { commands_.push_back(std::move(command)); };
    add({.menu = "Edit",
         .name = "Undo",
         .help = "Take back the last edit",
         .shortcut = {.key = 'Z', .ctrl = true},
         .run = [this] { replace(history_.undo()); },
         .enabled = [this] { return history_.canUndo() && !history_.pending(); },
         .repeats = true});
    add({.menu = "Edit",
         .name = "Redo",
         .help = "Do it again",
         .shortcut = {.key = 'Z', .ctrl = true, .shift = true},
         .alternative = {.key = 'Y', .ctrl = true},
         .run = [this] { replace(history_.redo()); },
         .enabled = [this] { return history_.canRedo() && !history_.pending(); },
         .repeats = true});
    add({.menu = "Edit",
         .name = "-Clear brushes",
         .help = "Nothing is selected: everything is in focus",
         .shortcut = {.key = key::kEscape},
         .run = [this] { session_.selection.brushes.clear(); },
         // While something is dragged Esc takes back that alone.
         .enabled = [this] { return !session_.selection.brushes.empty() && !ImGui::IsAnyItemActive(); }});
    add({.menu = "Edit",
         .name = "Invert brushes",
         .help = "Focus what is outside of every brush",
         .run =
             [this] {
                 for (vis::Brush& brush : session_.selection.brushes) brush.inverted = !brush.inverted;
             },
         .enabled = [this] { return !session_.selection.brushes.empty(); }});
    add({.menu = "Edit",
         .name = "-Previous time",
         .help = "One stored time back",
         .shortcut = {.key = key::kLeft},
         .run = [this] { step(-1); },
         .enabled = loaded,
         .repeats = true});
    add({.menu = "Edit",
         .name = "Next time",
         .help = "One stored time on",
         .shortcut = {.key = key::kRight},
         .run = [this] { step(1); },
         .enabled = loaded,
         .repeats = true});
    add({.menu = "Edit",
         .name = "Play",
         .help = "Play or pause",
         .shortcut = {.key = key::kSpace},
         .run = [this] { session_.animation.playing = !session_.animation.playing; },
         .enabled = [this] { return source_ && source_->info().times.size() > 1; },
         .checked = [this] { return session_.animation.playing; }});
    for (const auto lattice : {PictureLattice::Grid, PictureLattice::BodyCentred})
        add({.menu = "Edit",
             .name = lattice == PictureLattice::Grid ? "-Draw on the grid of the file"
                                                     : "Draw on the body-centred lattice (70.7 % of the samples)",
             .help = "What pictures are drawn from; numbers come from the samples of the file on either",
             .run = [this, lattice] { session_.data.lattice = lattice; },
             .enabled =
                 [this] {
                     return source_ && !session_.data.packed && (session_.data.files.empty() || showsDataFiles());
                 },
             .checked = [this, lattice] { return session_.data.lattice == lattice; }});
    for (const auto axis : {volume::SpaceAxis::X, volume::SpaceAxis::Y, volume::SpaceAxis::Z}) {
        const auto shown = [this, axis] { return session_.data.timeAxis && session_.data.timeAxis->axis == axis; };
        add({.menu = "Edit",
             .name = "Time along " + std::string(volume::kSpaceAxisNames[std::size_t(axis)]),
             .help =
                 "The plane through the cross-hair at all times, time in place of the axis; the data in space beside",
             .run =
                 [this, axis, shown] {
                     DataRef data = session_.data;
                     data.timeAxis.reset();
                     const volume::Box& box = source_->info().bounds;
                     const int a = static_cast<int>(axis);
                     if (!shown()) data.timeAxis = {axis, (session_.cursor[a] - box.lo[a]) / box.size()[a]};
                     showSpaceBeside(data.timeAxis.has_value());
                     showAs(data, "Times as an axis");
                 },
             .enabled =
                 [this, axis, shown] {
                     return source_ && (shown() || (!session_.data.timeAxis && source_->info().times.size() > 1 &&
                                                    source_->info().bounds.size()[static_cast<int>(axis)] > 0));
                 },
             .checked = shown});
    }
}

/// Of the parameter shown first, as new parameters; the list of derived ones offers further times.
void Workbench::addDifferenceCommands() {
    const auto add = [this](const char* name, const char* help, volume::OtherTime which) {
        commands_.push_back(
            {.menu = "",
             .name = name,
             .help = help,
             .run =
                 [this, which] {
                     const volume::DatasetInfo& info = source_->info();
                     const auto channel = resolveChannel(info, session_, "");
                     if (!channel) return;
                     const std::string of = info.channel(*channel).name;
                     message("New parameter: " + addDerived(session_, newDifference(info, of, {which, session_.time})));
                 },
             .enabled = [this] { return source_ && source_->info().times.size() > 1; }});
    };
    add("Minus another time: first", "How the parameter shown differs from what it is at the first time",
        volume::OtherTime::First);
    add("Minus another time: previous", "How the parameter shown differs from what it is at the time before",
        volume::OtherTime::Previous);
    add("Minus another time: last", "How the parameter shown differs from what it is at the last time",
        volume::OtherTime::Last);
    add("Minus another time: shown now", "How the parameter shown differs from what it is at the time shown now",
        volume::OtherTime::Time);
}

void Workbench::addHelpCommands() {
    const auto add = [this](Command command) { commands_.push_back(std::move(command)); };
    add({.menu = "Help",
         .name = "Shortcuts",
         .help = "Every key",
         .shortcut = {.key = key::kF1},
         .alternative = {.key = 'H'},
         .run = [this] { askHelp_ = true; }});
    add({.menu = "Help",
         .name = "Command palette",
         .help = "Find anything by name",
         .shortcut = {.key = 'P', .ctrl = true, .shift = true},
         .alternative = {.key = key::kSpace, .ctrl = true},
         .run = [this] { palette_.open = true; }});
    for (const std::string& model : volume::modelNames())
        add({.menu = "Help",
             .name = (model == volume::modelNames().front() ? "-" : "") + ("Example data: " + model),
             .help = "Computed by the program",
             .run = [this, model] {
                 OpenRequest request;
                 request.data.emplace();
                 request.data->model = model;
                 if (model == "fuel-cell" || model == "planted") request.layout = "overview";
                 open(std::move(request));
             }});
    add({.menu = "Help", .name = "-About Tessera", .help = "Version", .run = [this] { askAbout_ = true; }});
}

void Workbench::drawMenus() {
    if (!ImGui::BeginMainMenuBar()) return;
    const Command* chosen = nullptr;
    for (const char* menu : {"File", "Edit", "View", "Layout", "Help"}) {
        if (!ImGui::BeginMenu(menu)) continue;
        if (const Command* command = drawMenu(commands_, menu)) chosen = command;
        if (std::string_view(menu) == "File") {
            ImGui::Separator();
            if (ImGui::BeginMenu("Recent files")) {
                const auto recent = recentFiles(options_.stateFolder);
                if (recent.empty()) ImGui::TextDisabled("None yet");
                for (const std::string& path : recent) {
                    std::error_code problem;
                    if (ImGui::MenuItem(path.c_str(), nullptr, false, fs::exists(path, problem)))
                        chosen_ = [this, path] {
                            OpenRequest request;
                            request.paths = {path};
                            open(std::move(request));
                        };
                }
                ImGui::EndMenu();
            }
        }
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
    if (chosen) chosen_ = chosen->run;
}

} // namespace tessera::app
