#include "app/workbench/workbench.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <imgui.h>

/// The commands of the menus View and Layout: which views are open, where, and how they look.
namespace tessera::app {

namespace {

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
        const bool space = has([](const std::string&, const ViewState& view) { return traitsOf(view).inSpace; });
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

/// The stack that holds a pane; 0: none.
int stackOf(const DockNode& node, const std::string& pane) {
    if (std::ranges::find(node.tabs, pane) != node.tabs.end()) return node.id;
    for (const DockNode& child : node.children)
        if (const int id = stackOf(child, pane)) return id;
    return 0;
}

} // namespace

/// A view of the data in space to the right of the first volume view, or none any more.
void Workbench::showSpaceBeside(bool wanted) {
    const auto inSpace = [](const auto& view) {
        const auto* volume = std::get_if<VolumeView>(&view.second);
        return volume && volume->inSpace;
    };
    if (!wanted) {
        std::erase_if(session_.views, inSpace);
        repair(session_.dock, paneKeys(session_));
        return;
    }
    const auto first = std::ranges::find_if(
        session_.views, [](const auto& view) { return std::holds_alternative<VolumeView>(view.second); });
    if (first == session_.views.end() || std::ranges::any_of(session_.views, inSpace)) return;
    const std::string beside = first->first;
    VolumeView view = std::get<VolumeView>(first->second);
    view.inSpace = true;
    const std::string pane = addView(session_, view);
    if (const int id = stackOf(session_.dock.root, beside)) insertPane(session_.dock, pane, id, DockSide::Right);
    session_.dock.maximised.clear();
}

/// Opens a view beside the pane the hand is on, or where there is room for it.
void Workbench::openView(const ViewState& view) {
    const std::string beside = currentPane();
    const std::string pane = addView(session_, view);
    const std::map<int, DockRect> rects =
        layoutDock(session_.dock, {{0, 0}, ImGui::GetMainViewport()->Size}, scale_).rects;
    if (const int id = stackFor(session_, beside, rects, scale_)) insertPane(session_.dock, pane, id, DockSide::Center);
    session_.dock.maximised.clear();
    hand_.focus = pane;
}

void Workbench::addViewCommands() {
    const auto add = [this](Command command) { commands_.push_back(std::move(command)); };
    const auto opens = [&](std::string_view title, std::string_view help, const ViewState& view) {
        add({.menu = "View", .name = "New: " + std::string(title), .help = std::string(help), .run = [this, view] {
                 openView(view);
             }});
    };
    forEachViewKind([&]<class Kind>(const Kind& kind) {
        typename Kind::State view;
        opens(kind.traits.title, kind.traits.help, view);
        if (!kind.preset.prepare) return;
        kind.preset.prepare(view);
        opens(kind.preset.title, kind.preset.help, view);
    });
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
        add({.menu = "View",
             .name = name,
             .help = std::string(help) + "; in the volume used last, by key in the one under the mouse",
             .shortcut = {.key = key},
             .run =
                 [this, key = key] {
                     cameraPane_ = spacePane();
                     cameraKey_ = key;
                 },
             .enabled = [this] { return source_ && !spacePane().empty(); },
             .checked = [this,
                         key =
                             key] { return key == '5' && session_.camera.projection == vis::Projection::Orthographic; },
             .keyInView = true});
}

void Workbench::addLayoutCommands() {
    const auto loaded = [this] { return source_ != nullptr; };
    const auto add = [this](Command command) { commands_.push_back(std::move(command)); };
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
                 [this, name, title] {
                     try {
                         std::vector<std::string> messages;
                         const SessionDocument layout = loadSession(findLayout(name));
                         replace(changeLayout(layout, *source_, session_, messages));
                         history_.nameNext("Layout: " + title);
                         for (const std::string& text : messages) message(text);
                     } catch (const Error& error) {
                         message(error.what(), true);
                     }
                 },
             .enabled = loaded});
    }
}

} // namespace tessera::app
