#include "app/pane/view_parts.h"
#include "app/planes/plane_pane.h"
#include "app/tools/brush_list.h"
#include "app/ui/widgets.h"
#include "app/views/hyperslice/hyper_page.h"
#include "app/views/hyperslice/hyper_panel.h"
#include "volume/bricks/brick_cache.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kHyperCacheBytes = std::size_t(256) << 20; ///< a parameter of 64 x 64 x 256 samples at 24 times
constexpr float kLeastPanel = 1.6f, kGoodPanel = 3;              ///< em, of a panel; below a good one there are no axes

struct HyperSliceCache : ViewCache {
    std::vector<HyperPanelState> panels;     ///< row by row, of which those below the diagonal are used
    std::vector<HyperProfileState> profiles; ///< one for each axis
    HyperDrag drag;
    std::shared_ptr<const volume::BrickSource> source; ///< of `bricks`
    std::shared_ptr<const volume::BrickCache> bricks;  ///< so that a drag decodes few
};

/// The tool that chooses the axes: each of space, and one of time.
void chooseAxes(ToolRow& tools, HyperSliceView& view, const std::vector<HyperAxis>& all,
                const std::vector<HyperAxis>& shown) {
    if (!tools.next(buttonWidth("Axes"))) return;
    if (ImGui::Button("Axes")) ImGui::OpenPopup("axes");
    if (ImGui::IsItemHovered())
        tooltip("Axes with a row and a column each: of space, and time or a quantity that only rises or only falls "
                "over time");
    if (!ImGui::BeginPopup("axes")) return;
    const auto isShown = [&](const HyperAxis& axis) {
        return std::ranges::find(shown, axis.key, &HyperAxis::key) != shown.end();
    };
    for (const HyperAxis& axis : all) {
        const bool on = isShown(axis);
        const std::string text = titleWithUnit(axis.label.title(), axis.label.unit.name) + "##" + axis.key;
        if (!ImGui::MenuItem(text.c_str(), nullptr, on, !on || shown.size() > 1)) continue;
        view.axes.clear();
        for (const HyperAxis& each : all) { // in their order; one of time
            const bool wanted = each.key == axis.key ? !on : isShown(each);
            const bool replaced = !on && each.key != axis.key && each.along.ofTime() && axis.along.ofTime();
            if (wanted && !replaced) view.axes.push_back(each.key);
        }
    }
    ImGui::EndPopup();
}

/// Panels are not to scale, which they always say.
void drawScales(ToolRow& tools, const std::vector<HyperAxis>& axes, const volume::DatasetInfo& info) {
    const std::string text = hyperScale(axes, info);
    if (!tools.nextText(ImGui::CalcTextSize(text.c_str()).x)) return;
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text.c_str());
    if (ImGui::IsItemHovered()) tooltip("Each axis fills its panels");
}

void drawHyperTools(ViewContext& context, HyperSliceView& view, const std::vector<HyperAxis>& axes,
                    const HyperContent& content, const Readout& readout) {
    const auto& source = drawnSource(context);
    const volume::DatasetInfo& info = source->info();
    ToolRow tools(context);
    choosePlaneChannel(tools, info, content.channel, view.channel);
    chooseAxes(tools, view, possibleAxes(context.session, info), axes);
    chooseContours(tools, info, view.lines);
    if (!view.zoom.empty() && tools.next(buttonWidth("Show all"))) {
        if (ImGui::Button("Show all")) view.zoom.clear();
        if (ImGui::IsItemHovered()) tooltip("Show all of every axis");
    }
    const auto matrix =
        std::make_shared<const HyperMatrix>(HyperMatrix{axes, content, view.lines.values, context.session});
    const bool overTime = std::ranges::any_of(axes, [](const HyperAxis& axis) { return axis.along.ofTime(); });
    exportMenu(
        context, tools,
        {.name = "hyperslice",
         .figure = [source, matrix](const PageForm& form,
                                    const Progress& progress) { return hyperPage(*source, *matrix, form, progress); },
         .whole = false,
         .table = [source, matrix](const Progress& progress) { return hyperTable(*source, *matrix, progress); }},
        !overTime);
    copyReadout(context, tools, readout);
    drawScales(tools, axes, info);
    drawOrigin(context, tools, {content.channel}, !overTime);
}

/// Where the panels of a matrix lie.
struct HyperLayout {
    ImVec2 min, room, cell; ///< pixels; a panel with the gap beside it
    float left = 0, right = 0, bottom = 0, gap = 0;
    bool numbered = true;
    std::size_t count = 0;

