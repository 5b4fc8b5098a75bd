#include "app/views/slices/flat_slice.h"

#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/views/slices/slice_figure.h"
#include "volume/field/time_pair.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr double kSameOffset = 1e-9; ///< of the box: closer planes are one
constexpr double kMargin = 0.02;     ///< around the part in the box
constexpr double kAlong = 1 - 1e-8;  ///< cosine to an axis from which on a direction has its name
constexpr double kLeastSpan = 1e-3;  ///< of the box, where the plane touches a corner only

/// What values span, with a margin and never less than `least`.
Range spanOf(const std::vector<double>& values, double least) {
    const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
    const double margin = std::max(kMargin * (*hi - *lo), (least - (*hi - *lo)) / 2);
    return {*lo - margin, *hi + margin};
}

/// "x" for a direction along an axis, else the other name.
std::string nameOf(glm::dvec3 direction, const char* other) {
    const glm::dvec3 size = glm::abs(direction);
    return std::max({size.x, size.y, size.z}) > kAlong ? directionText(direction) : other;
}

/// "x", or "u = 0.71 x - 0.71 z".
std::string axisText(const std::string& name, glm::dvec3 direction) {
    return name == "u" || name == "v" ? name + " = " + directionText(direction) : name;
}

/// Places on a grid over the whole picture, row by row from below; the longer edge of the data has kSliceCells.
std::vector<std::vector<glm::dvec3>> gridOf(const FlatSlice& flat, bool ends, glm::ivec2 count) {
    std::vector<std::vector<glm::dvec3>> rows;
    const auto share = [&](int i, int n) { return ends ? i / (n - 1.0) : (i + 0.5) / n; };
    for (int j = 0; j < count.y; ++j) {
        rows.emplace_back();
        for (int i = 0; i < count.x; ++i)
            rows.back().push_back(flat.placeAt({std::lerp(flat.x.lo, flat.x.hi, share(i, count.x)),
                                                std::lerp(flat.y.lo, flat.y.hi, share(j, count.y))}));
    }
    return rows;
}

bool inside(const volume::Box& box, glm::dvec3 place) {
    for (int axis = 0; axis < 3; ++axis)
        if (place[axis] < box.lo[axis] || place[axis] > box.hi[axis]) return false;
    return true;
}

} // namespace

FlatSlice flatSlice(const Session& session, const volume::DatasetInfo& info, glm::dvec3 normal) {
    const double size = glm::length(info.bounds.size()), same = kSameOffset * std::max(size, 1e-300);
    FlatSlice flat;
    flat.plane.normal = unitNormal(normal);
    flat.plane.at = flat.plane.normal * (std::round(glm::dot(flat.plane.normal, session.cursor) / same) * same);
    flat.axes = flatAxes(normal, vis::worldFrame(info.bounds, session.stretch));
    flat.corners = planeSection(flat.plane, info.bounds);
    std::vector<double> across, upwards;
    for (const glm::dvec3& corner : flat.corners.empty() ? std::vector{session.cursor} : flat.corners) {
        across.push_back(flat.along(corner).x);
        upwards.push_back(flat.along(corner).y);
    }
    flat.x = spanOf(across, kLeastSpan * size);
    flat.y = spanOf(upwards, kLeastSpan * size);
    flat.unitX = suitableLength(info.lengthUnit, flat.x.hi - flat.x.lo);
    flat.unitY = suitableLength(info.lengthUnit, flat.y.hi - flat.y.lo);
    flat.nameX = nameOf(flat.axes.right, "u");
    flat.nameY = nameOf(flat.axes.up, "v");
    return flat;
}

std::string placeText(const FlatSlice& flat, const volume::DatasetInfo& info) {
    const double size = glm::length(info.bounds.size());
    const LengthUnit unit = suitableLength(info.lengthUnit, size);
    const double offset = glm::dot(flat.plane.normal, flat.plane.at) * unit.perUnit;
    return "across " + directionText(flat.plane.normal) + " at " +
           formatQuantity(offset, unit.name, size * unit.perUnit / 1000);
}

std::string axesText(const FlatSlice& flat) {
    std::string text;
    if (flat.nameX == "u") text = axisText("u", flat.axes.right);
    if (flat.nameY == "v") text += (text.empty() ? "" : ", ") + axisText("v", flat.axes.up);
    return text;
}

