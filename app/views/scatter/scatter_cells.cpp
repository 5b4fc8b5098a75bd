#include "app/views/scatter/scatter_cells.h"

#include "app/ui/ticks.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::uint64_t kFew = 3;           ///< samples in a bin that counts as an outlier
constexpr std::size_t kMostOutliers = 5000; ///< dots in one plot

std::string binText(const volume::Channel& channel, Range range, std::size_t bin, std::size_t bins) {
    const double width = (range.hi - range.lo) / static_cast<double>(bins);
    const double middle = range.lo + (static_cast<double>(bin) + 0.5) * width;
    return channel.name + " " + formatQuantity(middle, channel.unit, width);
}

std::string countText(double count, double total, double focus, const std::string& selected) {
    std::string text = formatCount(count) + (count == 1 ? " sample" : " samples");
    if (total > 0) text += ", " + formatShare(count / total);
    if (!selected.empty() && count > 0)
        text += "\n" + formatShare(std::min(1.0, focus / count)) + " of them in " + selected;
    return text;
}

/// A title in two parts: the name, and what its numbers mean nothing without.
struct TitleParts {
    std::string name, rest;
    std::string whole() const { return rest.empty() ? name : name + " " + rest; }
};

constexpr float kTwoLines = 2.2f; ///< height of a row whose title stands in two lines beside it, em

TitlePlace placeOf(TitleWay way) {
    return way == TitleWay::Across ? TitlePlace::Elsewhere : TitlePlace::Beside;
}

TitleParts titleParts(const ScatterLayout& matrix, std::size_t i, AxisSide side, float length) {
    const volume::Channel& own = matrix.infos[i];
    TitleParts parts{own.name, own.unit.empty() ? "" : "[" + prettyUnit(own.unit) + "]"};
    if (const std::string note = axisNote(side, matrix.ranges[i], length); !note.empty())
        parts.rest += (parts.rest.empty() ? "" : " ") + note;
    return parts;
}

float widthOf(const std::string& text) {
    return ImGui::CalcTextSize(text.c_str()).x;
}

/// The widest of one side's titles from `first` on: whole, the wider one of both parts, and the second part.
struct TitleWidths {
    float whole = 0, part = 0, rest = 0;
};
TitleWidths titleWidths(const ScatterLayout& matrix, std::size_t first, AxisSide side, float length) {
    TitleWidths widest;
    for (std::size_t i = first; i < matrix.size(); ++i) {
        const TitleParts parts = titleParts(matrix, i, side, length);
        widest.whole = std::max(widest.whole, widthOf(parts.whole()));
        widest.part = std::max({widest.part, widthOf(parts.name), widthOf(parts.rest)});
        widest.rest = std::max(widest.rest, widthOf(parts.rest));
    }
    return widest;
}

TitleWay titleWay(const TitleWidths& widths, float cell) {
    return widths.whole <= cell ? TitleWay::OneLine : widths.part <= cell ? TitleWay::TwoLines : TitleWay::Across;
}

/// The most pixels that titles across their cells take of a length: a fifth, but what the numbers mean nothing without.
float mostAcross(float room, float needed) {
    return std::max({em() * 4.5f, room * 0.2f, needed});
}

/// Name and unit in so many pixels: the name is cut off, the rest never, since numbers mean nothing without it.
std::string fittedTitle(const TitleParts& parts, float width) {
    if (widthOf(parts.whole()) <= width || parts.rest.empty()) return fitText(parts.whole(), width);
    const std::string name = fitText(parts.name, width - widthOf(" " + parts.rest));
    return name.empty() ? parts.rest : name + " " + parts.rest;
}

} // namespace

int jointIndex(const volume::Statistics& statistics, std::size_t column, std::size_t row) {
    for (std::size_t i = 0; i < statistics.joint.size(); ++i)
        if (statistics.joint[i].x == static_cast<int>(column) && statistics.joint[i].y == static_cast<int>(row))
            return static_cast<int>(i);
    return -1;
}

