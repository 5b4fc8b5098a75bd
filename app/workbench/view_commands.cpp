#include "app/data/apply_layout.h"
#include "app/data/packing_errors.h"
#include "app/data/plane_sources.h"
#include "app/session/shown_scene.h"
#include "app/ui/keys.h"
#include "app/workbench/fit_box.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <imgui.h>

/// The menus View and Layout: opening and arranging views, and their appearance.
namespace tessera::app {

namespace {

/// Two views without settings show the same.
bool hasSettings(ViewState& view) {
    bool any = false;
    std::visit([&](auto& state) { state.describe(state, [&](auto&, const FieldInfo&) { any = true; }); }, view);
    return any;
}

/// Opens a view. A hidden one of the same kind is shown instead of a second one, and so is one that has no settings.
void openView(Workbench& workbench, ViewState view) {
    Session& session = workbench.session();
    auto* const timeline = std::get_if<TimelineView>(&view);
    if (timeline && workbench.document().loaded() && hasNothingToShow(view, session, workbench.document().info())) {
        timeline->always = true;
        for (auto& [pane, other] : session.views)
            if (std::holds_alternative<TimelineView>(other)) {
                other = view;
                return;
            }
    }
    if (!hasSettings(view))
        for (const auto& [pane, other] : session.views)
            if (other.index() == view.index()) return workbench.panes().show(session, pane);
    workbench.panes().open(session, view, workbench.look().scale());
}

/// One for each kind of view, and for each preset of one.
void addOpeningCommands(std::vector<Command>& commands, Workbench& workbench) {
    const auto opens = [&](std::string_view title, std::string_view help, std::string_view words,
                           const ViewState& view) {
        commands.push_back({.menu = "View",
                            .name = "New: " + std::string(title),
                            .help = std::string(help),
                            .words = "open show add pane view window " + std::string(words),
                            .run = [&workbench, view] { openView(workbench, view); }});
    };
    forEachViewKind([&]<class Kind>(const Kind& kind) {
        typename Kind::State view;
        opens(kind.traits.title, kind.traits.help, kind.traits.words, view);
        if (!kind.preset.prepare) return;
        kind.preset.prepare(view);
        opens(kind.preset.title, kind.preset.help, kind.preset.words, view);
    });
}

void addPaneCommands(std::vector<Command>& commands, Workbench& workbench) {
    const auto current = [&workbench] { return workbench.panes().current(workbench.session()); };
    commands.push_back({.menu = "View",
                        .name = "-Maximise pane",
                        .help = "Make the pane under the mouse fill the window, or restore it",
                        .words = "full screen fullscreen enlarge restore",
                        .shortcut = {.key = key::kF11},
                        .run = [&workbench, current] {
                            std::string& maximised = workbench.session().dock.maximised;
                            maximised = maximised.empty() ? current() : std::string();
                        }});
    commands.push_back(
        {.menu = "View",
         .name = "Duplicate pane",
         .help = "Open a copy of the view under the mouse, of a 3D view beside it",
         .words = "copy clone second view side by side split",
         .shortcut = {.key = 'D', .ctrl = true},
         .run = [&workbench, current] {
             Session& session = workbench.session();
             const auto found = session.views.find(current());
             if (found == session.views.end()) return;
             const bool inSpace = traitsOf(found->second).inSpace;
             const int stack = stackWith(session.dock.root, found->first);
             const float scale = workbench.look().scale();
             const auto rects = layoutDock(session.dock, {{0, 0}, ImGui::GetMainViewport()->Size}, scale).rects;
             const auto rect = rects.find(stack);
             const bool high = rect != rects.end() && rect->second.length(false) > rect->second.length(true);
             const DockSide side = high ? DockSide::Bottom : DockSide::Right;
             const std::string copy = addView(session, ViewState(found->second));
             if (inSpace && stack) insertPane(session.dock, copy, stack, side);
             if (inSpace) session.dock.maximised.clear();
         }});
}

/// Offers the statistics of the selection for saving, in a pane that shows them.
void saveSelection(Workbench& workbench) {
    Session& session = workbench.session();
    const auto shows = [](const auto& entry) {
        const auto* statistics = std::get_if<StatisticsView>(&entry.second);
        return statistics && !statistics->byRegion;
    };
    if (std::ranges::none_of(session.views, shows))
        workbench.panes().open(session, StatisticsView{}, workbench.look().scale());
    const std::string pane = std::ranges::find_if(session.views, shows)->first;
    workbench.panes().show(session, pane);
    workbench.panes().exportTableOf(pane);
}

void addExportCommand(std::vector<Command>& commands, Workbench& workbench) {
    commands.push_back(
        {.menu = "",
         .name = "Save the selection as a table...",
         .help = "Save the statistics of what is brushed and of the rest, with its name and definition, "
                 "as CSV",
         .words = "export csv brush region numbers statistics",
         .run = [&workbench] { saveSelection(workbench); },
         .enabled = [&workbench] { return workbench.document().loaded() && workbench.session().selection.active(); }});
    commands.push_back({.menu = "",
                        .name = "Export table...",
                        .help = "Save the numbers of the pane under the mouse, or of the one clicked last, as CSV",
                        .words = "save csv numbers values spreadsheet",
                        .run = [&workbench] { workbench.panes().exportTable(workbench.session()); },
                        .enabled =
                            [&workbench] {
                                const Session& session = workbench.session();
                                const auto found = session.views.find(workbench.panes().current(session));
                                return workbench.document().loaded() && found != session.views.end() &&
                                       traitsOf(found->second).csv;
                            },
                        .needs = "a pane with a table, such as a plot, under the mouse or clicked last"});
}

void addKeyboardCommands(std::vector<Command>& commands, Workbench& workbench) {
    const auto add = [&](const char* name, const char* help, const char* words, Shortcut shortcut,
                         std::function<void()> run) {
        commands.push_back(
            {.menu = "", .name = name, .help = help, .words = words, .shortcut = shortcut, .run = std::move(run)});
    };
    add("Menu bar", "Open the menus; Alt does so too, and Alt with the first letter of a menu",
        "keyboard alt file edit", {.key = key::kF10}, [&workbench] { workbench.keyboard().openMenus(); });
    add("Next part of the window", "Go to the next pane or list; Tab and arrows go on within it", "keyboard focus pane",
        {.key = key::kF6}, [&workbench] { workbench.keyboard().nextPart(1); });
    add("Previous part of the window", "Go to the pane or list before", "keyboard focus pane back",
        {.key = key::kF6, .shift = true}, [&workbench] { workbench.keyboard().nextPart(-1); });
    add("Next tab", "Bring the next pane of a stack to the front", "keyboard pane switch",
        {.key = key::kPageDown, .ctrl = true}, [&workbench] { workbench.panes().nextTab(workbench.session(), 1); });
    add("Previous tab", "Bring the pane before to the front", "keyboard pane switch back",
        {.key = key::kPageUp, .ctrl = true}, [&workbench] { workbench.panes().nextTab(workbench.session(), -1); });
}

void addLookCommands(std::vector<Command>& commands, Workbench& workbench) {
    const auto looks = [&workbench]() -> Appearance& { return workbench.session().appearance; };
    const auto resize = [looks](float factor) {
        looks().scale = std::clamp(std::round(looks().scale * factor * 20) / 20, 0.5f, 3.0f);
    };
    commands.push_back({.menu = "View",
                        .name = "-Light theme",
                        .help = "Dark text on a light background, for print and bright rooms",
                        .words = "dark mode white bright black background ground print",
                        .run = [looks] { looks().theme = looks().theme == Theme::Dark ? Theme::Light : Theme::Dark; },
                        .checked = [looks] { return looks().theme == Theme::Light; }});
    commands.push_back({.menu = "View",
                        .name = "Larger text",
                        .help = "Enlarge text and controls",
                        .words = "font size scale bigger zoom",
                        .shortcut = {.key = '=', .ctrl = true},
                        .run = [resize] { resize(1.125f); }});
    commands.push_back({.menu = "View",
                        .name = "Smaller text",
                        .help = "Reduce text and controls",
                        .words = "font size scale zoom",
                        .shortcut = {.key = '-', .ctrl = true},
                        .run = [resize] { resize(1 / 1.125f); }});
}

void addCameraCommands(std::vector<Command>& commands, Workbench& workbench) {
    for (const auto& [name, key, help, words] :
         {std::tuple{"-Look from the front", '1', "Shift: from the back", "camera view back behind"},
          {"Look from the right", '3', "Shift: from the left", "camera view left side"},
          {"Look from the top", '7', "Shift: from below", "camera view below bottom above"},
          {"Look isometric", '9', "From the corner", "camera view corner 3d"},
          {"Parallel projection", '5', "Switch between perspective and parallel projection", "orthographic camera"},
          {"Reset the camera", 'R', "Show the whole data set", "fit home zoom all centre center view"}})
        commands.push_back(
            {.menu = "View",
             .name = name,
             .help =
                 std::string(help) + "; acts on the volume view used last (with the key: on the one under the mouse)",
             .words = words,
             .shortcut = {.key = key},
             .run = [&workbench, key = key] { workbench.panes().pressCameraKey(workbench.session(), key); },
             .enabled =
                 [&workbench] {
                     return workbench.document().loaded() && !workbench.panes().space(workbench.session()).empty();
                 },
             .checked =
                 [&workbench, key = key] {
                     if (key != '5') return false;
                     const VolumeView* view =
                         volumeView(workbench.session(), workbench.panes().space(workbench.session()));
                     const vis::Camera& camera = view && view->camera ? *view->camera : workbench.session().camera;
                     return camera.projection == vis::Projection::Orthographic;
                 },
             .keyInView = true});
}

/// Opens every view in the default arrangement.
void resetArrangement(Workbench& workbench) {
    Session& session = workbench.session();
    const Session fresh = defaultSession(workbench.document().info(), session.data);
    std::erase_if(session.views, [](const auto& each) {
        const auto* volume = std::get_if<VolumeView>(&each.second);
        return volume && volume->multiple;
    });
    for (const auto& [pane, view] : fresh.views) session.views.emplace(pane, view);
    session.dock = fresh.dock;
    repair(session.dock, paneKeys(session));
}

bool isLower(const std::string& text, std::size_t at) {
    return at < text.size() && text[at] >= 'a' && text[at] <= 'z';
}

/// "overTime" and "over_time" are "Over time"; capitals that stand together stay.
std::string titleOfLayout(const std::string& name) {
    std::string title;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool begins = i > 0 && name[i] >= 'A' && name[i] <= 'Z' && isLower(name, i - 1) && isLower(name, i + 1);
        if (begins) title += ' ';
        title += begins ? static_cast<char>(name[i] - 'A' + 'a') : name[i] == '_' ? ' ' : name[i];
    }
    if (isLower(title, 0)) title[0] = static_cast<char>(title[0] - 'a' + 'A');
    return title;
}

void showLayout(Workbench& workbench, const std::string& name, const std::string& title) {
    try {
        std::vector<std::string> messages;
        const SessionDocument layout = loadSession(findLayout(name));
        const DataRef& shown = workbench.session().data;
        const volume::DatasetInfo& info = workbench.document().info();
        // Errors of packing exist only where data were packed beside their originals, a plane only of data cut by it.
        if (packsForErrors(layout.session, shown) || layoutCuts(layout.session, shown, info)) {
            OpenRequest request;
            request.layout = name;
            if (!shown.files.empty() || shown.model != layout.session.data.model) request.data = shown;
            return workbench.open(std::move(request));
        }
        if (layout.session.data.timeAxis && !shown.timeAxis) messages.emplace_back(kNoTimesToCut);
        Session next = changeLayout(layout, *workbench.numbers(), workbench.session(), messages);
        const WindowLook& look = workbench.look();
        showWholeBox(next, workbench.document().info(), look.scale(), look.scaleWith(next.appearance));
        workbench.document().replace(std::move(next), "Layout: " + title);
        for (const std::string& text : messages) workbench.message(text);
    } catch (const Error& error) {
        workbench.message(error.what(), true);
    }
}

} // namespace

