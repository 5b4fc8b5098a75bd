#include "app/pane/view_parts.h"
#include "app/planes/plane_export.h"
#include "app/planes/plane_pane.h"
#include "app/ui/number_field.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostRows = 6; ///< where the user has not chosen

struct SliceMatrixCache : ViewCache {
    std::vector<PlaneState> slices; ///< plane by plane of each parameter
};

/// The longer axis of a slice lies level.
SliceAxes axesOf(volume::SpaceAxis axis, const vis::WorldFrame& world) {
    const int normal = static_cast<int>(axis);
    SliceAxes out{normal == 0 ? 1 : 0, normal == 2 ? 1 : 2, normal};
    if (world.halfSize[out.up] > world.halfSize[out.right]) std::swap(out.right, out.up);
    return out;
}

/// Position of plane `index` of `count`: the middle of its share of the box as it is drawn.
double planePosition(const volume::DatasetInfo& info, int axis, int index, int count) {
    const volume::Box& bounds = info.bounds;
    return info.lattice.axes.toSpace(axis, bounds.lo[axis] + bounds.size()[axis] * (index + 0.5) / count);
}

PlanePicture matrixSlice(const Session& session, const volume::DatasetInfo& info, const SliceMatrixView& view,
                         const SliceAxes& axes, int channel, int plane) {
    return axisPlane(session, info, axes, planePosition(info, axes.normal, plane, view.planes),
                     {.channel = channel, .plain = true});
}

/// With the unit where there is room for both.
std::string rowTitle(const volume::Channel& channel, float room) {
    const std::string whole = titleWithUnit(channel.name, channel.unit);
    return ImGui::CalcTextSize(whole.c_str()).x <= room ? whole : fitText(channel.name, room);
}

void chooseAxis(volume::SpaceAxis& axis, const std::string& directions) {
    ImGui::SetNextItemWidth(em() * 3.4f);
    if (ImGui::BeginCombo("##axis", volume::kSpaceAxisNames[static_cast<std::size_t>(axis)].data())) {
        for (int i = 0; i < 3; ++i)
            if (ImGui::Selectable(volume::kSpaceAxisNames[i].data(), static_cast<int>(axis) == i))
                axis = static_cast<volume::SpaceAxis>(i);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip(("Axis perpendicular to the planes; " + directions).c_str());
}

void drawToolbar(ViewContext& context, SliceMatrixView& view, const std::vector<int>& shown, const SliceAxes& axes) {
    const volume::DatasetInfo& info = context.source->info();
    const AxisLabels labels = axisLabels(context.session, info);
    const std::string directions = std::string(labels[static_cast<std::size_t>(axes.right)].name) + " to the right, " +
                                   labels[static_cast<std::size_t>(axes.up)].name + " up";
    ToolRow tools(context);
    chooseChannels(tools, info, view.channels, shown);
    if (tools.next(em() * 3.4f)) chooseAxis(view.axis, directions);
    if (tools.next(em() * 6)) {
        ImGui::SetNextItemWidth(em() * 6);
        slider("##planes", view.planes, 1, 12, view.planes == 1 ? "%d plane" : "%d planes");
    }
    std::vector<PlanePicture> slices; // with a row for each parameter
    for (const int channel : shown)
        for (int plane = 0; plane < view.planes; ++plane)
            slices.push_back(matrixSlice(context.session, drawnSource(context)->info(), view, axes, channel, plane));
    exportPlanes(context, tools, "slices", std::move(slices), view.planes, shown);
    if (tools.fits(ImGui::CalcTextSize(directions.c_str()).x)) drawNote(tools, directions);
}

/// Where a plane lies, in as many words as its column has room for.
void drawPlace(ImDrawList& draw, ImVec2 at, const PlanePicture& slice, float width) {
    const std::string length = slice.place.substr(slice.place.find(" = ") + 3);
    const std::string text = firstThatFits({slice.place, length, length.substr(0, length.find(' '))}, width);
    const ImVec2 room = ImGui::CalcTextSize(text.c_str());
    draw.AddText(at, plotColors().text, text.c_str());
    tellWhole(at, {at.x + room.x, at.y + room.y}, slice.place, text);
}

} // namespace