void drawHistogram(ImDrawList& draw, const PlotFrame& frame, const volume::Histogram& histogram, bool brushed,
                   bool logCounts, ImU32 focusShade) {
    const PlotColors colors = plotColors();
    std::uint64_t most = 1;
    for (std::uint64_t count : histogram.count) most = std::max(most, count);
    const auto height = [&](double count) {
        const double top = static_cast<double>(most);
        return static_cast<float>((logCounts ? std::log1p(count) / std::log1p(top) : count / top) * kHighestBar);
    };
    std::vector<float> all, focus;
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        all.push_back(height(static_cast<double>(histogram.count[i])));
        if (brushed) focus.push_back(histogram.focus[i] > 0 ? height(histogram.focus[i]) : 0.0f);
    }
    drawBars(draw, frame, all, colors.bars);
    if (brushed) drawBars(draw, frame, focus, focusShade);
}

void drawCorrelation(ImDrawList& draw, const PlotFrame& frame, const volume::JointHistogram& joint, bool brushed,
                     ImU32 focusShade) {
    const PlotColors colors = plotColors();
    const auto line = [&](double r, float centerY, float scale, ImU32 color, const char* prefix) {
        char text[48];
        if (std::isnan(r))
            std::snprintf(text, sizeof text, "%s-", prefix);
        else
            std::snprintf(text, sizeof text, "%s%+.2f", prefix, r);
        float size = em() * scale;
        ImFont* font = ImGui::GetFont();
        const float width = font->CalcTextSizeA(size, 1e6f, 0, text).x;
        if (width > frame.width() * 0.92f) size *= frame.width() * 0.92f / width;
        if (size < em() * 0.55f) return;
        const ImVec2 extent = font->CalcTextSizeA(size, 1e6f, 0, text);
        draw.AddText(font, size,
                     {std::round((frame.min.x + frame.max.x - extent.x) / 2), std::round(centerY - extent.y / 2)},
                     color, text);
    };
    if (!std::isnan(joint.correlation)) {
        const int alpha = static_cast<int>(std::abs(joint.correlation) * 70);
        draw.AddRectFilled(frame.min, frame.max,
                           joint.correlation > 0 ? IM_COL32(230, 140, 40, alpha) : IM_COL32(50, 120, 220, alpha));
    }
    const float middle = (frame.min.y + frame.max.y) / 2;
    const bool two = brushed && frame.height() > em() * 2.4f;
    line(joint.correlation, two ? middle - em() * 0.55f : middle, 1, colors.text, "");
    if (two) line(joint.focusCorrelation, middle + em() * 0.6f, 0.9f, focusShade, "");
}

void drawNothingCommon(ImDrawList& draw, const PlotFrame& frame) {
    const char* text = "no common samples";
    const ImVec2 size = ImGui::CalcTextSize(text);
    if (size.x > frame.width() || size.y > frame.height()) return;
    draw.AddText(
        {std::round((frame.min.x + frame.max.x - size.x) / 2), std::round((frame.min.y + frame.max.y - size.y) / 2)},
        plotColors().frame, text);
}

/// Text for a bin's colour: the mean of the parameter, or the region if all samples are in one.
std::string thirdText(const volume::DatasetInfo& info, const std::string& colorBy, double mean) {
    const auto channel = info.findChannel(colorBy);
    if (!channel || !volume::parameterOf(info, *channel).categorical)
        return "mean " + colorBy + " " + formatNumber(mean);
    const volume::Parameter& label = volume::parameterOf(info, *channel);
    return std::abs(mean - std::round(mean)) > 0.01
               ? "in several " + label.name + "s"
               : label.name + " " + volume::labelName(label, static_cast<int>(std::lround(mean)));
}

