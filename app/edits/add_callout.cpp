#include "app/edits/add_callout.h"

#include <algorithm>

namespace tessera::app {

namespace {

bool showsPlace(const Callout& callout, CalloutOf of, const std::string& placeholder) {
    return callout.of == of && callout.placeholder == placeholder;
}

} // namespace

bool takesCallout(const Session& session) {
    return session.callouts.size() < kMostCallouts;
}

std::string parameterToCompare(const Session& session, const volume::DatasetInfo& info, CalloutOf of,
                               const std::string& placeholder) {
    const std::vector<int> scalars = scalarChannels(info);
    std::vector<std::string> taken;
    for (const Callout& each : session.callouts) {
        if (!showsPlace(each, of, placeholder)) continue;
        const bool scene = each.kind == CalloutKind::Scene;
        if (scene && each.layers)
            for (const vis::Layer& layer : *each.layers) taken.push_back(vis::shownChannel(layer.technique));
        else if (!scene && !each.channel.empty())
            taken.push_back(each.channel);
        else if (!session.layers.empty())
            taken.push_back(vis::shownChannel(session.layers.front().technique));
    }
    for (const int channel : scalars)
        if (std::string name = info.channel(channel).name; std::ranges::find(taken, name) == taken.end()) return name;
    return scalars.empty() ? std::string() : info.channel(scalars.front()).name;
}

std::size_t addCallout(Session& session, const volume::DatasetInfo& info, CalloutOf of,
                       const std::string& placeholder) {
    Callout callout{.of = of, .placeholder = placeholder};
    const bool further =
        std::ranges::any_of(session.callouts, [&](const Callout& each) { return showsPlace(each, of, placeholder); });
    if (of == CalloutOf::Plane || further) callout.kind = CalloutKind::Slice;
    if (further) callout.channel = parameterToCompare(session, info, of, placeholder);
    session.callouts.push_back(std::move(callout));
    for (auto& [pane, view] : session.views)
        if (auto* const volume = std::get_if<VolumeView>(&view)) volume->showCallouts = true;
    return session.callouts.size() - 1;
}

std::string firstPlane(const Session& session) {
    for (const auto& [pane, view] : session.views)
        if (std::holds_alternative<ObliqueView>(view)) return pane;
    for (const vis::Layer& layer : session.layers)
        if (const auto* slice = std::get_if<vis::SliceLayer>(&layer.technique);
            slice && layer.visible && slice->atCursor && slice->orientation != vis::SliceOrientation::Oblique)
            return std::string(1, "xyz"[static_cast<int>(slice->orientation)]);
    return "z";
}

void renameCallouts(Session& session, CalloutOf of, const std::string& before, const std::string& now) {
    if (before.empty() && of != CalloutOf::Brush) return; // a name of a brush is empty while it is typed anew
    for (Callout& each : session.callouts)
        if (showsPlace(each, of, before)) each.placeholder = now;
}

void removeCallouts(Session& session, CalloutOf of, const std::string& placeholder) {
    std::erase_if(session.callouts, [&](const Callout& each) { return showsPlace(each, of, placeholder); });
}

} // namespace tessera::app
