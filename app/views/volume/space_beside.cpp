#include "app/views/volume/space_beside.h"

#include "app/pane/shown_plane.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
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
    glm::dvec4 point = along.pointAt(session.cursor, session.time);
    if (const auto cut = planeShown(session, space); cut && along.plane && cut->solved == along.plane->solved)
        point = cut->pointAt(session.cursor); // as it is being moved
    point = glm::clamp(point, glm::dvec4(space.bounds.lo, space.times.front()),
                       glm::dvec4(space.bounds.hi, space.times.back()));
    inner.cursor = glm::dvec3(point);
    inner.time = point.w;
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

void takeFromSpace(Session& session, const Session& before, const Session& edited, const volume::DatasetInfo& along,
                   const volume::DatasetInfo& space) {
    if (!session.data.timeAxis || !edited.data.timeAxis) return;
    session.camera = edited.camera;
    session.data.timeAxis = edited.data.timeAxis;
    const bool went = edited.cursor != before.cursor, moved = edited.data.timeAxis != before.data.timeAxis;
    if (!went && !moved) return;
    glm::dvec4 point(edited.cursor, before.time);
    auto cut = planeShown(session, space);
    if (cut && went && !cut->holds(point)) {
        session.data.timeAxis = volume::movedTo(*cut, *session.data.timeAxis, point);
        cut = planeShown(session, space);
    }
    if (!cut || !along.plane || cut->solved != along.plane->solved) return; // until the data are those of the plane
    // The cross-hair goes along with the plane, at the time shown.
    const glm::dvec3 normal(cut->normal);
    if (moved && glm::dot(normal, normal) > 0)
        point -= glm::dvec4((glm::dot(cut->normal, point) + cut->e) / glm::dot(normal, normal) * normal, 0);
    point = glm::clamp(point, cut->lo, cut->hi);
    for (int a = 0; a < 3; ++a)
        if (point[a] != before.cursor[a] && a != cut->solved) session.cursor[a] = point[a];
}

} // namespace tessera::app
