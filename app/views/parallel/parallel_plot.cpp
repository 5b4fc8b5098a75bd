#include "app/views/parallel/parallel_plot.h"

#include "app/pane/plot.h"
#include "app/pane/view_parts.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr float kMarkHeight = 0.9f, kMarkGap = 0.7f; ///< of the strip for what is absent, lines
constexpr float kWidestHistogram = 0.2f;             ///< of a gap
constexpr float kLongestBar = 3.5f;                  ///< lines
constexpr int kMostGapRows = 2048;                   ///< of a picture

GapInk inkOfColor(ImU32 color) {
    return {double(color >> IM_COL32_R_SHIFT & 255), double(color >> IM_COL32_G_SHIFT & 255),
            double(color >> IM_COL32_B_SHIFT & 255)};
}

std::string samplesText(double count, double selected, const std::string& name) {
    std::string text = formatCount(count) + (count == 1 ? " sample" : " samples");
    if (!name.empty() && count > 0) text += "\n" + formatShare(std::min(1.0, selected / count)) + " of them in " + name;
    return text;
}

} // namespace

PlaceRows ParallelPlot::rows(std::size_t axis) const {
    const ParallelAxis& own = axes[axis];
    return {double(own.bottom - own.top), own.flipped, double(markTop - own.top), double(markBottom - own.top)};
}

bool lacksAny(const volume::AxisDensities& densities) {
    const auto absent = static_cast<std::size_t>(volume::absentPlace(densities.bins));
    return std::ranges::any_of(densities.axes, [&](const volume::PlaceCounts& axis) { return axis.all[absent] > 0; });
}

float histogramLength(const ParallelPlot& plot, float line) {
    return plot.axes.size() > 1 ? std::min(plot.gap() * kWidestHistogram, line * kLongestBar) : line * 2 * kLongestBar;
}

void placeAxes(ParallelPlot& plot, ImVec2 min, ImVec2 max, bool marks, float left, float right, float line) {
    const float strip = marks ? line * (kMarkGap + kMarkHeight) : 0;
    const std::size_t count = plot.axes.size();
    const float from = min.x + left, to = max.x - right;
    for (std::size_t i = 0; i < count; ++i) {
        ParallelAxis& axis = plot.axes[i];
        axis.x = std::round(count > 1 ? from + (to - from) * float(i) / float(count - 1) : (from + to) / 2);
        axis.top = std::round(min.y);
        axis.bottom = std::round(std::max(min.y + line, max.y - strip - line * 0.4f));
    }
    const float bottom = count > 0 ? plot.axes.front().bottom : min.y;
    plot.markTop = marks ? std::round(bottom + line * kMarkGap) : bottom;
    plot.markBottom = marks ? std::round(bottom + strip) : bottom;
}

GapLook gapLook(bool logDensity, bool dark, const std::vector<ImU32>& focus) {
    GapLook look{.logDensity = logDensity, .focus = {}};
    // Context is grey-blue and focus a strong colour, so that they differ in lightness as well as hue.
    look.context = dark ? GapInk{138, 156, 180} : GapInk{92, 106, 128};
    look.plain = dark ? GapInk{150, 196, 236} : GapInk{28, 92, 158};
    for (const ImU32 color : focus) look.focus.push_back(inkOfColor(color));
    return look;
}

PlotDensities plotDensities(const ParallelPlot& plot, const volume::AxisDensities& densities, int width, int height) {
    PlotDensities out;
    if (plot.axes.empty()) return out;
    const double drawn = double(std::max(plot.axes.front().bottom, plot.markBottom) - plot.axes.front().top);
    const double scale = height / std::max(1.0, drawn);
    for (std::size_t g = 0; g < densities.gaps.size() && g + 1 < plot.axes.size(); ++g) {
        PlaceRows left = plot.rows(g), right = plot.rows(g + 1);
        for (PlaceRows* rows : {&left, &right}) rows->axis *= scale, rows->markFrom *= scale, rows->markTo *= scale;
        out.gaps.push_back(rasterGap(densities.gaps[g], densities.bins, left, right, width, height));
        out.most = std::max(out.most, greatestDensity(out.gaps.back()));
    }
    return out;
}

void GapPictures::update(vis::TexturesIn where, const ParallelPlot& plot,
                         const std::shared_ptr<const ParallelResult>& result, bool logDensity,
                         const std::vector<ImU32>& focus) {
    const ParallelAxis& first = plot.axes.front();
    const float drawn = std::max(first.bottom, plot.markBottom) - first.top;
    Key key{.result = result,
            .flipped = {},
            .focus = focus,
            .width = std::clamp(int(plot.gap()), 1, kMostGapRows),
            .height = std::clamp(int(drawn), 1, kMostGapRows),
            .axisHeight = int(first.bottom - first.top),
            .logDensity = logDensity,
            .dark = darkTheme()};
    for (const ParallelAxis& axis : plot.axes) key.flipped.push_back(axis.flipped);
    if (key == shown_) return;
    shown_ = key;
    const PlotDensities densities = plotDensities(plot, result->densities, key.width, key.height);
    GapLook look = gapLook(logDensity, key.dark, focus);
    look.most = densities.most;
    const int bins = result->densities.bins;
    look.unit = double(key.axisHeight) * binsTogether(bins, key.axisHeight) / bins;
    textures_.resize(densities.gaps.size());
    for (std::size_t g = 0; g < textures_.size(); ++g)
        textures_[g].upload(where, {key.width, key.height}, gapPixels(densities.gaps[g], look));
}