void drawSliceMatrixView(ViewContext& context, const std::string& pane, SliceMatrixView& view) {
    if (!context.source) {
        drawHint("No data", "Shows every parameter on several planes.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    SliceMatrixCache& cache = cacheOf<SliceMatrixCache>(context, pane);
    const std::vector<int> shown = chosenChannels(info, view.channels, kMostRows);
    const vis::WorldFrame world = vis::worldFrame(info, context.session.stretch);
    const SliceAxes axes = axesOf(view.axis, world);
    view.planes = std::clamp(view.planes, 1, 12);
    drawToolbar(context, view, shown, axes);
    drawStretch(context);
    if (shown.empty()) return drawHint("No parameters", "This data set has only labels.");
    if (!(world.halfSize[axes.right] > 0) || !(world.halfSize[axes.up] > 0))
        return drawHint("No extent", "The data have no extent within these planes.");

    const float title = em() * 1.5f, gap = em() * 0.4f, head = em() * 1.3f;
    float legend = 0;
    if (ImGui::GetContentRegionAvail().x >= em() * 20)
        for (const int channel : shown)
            legend =
                std::max({legend, em() * 5, legendColumnWidth(legendOf(context.session, info, channel)) + em() * 0.5f});
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ImVec2 room{ImGui::GetContentRegionAvail().x,
                      heightAtLeast(head + (em() * 1.8f + gap) * static_cast<float>(shown.size()))};
    const float cellX = (room.x - title - legend) / static_cast<float>(view.planes) - gap;
    const float cellY = (room.y - head) / static_cast<float>(shown.size()) - gap;
    if (cellX < em()) return drawHint("Not enough room", "Enlarge the pane, or show fewer planes.");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    cache.slices.resize(shown.size() * static_cast<std::size_t>(view.planes));
    for (int plane = 0; plane < view.planes; ++plane)
        for (std::size_t row = 0; row < shown.size(); ++row) {
            const std::size_t index = row * static_cast<std::size_t>(view.planes) + static_cast<std::size_t>(plane);
            const PlanePicture slice = matrixSlice(context.session, info, view, axes, shown[row], plane);
            PlaneFrame frame = planeFrame(slice, world, info.bounds, {}, planeScale(slice, {}, {cellX, cellY}, 0));
            const float wide = frame.plot.max.x, high = frame.plot.max.y;
            // Narrow slices stand close together, but not closer than their titles.
            const float pitch = std::min(cellX, std::max(wide, em() * 6.5f)) + gap;
            const ImVec2 at{std::round(origin.x + title + pitch * static_cast<float>(plane)),
                            std::round(origin.y + head + (cellY + gap) * static_cast<float>(row))};
            frame.plot.min = at, frame.plot.max = {at.x + wide, at.y + high};
            ImGui::PushID(static_cast<int>(index));
            useMouse(context, cache.slices[index], slice, frame);
            ImGui::PopID();
            drawPicture(context, cache.slices[index], slice, frame, 1 / static_cast<double>(cache.slices.size()),
                        pane + std::to_string(index));
            drawOver(context, cache.slices[index], slice, frame, {});
            if (row == 0 && context.decoration.title) drawPlace(draw, {at.x, origin.y}, slice, pitch - gap);
            if (plane > 0) continue;
            if (context.decoration.legend && legend > 0)
                drawLegendColumn(draw, {origin.x + title + pitch * static_cast<float>(view.planes), at.y}, high,
                                 legendOf(context.session, info, shown[row]));
            if (context.decoration.title)
                addTextUpwards(draw, {origin.x + em() * 0.6f, at.y + high / 2}, plotColors().text,
                               rowTitle(info.channel(shown[row]), high + gap).c_str());
        }
}

} // namespace tessera::app
