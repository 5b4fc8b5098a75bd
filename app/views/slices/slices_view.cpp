#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/ui/widgets.h"
#include "app/views/slices/slice_figure.h"
#include "app/views/slices/slice_plane.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct SlicesCache : ViewCache {
    SlicePlanes planes;
    Readout readout;
};

/// Size of the first of two columns or rows whose plots share `room` in proportion to the box, none too narrow to
/// read; each has `around` pixels of axes besides.
float split(double first, double second, float room, float around, double least) {
    const double share = first + second > 0 ? first / (first + second) : 0.5;
    const float plots = std::max(0.0f, room - 2 * around);
    return std::round(around + plots * static_cast<float>(std::clamp(share, least, 1 - least)));
}

/// Chooses the parameter of the lines, and whether they are labelled.
void chooseContours(const volume::DatasetInfo& info, SlicesView& view) {
    continueLine(em() * 8);
    ImGui::SetNextItemWidth(em() * 8);
    ImGui::SliderInt("##contours", &view.contours, 0, 50, view.contours == 0 ? "no contours" : "%d contours");
    if (ImGui::IsItemHovered())
        tooltip("Number of contour lines over the colour range; of another parameter, or with values, at most this "
                "many at round values");
    if (view.contours == 0) return;
    continueLine(em() * 8);
    ImGui::SetNextItemWidth(em() * 8);
    chooseChannel("##contourOf", &info, view.contourOf, "same parameter");
    if (ImGui::IsItemHovered()) tooltip("Parameter of the contour lines");
    continueLine(buttonWidth("values") + em());
    ImGui::Checkbox("values", &view.contourValues);
    if (ImGui::IsItemHovered()) tooltip("Draw the lines at round values, labelled with them");
}

/// The line below the legend that says what the contour lines are.
std::string contourNote(const volume::DatasetInfo& info, const SlicesView& view, const DrawnContours& lines) {
    if (view.contours == 0 || (view.contourOf.empty() && !view.contourValues)) return {};
    if (lines.channel) return contourTitle(info.channel(*lines.channel), lines.levels);
    return "no contour lines: " +
           (info.findChannel(view.contourOf) ? "labels have none" : "there is no " + view.contourOf);
}

/// Parameter, contour lines and export.
void chooseShown(ViewContext& context, SlicesView& view, int channel, std::string& name) {
    const volume::DatasetInfo& info = context.source->info();
    ImGui::SetNextItemWidth(std::min(em() * 11, ImGui::GetContentRegionAvail().x * 0.4f));
    if (chooseChannel("##channel", &info, name)) view.channel = name;
    if (ImGui::IsItemHovered()) tooltip("Parameter that colours the slices");
    chooseContours(info, view);
    continueLine(buttonWidth("Export"));
    exportMenu(
        context, "slices",
        [source = context.numbers, session = context.session, view, channel](const Progress& progress) {
            return slicesDrawing(*source, session, view, channel, progress);
        },
        nullptr);
}

/// The stretch of the box, if it has one, at the end of the line.
void drawStretch(const ViewContext& context) {
    const std::string text = stretchText(context.session.stretch);
    if (text.empty()) return;
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (!context.figure) ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x > width + em()) {
        ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
        ImGui::AlignTextToFramePadding();
        if (context.decoration.title)
            ImGui::TextDisabled("%s", text.c_str());
        else
            ImGui::Dummy({width, em()});
    } else {
        ImGui::NewLine();
    }
}

/// Legend and read-out in the quarter that the three slices leave.
void drawNumbers(ViewContext& context, const std::string& pane, const SlicesView& view, SlicesCache& cache, int channel,
                 const DrawnContours& lines) {
    const volume::DatasetInfo& info = context.source->info();
    LegendEntry legend = legendOf(context.session, info, channel);
    updateReadout(context, pane, cache.readout);
    if (const auto value = cache.readout.value(info.channel(channel).name); value && context.decoration.cursor)
        legend.marker = *value;
    // If the table does not fit below the legend, the values come first, as running text; in figures after the legend,
    // which is whole.
    const std::string note = contourNote(info, view, lines);
    const float legends = legendBarHeight() + (note.empty() ? 0 : ImGui::GetTextLineHeightWithSpacing());
    const bool readout = view.showReadout && context.decoration.cursor;
    const bool compact = readout && legends + readoutHeight(cache.readout) > ImGui::GetContentRegionAvail().y;
    if (compact && !context.figure) drawReadout(context, cache.readout, true);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::min(ImGui::GetContentRegionAvail().x, em() * 20);
    // What is left out keeps its place: the rest stays where it is.
    const bool legendShown = context.decoration.legend;
    ImGui::Dummy(
        {width, (legendShown ? drawLegendBar(*ImGui::GetWindowDrawList(), at, width, legend) : legendBarHeight()) +
                    em() * 0.3f});
    if (!note.empty() && legendShown) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(note.c_str());
        ImGui::PopTextWrapPos();
    }
    if (readout && (!compact || context.figure)) drawReadout(context, cache.readout, compact);
}

} // namespace

void drawSlicesView(ViewContext& context, const std::string& pane, SlicesView& view) {
    if (!context.source) {
        drawHint("No data", "Shows three slices through the cross-hair.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const auto channel = resolveChannel(info, context.session, view.channel);
    if (!channel) {
        drawHint("No parameters", "This data set has no parameter to show.");
        return;
    }
    SlicesCache& cache = cacheOf<SlicesCache>(context, pane);
    std::string name = info.channel(*channel).name;
    if (!context.figure) chooseShown(context, view, *channel, name);
    DrawnContours lines;
    if (!view.contourOf.empty() || view.contourValues) lines.channel = contourChannel(info, view, *channel);
    if (lines.channel) lines.levels = contourLevels(context.session, info, *lines.channel, view.contours);
    drawStretch(context);

    const ImVec2 min = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    if (room.x < em() * 10 || room.y < em() * 8) return;
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const glm::dvec3 half = vis::worldFrame(info.bounds, context.session.stretch).halfSize;
    const float columns = split(half.x, half.z, room.x, em() * 3.2f, 0.3);
    // The head lines of both columns need some room.
    const float x = min.x + std::clamp(columns, std::min(em() * 12.5f, room.x / 2), room.x - em() * 8),
                y = min.y + split(half.y, half.z, room.y, em() * 2.8f, 0.4);
    const float gap = em() * 0.3f;
    drawSlicePlane(context, cache.planes, pane, view, name, lines, 0, min, {x - gap, y - gap});
    drawSlicePlane(context, cache.planes, pane, view, name, lines, 1, {x + gap, min.y}, {max.x, y - gap});
    drawSlicePlane(context, cache.planes, pane, view, name, lines, 2, {min.x, y + gap}, {x - gap, max.y});

    ImGui::SetCursorScreenPos({x + gap * 2, y + gap});
    ImGui::BeginChild("readout", {max.x - x - gap * 2, max.y - y - gap}, false,
                      context.figure ? ImGuiWindowFlags_NoScrollbar : ImGuiWindowFlags_None);
    drawNumbers(context, pane, view, cache, *channel, lines);
    ImGui::EndChild();
}

} // namespace tessera::app