void GapPictures::draw(ImDrawList& draw, const ParallelPlot& plot) const {
    for (std::size_t g = 0; g < textures_.size() && g + 1 < plot.axes.size(); ++g) {
        const ParallelAxis &left = plot.axes[g], &right = plot.axes[g + 1];
        draw.AddImage(textureId(textures_[g].name()), {left.x, left.top},
                      {right.x, std::max(left.bottom, plot.markBottom)});
    }
}

namespace {

/// A number beside an axis, which bright bands run beneath: its ground lets hardly anything through.
void drawAxisNumber(ImDrawList& draw, ImVec2 rightTop, const std::string& text) {
    const PlotColors colors = plotColors();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const ImVec2 from{std::round(rightTop.x - size.x), std::round(rightTop.y)};
    const float pad = em() * 0.2f;
    draw.AddRectFilled({from.x - pad, from.y}, {from.x + size.x + pad, from.y + size.y},
                       (colors.backdrop & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 240), pad);
    draw.AddText(from, colors.text, text.c_str());
}

} // namespace

void drawParallelAxes(ImDrawList& draw, const ParallelPlot& plot) {
    const PlotColors colors = plotColors();
    const float tick = em() * 0.3f;
    for (std::size_t i = 0; i < plot.axes.size(); ++i) {
        const ParallelAxis& axis = plot.axes[i];
        const float room = i == 0 ? em() * 6 : plot.gap() * 0.45f;
        draw.AddLine({axis.x + 0.5f, axis.top}, {axis.x + 0.5f, axis.bottom}, colors.faint,
                     std::max(1.0f, em() * 0.09f));
        const TickLabels ticks = axisTicks(axis, double(em()));
        float above = 1e9f;
        for (std::size_t t = 0; t < ticks.values.size(); ++t) {
            const float y = std::round(axis.pixel(ticks.values[t])) + 0.5f;
            draw.AddLine({axis.x - tick, y}, {axis.x, y}, colors.faint);
            const std::string text = fitText(ticks.texts[t], room - tick);
            const float top = std::clamp(y - em() / 2, axis.top - em() * 0.3f, axis.bottom - em() * 0.7f);
            if (text.empty() || (std::abs(top - above) < em() && t > 0)) continue;
            above = top;
            drawAxisNumber(draw, {axis.x - tick - em() * 0.2f, top}, text);
        }
        if (!plot.hasMarks()) continue;
        draw.AddLine({axis.x + 0.5f, plot.markTop}, {axis.x + 0.5f, plot.markBottom}, colors.faint);
        draw.AddCircle({axis.x + 0.5f, plot.markAt()}, em() * 0.22f, colors.faint, 12);
    }
    if (plot.hasMarks() && !plot.axes.empty())
        addTextWithBackdrop(draw, {plot.axes.front().x - em() * 0.5f, plot.markAt() - em() / 2}, {1, 0}, colors.faint,
                            "absent");
}

void drawAxisHistograms(ImDrawList& draw, const ParallelPlot& plot, const ParallelResult& result, bool logCounts,
                        const std::vector<ImU32>& focus) {
    const PlotColors colors = plotColors();
    const int bins = result.densities.bins;
    const float widest = histogramLength(plot, em());
    for (std::size_t a = 0; a < plot.axes.size() && a < result.densities.axes.size(); ++a) {
        const volume::PlaceCounts& counts = result.densities.axes[a];
        double most = 1;
        for (int bin = 0; bin < bins; ++bin) most = std::max(most, double(counts.all[std::size_t(bin)]));
        const auto length = [&](double count) {
            return float(logCounts ? std::log1p(count) / std::log1p(most) : count / most) * widest;
        };
        const ParallelAxis& axis = plot.axes[a];
        for (int bin = 0; bin < bins; ++bin) {
            const Range rows = *placeRows(plot.rows(a), bins, bin);
            const float top = std::round(axis.top + float(rows.lo)), bottom = std::round(axis.top + float(rows.hi));
            const auto bar = [&](float from, float to, ImU32 color) {
                if (to > from)
                    draw.AddRectFilled({axis.x + from, top}, {axis.x + to, std::max(bottom, top + 1)}, color);
            };
            const auto at = std::size_t(bin);
            bar(0, length(double(counts.all[at])), (colors.bars & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 150));
            const double selected = counts.selectedAt(at);
            if (!(selected > 0)) continue;
            float from = 0;
            for (std::size_t g = 0; g < counts.selected.size() && g < focus.size(); ++g) {
                const float part = length(selected) * float(counts.selected[g][at] / selected);
                bar(from, from + part, focus[g]);
                from += part;
            }
        }
    }
}