void hoverText(const ScatterLayout& matrix, std::size_t column, std::size_t row, const PlotFrame& frame,
               const StatisticsResult& result, const volume::DatasetInfo& info, const std::string& colorBy,
               const std::string& selection) {
    const std::string selected = result.brushed ? selection : "";
    const glm::dvec2 at = frame.data(ImGui::GetIO().MousePos);
    const volume::Statistics& statistics = result.statistics;
    const auto bin = [](double value, Range range, std::size_t bins) {
        const double u = (value - range.lo) / (range.hi - range.lo) * static_cast<double>(bins);
        return static_cast<std::size_t>(std::clamp(u, 0.0, static_cast<double>(bins - 1)));
    };
    std::string text;
    if (column == row) {
        const volume::ChannelStatistics& channel = statistics.channels[column];
        const std::size_t bins = channel.histogram.count.size(), i = bin(at.x, channel.histogram.range, bins);
        text = binText(matrix.infos[column], channel.histogram.range, i, bins) + "\n" +
               countText(static_cast<double>(channel.histogram.count[i]), static_cast<double>(channel.all.samples),
                         channel.histogram.focus[i], selected);
    } else {
        for (const volume::JointHistogram& joint : statistics.joint) {
            if (joint.x != static_cast<int>(std::min(column, row)) ||
                joint.y != static_cast<int>(std::max(column, row)))
                continue;
            const auto bins = static_cast<std::size_t>(joint.bins);
            if (column > row) {
                text = matrix.infos[row].name + " and " + matrix.infos[column].name + "\ncorrelation ";
                text += std::isnan(joint.correlation) ? "not defined" : formatNumber(joint.correlation, 0.001);
                if (result.brushed)
                    text += "\nin " + selected + " " +
                            (std::isnan(joint.focusCorrelation) ? std::string("not defined")
                                                                : formatNumber(joint.focusCorrelation, 0.001));
                text += "\n" + formatCount(static_cast<double>(joint.samples)) + " samples have both";
            } else {
                const std::size_t bx = bin(at.x, joint.xRange, bins), by = bin(at.y, joint.yRange, bins);
                const std::size_t i = by * bins + bx;
                text = binText(matrix.infos[column], joint.xRange, bx, bins) + "\n" +
                       binText(matrix.infos[row], joint.yRange, by, bins) + "\n" +
                       countText(static_cast<double>(joint.count[i]), static_cast<double>(joint.samples),
                                 joint.focus[i], selected);
                if (i < joint.mean.size() && !std::isnan(joint.mean[i]))
                    text += "\n" + thirdText(info, colorBy, joint.mean[i]);
            }
        }
    }
    if (result.statistics.level > 0) text += "\n(estimated from a coarser level)";
    if (!text.empty()) ImGui::SetTooltip("%s", text.c_str());
}

void drawOutliers(ImDrawList& draw, const PlotFrame& frame, const volume::JointHistogram& joint,
                  const std::function<ImU32(std::size_t bin)>& colorOf) {
    const int bins = joint.bins;
    const double width = (joint.xRange.hi - joint.xRange.lo) / bins,
                 height = (joint.yRange.hi - joint.yRange.lo) / bins;
    const auto place = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(bins) + static_cast<std::size_t>(x);
    };
    const auto count = [&](int x, int y) {
        return x < 0 || y < 0 || x >= bins || y >= bins ? std::uint64_t(0) : joint.count[place(x, y)];
    };
    std::size_t drawn = 0;
    const float radius = std::max(1.0f, em() * 0.09f);
    for (int y = 0; y < bins; ++y)
        for (int x = 0; x < bins && drawn < kMostOutliers; ++x) {
            const std::uint64_t own = count(x, y);
            if (own == 0 || own > kFew) continue;
            int empty = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) empty += count(x + dx, y + dy) == 0;
            if (empty < 5) continue;
            draw.AddCircleFilled(frame.pixel(joint.xRange.lo + (x + 0.5) * width, joint.yRange.lo + (y + 0.5) * height),
                                 radius, colorOf(place(x, y)), 6);
            ++drawn;
        }
}

