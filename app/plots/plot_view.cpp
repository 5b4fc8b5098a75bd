#include "app/plots/plot_view.h"

#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::app {

namespace {

// Widths and radii in em, as pages have them in sizes of text.
constexpr float kPlotLine = 0.13f, kPlotDot = 0.2f, kPlotRing = 0.5f;

ImU32 seriesInk(glm::vec3 color) {
    return toColor({double(color.r), double(color.g), double(color.b)});
}

/// The frame with the values of the series' own axis.
PlotFrame frameOf(const Plot& plot, const PlotSeries& series, PlotFrame frame) {
    if (series.right && plot.right) frame.y = plot.right->range;
    return frame;
}

/// Points along the lines of a plot, close enough to find out what they cross.
std::vector<ImVec2> alongSeries(const Plot& plot, const PlotFrame& whole) {
    constexpr int kParts = 16;
    std::vector<ImVec2> along;
    for (const PlotSeries& series : plot.series) {
        const PlotFrame frame = frameOf(plot, series, whole);
        for (std::size_t i = 0; i < series.points.size(); ++i) {
            if (!std::isfinite(series.points[i].y)) continue;
            const ImVec2 to = frame.pixel(series.points[i].x, series.points[i].y);
            const bool joined = !series.bars && i > 0 && std::isfinite(series.points[i - 1].y);
            const ImVec2 from = joined        ? frame.pixel(series.points[i - 1].x, series.points[i - 1].y)
                                : series.bars ? ImVec2{to.x, frame.max.y}
                                              : to;
            for (int part = 1; part <= kParts; ++part) {
                const float share = float(part) / kParts;
                along.push_back({std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)});
            }
        }
    }
    for (const PlotFlow& flow : plot.flows)
        for (const glm::dvec2& at : flow.points) along.push_back(whole.pixel(at.x, at.y));
    return along;
}

void drawSeriesBars(ImDrawList& draw, const PlotSeries& series, const PlotFrame& frame) {
    // A single bar is as wide as the plot.
    const bool several = series.points.size() > 1;
    const double half = (several ? series.points[1].x - series.points[0].x : frame.x.hi - frame.x.lo) / 2;
    const float zero = frame.pixel(frame.x.lo, std::clamp(0.0, frame.y.lo, frame.y.hi)).y;
    for (const glm::dvec2& bar : series.points) {
        if (!(bar.y > 0 || bar.y < 0)) continue;
        const float left = std::round(frame.pixel(bar.x - half, 0).x),
                    right = std::round(frame.pixel(bar.x + half, 0).x);
        // What is not 0 is at least visible.
        const float end = frame.pixel(bar.x, bar.y).y, top = bar.y > 0 ? std::min(zero - 1, end) : zero;
        draw.AddRectFilled({left, top}, {std::max(right, left + 1), bar.y > 0 ? zero : std::max(zero + 1, end)},
                           seriesInk(series.color));
    }
}

void drawFlow(ImDrawList& draw, const PlotFlow& flow, const PlotFrame& frame) {
    const ImU32 color = ImGui::ColorConvertFloat4ToU32({flow.color.r, flow.color.g, flow.color.b, flow.color.a});
    std::vector<ImVec2> upper, lower;
    for (std::size_t i = 0; i < flow.points.size(); ++i) {
        const glm::dvec2 at = flow.points[i];
        const ImVec2 middle = frame.pixel(at.x, at.y);
        const float half = std::max(0.6f, std::abs(frame.pixel(at.x, at.y + flow.half[i]).y - middle.y));
        upper.push_back({middle.x, middle.y - half});
        lower.push_back({middle.x, middle.y + half});
    }
    // Smooth edges between neighbouring parts would be seen as gaps.
    const ImDrawListFlags flags = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    for (std::size_t i = 1; i < upper.size(); ++i)
        draw.AddQuadFilled(upper[i - 1], upper[i], lower[i], lower[i - 1], color);
    draw.Flags = flags;
}

void drawSeriesLine(ImDrawList& draw, const PlotSeries& series, const PlotFrame& frame) {
    const ImU32 color = seriesInk(series.color);
    std::vector<ImVec2> run;
    const auto flush = [&] {
        if (run.size() > 1)
            draw.AddPolyline(run.data(), static_cast<int>(run.size()), color, 0, std::max(1.2f, em() * kPlotLine));
        if (series.dots || run.size() == 1)
            for (const ImVec2 at : run) draw.AddCircleFilled(at, em() * kPlotDot, color);
        run.clear();
    };
    for (const glm::dvec2& point : series.points)
        if (std::isfinite(point.x) && std::isfinite(point.y))
            run.push_back(frame.pixel(point.x, point.y));
        else
            flush();
    flush();
}

} // namespace