VectorPage flatDrawing(const volume::BrickSource& source, const Session& session, const FlatSlice& flat,
                       const ContourSettings& lines, int channel, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const volume::Channel own = info.channel(channel);
    const vis::TransferFunction& function = transferOf(session, own.name);
    const Range range = vis::effectiveRange(function, info.channelRange(own));
    const double digits = (range.hi - range.lo) / 100;
    const auto scaled = [](Range values, double by) { return Range{values.lo * by, values.hi * by}; };
    FigurePanel panel;
    panel.title = own.name + " " + formatNumber(range.lo, digits) + " .. " + formatQuantity(range.hi, own.unit, digits);
    panel.note = placeText(flat, info);
    panel.x = {axisText(flat.nameX, flat.axes.right) + " [" + flat.unitX.name + "]",
               scaled(flat.x, flat.unitX.perUnit)};
    panel.y = {axisText(flat.nameY, flat.axes.up) + " [" + flat.unitY.name + "]", scaled(flat.y, flat.unitY.perUnit)};
    panel.image.width = panel.image.height = kSliceCells;
    const volume::TimePair time = volume::timesAround(info.times, session.time);
    const auto rows = gridOf(flat, false, {kSliceCells, kSliceCells});
    for (std::size_t j = rows.size(); j-- > 0;) {
        progress.advance(0.5 * (1 - static_cast<double>(j) / kSliceCells));
        const auto values = volume::probeAlong(source, channel, rows[j], time);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const bool shown = values[i].interpolated && inside(info.bounds, rows[j][i]);
            const glm::dvec4 color = shown ? vis::evaluate(function, range, *values[i].interpolated) : glm::dvec4(0);
            for (int k = 0; k < 3; ++k)
                panel.image.rgba.push_back(
                    static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[k], 0.0, 1.0))));
            panel.image.rgba.push_back(shown ? 255 : 0);
        }
    }
    addContours(panel, source, session, lines, channel, {channel, flat.page(), flat.x, flat.y, time, {}},
                flat.perUnit(), progress.part(0.5, 1));
    FigureOutline edge{.points = {}, .color = {0.267f, 0.267f, 0.267f, 1}};
    for (const glm::dvec3& corner : flat.corners) edge.points.push_back(flat.along(corner) * flat.perUnit());
    panel.outlines.push_back(std::move(edge));
    addSections(panel, session, info, flat.page(), flat.perUnit());
    return drawingOf({panel}, 1);
}

std::string flatCsv(const volume::BrickSource& source, const Session& session, const FlatSlice& flat,
                    const std::vector<int>& channels, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    std::string csv = "# values: interpolated between the samples\nu,v,x,y,z";
    for (const int channel : channels) {
        const volume::Channel own = info.channel(channel);
        csv += "," + csvField(titleWithUnit(own.name, own.unit));
    }
    csv += "\n";
    const volume::TimePair time = volume::timesAround(info.times, session.time);
    const double wide = flat.x.hi - flat.x.lo, high = flat.y.hi - flat.y.lo, longer = std::max(wide, high);
    const auto count = [&](double edge) {
        return std::max(2, static_cast<int>(std::lround(kSliceCells * edge / longer)));
    };
    const auto rows = gridOf(flat, true, {count(wide), count(high)});
    for (std::size_t j = 0; j < rows.size(); ++j) {
        progress.advance(static_cast<double>(j) / static_cast<double>(rows.size()));
        std::vector<glm::dvec3> row;
        std::copy_if(rows[j].begin(), rows[j].end(), std::back_inserter(row),
                     [&](glm::dvec3 place) { return inside(info.bounds, place); });
        if (row.empty()) continue;
        std::vector<std::vector<volume::ProbeValue>> values;
        for (const int channel : channels) values.push_back(volume::probeAlong(source, channel, row, time));
        for (std::size_t i = 0; i < row.size(); ++i) {
            const glm::dvec2 at = flat.along(row[i]);
            csv += csvNumber(at.x) + "," + csvNumber(at.y) + "," + csvNumber(row[i].x) + "," + csvNumber(row[i].y) +
                   "," + csvNumber(row[i].z);
            for (const auto& column : values) csv += "," + csvNumber(column[i].interpolated.value_or(std::nan("")));
            csv += "\n";
        }
    }
    return csv;
}

} // namespace tessera::app
