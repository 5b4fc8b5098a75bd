#include "app/edits/multiples.h"

#include "app/session/shown_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::app {

namespace {

/// The view that multiples are copies of, with its decoration reduced to what each of them needs.
VolumeView templateOf(const Session& session, const std::string& from) {
    const VolumeView* found = volumeView(session, from);
    VolumeView view = found ? *found : VolumeView{};
    view.multiple = true;
    view.camera.reset();
    view.showAxes = view.showGizmo = view.showScaleBar = false;
    return view;
}

/// The first view tells directions and lengths for all.
void decorateFirst(std::vector<VolumeView>& views, const Session& session, const std::string& from) {
    const VolumeView* found = volumeView(session, from);
    if (views.empty()) return;
    views.front().showGizmo = !found || found->showGizmo || found->multiple;
    views.front().showScaleBar = !found || found->showScaleBar || found->multiple;
}

/// The layer that a parameter is drawn like.
vis::Layer sampleLayer(const std::vector<vis::Layer>& layers) {
    for (const vis::Layer& layer : layers)
        if (layer.visible && layer.lens.empty() &&
            (std::holds_alternative<vis::VolumeLayer>(layer.technique) ||
             std::holds_alternative<vis::SliceLayer>(layer.technique)))
            return layer;
    return {.name = {}, .technique = vis::VolumeLayer{}};
}

vis::Layer layerOf(const std::string& channel, vis::Layer layer) {
    layer.name.clear();
    layer.transfer.clear();
    if (auto* const volume = std::get_if<vis::VolumeLayer>(&layer.technique))
        volume->channel = channel, volume->colorBy.clear();
    if (auto* const slice = std::get_if<vis::SliceLayer>(&layer.technique)) slice->channel = channel;
    return layer;
}

bool showsData(const Session& session, const std::string& pane) {
    const auto found = session.views.find(pane);
    if (found == session.views.end()) return true;
    const ViewTraits& traits = traitsOf(found->second);
    return traits.figure || traits.csv || traits.inSpace;
}

bool showsDataOnly(const Session& session, const DockNode& node) {
    return std::ranges::all_of(node.tabs, [&](const std::string& pane) { return showsData(session, pane); }) &&
           std::ranges::all_of(node.children, [&](const DockNode& child) { return showsDataOnly(session, child); });
}

/// The largest part with nothing but data around a pane; null: the pane is not in it.
template <class Node> Node* placeIn(const Session& session, Node& node, const std::string& from) {
    if (stackWith(node, from) == 0) return nullptr;
    if (showsDataOnly(session, node)) return &node;
    for (auto& child : node.children)
        if (Node* found = placeIn(session, child, from)) return found;
    return &node; // a stack shared with tools
}

void collectTabs(const DockNode& node, std::vector<std::string>& tabs) {
    tabs.insert(tabs.end(), node.tabs.begin(), node.tabs.end());
    for (const DockNode& child : node.children) collectTabs(child, tabs);
}

/// Equal parts in a row or column.
DockNode divided(DockKind kind, std::vector<DockNode> parts) {
    if (parts.size() == 1) return std::move(parts.front());
    DockNode node;
    node.kind = kind;
    node.ratio = 1 / float(parts.size());
    node.children.push_back(std::move(parts.front()));
    parts.erase(parts.begin());
    node.children.push_back(divided(kind, std::move(parts)));
    return node;
}

DockNode gridOf(const std::vector<std::string>& panes, std::size_t columns) {
    std::vector<DockNode> rows;
    for (std::size_t begin = 0; begin < panes.size(); begin += columns) {
        std::vector<DockNode> cells;
        for (std::size_t i = begin; i < std::min(begin + columns, panes.size()); ++i) {
            DockNode cell;
            cell.tabs = {panes[i]};
            cells.push_back(std::move(cell));
        }
        rows.push_back(divided(DockKind::Row, std::move(cells)));
    }
    return divided(DockKind::Column, std::move(rows));
}

/// The stack of the dock with the most tabs; null if there is none.
DockNode* fullestStack(DockNode& node) {
    if (node.kind == DockKind::Tabs) return node.tabs.empty() ? nullptr : &node;
    DockNode* best = nullptr;
    for (DockNode& child : node.children)
        if (DockNode* found = fullestStack(child); found && (!best || found->tabs.size() > best->tabs.size()))
            best = found;
    return best;
}

DockNode& firstCell(DockNode& node) {
    return node.kind == DockKind::Tabs ? node : firstCell(node.children.front());
}

DockNode besides(DockNode left, DockNode right) {
    DockNode node;
    node.kind = DockKind::Row;
    node.ratio = 0.7f;
    node.children.push_back(std::move(left));
    node.children.push_back(std::move(right));
    return node;
}

/// Removes all small multiples but the pane `from`.
void removeFormer(Session& session, const std::string& from) {
    std::vector<std::string> former;
    for (const auto& [pane, view] : session.views)
        if (const auto* volume = std::get_if<VolumeView>(&view); volume && volume->multiple && pane != from)
            former.push_back(pane);
    for (const std::string& pane : former) {
        removePane(session.dock, pane);
        session.views.erase(pane);
    }
}

/// Adds a volume view that is in no stack yet; returns its key.
std::string addUndocked(Session& session, VolumeView view) {
    const std::string kind(VolumeView::kType);
    std::string key = kind;
    for (int number = 2; session.views.contains(key); ++number) key = kind + "-" + std::to_string(number);
    session.views[key] = std::move(view);
    return key;
}

} // namespace

