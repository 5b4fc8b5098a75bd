#include "app/pane/axis_label.h"
#include "app/pane/view_parts.h"
#include "app/ui/number_field.h"
#include "app/ui/ticks.h"
#include "app/views/slices/slice_figure.h"
#include "volume/base/error.h"
#include "volume/field/time_pair.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostRows = 6; ///< where the user has not chosen

struct SliceMatrixCache : ViewCache {
    std::vector<vis::ViewTargetPtr> targets;
};

/// The longer axis of a slice lies level.
SliceAxes axesOf(volume::SpaceAxis axis, const vis::WorldFrame& world) {
    const int normal = static_cast<int>(axis);
    SliceAxes out{normal == 0 ? 1 : 0, normal == 2 ? 1 : 2, normal};
    if (world.halfSize[out.up] > world.halfSize[out.right]) std::swap(out.right, out.up);
    return out;
}

/// Position of plane `index` of `count`: the middle of its share of the box.
double planePosition(const volume::Box& bounds, int axis, int index, int count) {
    return bounds.lo[axis] + bounds.size()[axis] * (index + 0.5) / count;
}

void drawSlice(ViewContext& context, vis::ViewTargetPtr& target, const std::string& channel, const SliceAxes& axes,
               double position, ImVec2 min, glm::ivec2 pixels, double budget) {
    const volume::DatasetInfo& info = context.source->info();
    vis::Scene scene = sceneWithLimits(context);
    scene.paper.reset();
    scene.camera = vis::planeCamera(axes.right, axes.up, vis::worldFrame(info.bounds, context.session.stretch));
    scene.showBox = false;
    vis::SliceLayer layer;
    layer.channel = channel;
    layer.orientation = static_cast<vis::SliceOrientation>(axes.normal);
    scene.layers = {vis::Layer{"slice", true, layer}};
    scene.lenses.clear();
    scene.cursor = info.bounds.center();
    scene.cursor[axes.normal] = position;
    if (!target) target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = pixels;
    request.budgetMs = budget;
    request.moving = !context.headless && (context.interacting || context.session.animation.playing);
    request.wait = context.headless;
    const vis::FrameStatus status = context.renderer.render(*target, scene, request);
    context.follow(status);
    const ImVec2 max{min.x + static_cast<float>(pixels.x), min.y + static_cast<float>(pixels.y)};
    addPicture(*ImGui::GetWindowDrawList(), status.texture, min, max);
    if (context.decoration.box) ImGui::GetWindowDrawList()->AddRect(min, max, plotColors().frame);
}

/// Every slice as numbers: plane, position in it, values.
std::string sliceCsv(const volume::BrickSource& source, const std::vector<int>& channels, const SliceAxes& axes,
                     int planes, const volume::TimePair& time, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const std::vector<volume::Channel> all = info.channels();
    std::string csv = "x,y,z";
    for (const int channel : channels) {
        const volume::Channel& own = all[static_cast<std::size_t>(channel)];
        csv += "," + csvField(titleWithUnit(own.name, own.unit));
    }
    csv += "\n";
    const glm::dvec3 size = info.bounds.size();
    const double longest = std::max(size[axes.right], size[axes.up]);
    const auto places = [&](int axis) {
        return std::max(2, static_cast<int>(std::lround(kSliceCells * (longest > 0 ? size[axis] / longest : 1))));
    };
    const int across = places(axes.right), up = places(axes.up);
    for (int plane = 0; plane < planes; ++plane)
        for (int j = 0; j < up; ++j) {
            progress.advance((plane + static_cast<double>(j) / up) / planes);
            std::vector<glm::dvec3> row;
            for (int i = 0; i < across; ++i) {
                glm::dvec3 at(0);
                at[axes.normal] = planePosition(info.bounds, axes.normal, plane, planes);
                // The last ones lie on the border exactly: beyond it there are no values.
                at[axes.right] = std::lerp(info.bounds.lo[axes.right], info.bounds.hi[axes.right], i / (across - 1.0));
                at[axes.up] = std::lerp(info.bounds.lo[axes.up], info.bounds.hi[axes.up], j / (up - 1.0));
                row.push_back(at);
            }
            std::vector<std::vector<volume::ProbeValue>> values;
            for (const int channel : channels) values.push_back(volume::probeAlong(source, channel, row, time));
            for (std::size_t i = 0; i < row.size(); ++i) {
                csv += csvNumber(row[i].x) + "," + csvNumber(row[i].y) + "," + csvNumber(row[i].z);
                for (const auto& column : values) csv += "," + csvNumber(column[i].interpolated.value_or(std::nan("")));
                csv += "\n";
            }
        }
    return csv;
}

/// The slices as vector graphics.
VectorPage sliceDrawing(const volume::BrickSource& source, const Session& session, const std::vector<int>& channels,
                        const SliceAxes& axes, int planes, const Progress& progress) {
    std::vector<FigurePanel> panels;
    for (const int channel : channels)
        for (int plane = 0; plane < planes; ++plane) {
            progress.advance(static_cast<double>(panels.size()) /
                             static_cast<double>(channels.size() * static_cast<std::size_t>(planes)));
            panels.push_back(slicePanel(source, session, channel, axes,
                                        planePosition(source.info().bounds, axes.normal, plane, planes)));
        }
    return drawingOf(panels, planes);
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
    const volume::TimePair time = volume::timesAround(info.times, context.session.time);
    exportMenu(
        context, tools,
        {.name = "slices",
         .figure =
             [source = context.numbers, session = context.session, shown, axes,
              planes = view.planes](const PageForm&, const Progress& progress) {
                 return sliceDrawing(*source, session, shown, axes, planes, progress);
             },
         .csv = [source = context.numbers, shown, axes, planes = view.planes,
                 time](const Progress& progress) { return sliceCsv(*source, shown, axes, planes, time, progress); }});
    if (tools.fits(ImGui::CalcTextSize(directions.c_str()).x)) drawNote(tools, directions);
}

