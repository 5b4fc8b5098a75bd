#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/tools/brush_edit.h"
#include "app/tools/brush_list.h"
#include "app/ui/widgets.h"
#include "app/values/selection_text.h"
#include "app/views/parallel/parallel_plot.h"
#include "app/views/scatter3d/cloud_raster.h"
#include "app/views/scatter3d/cloud_table.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr float kCloudTurnPerPixel = 0.4f;
constexpr double kLeastAxisLength = 3; ///< em, of one that is named
constexpr float kLassoSoftness = 0;
constexpr double kTickTextAway = 1.1, kAxisTitleAway = 2.6; ///< of the texts of an axis from it, em

struct Scatter3dCache : ViewCache {
    AsyncDensities answers;
    BrushDrag drag;
    vis::PlotTexture texture;
    bool turning = false;
    // What the texture shows.
    std::shared_ptr<const ParallelResult> shown;
    glm::dvec2 turn{0};
    glm::ivec2 size{0};
    bool logDensity = false, dark = false;
    std::vector<ImU32> focus;
};

/// Three parameters: those chosen, then the first that vary.
std::vector<int> threeChannels(const volume::DatasetInfo& info, const std::vector<std::string>& names) {
    std::vector<int> out = names.empty() ? std::vector<int>() : chosenChannels(info, names, 3);
    for (const int channel : comparedChannels(info)) {
        const Range range = info.channelRange(info.channel(channel));
        if (out.size() < 3 && range.hi > range.lo && std::ranges::find(out, channel) == out.end())
            out.push_back(channel);
    }
    if (out.size() > 3) out.resize(3);
    return out;
}

void drawCloudToolbar(ViewContext& context, Scatter3dView& view, const std::vector<int>& channels,
                      const std::vector<ParallelAxis>& axes, const std::shared_ptr<const ParallelResult>& result) {
    const volume::DatasetInfo& info = context.numbers->info();
    ToolRow tools(context);
    static constexpr const char* kIds[] = {"##x", "##y", "##z"};
    static constexpr const char* kHelp[] = {"Parameter along x", "Parameter along y", "Parameter along z"};
    for (std::size_t a = 0; a < 3; ++a) {
        std::string name = info.channel(channels[a]).name;
        if (!tools.next(em() * 5)) continue;
        ImGui::SetNextItemWidth(em() * 5);
        if (chooseChannel(kIds[a], &info, name)) {
            view.channels.clear();
            for (const int channel : channels) view.channels.push_back(info.channel(channel).name);
            const auto other = std::ranges::find(view.channels, name);
            if (other != view.channels.end()) *other = view.channels[a]; // both change places
            view.channels[a] = name;
        }
        if (ImGui::IsItemHovered()) tooltip(kHelp[a]);
    }
    struct Facet {
        const char* name;
        glm::dvec2 turn;
    };
    static constexpr Facet kFaces[] = {{"xz", {0, 0}}, {"yz", {90, 0}}, {"xy", {0, 90}}};
    for (const Facet& face : kFaces) {
        if (!tools.next(buttonWidth(face.name), em() * 0.3f)) continue;
        if (ImGui::Button(face.name)) view.turn = face.turn;
        if (ImGui::IsItemHovered()) tooltip("Facet these axes, to draw around samples and select them");
    }
    if (tools.next(checkboxWidth("log"))) {
        ImGui::Checkbox("log", &view.logDensity);
        if (ImGui::IsItemHovered()) tooltip("Logarithmic density");
    }
    if (result)
        exportMenu(
            context, tools,
            {.name = "scatterplot-3d",
             .table = [result, axes, selected = result->brushed() ? selectionName(context.session) : std::string()](
                          const Progress&) { return cloudTable(*result, axes, selected); },
             .brushed = result->brushed()});
    if (tools.next(ImGui::GetFrameHeight(), em() * 0.3f) && // also without brushes: the cloud stays where it is
        iconButton(context, "clear", icons::kTrash, "Remove all brushes (Esc)",
                   !context.session.selection.brushes.empty()))
        clearBrushes(context);
    drawNote(tools, "drag to turn; xz, yz, xy: to draw around samples");
    drawOrigin(context, tools, channels);
}