ImU32 meanColor(const vis::TransferFunction& function, Range range, double mean) {
    // The mean of two labels has no meaning.
    constexpr double kOneLabel = 0.01;
    if (function.colormap == "labels" && std::abs(mean - std::round(mean)) > kOneLabel) return toColor({0.5, 0.5, 0.5});
    const glm::dvec4 color = vis::evaluate(function, range, mean);
    return toColor({color.r, color.g, color.b});
}

int meanImage(const volume::JointHistogram& joint, int merge, const vis::TransferFunction& function, Range range,
              std::vector<std::uint8_t>& rgba) {
    const auto bins = static_cast<std::size_t>(joint.bins), step = static_cast<std::size_t>(std::max(1, merge));
    const std::size_t n = (bins + step - 1) / step;
    std::vector<double> sum(n * n), weight(n * n);
    for (std::size_t row = 0; row < bins; ++row)
        for (std::size_t column = 0; column < bins; ++column) {
            const std::size_t from = row * bins + column, to = row / step * n + column / step;
            if (from >= joint.mean.size() || std::isnan(joint.mean[from])) continue;
            const auto samples = static_cast<double>(joint.count[from]);
            sum[to] += samples * joint.mean[from];
            weight[to] += samples;
        }
    rgba.assign(n * n * 4, 0);
    for (std::size_t row = 0; row < n; ++row)
        for (std::size_t column = 0; column < n; ++column) {
            const std::size_t from = row * n + column;
            if (weight[from] <= 0) continue;
            const ImU32 color = meanColor(function, range, sum[from] / weight[from]);
            std::uint8_t* pixel = &rgba[((n - 1 - row) * n + column) * 4];
            for (const int shift : {IM_COL32_R_SHIFT, IM_COL32_G_SHIFT, IM_COL32_B_SHIFT, IM_COL32_A_SHIFT})
                *pixel++ = static_cast<std::uint8_t>(color >> shift & 255);
        }
    return static_cast<int>(n);
}

MatrixTitles matrixTitles(const ScatterLayout& matrix, ImVec2 room, double most, bool logCounts) {
    MatrixTitles titles;
    const auto n = static_cast<float>(matrix.size());
    const bool lone = matrix.size() == 1;
    titles.left = em() * 4, titles.bottom = em() * 3;
    const auto leavesRoom = [&] {
        return lone || ((room.x - titles.left) / n >= em() * 2.6f && (room.y - titles.bottom) / n >= em() * 1.9f);
    };
    titles.shown = leavesRoom();
    if (lone) {
        titles.counts = {0, (logCounts ? std::log10(1 + most) : std::max(1.0, most)) / kHighestBar};
        titles.countTitle = room.y < em() * 8 ? "" : logCounts ? "log10(1 + samples)" : "samples";
    }
    for (int pass = 0; titles.shown && pass < 2; ++pass) { // titles make the cells smaller that they stand beside
        const float cellX = (room.x - titles.left) / n - em() * 0.6f,
                    cellY = (room.y - titles.bottom) / n - em() * 0.6f;
        const TitleWidths across = titleWidths(matrix, 0, AxisSide::Bottom, cellX),
                          up = titleWidths(matrix, 1, AxisSide::Left, cellY);
        titles.below = titleWay(across, cellX);
        titles.beside = titleWay(up, cellY);
        titles.bottom = axisRoom(AxisSide::Bottom, matrix.ranges[0], placeOf(titles.below));
        if (titles.below == TitleWay::TwoLines) titles.bottom += em();
        if (titles.below == TitleWay::Across)
            titles.bottom += std::min(across.whole, mostAcross(room.y, across.rest + em() * 2)) + em() * 0.5f;
        titles.left = lone ? axisRoom(AxisSide::Left, titles.counts,
                                      titles.countTitle.empty() ? TitlePlace::Nowhere : TitlePlace::Beside)
                           : 0;
        for (std::size_t i = 1; i < matrix.size(); ++i)
            titles.left = std::max(titles.left, axisRoom(AxisSide::Left, matrix.ranges[i], placeOf(titles.beside)));
        if (titles.beside == TitleWay::TwoLines) titles.left += em();
        if (titles.beside == TitleWay::Across)
            titles.left += (cellY >= em() * kTwoLines ? std::min(up.part, mostAcross(room.x, up.rest))
                                                      : std::min(up.whole, mostAcross(room.x, up.rest + em() * 3))) +
                           em() * 0.5f;
        titles.shown = leavesRoom();
    }
    if (!titles.shown) titles.left = titles.bottom = 0;
    return titles;
}

