#include "app/views/scatter/scatter_page.h"

#include "app/pane/plot.h"
#include "app/values/selection_text.h"
#include "app/views/scatter/scatter_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tessera::app {

namespace {

volume::Channel queryChannel(const volume::DatasetInfo& info, const StatisticsResult& result, std::size_t position) {
    return info.channel(result.query.channels[position]);
}

Plot histogramCell(const volume::Histogram& histogram, bool brushed, const ScatterPageLook& look, bool alone) {
    Plot cell;
    std::uint64_t most = 1;
    for (const std::uint64_t count : histogram.count) most = std::max(most, count);
    const auto height = [&](double count) { return look.logDensity ? std::log10(1 + count) : count; };
    const ImVec4 focus = ImGui::ColorConvertU32ToFloat4(look.focus);
    cell.series = {{.name = "", .points = {}, .color = {0.53f, 0.57f, 0.64f}, .bars = true}};
    if (brushed) cell.series.push_back({.name = "", .points = {}, .color = {focus.x, focus.y, focus.z}, .bars = true});
    const double width = (histogram.range.hi - histogram.range.lo) / double(histogram.count.size());
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        const double at = histogram.range.lo + (double(i) + 0.5) * width;
        cell.series[0].points.push_back({at, height(double(histogram.count[i]))});
        if (brushed) cell.series[1].points.push_back({at, height(histogram.focus[i])});
    }
    cell.y = {.title = !alone            ? ""
                       : look.logDensity ? "log10(1 + samples)"
                                         : "samples",
              .range = {0, height(double(most)) / kHighestBar},
              .numbered = alone};
    return cell;
}

Plot correlationCell(const volume::JointHistogram& joint) {
    Plot cell;
    char text[32] = "-";
    if (!std::isnan(joint.correlation)) std::snprintf(text, sizeof text, "%+.2f", joint.correlation);
    cell.x.range = cell.y.range = {0, 1};
    cell.labels = {{text, {0.5, 0.5}}};
    cell.framed = false;
    return cell;
}

} // namespace

VectorPage matrixPage(const volume::DatasetInfo& info, const StatisticsResult& result, std::size_t shown,
                      const ScatterPageLook& look, const PageForm& form) {
    std::vector<Plot> cells;
    for (std::size_t row = 0; row < shown; ++row)
        for (std::size_t column = 0; column < shown; ++column) {
            const auto axis = [&](std::size_t position) {
                const volume::Channel own = queryChannel(info, result, position);
                return PlotAxis{.title = own.name, .range = result.query.ranges[position], .unit = own.unit};
            };
            const int pair = jointIndex(result.statistics, std::min(column, row), std::max(column, row));
            Plot cell;
            if (column == row) {
                cell = histogramCell(result.statistics.channels[row].histogram, result.brushed, look, shown == 1);
            } else if (pair >= 0 && column > row) {
                cell = correlationCell(result.statistics.joint[std::size_t(pair)]);
            } else if (pair >= 0) {
                const volume::JointHistogram& joint = result.statistics.joint[std::size_t(pair)];
                cell.y = axis(row);
                const bool means = !joint.mean.empty() && look.meanRange.hi > look.meanRange.lo;
                const std::span<const double> focus =
                    result.brushed ? std::span<const double>(joint.focus) : std::span<const double>();
                cell.image.width = cell.image.height =
                    means ? meanImage(joint, 1, look.mean, look.meanRange, cell.image.rgba)
                          : densityImage(joint.count, focus, joint.bins, 1, look.logDensity, form.dark, look.focus,
                                         cell.image.rgba);
            }
            if (cell.framed) cell.x = axis(column);
            cells.push_back(std::move(cell));
        }
    PageForm plain = form;
    plain.legend = false; // there are no series with names
    return plotPage(cells, static_cast<int>(shown), plain, true);
}

Table matrixTable(const volume::DatasetInfo& info, const StatisticsResult& result, const std::string& selected) {
    Table table{.columns = {{.name = "x parameter"},
                            {.name = "x unit"},
                            {.name = "y parameter"},
                            {.name = "y unit"},
                            {.name = "x"},
                            {.name = "y"},
                            {.name = "samples"}}};
    const bool brushed = result.brushed && !selected.empty();
    if (brushed) table.columns.push_back({.name = "samples in " + selected});
    const auto text = [&](std::size_t column, const std::string& value) {
        table.columns[column].texts.push_back(value);
    };
    const auto number = [&](std::size_t column, double value) { table.columns[column].numbers.push_back(value); };
    for (const volume::JointHistogram& joint : result.statistics.joint) {
        const volume::Channel x = queryChannel(info, result, std::size_t(joint.x)),
                              y = queryChannel(info, result, std::size_t(joint.y));
        const auto middle = [&](Range range, std::size_t bin) {
            return range.lo + (range.hi - range.lo) * (double(bin) + 0.5) / joint.bins;
        };
        for (std::size_t i = 0; i < joint.count.size(); ++i) {
            if (joint.count[i] == 0) continue;
            text(0, x.name), text(1, x.unit), text(2, y.name), text(3, y.unit);
            number(4, middle(joint.xRange, i % std::size_t(joint.bins)));
            number(5, middle(joint.yRange, i / std::size_t(joint.bins)));
            number(6, double(joint.count[i]));
            if (brushed) number(7, joint.focus[i]);
        }
    }
    if (brushed) sayWeighted(table.columns.back());
    return table;
}

} // namespace tessera::app