/// Where a plane lies, in as many words as its column has room for. `position` and `size`: on its axis.
void drawPlace(ImDrawList& draw, ImVec2 at, const AxisLabel& axis, double position, double size, float width) {
    const LengthUnit& unit = axis.unit;
    const double digits = size * unit.perUnit / 100;
    const std::string number = formatNumber(position * unit.perUnit, digits),
                      length = formatQuantity(position * unit.perUnit, unit.name, digits),
                      whole = std::string(axis.name) + " = " + length;
    const std::string text = firstThatFits({whole, length, number}, width);
    const ImVec2 room = ImGui::CalcTextSize(text.c_str());
    draw.AddText(at, plotColors().text, text.c_str());
    tellWhole(at, {at.x + room.x, at.y + room.y}, whole, text);
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
    const vis::WorldFrame world = vis::worldFrame(info.bounds, context.session.stretch);
    const SliceAxes axes = axesOf(view.axis, world);
    view.planes = std::clamp(view.planes, 1, 12);
    if (!context.figure) drawToolbar(context, view, shown, axes);
    if (shown.empty()) return drawHint("No parameters", "This data set has only labels.");
    const double worldX = world.halfSize[axes.right], worldY = world.halfSize[axes.up];
    if (!(worldX > 0) || !(worldY > 0)) return drawHint("No extent", "The data have no extent within these planes.");

    const std::vector<volume::Channel> channels = info.channels();
    const float title = em() * 1.5f, gap = em() * 0.4f, head = em() * 1.3f;
    const float legend = ImGui::GetContentRegionAvail().x < em() * 20 ? 0 : em() * 5;
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ImVec2 room{ImGui::GetContentRegionAvail().x,
                      heightAtLeast(head + (em() * 1.8f + gap) * static_cast<float>(shown.size()))};
    const float cellX = (room.x - title - legend) / static_cast<float>(view.planes) - gap;
    const float cellY = (room.y - head) / static_cast<float>(shown.size()) - gap;
    if (cellX < em()) return drawHint("Not enough room", "Enlarge the pane, or show fewer planes.");
    const double scale = std::min(static_cast<double>(cellX) / worldX, static_cast<double>(cellY) / worldY);
    const glm::ivec2 pixels(std::max(1.0, std::floor(worldX * scale)), std::max(1.0, std::floor(worldY * scale)));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    const AxisLabel along = axisLabels(context.session, info)[static_cast<std::size_t>(axes.normal)];
    // Narrow slices stand close together, but not closer than their titles.
    const float pitch = std::min(cellX, std::max(static_cast<float>(pixels.x), em() * 6.5f)) + gap;
    cache.targets.resize(shown.size() * static_cast<std::size_t>(view.planes));
    for (int plane = 0; plane < view.planes; ++plane) {
        const double position = planePosition(info.bounds, axes.normal, plane, view.planes);
        const float x = std::round(origin.x + title + pitch * static_cast<float>(plane));
        if (context.decoration.title)
            drawPlace(draw, {x, origin.y}, along, position, info.bounds.size()[axes.normal], pitch - gap);
        for (std::size_t row = 0; row < shown.size(); ++row) {
            const float y = std::round(origin.y + head + (cellY + gap) * static_cast<float>(row));
            const volume::Channel& channel = channels[static_cast<std::size_t>(shown[row])];
            drawSlice(context,
                      cache.targets[row * static_cast<std::size_t>(view.planes) + static_cast<std::size_t>(plane)],
                      channel.name, axes, position, {x, y}, pixels, 40.0 / static_cast<double>(cache.targets.size()));
            if (plane > 0) continue;
            if (context.decoration.legend && legend > 0)
                drawLegendColumn(draw, {origin.x + title + pitch * static_cast<float>(view.planes), y},
                                 static_cast<float>(pixels.y), legendOf(context.session, info, shown[row]));
            if (context.decoration.title)
                addTextUpwards(draw, {origin.x + em() * 0.6f, y + static_cast<float>(pixels.y) / 2}, colors.text,
                               rowTitle(channel, static_cast<float>(pixels.y) + gap).c_str());
        }
    }
    // A click moves the linked cursor there.
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!ImGui::IsWindowHovered() || !ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return;
    const float inX = (mouse.x - origin.x - title) / pitch, inY = (mouse.y - origin.y - head) / (cellY + gap);
    if (inX < 0 || inY < 0 || inX >= static_cast<float>(view.planes) || inY >= static_cast<float>(shown.size())) return;
    const float u = (inX - std::floor(inX)) * pitch / static_cast<float>(pixels.x),
                v = 1 - (inY - std::floor(inY)) * (cellY + gap) / static_cast<float>(pixels.y);
    if (u > 1 || v < 0) return;
    glm::dvec3& cursor = context.session.cursor;
    cursor[axes.normal] = planePosition(info.bounds, axes.normal, static_cast<int>(inX), view.planes);
    cursor[axes.right] = glm::mix(info.bounds.lo[axes.right], info.bounds.hi[axes.right], static_cast<double>(u));
    cursor[axes.up] = glm::mix(info.bounds.lo[axes.up], info.bounds.hi[axes.up], static_cast<double>(v));
}

} // namespace tessera::app
