#include "app/views/volume/space_beside.h"

#include "volume/sources/time_axis.h"

#include <algorithm>
#include <variant>

namespace tessera::app {

namespace {

/// True for a brush that holds values, whatever their place.
bool ofValues(const vis::Brush& brush) {
    return !std::holds_alternative<vis::SphereRegion>(brush.region) &&
           !std::holds_alternative<vis::BoxRegion>(brush.region) &&
           !std::holds_alternative<vis::LensRegion>(brush.region);
}

bool shownInSpace(const vis::Layer& layer, const volume::DatasetInfo& space) {
    if (std::holds_alternative<vis::FlowLayer>(layer.technique) || !layer.lens.empty()) return false;
    return space.findChannel(std::visit([](const auto& own) { return std::string(own.channel); }, layer.technique))
        .has_value();
}

} // namespace

std::shared_ptr<const volume::BrickSource> spaceOfPlane(const ViewContext& context) {
    return context.session.data.timeAxis ? context.origin.spaceOfPlane : nullptr;
}

Session sessionInSpace(const Session& session, const volume::DatasetInfo& along, const volume::DatasetInfo& space) {
    Session inner = session;
    const volume::TimeAxis& cut = *session.data.timeAxis;
    const int axis = static_cast<int>(cut.axis);
    inner.time =
        std::clamp(session.cursor[axis] * volume::timePerLength(along, cut), space.times.front(), space.times.back());
    inner.cursor[axis] = space.bounds.lo[axis] + cut.place * space.bounds.size()[axis];
    std::erase_if(inner.layers, [&](const vis::Layer& layer) { return !shownInSpace(layer, space); });
    std::erase_if(inner.selection.brushes, [&](const vis::Brush& brush) {
        return !ofValues(brush) || std::ranges::any_of(vis::regionChannels(brush.region), [&](const std::string& name) {
            return !space.findChannel(name).has_value();
        });
    });
    inner.lenses.clear();
    inner.callouts.clear();
    inner.views.clear();
    inner.animation.playing = false;
    return inner;
}

void takeFromSpace(Session& session, const Session& before, const Session& edited, const volume::DatasetInfo& space) {
    if (!session.data.timeAxis || !edited.data.timeAxis) return;
    session.camera = edited.camera;
    volume::TimeAxis& cut = *session.data.timeAxis;
    const int axis = static_cast<int>(cut.axis);
    cut.place = edited.data.timeAxis->place;
    for (int a = 0; a < 3; ++a) {
        if (edited.cursor[a] == before.cursor[a]) continue;
        if (a != axis)
            session.cursor[a] = edited.cursor[a];
        else if (space.bounds.size()[a] > 0)
            cut.place = std::clamp((edited.cursor[a] - space.bounds.lo[a]) / space.bounds.size()[a], 0.0, 1.0);
    }
}

} // namespace tessera::app
