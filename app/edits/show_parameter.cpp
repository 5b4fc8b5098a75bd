#include "app/edits/show_parameter.h"

#include "app/session/session_json.h"
#include "volume/field/time_pair.h"

#include <algorithm>

namespace tessera::app {

void followChannel(std::string& name, const std::string& before, const std::string& now) {
    if (before.empty() || before == now) return;
    if (name == before || name.starts_with(before + " "))
        name = now + name.substr(before.size());
    else if (name.ends_with(" of " + before))
        name = name.substr(0, name.size() - before.size()) + now;
}

namespace {

template <class Technique> vis::Layer* firstLayer(Session& session) {
    for (vis::Layer& layer : session.layers)
        if (layer.lens.empty() && std::holds_alternative<Technique>(layer.technique)) return &layer;
    return nullptr;
}

template <class Technique> bool showIn(Session& session, const std::string& channel) {
    vis::Layer* const layer = firstLayer<Technique>(session);
    if (layer == nullptr) return false;
    std::string& shown = std::get<Technique>(layer->technique).channel;
    followChannel(layer->name, shown, channel);
    shown = channel;
    layer->transfer.clear();
    if constexpr (requires { Technique::colorBy; }) std::get<Technique>(layer->technique).colorBy.clear();
    if (std::is_same_v<Technique, vis::VolumeLayer>) layer->visible = true;
    return true;
}

} // namespace

void showParameter(Session& session, const std::string& channel) {
    if (!showIn<vis::VolumeLayer>(session, channel) && session.layers.size() < kMostLayers)
        session.layers.insert(session.layers.begin(), {channel, true, vis::VolumeLayer{.channel = channel}});
    showIn<vis::SliceLayer>(session, channel);
    for (auto& [pane, view] : session.views)
        std::visit(
            [&]<class View>(View& own) {
                if constexpr (std::is_same_v<View, SlicesView> || std::is_same_v<View, ObliqueView> ||
                              std::is_same_v<View, TransferView>)
                    own.channel = channel;
            },
            view);
}

bool leaveReference(Session& session, const volume::DatasetInfo& info, const volume::TimeReference& from) {
    if (from.which == volume::OtherTime::Other || info.times.size() < 2) return false;
    const volume::TimePair now = volume::timesAround(info.times, session.time);
    const auto other = volume::timesOf(from, info.times, now.nearest());
    if (now.between() || (other && *other != now)) return false;
    const bool last = now.nearest() + 1 == int(info.times.size());
    session.time = last                                        ? info.times.front()
                   : from.which == volume::OtherTime::Previous ? info.times[1]
                                                               : info.times.back();
    return true;
}

} // namespace tessera::app