    float least() const { return std::min(cell.x, cell.y) - gap; }
    PlotFrame frame(std::size_t column, std::size_t row) const {
        const ImVec2 lo{std::round(min.x + left + cell.x * static_cast<float>(column)),
                        std::round(min.y + cell.y * static_cast<float>(row))};
        return {lo, {std::round(lo.x + cell.x - gap), std::round(lo.y + cell.y - gap)}, {}, {}};
    }
};

HyperLayout hyperLayout(const std::vector<HyperAxis>& axes, Range values, bool numbered) {
    HyperLayout out;
    out.count = axes.size();
    out.numbered = numbered;
    out.min = ImGui::GetCursorScreenPos();
    out.min.y += em() * 0.3f;
    out.room = {ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 6) - em() * 0.3f};
    out.gap = std::round(em() * 0.4f);
    const auto count = static_cast<float>(std::max<std::size_t>(1, axes.size()));
    out.left = em() * 0.3f;
    if (numbered) {
        for (std::size_t row = 1; row < axes.size(); ++row)
            out.left = std::max(out.left,
                                axisRoom(AxisSide::Left, axes[row].shown, TitlePlace::Beside, axes[row].label.scale()));
        out.right = axisRoom(AxisSide::Left, values, TitlePlace::Beside);
        for (const HyperAxis& axis : axes)
            out.bottom =
                std::max(out.bottom, axisRoom(AxisSide::Bottom, axis.shown, TitlePlace::Beside, axis.label.scale()));
    }
    out.cell = {(out.room.x - out.left - out.right + out.gap) / count, (out.room.y - out.bottom + out.gap) / count};
    return out;
}

/// One frame of the view.
class HyperSlicePane {
public:
    HyperSlicePane(ViewContext& context, HyperSliceCache& cache, const std::string& pane, HyperSliceView& view,
                   const HyperContent& content)
        : context_(context), cache_(cache), pane_(pane), view_(view), content_(content),
          info_(drawnSource(context)->info()), axes_(axesOfView(view, context.session, info_)) {}

    const std::vector<HyperAxis>& axes() const { return axes_; }

    void draw(const Readout& readout) {
        values_ = profileRange(context_.session, info_, content_.channel);
        HyperLayout layout = hyperLayout(axes_, values_, context_.decoration.axes);
        if (layout.least() < em() * kGoodPanel) layout = hyperLayout(axes_, values_, false);
        if (layout.least() < em() * kLeastPanel)
            return drawHint("Not enough room", "Enlarge the pane, or show fewer axes.");
        cache_.panels.resize(axes_.size() * axes_.size());
        cache_.profiles.resize(axes_.size());
        const auto each = [&](const auto& visit) {
            for (std::size_t row = 0; row < axes_.size(); ++row)
                for (std::size_t column = 0; column <= row; ++column) visit(column, row, frameOf(layout, column, row));
        };
        if (context_.takesInput())
            each([&](std::size_t column, std::size_t row, const PlotFrame& frame) {
                useHyperMouse(context_, view_, cache_.drag, static_cast<int>(row * axes_.size() + column),
                              axes_[column], row > column ? &axes_[row] : nullptr, frame, [&] { drawMenu(); });
            });
        axes_ = axesOfView(view_, context_.session, info_); // the mouse may have zoomed
        each([&](std::size_t column, std::size_t row, const PlotFrame& frame) {
            drawPanel(column, row, frame);
            if (layout.numbered) drawPanelAxes(layout, column, row, frame);
        });
        drawCorner(layout, readout);
    }

private:
    PlotFrame frameOf(const HyperLayout& layout, std::size_t column, std::size_t row) const {
        PlotFrame frame = layout.frame(column, row);
        frame.x = axes_[column].shown;
        frame.y = row > column ? axes_[row].shown : values_;
        return frame;
    }

    void drawMenu() {
        if (ImGui::MenuItem("Show all of every axis", nullptr, false, !view_.zoom.empty())) view_.zoom.clear();
        ImGui::Separator();
        drawBrushMenu(context_);
    }

    void drawPanel(std::size_t column, std::size_t row, const PlotFrame& frame) {
        const std::string key = "hyperslice " + pane_ + " " + axes_[column].key + " " + axes_[row].key;
        if (row == column)
            drawHyperProfile(context_, cache_.profiles[row], cache_.bricks, content_.channel, axes_[row], frame, key);
        else
            drawHyperPanel(context_, cache_.panels[row * axes_.size() + column], cache_.bricks, content_,
                           view_.lines.values, {axes_[column], axes_[row], frame, key});
    }

