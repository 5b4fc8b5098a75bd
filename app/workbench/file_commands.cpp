#include "app/dialogs/import_form.h"
#include "app/document/surface_export.h"
#include "app/edits/compare_files.h"
#include "app/session/shown_scene.h"
#include "app/ui/keys.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"
#include "volume/base/error.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <filesystem>
#include <imgui.h>

/// The menus File and Help.
namespace tessera::app {

namespace fs = std::filesystem;

namespace {

void askWhatToOpen(Workbench& workbench) {
    const auto open = [&workbench](const std::vector<std::string>& paths, const volume::ImportOptions& stated) {
        OpenRequest request;
        request.paths = paths;
        request.import = stated;
        workbench.open(std::move(request));
    };
    workbench.files().askData("Open", open);
}

/// Whether the dialog can show these as chosen: files of one folder.
bool areFilesOfOneFolder(const std::vector<std::string>& paths) {
    return std::ranges::all_of(paths, [&](const fs::path& path) {
        std::error_code unknown;
        return fs::is_regular_file(path, unknown) && path.parent_path() == fs::path(paths.front()).parent_path();
    });
}

void askPack(Workbench& workbench) {
    const std::string stem = fs::path(workbench.session().data.files.front().absolutePath).stem().string();
    workbench.files().askSave("Pack into an archive", stem + ".tsr", ".tsr",
                              [&workbench](const std::string& path) { workbench.data().pack(path); });
}

void askCompared(Workbench& workbench) {
    if (workbench.session().data.other) return workbench.data().compareNoMore();
    const auto compare = [&workbench](const std::vector<std::string>& paths, const volume::ImportOptions& stated) {
        compareWithFiles(workbench, paths, stated);
    };
    workbench.files().askData("Compare with", compare);
}

void askSurface(Workbench& workbench) {
    workbench.files().askSave("Export surface", "surface.ply", "", [&workbench](const std::string& path) {
        exportSurface(workbench.document(), path, workbench.jobs(), workbench.messages());
    });
}

/// The pane that a picture is proposed of: the current one if it shows data, else the scene. Lists beside them are
/// seldom meant, and at first one of them has the keyboard.
std::string paneForPicture(Workbench& workbench) {
    const Session& session = workbench.session();
    const std::string current = workbench.panes().current(session), scene = workbench.panes().space(session);
    const auto view = session.views.find(current);
    const bool shows = view != session.views.end() && (traitsOf(view->second).inSpace || traitsOf(view->second).figure);
    return shows || scene.empty() ? current : scene;
}

void copySession(Workbench& workbench) {
    const std::string folder = fs::current_path().string();
    ImGui::SetClipboardText(printSession(workbench.document().snapshot(), folder + "/clipboard").c_str());
    workbench.message("Session copied");
}

void pasteSession(Workbench& workbench) {
    const char* text = ImGui::GetClipboardText();
    if (!text || !looksLikeSession(text)) return workbench.message("The clipboard contains no session");
    try {
        workbench.openText(text);
    } catch (const Error& error) {
        workbench.message(error.what(), true);
    }
}

/// Jobs that a user knows of; quiet ones belong to the views.
bool hasJobs(const Jobs& jobs) {
    return std::ranges::any_of(jobs.list(), [](const Jobs::Status& job) { return !job.quiet; });
}

void cancelJobs(Jobs& jobs) {
    for (const Jobs::Status& job : jobs.list())
        if (!job.quiet) jobs.cancel(job.key);
}

} // namespace

void dropFiles(Workbench& workbench, const std::vector<std::string>& paths) {
    if (paths.empty()) return;
    std::error_code unknown;
    for (const std::string& path : paths)
        if (!fs::exists(path, unknown)) return workbench.message(path + ": no such file", true);
    FileQuestions& files = workbench.files();
    const bool choosable = areFilesOfOneFolder(paths);
    if (files.asksData() && choosable) return files.choose(paths);
    if (workbench.missingFiles().shown() && !files.shown()) {
        if (!workbench.missingFiles().found(paths))
            workbench.message("None of the files dropped is called like one that is missing", true);
        return;
    }
    if (!KeyboardFocus::closeMenus()) return workbench.message("Close the dialog before you drop files", true);
    if (choosable && lacksLayout(paths.front(), {})) {
        askWhatToOpen(workbench);
        return files.choose(paths);
    }
    OpenRequest request;
    request.paths = paths;
    workbench.open(std::move(request));
}

void compareWithFiles(Workbench& workbench, const std::vector<std::string>& paths,
                      const volume::ImportOptions& stated) {
    workbench.data().compareWith(paths, stated, [&workbench](Session& session, const CompareView& view) {
        for (auto& [pane, each] : session.views)
            if (auto* const open = std::get_if<CompareView>(&each))
                if (std::ranges::any_of(open->variants, showsOtherData)) {
                    *open = view;
                    return workbench.panes().show(session, pane);
                }
        // In the place of the picture that is compared, wherever the mouse was in the dialog.
        const std::string scene = volumePane(session), pane = addView(session, view);
        if (const int id = stackWith(session.dock.root, scene)) insertPane(session.dock, pane, id, DockSide::Center);
        session.dock.maximised.clear();
        workbench.panes().show(session, pane);
    });
}

std::vector<Command> fileCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    return {{.menu = "File",
             .name = "Open...",
             .help = "Open a session, an archive, a picture exported by Tessera, or data files",
             .words = "load import read file data",
             .shortcut = {.key = 'O', .ctrl = true},
             .run = [&workbench] { askWhatToOpen(workbench); }},
            {.menu = "File",
             .name = "-Save session",
             .help = "Save the session to its file",
             .words = "store state project",
             .shortcut = {.key = 'S', .ctrl = true},
             .run = [&workbench] { workbench.save(); },
             .enabled = loaded},
            {.menu = "File",
             .name = "Save session as...",
             .help = "Save the session to another file",
             .words = "store state project",
             .shortcut = {.key = 'S', .ctrl = true, .shift = true},
             .run = [&workbench] { workbench.saveAs(); },
             .enabled = loaded},
            {.menu = "File",
             .name = "Pack into an archive...",
             .help = "Pack the data files shown into one .tsr archive, and open it",
             .words = "compress convert tsr export smaller",
             .run = [&workbench] { askPack(workbench); },
             .enabled = [&workbench] { return showsDataFiles(workbench.document()); }},
            {.menu = "File",
             .name = "Compare with another file...",
             .help = "Show another file beside this one, with one colour bar and the difference; again: no longer",
             .words = "difference second data set two files side by side versus minus diff",
             .run = [&workbench] { askCompared(workbench); },
             .enabled = loaded,
             .checked = [&workbench] { return workbench.session().data.other.has_value(); }},
            {.menu = "File",
             .name = "-Save picture...",
             .help = "Save the window, one view, or several as a figure: PNG, SVG or PDF, which contain the session",
             .words = "screenshot image png export figure print capture",
             .shortcut = {.key = key::kF12},
             .run = [&workbench] { workbench.pictureDialog().show(paneForPicture(workbench)); },
             .enabled = loaded},
            {.menu = "File",
             .name = "Export surface...",
             .help = "Save the selected iso-surface layer at full resolution as PLY, STL, OBJ or VTP",
             .words = "mesh isosurface contour stl ply obj vtp save",
             .run = [&workbench] { askSurface(workbench); },
             .enabled = [&workbench, loaded] { return loaded() && chosenSurface(workbench.session()) >= 0; }},
            {.menu = "File",
             .name = "Cancel jobs",
             .help = "Cancel what runs in the background; what is shown does not change",
             .words = "stop abort interrupt job background work",
             .run = [&workbench] { cancelJobs(workbench.jobs()); },
             .enabled = [&workbench] { return hasJobs(workbench.jobs()); }},
            {.menu = "File",
             .name = "Copy session",
             .help = "Copy the session as text, to send it to somebody",
             .words = "clipboard share send",
             .shortcut = {.key = 'C', .ctrl = true},
             .run = [&workbench] { copySession(workbench); },
             .enabled = loaded},
            {.menu = "File",
             .name = "Paste session",
             .help = "Open the session in the clipboard",
             .words = "clipboard open",
             .shortcut = {.key = 'V', .ctrl = true},
             .run = [&workbench] { pasteSession(workbench); }},
            {.menu = "File",
             .name = "-Quit",
             .help = "Quit the program",
             .words = "exit close leave",
             .shortcut = {.key = 'Q', .ctrl = true},
             .run = [&workbench] { workbench.requestQuit(); }}};
}

