#include "app/pane/pane_title.h"

#include "app/session/shown_scene.h"
#include "app/ui/time_text.h"

#include <algorithm>

namespace tessera::app {

namespace {

/// What the visible layers show, each once: "O2", "O2, T surface"; "" where there are none, or too many for a title.
std::string layersText(const std::vector<vis::Layer>& layers) {
    constexpr std::size_t kMost = 2;
    std::vector<std::string> names;
    for (const vis::Layer& layer : layers) {
        if (!layer.visible) continue;
        const auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique);
        std::string name = volume && layer.name.empty() ? volume->channel : layerName(layer);
        if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
    }
    if (names.size() > kMost) return {};
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

std::string ownText(const Session& session, const std::string& pane, const volume::DatasetInfo& info) {
    if (const auto found = session.views.find(pane); found != session.views.end())
        if (const auto* worth = std::get_if<WorthSeeingView>(&found->second))
            return worth->list == WorthList::WhatElse ? "What else" : worth->list == WorthList::When ? "When" : "";
    const VolumeView* view = volumeView(session, pane);
    if (!view) return {};
    std::string text = view->layers ? layersText(*view->layers) : std::string();
    if (view->time && info.times.size() > 1) text += (text.empty() ? "" : ", ") + timeText(info, *view->time);
    return text;
}

} // namespace

std::string shownTitle(const Session& session, const std::string& pane, const volume::DatasetInfo& info) {
    const std::string own = ownText(session, pane, info);
    std::string usual = paneTitle(session, pane);
    if (own.empty()) return usual;
    const bool twice = std::ranges::any_of(session.views, [&](const auto& each) {
        return each.first != pane && ownText(session, each.first, info) == own;
    });
    return twice ? own + " (" + usual + ")" : own;
}

} // namespace tessera::app
