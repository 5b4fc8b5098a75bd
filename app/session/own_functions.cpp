#include "app/session/own_functions.h"

#include "app/session/shown_scene.h"
#include "vis/glyphs/glyph_parts.h"

#include <algorithm>
#include <utility>

namespace tessera::app {

std::vector<OwnFunction> ownFunctions(const Session& session) {
    std::vector<OwnFunction> out;
    const auto add = [&](const std::string& name, const std::string& channel) {
        const bool known = std::ranges::any_of(out, [&](const OwnFunction& each) { return each.name == name; });
        if (!name.empty() && !known) out.push_back({name, channel});
    };
    for (const auto* layers : layerLists(session))
        for (const vis::Layer& layer : *layers) add(layer.transfer, channelOfFunction(layer.technique));
    for (const auto& [pane, view] : session.views)
        if (const auto* cube = std::get_if<ShadowCubeView>(&view))
            for (const Wall* wall : ShadowCubeView::walls(*cube)) add(wall->transfer, wall->channel);
    return out;
}

std::optional<OwnFunction> ownFunction(const Session& session, const std::string& name) {
    const std::vector<OwnFunction> all = ownFunctions(session);
    const auto found = std::ranges::find(all, name, &OwnFunction::name);
    return found == all.end() ? std::nullopt : std::optional(*found);
}

namespace {

/// Views of the transfer function that show `former` show `now`.
void showInstead(Session& session, const std::string& former, const std::string& now) {
    for (auto& [pane, view] : session.views)
        if (auto* const shown = std::get_if<TransferView>(&view); shown && shown->channel == former)
            shown->channel = now;
}

} // namespace

void removeUnused(Session& session, const std::vector<OwnFunction>& before, const volume::DatasetInfo& info) {
    for (const auto& [name, channel] : before) {
        if (ownFunction(session, name) || info.findChannel(name)) continue;
        session.transfer.erase(name);
        showInstead(session, name, channel);
    }
}

void dropFormerFunction(Session& session, vis::Layer& layer, const std::vector<OwnFunction>& before,
                        const volume::DatasetInfo& info) {
    const auto own = std::ranges::find(before, layer.transfer, &OwnFunction::name);
    if (own == before.end() || own->channel == channelOfFunction(layer.technique)) return;
    layer.transfer.clear();
    removeUnused(session, before, info);
}

const std::string& channelOfFunction(const vis::Technique& technique) {
    const auto* surface = std::get_if<vis::IsoLayer>(&technique);
    if (surface && !surface->colorBy.empty()) return surface->colorBy;
    if (const auto* glyphs = std::get_if<vis::GlyphLayer>(&technique)) return vis::glyphColorChannel(*glyphs);
    return vis::shownChannel(technique);
}

std::size_t selectedLayer(const Session& session) {
    for (const auto& [pane, view] : session.views)
        if (const auto* layers = std::get_if<LayersView>(&view)) {
            const auto chosen = std::size_t(std::max(layers->selected, 0));
            return chosen < session.layers.size() ? chosen : 0;
        }
    return 0;
}

std::string shownFunction(const Session& session, const TransferView& view) {
    if (!view.channel.empty() || session.layers.empty()) return view.channel;
    const vis::Layer& layer = session.layers[selectedLayer(session)];
    return layer.transfer.empty() ? channelOfFunction(layer.technique) : layer.transfer;
}

void followSelectedLayer(Session& session) {
    for (auto& [pane, view] : session.views)
        if (auto* const shown = std::get_if<TransferView>(&view)) shown->channel.clear();
}

void setOwnFunction(Session& session, std::string& transfer, const std::string& channel, bool own,
                    const std::string& name) {
    const auto now = session.transfer.find(transfer.empty() ? channel : transfer);
    const vis::TransferFunction function = now == session.transfer.end() ? vis::TransferFunction() : now->second;
    std::string free = name;
    while (own && session.transfer.contains(free)) free += "'";
    if (own) session.transfer[free] = function;
    const std::string former = std::exchange(transfer, own ? free : "");
    if (!own && !ownFunction(session, former)) session.transfer.erase(former);
    for (auto& [pane, view] : session.views)
        if (auto* const shown = std::get_if<TransferView>(&view); shown && (own || shown->channel == former))
            shown->channel = own ? free : channel;
}

} // namespace tessera::app
