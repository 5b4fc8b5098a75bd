#include "app/views/slices/slice_figure.h"

#include "app/pane/axis_label.h"
#include "app/pane/view_parts.h"
#include "app/tools/plane_sections.h"
#include "app/ui/ticks.h"
#include "app/views/slices/contour_labels.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera::app {

namespace {

constexpr float kOnWhite = 0.7f; // of light colours, which vanish on white

/// The lines, broken beneath the values written on them.
void addLines(FigurePanel& panel, const Contours& contours, double step, bool values, glm::dvec2 perUnit) {
    // Placed in points, as the page has them, and kept in the units of the axes.
    const glm::dvec2 size = kFigurePlot, from(panel.x.range.lo, panel.y.range.lo),
                     span(panel.x.range.hi - panel.x.range.lo, panel.y.range.hi - panel.y.range.lo);
    if (!(span.x > 0) || !(span.y > 0)) return;
    std::vector<PageLine> lines;
    for (const volume::ContourLine& line : contours.lines) {
        PageLine& own = lines.emplace_back(PageLine{contourText(line.level, step), {}});
        for (const glm::dvec2& point : line.points) {
            const glm::dvec2 share = (point * perUnit - from) / span;
            own.points.emplace_back(share.x * size.x, (1 - share.y) * size.y);
        }
    }
    const auto data = [&](glm::dvec2 at) { return from + glm::dvec2(at.x / size.x, 1 - at.y / size.y) * span; };
    std::vector<LineLabel> labels;
    if (values) labels = placeLabels(lines, {{0, 0}, size, kFigureText, figureTextWidth});
    for (const LineLabel& label : labels)
        panel.labels.push_back({label.text, data(label.at), label.angle * 180 / std::numbers::pi});
    for (const std::vector<glm::dvec2>& piece : linesAround(lines, labels)) {
        panel.contours.emplace_back();
        for (const glm::dvec2& point : piece) panel.contours.back().push_back(data(point));
    }
}

} // namespace

void addContours(FigurePanel& panel, const volume::BrickSource& source, const Session& session,
                 const ContourSettings& settings, int shown, ContourQuery query, glm::dvec2 perUnit,
                 const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const std::optional<int> lined = contourChannel(info, settings, shown);
    if (!lined) return;
    const ContourLevels levels = contourLevels(session, info, *lined, settings.count);
    query.channel = *lined;
    query.levels = levels.values;
    // Below the title, or behind it where something else stands there.
    const std::string text = contourTitle(info.channel(*lined), levels);
    panel.note.empty() ? panel.note = text : panel.title += "; " + text;
    addLines(panel, readContours(source, query, progress), levels.step, settings.values, perUnit);
}

void addSections(FigurePanel& panel, const Session& session, const volume::DatasetInfo& info, const PicturePlane& plane,
                 glm::dvec2 perUnit) {
    for (const PlaneSection& section : planeSections(session, info, plane)) {
        FigureOutline outline;
        for (const glm::dvec2& point : section.outline) outline.points.push_back(point * perUnit);
        outline.color = glm::vec4(section.color * kOnWhite, section.faint ? 0.35f : 1.0f);
        outline.dashed = section.dashed;
        if (section.middle) outline.dot = *section.middle * perUnit;
        panel.outlines.push_back(std::move(outline));
    }
}

FigurePanel slicePanel(const volume::BrickSource& source, const Session& session, int channel, const SliceAxes& axes,
                       double position) {
    const volume::DatasetInfo& info = source.info();
    const AxisLabels labels = axisLabels(session, info);
    const auto& [nameX, unitX] = labels[static_cast<std::size_t>(axes.right)];
    const auto& [nameY, unitY] = labels[static_cast<std::size_t>(axes.up)];
    const auto& [name, unit] = labels[static_cast<std::size_t>(axes.normal)];
    const double depth = info.bounds.size()[axes.normal] * unit.perUnit;
    const volume::Channel own = info.channel(channel);
    const vis::TransferFunction& function = transferOf(session, own.name);
    const Range range = vis::effectiveRange(function, info.channelRange(own));
    const double digits = (range.hi - range.lo) / 100;
    FigurePanel panel;
    panel.title = name + (" = " + formatQuantity(position * unit.perUnit, unit.name, depth / 100)) + ", " + own.name +
                  " " + formatNumber(range.lo, digits) + " .. " + formatQuantity(range.hi, own.unit, digits);
    panel.x = {std::string(nameX) + " [" + unitX.name + "]",
               {info.bounds.lo[axes.right] * unitX.perUnit, info.bounds.hi[axes.right] * unitX.perUnit}};
    panel.y = {std::string(nameY) + " [" + unitY.name + "]",
               {info.bounds.lo[axes.up] * unitY.perUnit, info.bounds.hi[axes.up] * unitY.perUnit}};
    panel.image.width = panel.image.height = kSliceCells;
    const volume::TimePair time = volume::timesAround(info.times, session.time);
    for (int j = kSliceCells - 1; j >= 0; --j) {
        std::vector<glm::dvec3> row;
        for (int i = 0; i < kSliceCells; ++i) {
            glm::dvec3 at(0);
            at[axes.normal] = position;
            at[axes.right] = info.bounds.lo[axes.right] + info.bounds.size()[axes.right] * (i + 0.5) / kSliceCells;
            at[axes.up] = info.bounds.lo[axes.up] + info.bounds.size()[axes.up] * (j + 0.5) / kSliceCells;
            row.push_back(at);
        }
        for (const volume::ProbeValue& value : volume::probeAlong(source, channel, row, time)) {
            const glm::dvec4 color =
                value.interpolated ? vis::evaluate(function, range, *value.interpolated) : glm::dvec4(0);
            for (int k = 0; k < 3; ++k)
                panel.image.rgba.push_back(
                    static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[k], 0.0, 1.0))));
            panel.image.rgba.push_back(value.interpolated ? 255 : 0);
        }
    }
    return panel;
}

VectorPage slicesDrawing(const volume::BrickSource& source, const Session& session, const SlicesView& view, int channel,
                         const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const AxisLabels labels = axisLabels(session, info);
    std::vector<FigurePanel> panels;
    for (const SliceAxes& axes : kSlicePlanes) {
        const double done = static_cast<double>(panels.size()) / std::size(kSlicePlanes);
        progress.advance(done);
        const double position = session.cursor[axes.normal];
        FigurePanel& panel = panels.emplace_back(slicePanel(source, session, channel, axes, position));
        const glm::dvec2 perUnit(labels[static_cast<std::size_t>(axes.right)].unit.perUnit,
                                 labels[static_cast<std::size_t>(axes.up)].unit.perUnit);
        addContours(panel, source, session, view.lines, channel,
                    contourQuery(info, channel, axes, position, volume::timesAround(info.times, session.time), {}),
                    perUnit, progress.part(done, done + 1.0 / std::size(kSlicePlanes)));
        addSections(panel, session, info, planeAcross(axes.right, axes.up, axes.normal, position), perUnit);
    }
    return drawingOf(panels, 2);
}

} // namespace tessera::app