namespace {

/// As few columns as give each plot some height, while they are wide enough.
std::size_t columnsFor(std::size_t plots, ImVec2 room) {
    constexpr float kLow = 9, kNarrow = 17; // em
    std::size_t columns = 1;
    const auto rows = [&] { return (plots + columns - 1) / columns; };
    while (columns < plots && room.y < em() * kLow * static_cast<float>(rows()) &&
           room.x >= em() * kNarrow * static_cast<float>(columns + 1))
        ++columns;
    return columns;
}

} // namespace

std::optional<PlotColumn> placePlots(const std::vector<Plot>& plots, float beside, bool several) {
    PlotColumn column;
    column.origin = ImGui::GetCursorScreenPos();
    ImVec2 all = ImGui::GetContentRegionAvail();
    if (several) column.columns = columnsFor(plots.size(), all);
    const std::size_t rows = (plots.size() + column.columns - 1) / column.columns;
    const ColumnHeights heights = columnHeights(all.y, rows);
    column.room = {all.x, heightAtLeast(heights.all)};
    column.titledBelow = heights.titled;
    all.x /= static_cast<float>(column.columns);
    column.titled = all.x > em() * (several ? 16 : 24);
    for (const Plot& plot : plots)
        column.titled =
            column.titled && ImGui::CalcTextSize(titleWithUnit(plot.y.title, plot.y.unit).c_str()).x < heights.each;
    for (const Plot& plot : plots)
        if (plot.y.numbered)
            column.left = std::max(column.left, axisRoom(AxisSide::Left, plot.y.range,
                                                         column.titled ? TitlePlace::Beside : TitlePlace::Nowhere));
    if (all.x - column.left < em() * 4) {
        drawHint("Not enough room", "Enlarge the pane.");
        return std::nullopt;
    }
    const float x0 = column.origin.x + column.left;
    float x1 = column.origin.x + all.x - em() * 0.6f;
    if (beside > 0 && x1 - x0 - beside > em() * 8) column.beside = beside;
    x1 -= column.beside;
    ImGui::SetCursorScreenPos({x0, column.origin.y});
    mouseArea("plots", {x1 - x0 + all.x * static_cast<float>(column.columns - 1), column.room.y - heights.bottom});
    column.taken = ImGui::IsItemActive();
    column.hovered = ImGui::IsItemHovered() || column.taken;
    const float under = ImGui::GetIO().MousePos.x - column.origin.x;
    const float left = std::clamp(std::floor(under / all.x), 0.0f, static_cast<float>(column.columns - 1)) * all.x;
    column.share = std::clamp(double((column.origin.x + under - left - x0) / (x1 - x0)), 0.0, 1.0);
    for (std::size_t i = 0; i < plots.size(); ++i) {
        const float top = column.origin.y + em() * 0.2f + heights.each * static_cast<float>(i / column.columns);
        const float right = std::round(all.x * static_cast<float>(i % column.columns));
        column.frames.push_back({{x0 + right, std::round(top)},
                                 {x1 + right, std::round(top + heights.each - em() * 0.4f)},
                                 plots[i].x.range,
                                 plots[i].y.range});
    }
    return column;
}

void drawPlotNames(ImDrawList& draw, const Plot& plot, const PlotFrame& frame, bool titled) {
    const bool single = plot.series.size() == 1 && plot.y.numbered;
    std::vector<std::pair<std::string, ImU32>> names;
    const std::string up = titleWithUnit(plot.y.title, plot.y.unit);
    if (plot.series.empty() && !plot.title.empty())
        names.emplace_back(plot.title + (titled ? "" : ", up: " + up), plotColors().text);
    else if (!plot.title.empty())
        names.emplace_back(plot.title, plotColors().text);
    const bool told = std::ranges::all_of(plot.series, [&](const PlotSeries& series) { // names with the unit
        const std::string& unit = plot.upOf(series).unit;
        return !unit.empty() && series.name.ends_with(titleWithUnit("", unit));
    });
    if (!titled && plot.series.size() > 1 && !told && !up.empty()) names.emplace_back(up, plotColors().text);
    for (const PlotSeries& series : plot.series) {
        if (single && titled && series.value.empty()) continue;
        names.emplace_back((single ? up : series.name) + (series.value.empty() ? "" : "  " + series.value),
                           single ? plotColors().text : seriesInk(series.color));
    }
    if (names.empty()) return;
    // A list, or where that is too high, in lines as wide as the plot.
    const float line = em() * 1.15f, most = frame.width() - em(), gap = em() * 0.8f;
    float widest = 0;
    for (const auto& [text, color] : names)
        widest = std::max(widest, std::min(most, ImGui::CalcTextSize(text.c_str()).x));
    const bool list = line * static_cast<float>(names.size()) <= frame.height() * 0.6f;
    std::vector<ImVec2> at;
    ImVec2 pen{0, 0}, size{0, line};
    for (const auto& [text, color] : names) {
        const float width = std::min(most, ImGui::CalcTextSize(text.c_str()).x);
        if (!at.empty() && (list || pen.x + width > most)) pen = {0, pen.y + line};
        at.push_back(pen);
        pen.x += width + gap;
        size = {std::max(size.x, pen.x - gap), pen.y + line};
    }
    const ImVec2 corner = freeCorner(frame, {size.x + gap, size.y + em() * 0.4f}, alongSeries(plot, frame));
    const ImVec2 from{corner.x > 0 ? frame.max.x - em() * 0.4f - size.x : frame.min.x + em() * 0.4f,
                      corner.y > 0 ? std::max(frame.min.y, frame.max.y - size.y) : frame.min.y + em() * 0.2f};
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool right = list && corner.x > 0;
        addFittedWithBackdrop(draw, {from.x + (right ? size.x : at[i].x), from.y + at[i].y}, {right ? 1.0f : 0.0f, 0},
                              names[i].second, names[i].first, most);
    }
}