namespace {

/// The title of a column below its numbers.
void drawTitleBelow(ImDrawList& draw, const PlotFrame& frame, const TitleParts& title, const MatrixTitles& titles) {
    const PlotColors colors = plotColors();
    const float middle = (frame.min.x + frame.max.x) / 2, bottom = frame.max.y + titles.bottom;
    if (titles.below == TitleWay::Across) {
        const float most = titles.bottom - axisRoom(AxisSide::Bottom, frame.x, TitlePlace::Elsewhere) - em() * 0.4f;
        const std::string shown = fittedTitle(title, most);
        const float half = widthOf(shown) / 2;
        addTextUpwards(draw, {middle, bottom - half}, colors.text, shown.c_str());
        tellWhole({middle - em() / 2, bottom - 2 * half}, {middle + em() / 2, bottom}, title.whole(), shown);
        return;
    }
    float y = bottom - em() * (titles.below == TitleWay::TwoLines ? 2.15f : 1.15f);
    const bool two = titles.below == TitleWay::TwoLines;
    for (const std::string& line : {two ? title.name : title.whole(), two ? title.rest : std::string()}) {
        draw.AddText({std::round(middle - widthOf(line) / 2), std::round(y)}, colors.faint, line.c_str());
        y += em();
    }
}

/// The title of a row beside its numbers.
void drawTitleBeside(ImDrawList& draw, const PlotFrame& frame, const TitleParts& title, const MatrixTitles& titles) {
    const PlotColors colors = plotColors();
    const float middle = (frame.min.y + frame.max.y) / 2, left = frame.min.x - titles.left;
    if (titles.beside == TitleWay::Across) {
        const float most = titles.left - axisRoom(AxisSide::Left, frame.y, TitlePlace::Elsewhere) - em() * 0.4f;
        const bool two = !title.rest.empty() && frame.height() >= em() * kTwoLines;
        float y = middle - em() * (two ? 1.0f : 0.5f);
        for (const std::string& line :
             {two ? title.name : fittedTitle(title, most), two ? title.rest : std::string()}) {
            addFittedText(draw, {std::round(left), std::round(y)}, colors.text, line, most);
            y += em();
        }
        return;
    }
    const bool two = titles.beside == TitleWay::TwoLines;
    float x = left + em() * 0.6f;
    for (const std::string& line : {two ? title.name : title.whole(), two ? title.rest : std::string()}) {
        addTextUpwards(draw, {x, middle}, colors.faint, line.c_str());
        x += em();
    }
}

} // namespace

void drawMatrixAxes(ImDrawList& draw, const ScatterLayout& matrix, const MatrixTitles& titles) {
    for (std::size_t i = 0; i < matrix.size() && titles.shown; ++i) {
        const PlotFrame across = matrix.cell(i, matrix.size() - 1);
        drawAxis(draw, across, AxisSide::Bottom, "", "", across.min.x, across.max.x, {.noteElsewhere = true});
        drawTitleBelow(draw, across, titleParts(matrix, i, AxisSide::Bottom, across.width()), titles);
        PlotFrame up = matrix.cell(0, i);
        if (matrix.size() == 1) {
            up.y = titles.counts;
            drawAxis(draw, up, AxisSide::Left, titles.countTitle, "", up.min.y, up.max.y, {.room = titles.left});
        }
        if (i == 0) continue;
        drawAxis(draw, up, AxisSide::Left, "", "", up.min.y, up.max.y, {.noteElsewhere = true});
        drawTitleBeside(draw, up, titleParts(matrix, i, AxisSide::Left, up.height()), titles);
    }
}

} // namespace tessera::app
