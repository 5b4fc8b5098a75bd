#include "app/workbench/pane_host.h"

#include "app/pane/pane_title.h"
#include "app/pane/tool_row.h"
#include "app/session/own_functions.h"
#include "app/session/shown_scene.h"

#include <algorithm>
#include <utility>

namespace tessera::app {

namespace {

/// Whether a pane shows the scene from the session's camera.
bool hasCamera(const Session& session, const std::string& pane) {
    const auto found = session.views.find(pane);
    return found != session.views.end() && traitsOf(found->second).camera;
}

/// The stack in which a new view opens: that of the active pane, unless it is too narrow or low; then the largest that
/// shows no picture in space. `least`: height that the view keeps at least, design pixels. 0: none.
int stackFor(const Session& session, const std::string& beside, const std::map<int, DockRect>& rects, float least,
             float scale) {
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
        constexpr float kReadable = 400, kLow = 200; // design pixels: the width of a tool bar, a height for two plots
        const bool roomy = size.x >= kReadable * scale && size.y >= std::max(kLow, least * 1.3f) * scale;
        const bool near = has([&](const std::string& pane, const ViewState&) { return pane == beside; });
        const bool space = has([](const std::string&, const ViewState& view) { return traitsOf(view).inSpace; });
        float worth = size.x * size.y;
        if (near && roomy) worth += 1e12f;
        if (space && !near) worth *= 1e-6f;
        if (worth <= largest) return;
        largest = worth;
        chosen = node.id;
    };
    look(session.dock.root);
    return chosen;
}

bool isClicked() {
    return ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseClicked(ImGuiMouseButton_Middle) ||
           ImGui::IsMouseClicked(ImGuiMouseButton_Right);
}

} // namespace

bool hasNothingToShow(const ViewState& view, const Session& session, const volume::DatasetInfo& info) {
    const auto* const timeline = std::get_if<TimelineView>(&view);
    return timeline && !timeline->always && info.times.size() <= 1 && session.animation.tracks.empty() &&
           !session.data.timeAxis;
}

const ViewCache* PaneHost::cache(const std::string& pane) const {
    const auto found = caches_.find(pane);
    return found == caches_.end() ? nullptr : found->second.get();
}

const ViewExport* PaneHost::exported(const std::string& pane) const {
    const auto found = exports_.find(pane);
    return found == exports_.end() ? nullptr : &found->second;
}

void PaneHost::draw(const ViewContext& frame, const Area& area) {
    Session& session = frame.session;
    std::erase_if(caches_,
                  [&](const auto& entry) { return !entry.second->shared() && !session.views.contains(entry.first); });
    if (!session.views.contains(session.dock.volume)) session.dock.volume.clear();
    int renderers = 1;
    for (const auto& [pane, cache] : caches_) renderers += cache->renderers();
    idle_ = !working_;
    busy_ = hurries_ = working_ = compiling_ = behind_ = false;
    hovered_.clear();
    drawn_.clear();
    DockPanes panes;
    panes.title = [&](const std::string& pane) {
        return frame.source ? shownTitle(session, pane, frame.source->info()) : paneTitle(session, pane);
    };
    panes.draw = [&](const std::string& pane) { drawPane(frame, pane, renderers); };
    panes.padded = [&](const std::string& pane) {
        const auto found = session.views.find(pane);
        return found == session.views.end() || traitsOf(found->second).padded;
    };
    panes.close = [&](const std::string& pane) {
        const std::vector<OwnFunction> before = ownFunctions(session);
        removePane(session.dock, pane);
        session.views.erase(pane);
        if (frame.source) removeUnused(session, before, frame.source->info());
    };
    panes.hidden = [&](const std::string& pane) {
        const auto found = session.views.find(pane);
        return found != session.views.end() && frame.source &&
               hasNothingToShow(found->second, session, frame.source->info());
    };
    panes.least = [&](const std::string& pane) {
        const auto found = session.views.find(pane);
        const ViewTraits traits = found == session.views.end() ? ViewTraits{} : traitsOf(found->second);
        return ImVec2{traits.leastWidth, traits.leastHeight};
    };
    panes.none = area.none;
    if (area.only.empty()) {
        drawDock(session.dock, hand_, panes, area.origin, area.size, frame.scale);
    } else {
        DockTree alone;
        alone.maximised = area.only;
        drawDock(alone, hand_, panes, area.origin, area.size, frame.scale, true);
    }
    last_ = drawn_;
}

