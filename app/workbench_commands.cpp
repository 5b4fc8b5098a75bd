#include "app/workbench.h"

#include "volume/error.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <imgui.h>
#include <imgui_internal.h>

/// The table of commands: the one place that says what the program can do, by which name and key.
namespace tessera::app {

namespace fs = std::filesystem;

namespace {

struct ViewKind {
    const char *name, *help;
    ViewState view;
};

std::vector<ViewKind> viewKinds() {
    return {{"Volume", "The data in space", VolumeView{}},
            {"Slices", "Three orthogonal slices with a read-out", SlicesView{}},
            {"Scatterplots", "Every pair of parameters; brush to select", ScatterMatrixView{}},
            {"Transfer function", "Colours and opacity of a parameter", TransferView{}},
            {"Layers", "What the 3D views show", LayersView{}},
            {"Timeline", "Play through time", TimelineView{}},
            {"Data", "What is in the data set and the selection", DataView{}},
            {"History", "Every edit, undone and redone by a click", HistoryView{}},
            {"Messages", "What the program had to say", LogView{}},
            {"Statistics", "Every parameter inside and outside of the selection", StatisticsView{}},
            {"Histogram", "One parameter's histogram; drag to select", HistogramView{}},
            {"Line profile", "Parameters along a line", ProfileView{}},
            {"Slice matrix", "Parameters on parallel planes", SliceMatrixView{}},
            {"Shadow cube", "Projections on the faces of a cube around the scene", ShadowCubeView{}},

            {"Tesseract", "The field in four dimensions, turned in six planes", TesseractView{}},
            {"Side by side", "The 3D scene with other settings", CompareView{}}};
}

/// The stack a new view opens in: that of the pane the hand is on, unless it is too narrow to read; then the largest
/// that hides no picture in space. 0: none.
int stackFor(const Session& session, const std::string& beside, const std::map<int, DockRect>& rects, float scale) {
    int chosen = 0;
    float largest = 0;
    const std::function<void(const DockNode&)> look = [&](const DockNode& node) {
        for (const DockNode& child : node.children) look(child);
        const auto rect = rects.find(node.id);
        if (node.tabs.empty() || rect == rects.end()) return;
        const ImVec2 size{rect->second.hi.x - rect->second.lo.x, rect->second.hi.y - rect->second.lo.y};
        const auto has = [&](const auto& wanted) {
            return std::any_of(node.tabs.begin(), node.tabs.end(), [&](const std::string& pane) {
                const auto view = session.views.find(pane);
                return view != session.views.end() && wanted(pane, view->second);
            });
        };
        constexpr float kReadable = 400; // design pixels, the width of a tool bar
        const bool near = has([&](const std::string& pane, const ViewState&) { return pane == beside; });
        const bool space = has([](const std::string&, const ViewState& view) {
            return std::holds_alternative<VolumeView>(view) || std::holds_alternative<ShadowCubeView>(view) ||
                   std::holds_alternative<TesseractView>(view) || std::holds_alternative<CompareView>(view);
        });
        float worth = size.x * size.y;
        if (near && size.x >= kReadable * scale) worth += 1e12f;
        if (space && !near) worth *= 1e-6f;
        if (worth <= largest) return;
        largest = worth;
        chosen = node.id;
    };
    look(session.dock.root);
    return chosen;
}

} // namespace

void Workbench::makeCommands() {
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
                 if (!opened->missing.empty()) {
                     missing_ = std::move(*opened);
                     return;
                 }
                 jobs_.start("open", "Opening the pasted session",
                             [this, opened, data = found.data](const Progress& progress) -> Jobs::Finish {
                                 auto done = std::make_shared<Opened>(openWith(*opened, data, progress));
                                 return [this, done] { install(std::move(*done)); };
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
    add({.menu = "Edit",
         .name = "-Show on BCC lattice",
         .help = "Resample data files to 70.7 % of the samples on the body-centred cubic lattice",
         .run =
             [this] {
                 DataRef data = session_.data;
                 data.bcc = !data.bcc;
                 showAs(data, "Resampling");
             },
         .enabled = [this] { return source_ && (session_.data.files.empty() || showsDataFiles()); },
         .checked = [this] { return session_.data.bcc; }});
    for (const auto axis : {volume::SpaceAxis::X, volume::SpaceAxis::Y, volume::SpaceAxis::Z}) {
        const auto shown = [this, axis] { return session_.data.timeAxis && session_.data.timeAxis->axis == axis; };
        add({.menu = "Edit",
             .name = "Time along " + std::string(volume::kSpaceAxisNames[std::size_t(axis)]),
             .help = "The plane through the cross-hair at all times, time in place of the axis",
             .run =
                 [this, axis, shown] {
                     DataRef data = session_.data;
                     data.timeAxis.reset();
                     const volume::Box& box = source_->info().bounds;
                     const int a = static_cast<int>(axis);
                     if (!shown()) data.timeAxis = {axis, (session_.cursor[a] - box.lo[a]) / box.size()[a]};
                     showAs(data, "Times as an axis");
                 },
             .enabled =
                 [this, axis, shown] {
                     return source_ && (shown() || (!session_.data.timeAxis && source_->info().times.size() > 1 &&
                                                    source_->info().bounds.size()[static_cast<int>(axis)] > 0));
                 },
             .checked = shown});
    }

    for (const ViewKind& kind : viewKinds())
        add({.menu = "View",
             .name = std::string("New: ") + kind.name,
             .help = kind.help,
             .run = [this, view = kind.view] {
                 const std::string beside = currentPane();
                 const std::string pane = addView(session_, view);
                 const std::map<int, DockRect> rects =
                     layoutDock(session_.dock, {0, 0}, ImGui::GetMainViewport()->Size, scale_);
                 if (const int id = stackFor(session_, beside, rects, scale_))
                     insertPane(session_.dock, pane, id, DockSide::Center);
                 session_.dock.maximised.clear();
                 hand_.focus = pane;
             }});
    add({.menu = "View",
         .name = "-Maximise pane",
         .help = "The pane under the mouse fills the window, or goes back",
         .shortcut = {.key = key::kF11},
         .run = [this] { session_.dock.maximised = session_.dock.maximised.empty() ? currentPane() : std::string(); }});
    add({.menu = "View",
         .name = "Duplicate pane",
         .help = "Another view like the one under the mouse",
         .shortcut = {.key = 'D', .ctrl = true},
         .run = [this] {
             const std::string pane = currentPane();
             if (const auto found = session_.views.find(pane); found != session_.views.end())
                 addView(session_, ViewState(found->second));
         }});
    add({.menu = "View",
         .name = "-Light theme",
         .help = "Dark on light, for print and bright rooms",
         .run =
             [this] {
                 session_.appearance.theme = session_.appearance.theme == Theme::Dark ? Theme::Light : Theme::Dark;
             },
         .checked = [this] { return session_.appearance.theme == Theme::Light; }});
    const auto resize = [this](float factor) {
        session_.appearance.scale = std::clamp(std::round(session_.appearance.scale * factor * 20) / 20, 0.5f, 3.0f);
    };
    add({.menu = "View",
         .name = "Larger text",
         .help = "Text and controls grow",
         .shortcut = {.key = '=', .ctrl = true},
         .run = [resize] { resize(1.125f); }});
    add({.menu = "View",
         .name = "Smaller text",
         .help = "Text and controls shrink",
         .shortcut = {.key = '-', .ctrl = true},
         .run = [resize] { resize(1 / 1.125f); }});
    for (const auto& [name, key, help] : {std::tuple{"-Look from the front", '1', "Shift: from the back"},
                                          {"Look from the right", '3', "Shift: from the left"},
                                          {"Look from the top", '7', "Shift: from below"},
                                          {"Look isometric", '9', "The corner"},
                                          {"Parallel projection", '5', "Perspective or parallel"},
                                          {"Reset the camera", 'R', "See everything again"}})
        add({.menu = "View", .name = name, .help = std::string(help) + "; in a volume", .shortcut = {.key = key}});

    add({.menu = "Layout",
         .name = "Reset arrangement",
         .help = "Every view open, arranged as at first",
         .shortcut = {.key = 'R', .ctrl = true, .shift = true},
         .run =
             [this] {
                 const Session fresh = defaultSession(source_->info(), session_.data);
                 for (const auto& [pane, view] : fresh.views) session_.views.emplace(pane, view);
                 session_.dock = fresh.dock;
                 repair(session_.dock, paneKeys(session_));
             },
         .enabled = loaded});
    for (const std::string& name : layoutNames()) {
        std::string title = name;
        std::replace(title.begin(), title.end(), '_', ' ');
        title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
        add({.menu = "Layout",
             .name = (name == layoutNames().front() ? "-" : "") + title,
             .help = "Show the data in the layout " + name,
             .run =
                 [this, name] {
                     try {
                         std::vector<std::string> messages;
                         const SessionDocument layout = loadSession(findLayout(name));
                         Session next = applyLayout(layout, source_->info(), session_.data, messages);
                         next.appearance = session_.appearance;
                         replace(std::move(next));
                         for (const std::string& text : messages) message(text);
                     } catch (const Error& error) {
                         message(error.what(), true);
                     }
                 },
             .enabled = loaded});
    }

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
