#include "app/views/data/plane_setting.h"

#include "app/pane/shown_plane.h"
#include "app/ui/parameter_widget.h"

#include <cmath>
#include <imgui.h>

namespace tessera::app {

namespace {

/// The same plane by its equation.
volume::PlaneEquation equationOf(const volume::SpaceTimePlane& plane) {
    return {plane.normal.x, plane.normal.y, plane.normal.z, plane.normal.w, plane.e};
}

void drawFaint(const std::string& text) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopTextWrapPos();
}

} // namespace

void drawPlaneSetting(ViewContext& context) {
    const volume::DatasetInfo& info = context.numbers->info();
    std::optional<volume::TimeAxis>& wanted = context.session.data.timeAxis;
    if (!wanted) {
        if (info.times.size() < 2) return drawFaint("The data have one time: a plane in space and time needs several.");
        drawFaint("The data are shown themselves, at one time.");
        if (context.runCommand && ImGui::SmallButton("Show a plane in space and time"))
            context.runCommand("Plane in space and time");
        return;
    }
    const bool byEquation = wanted->equation.has_value();
    const std::shared_ptr<const volume::BrickSource> space = context.origin.spaceOfPlane;
    const auto meant = space ? planeShown(context.session, space->info()) : info.plane;
    drawDescribed(*wanted, WidgetContext{.info = &info, .path = "/data/timeAxis"});
    if (!byEquation && wanted->equation && meant) wanted->equation = equationOf(*meant); // goes on from the angle
    if (space && !planeShown(context.session, space->info()))
        drawFaint("This plane does not meet the data: what was shown before stays.");
    if (info.plane) drawFaint(planeText(info, *info.plane));
    drawFaint("Values are linear between the samples and between the times of the data, and theirs where both are "
              "stored; beyond the data nothing is there.");
    if (!context.runCommand || !ImGui::SmallButton("Show the data themselves")) return;
    const bool alongAxis = !wanted->equation && std::abs(wanted->degrees) == 90;
    const std::string axis(volume::kSpaceAxisNames[std::size_t(wanted->axis)]);
    context.runCommand(alongAxis ? "Time along " + axis : "Plane in space and time"); // that goes back
}

} // namespace tessera::app