/// The edges of the cube, and at one edge of each direction its numbers and title.
void drawCloudAxes(ImDrawList& draw, const CloudPlace& place, const std::vector<ParallelAxis>& axes) {
    const PlotColors colors = plotColors();
    const auto at = [&](glm::dvec3 shares) {
        const glm::dvec2 p = place.pixel(shares);
        return ImVec2(static_cast<float>(p.x), static_cast<float>(p.y));
    };
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        glm::dvec3 from(0), to(0), best(0);
        double outermost = -1e300;
        for (int corner = 0; corner < 4; ++corner) {
            from[u] = to[u] = corner & 1, from[v] = to[v] = corner >> 1;
            from[axis] = 0, to[axis] = 1;
            draw.AddLine(at(from), at(to), colors.frame);
            const glm::dvec2 middle = (place.pixel(from) + place.pixel(to)) * 0.5;
            const double outside = axis == 2 ? -middle.x : middle.y; // z at the left, x and y below
            if (outside > outermost) outermost = outside, best = from;
        }
        from = to = best;
        from[axis] = 0, to[axis] = 1;
        const glm::dvec2 a = place.pixel(from), b = place.pixel(to), way = b - a;
        const double length = std::hypot(way.x, way.y);
        if (length < kLeastAxisLength * double(em())) continue;
        glm::dvec2 normal(way.y / length, -way.x / length);
        const glm::dvec2 outwards = (a + b) * 0.5 - place.middle;
        if (normal.x * outwards.x + normal.y * outwards.y < 0) normal = -normal;
        ParallelAxis measured = axes[std::size_t(axis)];
        measured.top = 0, measured.bottom = static_cast<float>(length);
        const bool steep = std::abs(way.y) > std::abs(way.x);
        const TickLabels ticks = axisTicks(measured, double(em()) * (steep ? 1.0 : 2.4));
        const auto text = [&](glm::dvec2 middle, const std::string& what, ImU32 color) {
            const ImVec2 size = ImGui::CalcTextSize(what.c_str());
            draw.AddText({std::round(float(middle.x) - size.x / 2), std::round(float(middle.y) - size.y / 2)}, color,
                         what.c_str());
        };
        double widest = 0;
        for (std::size_t t = 0; t < ticks.values.size(); ++t) {
            const glm::dvec2 on = a + way * volume::axisShare(measured.density, ticks.values[t]);
            const double wide = double(ImGui::CalcTextSize(ticks.texts[t].c_str()).x) / 2;
            const double away = double(em()) * kTickTextAway + std::abs(normal.x) * wide;
            widest = std::max(widest, std::abs(normal.x) * wide * 2);
            const glm::dvec2 end = on + normal * double(em()) * 0.3;
            draw.AddLine({float(on.x), float(on.y)}, {float(end.x), float(end.y)}, colors.faint);
            text(on + normal * away, ticks.texts[t], colors.text);
        }
        const std::string title = axisTitle(measured, ticks.note);
        const double away = double(em()) * kAxisTitleAway + widest;
        const glm::dvec2 middle = (a + b) * 0.5 + normal * away;
        if (steep)
            addTextUpwards(draw, {float(middle.x), float(middle.y)}, colors.faint, title.c_str());
        else
            text(middle + normal * std::abs(normal.x) * double(ImGui::CalcTextSize(title.c_str()).x) * 0.5, title,
                 colors.faint);
    }
}

