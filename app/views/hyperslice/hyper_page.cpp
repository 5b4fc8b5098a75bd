#include "app/views/hyperslice/hyper_page.h"

#include "app/pages/plot_marks.h"
#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/planes/contour_labels.h"
#include "app/ui/time_text.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

namespace tessera::app {

namespace {

constexpr int kFewPageCells = 96, kManyPageCells = 384; ///< of a panel on a page, along an edge
constexpr double kCellsOfPoint = 2;                     ///< cells, where the size of the page is given
constexpr int kRowsOfTable = 64;                        ///< of a panel, along an edge
constexpr int kProfilePlaces = 257;

PlotAxis pageAxis(const HyperAxis& axis) {
    return {
        .title = axis.label.title(), .range = axis.shown, .unit = axis.label.unit.name, .scale = axis.label.scale()};
}

/// Contour lines, broken beneath their values; `size`: of the plot on the page, points.
void addPanelLines(Plot& plot, const HyperMatrix& matrix, const std::vector<volume::ContourLine>& lines,
                   glm::dvec2 size, double text) {
    const glm::dvec2 from(plot.x.range.lo, plot.y.range.lo),
        span(plot.x.range.hi - plot.x.range.lo, plot.y.range.hi - plot.y.range.lo);
    std::vector<PageLine> onPage;
    for (const volume::ContourLine& line : lines) {
        PageLine& own = onPage.emplace_back(PageLine{contourText(line.level, matrix.content.levels.step), {}});
        for (const glm::dvec2& point : line.points) {
            const glm::dvec2 share = (point - from) / span;
            own.points.emplace_back(share.x * size.x, (1 - share.y) * size.y);
        }
    }
    const auto data = [&](glm::dvec2 at) { return from + glm::dvec2(at.x / size.x, 1 - at.y / size.y) * span; };
    std::vector<LineLabel> labels;
    if (matrix.lineValues)
        labels = placeLabels(onPage,
                             {{0, 0}, size, text, [&](const std::string& word) { return pageTextWidth(word, text); }});
    for (const LineLabel& label : labels)
        plot.labels.push_back({label.text, data(label.at), label.angle * 180 / std::numbers::pi});
    for (const std::vector<glm::dvec2>& piece : linesAround(onPage, labels)) {
        plot.contours.emplace_back();
        for (const glm::dvec2& point : piece) plot.contours.back().push_back(data(point));
    }
}

/// Lenses and brushes where they cross a panel that is a plane of space.
void addSections(Plot& plot, const Session& session, const volume::DatasetInfo& info, const HyperAxis& across,
                 const HyperAxis& up, bool dark) {
    for (const PlaneSection& section : panelSections(session, info, across.along, up.along)) {
        PlotOutline& outline = plot.outlines.emplace_back();
        const glm::dvec2 perUnit(across.along.perUnit, up.along.perUnit);
        for (const glm::dvec2& point : section.outline) outline.points.push_back(point * perUnit);
        outline.color = glm::vec4(section.color * (dark ? 1 : kBrightOnWhite), section.faint ? 0.35f : 1.0f);
        outline.dashed = section.dashed;
        if (section.middle) outline.dot = *section.middle * perUnit;
    }
}

Plot profilePlot(const volume::DatasetInfo& info, const HyperMatrix& matrix, const HyperAxis& axis,
                 const ProfileAlong& profile, bool dark) {
    const volume::Channel own = info.channel(matrix.content.channel);
    Plot plot;
    plot.x = pageAxis(axis);
    const Range values = profileRange(matrix.session, info, matrix.content.channel);
    plot.y = {.title = "", .range = values, .numbered = false};
    plot.right = PlotAxis{.title = own.name, .range = values, .unit = own.unit};
    plot.series.push_back({.name = "", .points = profile.points, .color = plotInk(0, dark), .right = true});
    plot.cursorX = placeAtCursor(axis, matrix.session, info);
    return plot;
}

/// Without a frame: where the cross-hair is, and what lines there are.
Plot wordsPlot(const std::vector<std::string>& lines) {
    Plot plot;
    plot.framed = false;
    plot.x.range = plot.y.range = {0, 1};
    for (std::size_t i = 0; i < lines.size(); ++i)
        plot.labels.push_back({lines[i], {0.5, 0.92 - 0.14 * static_cast<double>(i)}});
    return plot;
}

/// Rows of a table from places along both axes of a panel.
struct TableRows {
    std::vector<std::string> panels;
    std::array<std::vector<double>, 3> position;
    std::vector<double> times, values;