std::vector<VolumeView> viewsByParameter(const Session& session, const std::string& from,
                                         const std::vector<std::string>& channels) {
    const VolumeView* found = volumeView(session, from);
    const vis::Layer sample = sampleLayer(found && found->layers ? *found->layers : session.layers);
    std::vector<VolumeView> views;
    for (const std::string& channel : channels) {
        VolumeView view = templateOf(session, from);
        view.layers = std::vector<vis::Layer>{layerOf(channel, sample)};
        view.showLegend = true;
        views.push_back(std::move(view));
    }
    decorateFirst(views, session, from);
    return views;
}

std::vector<VolumeView> viewsByTime(const Session& session, const std::string& from, const std::vector<double>& times) {
    std::vector<VolumeView> views;
    for (const double time : times) {
        VolumeView view = templateOf(session, from);
        view.time = time;
        view.showLegend = false;
        views.push_back(std::move(view));
    }
    if (!views.empty()) views.back().showLegend = true;
    decorateFirst(views, session, from);
    return views;
}

std::vector<std::size_t> spreadTimes(std::size_t count, std::size_t most) {
    const std::size_t chosen = std::min(count, most);
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < chosen; ++i)
        indices.push_back(chosen < 2 ? 0 : (i * (count - 1) + (chosen - 1) / 2) / (chosen - 1));
    return indices;
}

int gridColumns(int count, double aspect, double object) {
    int best = 1;
    double largest = 0;
    for (int columns = 1; columns <= count; ++columns) {
        const int rows = (count + columns - 1) / columns;
        const double height = std::min(1.0 / rows, aspect / columns / object); // of the object, place = 1
        if (height <= largest * 1.001) continue;
        largest = height;
        best = columns;
    }
    // As many rows with fewer columns: the last row is as full as the others.
    const int rows = (count + best - 1) / best;
    return (count + rows - 1) / rows;
}

const DockNode* placeOfMultiples(const Session& session, const std::string& from) {
    return placeIn(session, session.dock.root, from);
}

void makeMultiples(Session& session, const std::string& from, std::vector<VolumeView> views, double aspect,
                   double object) {
    if (views.empty()) return;
    if (const VolumeView* view = volumeView(session, from); view && view->camera) session.camera = *view->camera;
    removeFormer(session, from);
    DockNode* const place = placeIn(session, session.dock.root, from);
    std::vector<std::string> displaced;
    if (place) collectTabs(std::exchange(*place, DockNode{}), displaced);
    std::erase(displaced, from);
    session.views.erase(from);
    std::vector<std::string> panes;
    for (VolumeView& view : views) panes.push_back(addUndocked(session, std::move(view)));
    DockNode grid = gridOf(panes, std::size_t(gridColumns(int(panes.size()), aspect, object)));
    DockNode* const other = fullestStack(session.dock.root);
    std::vector<std::string>& tabs = other ? other->tabs : firstCell(grid).tabs;
    tabs.insert(tabs.end(), displaced.begin(), displaced.end());
    if (place)
        *place = std::move(grid);
    else // it was floating
        session.dock.root = besides(std::move(grid), std::move(session.dock.root));
    session.dock.maximised.clear();
    repair(session.dock, paneKeys(session));
    session.dock.volume = panes.front();
}

} // namespace tessera::app