void updateCloud(ViewContext& context, Scatter3dCache& cache, const Scatter3dView& view,
                 const std::shared_ptr<const ParallelResult>& result, CloudPlace place, ImVec2 min, glm::ivec2 size) {
    const std::vector<ImU32> focus = brushGroups(context.session).colors;
    const bool dark = darkTheme();
    if (cache.shown == result && cache.turn == view.turn && cache.size == size && cache.logDensity == view.logDensity &&
        cache.dark == dark && cache.focus == focus)
        return;
    cache.shown = result, cache.turn = view.turn, cache.size = size;
    cache.logDensity = view.logDensity, cache.dark = dark, cache.focus = focus;
    place.middle -= glm::dvec2(double(min.x), double(min.y));
    const int bins = result->densities.bins;
    const GapDensity density = rasterCloud(result->densities.cube, bins, place, size.x, size.y);
    GapLook look = gapLook(view.logDensity, dark, focus);
    look.most = greatestDensity(density);
    look.unit = place.edge * place.edge / bins / bins;
    cache.texture.upload(context.renderer.textures(), size, gapPixels(density, look));
}

void cloudHover(const PlotFrame& frame, std::array<int, 2> faced, const std::vector<ParallelAxis>& axes,
                const ParallelResult& result, const std::string& selected) {
    if (!frame.contains(ImGui::GetIO().MousePos)) return;
    const glm::dvec2 at = frame.data(ImGui::GetIO().MousePos);
    const auto bins = static_cast<std::size_t>(result.densities.bins);
    std::size_t bin[3] = {0, 0, 0};
    std::string text;
    for (int k = 0; k < 2; ++k) {
        const ParallelAxis& axis = axes[std::size_t(faced[std::size_t(k)])];
        const double share = volume::axisShare(axis.density, at[k]);
        bin[faced[std::size_t(k)]] = std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, share) * double(bins)));
        text += axis.channel.name + " " + axisText(axis, at[k], k == 0 ? frame.perPixelX() : frame.perPixelY()) + "\n";
    }
    const int behind = 3 - faced[0] - faced[1];
    double all = 0, focus = 0;
    for (bin[behind] = 0; bin[behind] < bins; ++bin[behind]) {
        const std::size_t cell = (bin[0] * bins + bin[1]) * bins + bin[2];
        all += double(result.densities.cube.all[cell]);
        focus += result.densities.cube.selectedAt(cell);
    }
    text += formatCount(all) + (all == 1 ? " sample" : " samples");
    if (result.brushed() && all > 0) text += "\n" + formatShare(std::min(1.0, focus / all)) + " of them in " + selected;
    if (result.densities.level > 0) text += "\n(estimated from a coarser level)";
    ImGui::SetTooltip("%s", text.c_str());
}

/// The mouse over the picture, the last item: turns it, or where two axes face the viewer draws a lasso in their plane.
void editCloud(ViewContext& context, Scatter3dCache& cache, Scatter3dView& view, const PlotFrame* frame,
               const PlotChannels& plot) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    const int turns = frame ? ImGuiMouseButton_Middle : ImGuiMouseButton_Left;
    if (hovered && (ImGui::IsMouseClicked(turns) || ImGui::IsMouseClicked(ImGuiMouseButton_Middle)))
        cache.turning = true;
    const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Middle) || (!frame && ImGui::IsMouseDown(turns));
    if (!held && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) cache.turning = false;
    if (cache.turning && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        const double turned = view.turn.x - double(io.MouseDelta.x * kCloudTurnPerPixel);
        view.turn = {std::remainder(turned, 360.0),
                     std::clamp(view.turn.y + double(io.MouseDelta.y * kCloudTurnPerPixel), -90.0, 90.0)};
    }
    if (frame && !cache.turning) {
        editBrushes(cache.drag, context.session.selection, *frame, plot, {BrushTool::Lasso, kLassoSoftness});
        clearAfterQuestion(cache.drag, context);
    }
    if (cache.turning || cache.drag.active) context.interacting = true;
}