void PaneHost::drawPane(const ViewContext& frame, const std::string& pane, int renderers) {
    drawn_.insert(pane);
    const bool focused =
        ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows) && std::exchange(focused_, pane) != pane;
    if (ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows | ImGuiHoveredFlags_AllowWhenBlockedByActiveItem))
        hovered_ = pane;
    if ((focused || hovered_ == pane) && hasCamera(frame.session, pane)) lastSpace_ = pane;
    const bool clicked = hovered_ == pane && isClicked();
    if ((clicked || (focused && last_.contains(pane))) && volumeViews(frame.session) > 1 &&
        volumeView(frame.session, pane))
        frame.session.dock.volume = pane;
    const auto found = frame.session.views.find(pane);
    if (found == frame.session.views.end()) {
        ImGui::TextDisabled("No view is named %s.", pane.c_str());
        return;
    }
    ViewContext context = frame;
    context.renderers = renderers;
    context.volumes = static_cast<int>(std::ranges::count_if(
        last_, [&](const std::string& each) { return volumeView(frame.session, each) != nullptr; }));
    context.idle = idle_;
    if (cameraPane_ == pane) context.cameraKey = std::exchange(cameraKey_, 0);
    if (tablePane_ == pane)
        context.offerExport = [&](const ViewExport& made) {
            tablePane_.clear();
            app::exportTable(frame, made);
        };
    else if (frame.headless)
        context.offerExport = [&](ViewExport made) { exports_[pane] = std::move(made); };
    ImGui::PushID(pane.c_str());
    // By the index taken before, since drawing may remove the view from the session.
    forEachViewKind([&, at = std::size_t(0), index = found->second.index()]<class Kind>(const Kind&) mutable {
        if (at++ == index) Kind::draw(context, pane, std::get<typename Kind::State>(found->second));
    });
    ImGui::PopID();
    messages_.insert(messages_.end(), context.answers.messages.begin(), context.answers.messages.end());
    working_ = working_ || context.answers.unfinished();
    busy_ = busy_ || context.answers.unfinished() || context.answers.postponed;
    hurries_ = hurries_ || context.answers.busy || (context.answers.postponed && context.idle);
    compiling_ = compiling_ || context.answers.compiling;
    behind_ = behind_ || context.answers.behind;
    if (paneDrawn) paneDrawn(pane, context.answers.behind);
}

void PaneHost::open(Session& session, const ViewState& view, float scale) {
    const std::string beside = current(session);
    const std::string pane = addView(session, view);
    const std::map<int, DockRect> rects =
        layoutDock(session.dock, {{0, 0}, ImGui::GetMainViewport()->Size}, scale).rects;
    if (const int id = stackFor(session, beside, rects, traitsOf(view).leastHeight, scale))
        insertPane(session.dock, pane, id, DockSide::Center);
    session.dock.maximised.clear();
    hand_.focus = pane;
}

void PaneHost::show(Session& session, const std::string& pane) {
    showPane(session.dock, pane);
    hand_.focus = pane;
}

void PaneHost::nextTab(Session& session, int direction) {
    const std::vector<std::string> tabs = tabsBeside(session.dock, focused_);
    const auto now = std::ranges::find(tabs, focused_);
    if (now == tabs.end()) return;
    const int count = int(tabs.size()), at = int(now - tabs.begin());
    show(session, tabs[std::size_t((at + direction + count) % count)]);
}

std::string PaneHost::current(const Session& session) const {
    if (!session.dock.maximised.empty()) return session.dock.maximised;
    if (session.views.contains(hovered_)) return hovered_;
    return session.views.contains(focused_) ? focused_ : std::string();
}

std::string PaneHost::space(const Session& session) const {
    if (last_.contains(lastSpace_) && hasCamera(session, lastSpace_)) return lastSpace_;
    for (const std::string& pane : last_)
        if (hasCamera(session, pane)) return pane;
    return {};
}

void PaneHost::pressCameraKey(const Session& session, int key) {
    cameraPane_ = space(session);
    cameraKey_ = key;
}

bool PaneHost::plays(const Session& session) const {
    return std::ranges::any_of(
        session.views, [&](const auto& view) { return last_.contains(view.first) && traitsOf(view.second).plays; });
}

} // namespace tessera::app
