#include "app/session/shown_scene.h"

#include <algorithm>
#include <utility>

namespace tessera::app {

VolumeView* volumeView(Session& session, const std::string& pane) {
    const auto found = session.views.find(pane);
    return found == session.views.end() ? nullptr : std::get_if<VolumeView>(&found->second);
}

const VolumeView* volumeView(const Session& session, const std::string& pane) {
    const auto found = session.views.find(pane);
    return found == session.views.end() ? nullptr : std::get_if<VolumeView>(&found->second);
}

int volumeViews(const Session& session) {
    return static_cast<int>(std::ranges::count_if(
        session.views, [](const auto& each) { return std::holds_alternative<VolumeView>(each.second); }));
}

std::string volumePane(const Session& session) {
    if (volumeView(session, session.dock.volume)) return session.dock.volume;
    for (const auto& [pane, view] : session.views)
        if (std::holds_alternative<VolumeView>(view)) return pane;
    return {};
}

bool owns(const VolumeView& view, Owned what) {
    return what == Owned::Camera   ? view.camera.has_value()
           : what == Owned::Layers ? view.layers.has_value()
                                   : view.time.has_value();
}

void setOwned(const Session& session, VolumeView& view, Owned what, bool own) {
    const auto set = [&](auto& mine, const auto& shared) {
        if (!own)
            mine.reset();
        else if (!mine)
            mine = shared;
    };
    if (what == Owned::Camera) set(view.camera, session.camera);
    if (what == Owned::Layers) set(view.layers, session.layers);
    if (what == Owned::Time) set(view.time, session.time);
}

void ShownScene::swap() {
    for (const Owned part : parts_) {
        if (!view_ || !owns(*view_, part)) continue;
        if (part == Owned::Camera) std::swap(session_.camera, *view_->camera);
        if (part == Owned::Layers) std::swap(session_.layers, *view_->layers);
        if (part == Owned::Time) std::swap(session_.time, *view_->time);
    }
}

Session sessionShownIn(const Session& session, const std::string& pane) {
    Session shown = session;
    if (const VolumeView* view = volumeView(session, pane)) {
        shown.camera = view->camera.value_or(session.camera);
        shown.layers = view->layers.value_or(session.layers);
        shown.time = view->time.value_or(session.time);
    }
    return shown;
}

namespace {

template <class Lists, class Of> Lists listsOf(Of& session) {
    Lists lists{&session.layers};
    for (auto& [pane, view] : session.views)
        if (auto* const volume = std::get_if<VolumeView>(&view); volume && volume->layers)
            lists.push_back(&*volume->layers);
    for (auto& callout : session.callouts)
        if (callout.layers) lists.push_back(&*callout.layers);
    return lists;
}

} // namespace

std::vector<std::vector<vis::Layer>*> layerLists(Session& session) {
    return listsOf<std::vector<std::vector<vis::Layer>*>>(session);
}

std::vector<const std::vector<vis::Layer>*> layerLists(const Session& session) {
    return listsOf<std::vector<const std::vector<vis::Layer>*>>(session);
}

bool isDrawing(const vis::Technique& technique) {
    const vis::Look* look = vis::lookOf(technique);
    return look && look->charcoal && look->part == vis::LookPart::Everything;
}

bool onlyDrawings(const Session& session) {
    const auto shown = [](const vis::Layer& layer) { return layer.visible; };
    return std::ranges::any_of(session.layers, shown) &&
           std::ranges::all_of(session.layers,
                               [&](const vis::Layer& layer) { return !shown(layer) || isDrawing(layer.technique); });
}

} // namespace tessera::app