    void add(const std::string& panel, glm::dvec3 at, double time, double value) {
        panels.push_back(panel);
        for (int k = 0; k < 3; ++k) position[static_cast<std::size_t>(k)].push_back(at[k]);
        times.push_back(time);
        values.push_back(value);
    }
};

void addPanelRows(TableRows& rows, const volume::DatasetInfo& info, const std::string& name, const HyperValues& panel) {
    for (int j = 0; j < panel.query.cells.y; ++j)
        for (int i = 0; i < panel.query.cells.x; ++i) {
            double time = panel.query.time;
            for (int k = 0; k < 2; ++k) {
                const auto axis = static_cast<std::size_t>(k);
                if (panel.query.axes[axis].ofTime())
                    time = panel.query.axes[axis].at(
                        cellMiddle(panel.query.shown[axis], k == 0 ? i : j, panel.query.cells[k]), info.lattice.axes);
            }
            rows.add(name, panel.positionOf({i, j}, info.lattice.axes), time, panel.at(0, {i, j}));
        }
}

void addProfileRows(TableRows& rows, const volume::DatasetInfo& info, const std::string& name,
                    const ProfileAlong& profile) {
    const AxisPlaces& along = profile.query.along;
    for (const glm::dvec2& point : profile.points) {
        glm::dvec3 at = profile.query.cursor;
        const double own = along.at(point.x, info.lattice.axes);
        if (!along.ofTime()) at[along.dimension] = own;
        rows.add(name, at, along.ofTime() ? own : profile.query.time, point.y);
    }
}

} // namespace

Range profileRange(const Session& session, const volume::DatasetInfo& info, int channel) {
    const volume::Channel own = info.channel(channel);
    return paddedRange(vis::effectiveRange(transferOf(session, own.name), info.channelRange(own)), 0.05);
}

std::string hyperScale(const std::vector<HyperAxis>& axes, const volume::DatasetInfo& info) {
    volume::AxisMaps maps;
    for (const HyperAxis& axis : axes)
        if (!axis.along.ofTime())
            maps.of[static_cast<std::size_t>(axis.along.dimension)] =
                info.lattice.axes.of[static_cast<std::size_t>(axis.along.dimension)];
    const std::string cells = stretchText(glm::dvec3(1), maps);
    return "not to scale" + (cells.empty() ? "" : ", " + cells);
}

std::vector<std::string> hyperPlaces(const Session& session, const volume::DatasetInfo& info) {
    std::vector<std::string> texts;
    const AxisLabels labels = axisLabels(session, info);
    for (int axis = 0; axis < 3; ++axis) {
        const AxisLabel& label = labels[static_cast<std::size_t>(axis)];
        const double digits = tellingLength(info, axis, session.cursor, 1e-3) * label.unit.perUnit;
        texts.push_back(label.name + " = " +
                        formatQuantity(session.cursor[axis] * label.unit.perUnit, label.unit.name, digits));
    }
    return texts;
}

std::vector<std::string> hyperTimes(const std::vector<HyperAxis>& axes, const Session& session,
                                    const volume::DatasetInfo& info) {
    if (info.times.size() < 2) return {};
    std::vector<std::string> texts{timeText(info, session.time)};
    for (const HyperAxis& axis : axes)
        if (axis.along.ofTime() && axis.key != "time")
            texts.push_back(axis.label.name + " = " +
                            formatQuantity(placeAtCursor(axis, session, info), axis.label.unit.name,
                                           (axis.whole.hi - axis.whole.lo) / 1000));
    return texts;
}

VectorPage hyperPage(const volume::BrickSource& source, const HyperMatrix& matrix, const PageForm& form,
                     const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const std::size_t count = matrix.axes.size();
    const volume::Channel own = info.channel(matrix.content.channel);
    const vis::TransferFunction& function = transferOf(matrix.session, own.name);
    std::vector<Plot> plots(count * count, wordsPlot({}));
    const auto panels = [&](const auto& visit) {
        for (std::size_t row = 0; row < count; ++row)
            for (std::size_t column = 0; column < row; ++column) visit(plots[row * count + column], column, row);
    };
    for (std::size_t k = 0; k < count; ++k)
        plots[k * count + k] =
            profilePlot(info, matrix, matrix.axes[k],
                        readProfileAlong(source, profileAlongQuery(matrix.axes[k], matrix.content.channel,
                                                                   kProfilePlaces, matrix.session, info)),
                        form.dark);
    panels([&](Plot& plot, std::size_t column, std::size_t row) {
        plot = {};
        plot.x = pageAxis(matrix.axes[column]);
        plot.y = pageAxis(matrix.axes[row]);
        plot.cursorX = placeAtCursor(matrix.axes[column], matrix.session, info);
        plot.cursorY = placeAtCursor(matrix.axes[row], matrix.session, info);
    });
    std::vector<std::string> words = hyperPlaces(matrix.session, info);
    for (std::string& text : hyperTimes(matrix.axes, matrix.session, info)) words.push_back(std::move(text));
    words.push_back(hyperScale(matrix.axes, info));
    if (matrix.content.lined) words.push_back(contourTitle(info.channel(*matrix.content.lined), matrix.content.levels));
    if (count > 1) plots[count - 1] = wordsPlot(words);
    const bool labels = info.parameters[static_cast<std::size_t>(own.parameter)].categorical;
    if (count > 1 && !labels)
        plots[(count - 1) * count + count - 2].key =
            colorKey(function, vis::effectiveRange(function, info.channelRange(own)));
    const int columns = static_cast<int>(count);
    const glm::dvec2 size = plotArea(plots, columns, form);
    const glm::ivec2 cells =
        glm::clamp(form.size.x > 0 ? glm::ivec2(size * kCellsOfPoint) : glm::ivec2(0), kFewPageCells, kManyPageCells);
    double done = 0;
    const double each = 2.0 / static_cast<double>(std::max<std::size_t>(2, count * (count - 1)));
    panels([&](Plot& plot, std::size_t column, std::size_t row) {
        const HyperValues values = readPanel(
            source,
            panelQuery(matrix.axes[column], matrix.axes[row], matrix.content.channels, cells, matrix.session, info),
            progress.part(done, done + each));
        done += each;
        plot.image = {cells.x, cells.y, panelImage(info, matrix.session, matrix.content, values)};
        addSections(plot, matrix.session, info, matrix.axes[column], matrix.axes[row], form.dark);
        addPanelLines(plot, matrix, panelLines(info, matrix.content, values), size, form.text);
    });
    return plotPage(plots, columns, form);
}

Table hyperTable(const volume::BrickSource& source, const HyperMatrix& matrix, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const int channel = matrix.content.channel;
    TableRows rows;
    const double each =
        2.0 / static_cast<double>(std::max<std::size_t>(2, matrix.axes.size() * (matrix.axes.size() - 1)));
    double done = 0;
    for (std::size_t row = 0; row < matrix.axes.size(); ++row)
        for (std::size_t column = 0; column < row; ++column) {
            const HyperAxis &across = matrix.axes[column], &up = matrix.axes[row];
            addPanelRows(rows, info, across.label.title() + ", " + up.label.title(),
                         readPanel(source,
                                   panelQuery(across, up, {channel}, glm::ivec2(kRowsOfTable), matrix.session, info),
                                   progress.part(done, done + each)));
            done += each;
        }
    for (const HyperAxis& axis : matrix.axes)
        addProfileRows(
            rows, info, axis.label.title(),
            readProfileAlong(source, profileAlongQuery(axis, channel, kProfilePlaces, matrix.session, info)));
    const volume::Channel own = info.channel(channel);
    Table table{.columns = {},
                .notes = {"values: interpolated between the samples; panels: in the middles of " +
                          std::to_string(kRowsOfTable) + " x " + std::to_string(kRowsOfTable) +
                          " cells of what is shown"}};
    table.columns.push_back({.name = "panel", .texts = std::move(rows.panels)});
    const AxisLabels labels = axisLabels(matrix.session, info);
    for (std::size_t k = 0; k < 3; ++k) {
        for (double& place : rows.position[k]) place *= labels[k].unit.perUnit;
        table.columns.push_back(
            {.name = labels[k].name, .unit = labels[k].unit.name, .numbers = std::move(rows.position[k])});
    }
    for (const HyperAxis& axis : matrix.axes) {
        if (!axis.along.ofTime() || axis.key == "time") continue;
        TableColumn& column = table.columns.emplace_back(TableColumn{.name = axis.key, .unit = axis.label.unit.name});
        for (const double time : rows.times) column.numbers.push_back(axis.along.placeOf(time, info.lattice.axes));
    }
    if (info.times.size() > 1)
        table.columns.push_back({.name = info.timeName, .unit = info.timeUnit, .numbers = std::move(rows.times)});
    table.columns.push_back({.name = own.name, .unit = own.unit, .numbers = std::move(rows.values)});
    return table;
}

} // namespace tessera::app