std::vector<Command> helpCommands(Workbench& workbench) {
    std::vector<Command> commands = {{.menu = "Help",
                                      .name = "Shortcuts",
                                      .help = "List all keyboard shortcuts",
                                      .words = "keys keyboard help hotkeys mouse",
                                      .shortcut = {.key = key::kF1},
                                      .alternative = {.key = 'H'},
                                      .run = [&workbench] { workbench.help().showShortcuts(); }},
                                     {.menu = "Help",
                                      .name = "Command palette",
                                      .help = "Find any command by name",
                                      .words = "find search action",
                                      .shortcut = {.key = 'P', .ctrl = true, .shift = true},
                                      .alternative = {.key = key::kSpace, .ctrl = true},
                                      .run = [&workbench] { workbench.palette().open = true; }}};
    for (const std::string& model : volume::modelNames())
        commands.push_back({.menu = "Help",
                            .name = (model == volume::modelNames().front() ? "-" : "") + ("Example data: " + model),
                            .help = "Data computed by the program",
                            .words = "sample demo test model built-in",
                            .run = [&workbench, model] {
                                OpenRequest request;
                                request.data.emplace();
                                request.data->model = model;
                                if (model == "fuel-cell" || model == "planted") request.layout = "overview";
                                workbench.open(std::move(request));
                            }});
    commands.push_back(
        {.menu = "Help", .name = "-About Tessera", .help = "Version", .words = "licence license", .run = [&workbench] {
             workbench.help().showAbout();
         }});
    return commands;
}

} // namespace tessera::app
