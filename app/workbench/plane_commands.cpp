#include "app/session/shown_scene.h"
#include "app/workbench/fit_box.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <algorithm>
#include <cmath>
#include <optional>

/// Planes of the data in space and time in place of the data: time along an axis, or at an angle.
namespace tessera::app {

namespace {

/// The panes of volume views, those of the data in space beside a plane of theirs last.
std::vector<std::string> volumePanes(const Session& session) {
    std::vector<std::string> panes, inSpace;
    for (const auto& [pane, view] : session.views)
        if (const auto* volume = std::get_if<VolumeView>(&view)) (volume->inSpace ? inSpace : panes).push_back(pane);
    panes.insert(panes.end(), inSpace.begin(), inSpace.end());
    return panes;
}

/// Where a pane beside a volume view leaves the box larger in both: to its right or below it.
DockSide roomierSide(const Session& session, const std::string& pane, const std::string& beside,
                     const vis::WorldFrame& world, float scale) {
    const auto distance = [&](DockSide side) {
        Session tried = session;
        insertPane(tried.dock, pane, stackWith(tried.dock.root, beside), side);
        fitToPane(tried, beside, world, scale);
        const VolumeView* const view = volumeView(tried, beside);
        return view->camera ? view->camera->distance : tried.camera.distance;
    };
    return distance(DockSide::Bottom) < distance(DockSide::Right) ? DockSide::Bottom : DockSide::Right;
}

/// Opens a view of the data in space beside the first volume view, or closes it.
void showSpaceBeside(Session& session, bool wanted, const vis::WorldFrame& world, float scale) {
    const auto inSpace = [](const auto& view) {
        const auto* volume = std::get_if<VolumeView>(&view.second);
        return volume && volume->inSpace;
    };
    if (!wanted) {
        std::erase_if(session.views, inSpace);
        repair(session.dock, paneKeys(session));
        return;
    }
    const auto first = std::ranges::find_if(
        session.views, [](const auto& view) { return std::holds_alternative<VolumeView>(view.second); });
    if (first == session.views.end() || std::ranges::any_of(session.views, inSpace)) return;
    const std::string beside = first->first;
    VolumeView view = std::get<VolumeView>(first->second);
    view.inSpace = true;
    const std::string pane = addView(session, view);
    session.dock.maximised.clear();
    if (const int id = stackWith(session.dock.root, beside))
        insertPane(session.dock, pane, id, roomierSide(session, pane, beside, world, scale));
}

bool isTimeAlong(const DataRef& data, volume::SpaceAxis axis) {
    return data.timeAxis && data.timeAxis->axis == axis && std::abs(data.timeAxis->degrees) == 90 &&
           !data.timeAxis->equation;
}

bool isAtAnAngle(const DataRef& data) {
    return data.timeAxis && (std::abs(data.timeAxis->degrees) != 90 || data.timeAxis->equation);
}

/// Shows a plane through the cross-hair and the time shown, or the data themselves.
void showPlane(Workbench& workbench, std::optional<volume::TimeAxis> plane) {
    DataRef data = workbench.session().data;
    const volume::DatasetInfo& info = workbench.document().info();
    const volume::Box& box = info.bounds;
    if (plane) {
        // The cross-hair may lie outside of the box.
        const int a = static_cast<int>(plane->axis);
        const double place = (workbench.session().cursor[a] - box.lo[a]) / box.size()[a];
        plane->place = std::clamp(place, 0.0, 1.0);
        const double duration = info.times.back() - info.times.front();
        const double time = (workbench.session().time - info.times.front()) / duration;
        if (std::abs(plane->degrees) != 90) plane->time = std::clamp(time, 0.0, 1.0);
    }
    data.timeAxis = plane;
    // Half the room, or twice as much, for the same box: it has the same extent in space and over time.
    Session& session = workbench.session();
    const float scale = workbench.look().scale();
    const vis::WorldFrame world = vis::worldFrame(box, session.stretch);
    const std::vector<std::string> panes = volumePanes(session);
    const bool whole = !panes.empty() && seesWholeBox(session, panes.front(), world, scale);
    showSpaceBeside(session, data.timeAxis.has_value(), world, scale);
    if (whole)
        for (const std::string& pane : volumePanes(session)) fitToPane(session, pane, world, scale);
    workbench.data().show(data, "Plane in space and time");
}

/// Whether a plane in space and time can be shown in place of the data.
bool canShowPlane(Workbench& workbench, volume::SpaceAxis axis) {
    const volume::DatasetInfo& info = workbench.document().info();
    return !workbench.session().data.timeAxis && info.times.size() > 1 &&
           info.bounds.size()[static_cast<int>(axis)] > 0;
}

volume::SpaceAxis longestAxis(const volume::DatasetInfo& info) {
    const glm::dvec3 size = info.bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return static_cast<volume::SpaceAxis>(axis);
}

} // namespace

std::vector<Command> planeCommands(Workbench& workbench) {
    std::vector<Command> commands;
    for (const auto axis : {volume::SpaceAxis::X, volume::SpaceAxis::Y, volume::SpaceAxis::Z}) {
        const auto shown = [&workbench, axis] { return isTimeAlong(workbench.session().data, axis); };
        const auto possible = [&workbench, axis] { return canShowPlane(workbench, axis); };
        commands.push_back({.menu = "Edit",
                            .name = (axis == volume::SpaceAxis::X ? "-Time along " : "Time along ") +
                                    std::string(volume::kSpaceAxisNames[std::size_t(axis)]),
                            .help = "Show the plane through the cross-hair at all times, with time along this axis, "
                                    "beside the data in space",
                            .words = "axis plane space-time kymograph hovmoller",
                            .run =
                                [&workbench, axis, shown] {
                                    showPlane(workbench,
                                              shown() ? std::nullopt : std::optional(volume::TimeAxis{.axis = axis}));
                                },
                            .enabled = [&workbench, shown,
                                        possible] { return workbench.document().loaded() && (shown() || possible()); },
                            .checked = shown});
    }
    const auto shown = [&workbench] { return isAtAnAngle(workbench.session().data); };
    commands.push_back({.menu = "Edit",
                        .name = "Plane in space and time",
                        .help = "Show a plane that moves through the data as time goes on, by an angle or an equation, "
                                "beside the data in space",
                        .words = "hyperplane slice 4D shear moving frame space-time angle equation",
                        .run =
                            [&workbench, shown] {
                                const volume::SpaceAxis axis = longestAxis(workbench.document().info());
                                showPlane(workbench,
                                          shown() ? std::nullopt
                                                  : std::optional(volume::TimeAxis{.axis = axis, .degrees = 45}));
                            },
                        .enabled =
                            [&workbench, shown] {
                                return workbench.document().loaded() &&
                                       (shown() || canShowPlane(workbench, longestAxis(workbench.document().info())));
                            },
                        .checked = shown});
    return commands;
}

} // namespace tessera::app