void drawCloudCursor(ViewContext& context, ImDrawList& draw, const CloudPlace& place,
                     const std::vector<ParallelAxis>& axes) {
    const Readout& cursor = sharedReadout(context);
    glm::dvec3 shares(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto value = cursor.value(axes[std::size_t(axis)].channel.name);
        if (!value || !axes[std::size_t(axis)].shows(*value)) return;
        shares[axis] = volume::axisShare(axes[std::size_t(axis)].density, *value);
    }
    const glm::dvec2 p = place.pixel(shares);
    draw.AddCircle({float(p.x), float(p.y)}, em() * 0.28f, plotColors().backdrop, 16, 3);
    draw.AddCircle({float(p.x), float(p.y)}, em() * 0.28f, plotColors().cursor, 16, 1.5f);
}

} // namespace

void drawScatter3dView(ViewContext& context, const std::string& pane, Scatter3dView& view) {
    if (!context.source) {
        drawHint("No data", "Shows the samples over three parameters.");
        return;
    }
    const volume::DatasetInfo& info = context.numbers->info();
    const std::vector<int> channels = threeChannels(info, view.channels);
    if (channels.size() < 3) {
        drawHint("Fewer than three parameters", "This view needs three that vary.");
        return;
    }
    Scatter3dCache& cache = cacheOf<Scatter3dCache>(context, pane);
    std::vector<ParallelAxis> axes = parallelAxes(info, {}, channels);
    std::vector<volume::DensityAxis> counted;
    for (const ParallelAxis& axis : axes) counted.push_back(axis.density);
    ParallelQuery query = parallelQuery(context.session, info, counted, view.bins);
    query.together = true;
    const std::shared_ptr<const ParallelResult> result = cache.answers.get(context, "cloud " + pane, query);
    drawCloudToolbar(context, view, channels, axes, result);

    const ImVec2 min = ImGui::GetCursorScreenPos(), room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 6)};
    const double margin = double(em()) * 5, least = double(std::min(room.x, room.y));
    CloudPlace place{
        .middle = {double(min.x + room.x / 2), double(min.y + room.y / 2)},
        .edge = std::max(double(em()) * 2, (least - margin) / (facedAxes(cloudDirections(view.turn)) ? 1.15 : 1.6)),
        .directions = cloudDirections(view.turn)};
    const glm::ivec2 size(std::max(1, int(room.x)), std::max(1, int(room.y)));
    mouseArea("cloud", room,
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                  ImGuiButtonFlags_MouseButtonMiddle);
    const bool hovered = ImGui::IsItemHovered();
    const auto faced = facedAxes(place.directions);
    PlotFrame frame{};
    PlotChannels plot;
    if (faced) {
        const ParallelAxis &across = axes[std::size_t((*faced)[0])], &up = axes[std::size_t((*faced)[1])];
        const auto half = static_cast<float>(place.edge / 2);
        const ImVec2 middle{float(place.middle.x), float(place.middle.y)};
        frame = {{middle.x - half, middle.y - half},
                 {middle.x + half, middle.y + half},
                 across.density.range,
                 up.density.range};
        plot = {across.channel.name, up.channel.name};
    }
    editCloud(context, cache, view, faced ? &frame : nullptr, plot);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(min, {min.x + room.x, min.y + room.y}, true);
    drawCloudAxes(draw, place, axes);
    if (result) {
        updateCloud(context, cache, view, result, place, min, size);
        draw.AddImage(textureId(cache.texture.name()), min, {min.x + float(size.x), min.y + float(size.y)});
    }
    if (faced) drawBrushes(draw, context.session.selection, frame, plot);
    if (context.decoration.cursor) drawCloudCursor(context, draw, place, axes);
    draw.PopClipRect();
    if (faced && hovered && result && !cache.drag.active)
        cloudHover(frame, *faced, axes, *result, selectionName(context.session));
    if (!cache.answers.failure().empty() && !result) ImGui::TextWrapped("%s", cache.answers.failure().c_str());
}

} // namespace tessera::app