void drawPlot(ImDrawList& draw, const Plot& plot, const PlotFrame& frame, bool titled, float left, bool grid) {
    const PlotColors colors = plotColors();
    drawPlotNames(draw, plot, frame, titled); // below the lines: a low plot has no room beside them
    draw.PushClipRect({frame.min.x - em(), frame.min.y}, {frame.max.x + em(), frame.max.y}, true);
    for (const PlotFlow& flow : plot.flows) drawFlow(draw, flow, frame);
    for (const PlotSeries& series : plot.series)
        series.bars ? drawSeriesBars(draw, series, frame) : drawSeriesLine(draw, series, frameOf(plot, series, frame));
    if (plot.cursorX || plot.cursorY)
        drawCrosshair(draw, frame, plot.cursorX.value_or(std::nan("")), plot.cursorY.value_or(std::nan("")),
                      plot.series.empty());
    for (const glm::dvec2& mark : plot.marks) {
        if (!std::isfinite(mark.x) || !std::isfinite(mark.y)) continue;
        const ImVec2 at = frame.pixel(mark.x, mark.y);
        draw.AddCircle(at, em() * kPlotRing, colors.backdrop, 24, em() * 0.25f);
        draw.AddCircle(at, em() * kPlotRing, colors.cursor, 24, em() * kPlotLine);
    }
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    if (plot.y.numbered)
        drawAxis(draw, frame, AxisSide::Left, titled ? plot.y.title : "", titled ? plot.y.unit : "",
                 frame.min.y - em() * 0.3f, frame.max.y + em() * 0.3f,
                 {.grid = grid, .room = left, .ink = plot.y.ink ? seriesInk(*plot.y.ink) : 0});
    if (!plot.right) return;
    PlotFrame right = frame;
    right.y = plot.right->range;
    drawRightAxis(draw, right, plot.right->title, plot.right->unit, rightAxisRoom(plot),
                  plot.right->ink ? seriesInk(*plot.right->ink) : 0);
}

float rightAxisRoom(const Plot& plot) {
    return plot.right ? axisRoom(AxisSide::Left, plot.right->range, TitlePlace::Beside) : 0;
}

void drawPlotBottom(ImDrawList& draw, const Plot& last, const PlotColumn& column) {
    const float width = column.room.x / static_cast<float>(column.columns);
    for (std::size_t i = 0; i < std::min(column.columns, column.frames.size()); ++i) {
        PlotFrame frame = column.frames[i];
        frame.max.y = column.frames.back().max.y;
        const float left = column.origin.x + width * static_cast<float>(i);
        drawAxis(draw, frame, AxisSide::Bottom, last.x.title, last.x.unit, left, left + width,
                 {.inlineTitle = !column.titledBelow});
    }
}

ImVec2 freeCorner(const PlotFrame& frame, ImVec2 size, const std::vector<ImVec2>& line) {
    ImVec2 best{0, 0};
    std::ptrdiff_t least = std::numeric_limits<std::ptrdiff_t>::max();
    for (const ImVec2 corner : {ImVec2{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
        const ImVec2 lo{frame.min.x + (frame.width() - size.x) * corner.x,
                        frame.min.y + (frame.height() - size.y) * corner.y};
        const auto hidden = std::ranges::count_if(line, [&](ImVec2 at) {
            return at.x >= lo.x && at.y >= lo.y && at.x <= lo.x + size.x && at.y <= lo.y + size.y;
        });
        if (hidden >= least) continue;
        least = hidden;
        best = corner;
    }
    return best;
}

} // namespace tessera::app