namespace {

void drawLineOf(ImDrawList& draw, const ParallelPlot& plot, const std::vector<std::optional<double>>& values,
                ImU32 ink) {
    const PlotColors colors = plotColors();
    std::vector<ImVec2> line;
    std::vector<bool> there, shown;
    for (std::size_t a = 0; a < plot.axes.size() && a < values.size(); ++a) {
        const ParallelAxis& axis = plot.axes[a];
        const std::optional<double>& value = values[a];
        there.push_back(value.has_value());
        shown.push_back(value && axis.shows(*value));
        line.push_back({axis.x, value ? axis.pixel(*value) : plot.markAt()});
    }
    for (const bool rim : {true, false})
        for (std::size_t i = 0; i < line.size(); ++i) {
            const ImU32 color = rim ? colors.backdrop : ink;
            if (i + 1 < line.size() && (there[i] || there[i + 1]) && (plot.hasMarks() || (there[i] && there[i + 1])))
                draw.AddLine(line[i], line[i + 1], color, rim ? 4.0f : 2.0f);
            if (shown[i]) draw.AddCircleFilled(line[i], em() * (rim ? 0.3f : 0.2f), color, 12);
        }
}

} // namespace

void drawCursorLine(ImDrawList& draw, const ParallelPlot& plot, const Readout& cursor) {
    std::vector<std::optional<double>> values;
    for (const ParallelAxis& axis : plot.axes) values.push_back(cursor.value(axis.channel.name));
    drawLineOf(draw, plot, values, plotColors().cursor);
}

void drawSampleLine(ImDrawList& draw, const ParallelPlot& plot, const std::vector<std::optional<double>>& values) {
    drawLineOf(draw, plot, values, plotColors().text);
}

std::string axisHoverText(const ParallelPlot& plot, std::size_t axis, float y, const ParallelResult& result,
                          const std::string& selected) {
    const ParallelAxis& own = plot.axes[axis];
    const volume::PlaceCounts& counts = result.densities.axes[axis];
    const int bins = result.densities.bins;
    const auto sum = [&](int place) { return double(counts.all[static_cast<std::size_t>(place)]); };
    std::string text = own.channel.name;
    if (y <= own.bottom) {
        const double value = own.value(y);
        const auto bin =
            static_cast<std::size_t>(std::clamp(volume::axisShare(own.density, value) * bins, 0.0, double(bins - 1)));
        text += " " + axisText(own, value, own.perPixel(y)) + "\n" +
                samplesText(double(counts.all[bin]), counts.selectedAt(bin), result.brushed() ? selected : "");
    }
    const auto add = [&](double count, const std::string& what) {
        if (count > 0) text += "\n" + formatCount(count) + (count == 1 ? " has " : " have ") + what;
    };
    add(sum(volume::absentPlace(bins)), "no " + own.channel.name);
    add(sum(volume::belowPlace(bins)) + sum(volume::abovePlace(bins)),
        own.density.logarithmic && own.density.range == own.whole ? "no place on a logarithmic axis"
                                                                  : "values beyond the ends of the axis");
    if (result.densities.level > 0) text += "\n(estimated from a coarser level)";
    return text;
}

std::string gapHoverText(const ParallelPlot& plot, std::size_t gap, ImVec2 at, const ParallelResult& result,
                         const std::string& selected) {
    const volume::PlaceCounts& counts = result.densities.gaps[gap];
    const int bins = result.densities.bins;
    const ParallelAxis &left = plot.axes[gap], &right = plot.axes[gap + 1];
    const double u = double((at.x - left.x) / std::max(1.0f, right.x - left.x)), row = double(at.y - left.top);
    const PlaceRows from = plot.rows(gap), to = plot.rows(gap + 1);
    const std::size_t places = volume::placesOf(bins);
    const auto absent = static_cast<std::size_t>(volume::absentPlace(bins));
    double all = 0, focus = 0;
    for (std::size_t i = 0; i < counts.all.size(); ++i) {
        if (counts.all[i] == 0 || (i / places == absent && i % places == absent)) continue;
        const auto a = placeRows(from, bins, static_cast<int>(i / places)),
                   b = placeRows(to, bins, static_cast<int>(i % places));
        if (!a || !b || row < a->lo + (b->lo - a->lo) * u - 0.5 || row > a->hi + (b->hi - a->hi) * u + 0.5) continue;
        all += double(counts.all[i]);
        focus += counts.selectedAt(i);
    }
    if (all <= 0) return {};
    std::string text = left.channel.name + " to " + right.channel.name + "\n" +
                       samplesText(all, focus, result.brushed() ? selected : "") + (all == 1 ? " runs" : " run") +
                       " through here";
    if (result.brushed()) {
        text = left.channel.name + " to " + right.channel.name + "\nthrough here: " + samplesText(all, focus, selected);
    }
    if (result.densities.level > 0) text += "\n(estimated from a coarser level)";
    return text;
}

} // namespace tessera::app