std::vector<Command> viewCommands(Workbench& workbench) {
    std::vector<Command> commands;
    for (const auto add : {addOpeningCommands, addPaneCommands, addExportCommand, addKeyboardCommands, addLookCommands,
                           addCameraCommands})
        add(commands, workbench);
    return commands;
}

std::vector<Command> layoutCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    std::vector<Command> commands = {{.menu = "Layout",
                                      .name = "Reset arrangement",
                                      .help = "Restore the initial arrangement of views",
                                      .words = "default panes windows restore layout",
                                      .shortcut = {.key = 'R', .ctrl = true, .shift = true},
                                      .run = [&workbench] { resetArrangement(workbench); },
                                      .enabled = loaded}};
    // Those for tasks with any data, then those that show what pictures can look like.
    std::vector<std::string> names = layoutNames();
    const auto shows =
        std::ranges::stable_partition(names, [](const std::string& name) { return !isDemonstration(name); });
    for (const std::string& name : names) {
        const bool first = name == names.front() || (!shows.empty() && name == shows.front());
        const std::string title = titleOfLayout(name);
        commands.push_back(
            {.menu = "Layout",
             .name = (first ? "-" : "") + title,
             .help = "Show the data in the layout " + name,
             .words = isDemonstration(name) ? "demonstration arrangement preset" : "arrangement preset task",
             .run = [&workbench, name, title] { showLayout(workbench, name, title); },
             .enabled = loaded});
    }
    return commands;
}

} // namespace tessera::app