    /// Numbers on the outer axes, and of values at the right of each profile.
    void drawPanelAxes(const HyperLayout& layout, std::size_t column, std::size_t row, const PlotFrame& frame) {
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        const float room = layout.gap / 2 - 1; // numbers at the ends of neighbours stay apart
        if (row + 1 == axes_.size()) {
            const AxisLabel& label = axes_[column].label;
            drawAxis(draw, frame, AxisSide::Bottom, label.title(), label.unit.name, frame.min.x, frame.max.x,
                     {.ticks = label.ticks, .scale = label.scale()});
        }
        if (column == 0 && row > 0) {
            const AxisLabel& label = axes_[row].label;
            drawAxis(draw, frame, AxisSide::Left, label.title(), label.unit.name, frame.min.y - room,
                     frame.max.y + room, {.room = layout.left, .ticks = label.ticks, .scale = label.scale()});
        }
        if (row != column) return;
        const volume::Channel own = info_.channel(content_.channel);
        const auto fits = [&](const std::string& text) {
            return ImGui::CalcTextSize(text.c_str()).x <= frame.height();
        };
        const bool whole = fits(titleWithUnit(own.name, own.unit)); // the legend has the unit, too
        drawRightAxis(draw, frame, fits(own.name) ? own.name : "", whole ? own.unit : "", layout.right, 0);
    }

    /// Legend, place and values in the half of the matrix above the diagonal.
    void drawCorner(const HyperLayout& layout, const Readout& readout) {
        const std::size_t first = std::max<std::size_t>(1, (layout.count + 1) / 2);
        if (first >= layout.count) return;
        const ImVec2 lo{layout.frame(first, 0).min.x + layout.right, layout.min.y};
        const ImVec2 hi{layout.min.x + layout.room.x, layout.frame(0, first - 1).max.y};
        if (hi.x - lo.x < em() * 4 || hi.y - lo.y < em()) return;
        ImGui::SetCursorScreenPos(lo);
        ImGui::BeginChild("corner", {hi.x - lo.x, hi.y - lo.y}, false, ImGuiWindowFlags_NoScrollbar);
        LegendEntry legend = legendOf(context_.session, info_, content_.channel);
        const auto value = readout.value(info_.channel(content_.channel).name);
        if (value && context_.decoration.cursor) legend.marker = *value;
        legendBarItem(legend, context_.decoration.legend);
        if (context_.decoration.legend && content_.lined)
            drawContourNote(contourTitle(info_.channel(*content_.lined), content_.levels));
        if (context_.decoration.cursor) {
            std::string over; // places in space are among the values
            for (const std::string& text : hyperTimes(axes_, context_.session, info_))
                over += (over.empty() ? "" : "   ") + text;
            if (!over.empty()) ImGui::TextUnformatted(wrappedAtSpaces(over, hi.x - lo.x).c_str());
            const float left = ImGui::GetContentRegionAvail().y;
            if (left >= ImGui::GetTextLineHeight()) drawRunningReadout(context_, readout, left);
        }
        ImGui::EndChild();
    }

    ViewContext& context_;
    HyperSliceCache& cache_;
    const std::string& pane_;
    HyperSliceView& view_;
    const HyperContent& content_;
    const volume::DatasetInfo& info_;
    std::vector<HyperAxis> axes_;
    Range values_;
};

} // namespace

void drawHyperSliceView(ViewContext& context, const std::string& pane, HyperSliceView& view) {
    if (!context.source) return drawHint("No data", "Shows all slices through a point in space and time.");
    const auto& source = drawnSource(context);
    const volume::DatasetInfo& info = source->info();
    const auto channel = resolveChannel(info, context.session, view.channel);
    if (!channel) return drawHint("No parameters", "This data set has no parameter to show.");
    HyperSliceCache& cache = cacheOf<HyperSliceCache>(context, pane);
    if (cache.source != source) {
        cache.source = source;
        cache.bricks = std::make_shared<volume::BrickCache>(source, kHyperCacheBytes);
    }
    const Readout& readout = sharedReadout(context);
    const HyperContent content = hyperContent(view, *channel, context.session, info);
    HyperSlicePane matrix(context, cache, pane, view, content);
    drawHyperTools(context, view, matrix.axes(), content, readout);
    if (matrix.axes().empty()) return drawHint("No extent", "The data are one sample at one time.");
    matrix.draw(readout);
}

} // namespace tessera::app
