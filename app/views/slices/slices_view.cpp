#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/ui/widgets.h"
#include "app/views/slices/slice_figure.h"
#include "app/views/slices/slice_layout.h"
#include "app/views/slices/slice_plane.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct SlicesCache : ViewCache {
    SlicePlanes planes;
};

/// Parameter, contour lines and export, and a copy of the values at the cross-hair.
void chooseShown(ViewContext& context, ToolRow& tools, SlicesView& view, const Readout& readout, int channel,
                 std::string& name) {
    const volume::DatasetInfo& info = context.source->info();
    const float width = std::min(em() * 11, tools.room() * 0.4f);
    if (tools.next(width)) {
        ImGui::SetNextItemWidth(width);
        if (chooseChannel("##channel", &info, name)) view.channel = name;
        if (ImGui::IsItemHovered()) tooltip("Parameter that colours the slices");
    }
    chooseContours(tools, info, view.lines);
    exportMenu(context, tools,
               {.name = "slices",
                .figure = [source = context.numbers, session = context.session, view,
                           channel](const PageForm&, const Progress& progress) {
                    return slicesDrawing(*source, session, view, channel, progress);
                }});
    if (!view.showReadout || !tools.next(iconButtonWidth(context, icons::kCopy))) return;
    if (iconButton(context, "copy", icons::kCopy, "Copy the values at the cross-hair as CSV"))
        ImGui::SetClipboardText((originLine(context.origin, context.numbers->info()) +
                                 readoutCsv(context.session, context.numbers->info(), readout))
                                    .c_str());
}

/// The stretch of the box, if it has one, at the end of the line.
void drawStretch(const ViewContext& context) {
    const std::string whole = stretchText(context.session.stretch);
    if (whole.empty()) return;
    if (!context.figure) ImGui::SameLine();
    const float room = ImGui::GetContentRegionAvail().x - em();
    const std::string text = firstThatFits({whole, whole.substr(whole.find(' ') + 1), ""}, room);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (!text.empty()) {
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

void drawSliceLegend(const ViewContext& context, const SlicesView& view, const Readout& readout, int channel,
                     const DrawnContours& lines) {
    const volume::DatasetInfo& info = context.source->info();
    LegendEntry legend = legendOf(context.session, info, channel);
    if (const auto value = readout.value(info.channel(channel).name); value && context.decoration.cursor)
        legend.marker = *value;
    if (ImGui::GetContentRegionAvail().y < legendBarHeight()) legend.title = legend.unit = ""; // the tools have it
    // What is left out keeps its place: the rest stays where it is.
    legendBarItem(legend, context.decoration.legend);
    if (context.decoration.legend) drawContourNote(contourNote(info, view.lines, lines));
}

/// Legend and read-out in the room that the three slices leave, or the read-out in one of its own.
void drawNumbers(ViewContext& context, const SlicesView& view, const Readout& values, int channel,
                 const DrawnContours& lines, const SliceLayout& layout) {
    const bool readout = view.showReadout && context.decoration.cursor;
    const auto within = [&](const char* id, const SliceArea& room, const auto& body) {
        const ImVec2 size = room.size();
        if (size.x < em() || size.y < em()) return;
        ImGui::SetCursorScreenPos(room.min);
        ImGui::BeginChild(id, size, false, ImGuiWindowFlags_NoScrollbar);
        body(size.y);
        ImGui::EndChild();
    };
    const auto legend = [&] { drawSliceLegend(context, view, values, channel, lines); };
    const bool apart = layout.values.size().x > 0;
    within("legend", layout.numbers, [&](float room) {
        if (!readout || apart) return legend();
        const std::string note = contourNote(context.source->info(), view.lines, lines);
        const float left = room - legendBarHeight() - em() * 0.3f - ImGui::GetStyle().ItemSpacing.y -
                           (note.empty() ? 0 : ImGui::GetTextLineHeightWithSpacing());
        if (readoutHeight(values) <= left) {
            legend();
            return drawReadout(context, values);
        }
        // Values in running lines change their number of lines, so that the legend comes after them; but in figures.
        if (context.figure) legend();
        const bool any = left >= ImGui::GetTextLineHeight();
        if (any) drawRunningReadout(context, values, left);
        if (!context.figure) legend();
        const ImVec2 max = layout.numbers.max;
        if (!any) tellWhole(layout.numbers.min, max, readoutText(context, values), "");
    });
    if (readout && apart)
        within("values", layout.values, [&](float room) { drawRunningReadout(context, values, room); });
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
    const Readout& readout = sharedReadout(context);
    std::string name = info.channel(*channel).name;
    if (!context.figure) {
        ToolRow tools(context);
        chooseShown(context, tools, view, readout, *channel, name);
    }
    const DrawnContours lines = drawnContours(context.session, info, view.lines, *channel);
    drawStretch(context);

    const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 6)};
    const SliceLayout layout =
        sliceLayout(ImGui::GetCursorScreenPos(), room, vis::worldFrame(info.bounds, context.session.stretch).halfSize,
                    em(), context.figure);
    for (int i = 0; i < 3; ++i) drawSlicePlane(context, cache.planes, pane, view, name, lines, i, layout);
    drawNumbers(context, view, readout, *channel, lines, layout);
}

} // namespace tessera::app
