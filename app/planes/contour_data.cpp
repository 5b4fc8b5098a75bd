#include "app/planes/contour_data.h"

#include "app/drawing/line_pieces.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr int kFewNodes = 160, kMostNodes = 512; ///< along the longer and along any edge of the grid of lines
constexpr int kBand = 16;                        ///< rows of it that are read at once

/// Nodes along a direction: on the samples where there are not too many, and between them where there are few.
int nodesAlong(const volume::DatasetInfo& info, glm::dvec3 direction, double length, int finer) {
    const double each = info.lattice.kind == volume::LatticeKind::BCC ? 2 : 1;
    const double cells = length * glm::length(direction / info.lattice.spacing) * each;
    return std::clamp(std::isfinite(cells) ? static_cast<int>(std::lround(cells)) * finer : 1, 1, kMostNodes - 1) + 1;
}

/// The nodes of a query, row by row from below. Those beside the data that have a neighbour in them stand at the
/// nearest place in them, so that lines reach their faces; the others have none.
struct ContourNodes {
    glm::ivec2 size{0};
    glm::dvec2 step{0};
    std::vector<std::optional<glm::dvec3>> places;
    std::vector<std::size_t> beside;  ///< those that stand at the edge instead, and as far within it
    std::vector<glm::dvec3> mirrored; ///< as they are beside it
    std::vector<glm::dvec2> within;   ///< the part of the picture in the data, where some nodes are beside it
};

ContourNodes nodesOf(const volume::DatasetInfo& info, const ContourQuery& query) {
    const PicturePlane& plane = query.plane;
    const glm::dvec2 lo(query.x.lo, query.y.lo), span(query.x.hi - query.x.lo, query.y.hi - query.y.lo);
    const int most = std::max(nodesAlong(info, plane.right, span.x, 1), nodesAlong(info, plane.up, span.y, 1));
    const int finer = std::clamp((kFewNodes + most - 1) / most, 1, 4);
    ContourNodes nodes;
    nodes.size = {nodesAlong(info, plane.right, span.x, finer), nodesAlong(info, plane.up, span.y, finer)};
    nodes.step = span / glm::dvec2(nodes.size - 1);
    const volume::AxisMaps& maps = query.maps; // pictures may be to scale where the samples are not even
    const double slack = 1e-9 * glm::length(info.bounds.size());
    const double near = 1.5 * glm::length(nodes.step);
    bool beside = false;
    for (int j = 0; j < nodes.size.y; ++j)
        for (int i = 0; i < nodes.size.x; ++i) {
            const glm::dvec3 at = plane.placeAt(lo + nodes.step * glm::dvec2(i, j));
            glm::dvec3 inside = glm::clamp(at, info.bounds.lo, info.bounds.hi);
            double away = glm::distance(inside, at);
            if (away > slack) {
                beside = true;
                if (away <= near) inside = nearestInPlane(plane.plane(), info.bounds, at);
                away = std::max(away, glm::distance(inside, at));
            }
            if (away > slack && away <= near) {
                nodes.beside.push_back(nodes.places.size());
                nodes.mirrored.push_back(maps.toSpace(2.0 * inside - at));
            }
            nodes.places.push_back(away <= near ? std::optional(maps.toSpace(inside)) : std::nullopt);
        }
    if (beside)
        for (const glm::dvec3& corner : planeSection(plane.plane(), info.bounds))
            nodes.within.push_back(plane.along(corner));
    return nodes;
}

} // namespace

ContourLevels contourLevels(Range range, int count) {
    const double span = range.hi - range.lo;
    ContourLevels out;
    if (!(span > 0) || !std::isfinite(span) || count < 1) return out;
    // A line at the least or largest value would be where values end.
    for (int most = count; most < count + 5 && out.values.empty(); ++most) {
        out.step = niceStep(span, most);
        for (const double value : niceTicks(range, most))
            if (value > range.lo + span * 1e-9 && value < range.hi - span * 1e-9) out.values.push_back(value);
    }
    return out;
}

std::string contourText(double level, double step) {
    return std::abs(level) < step * 1e-6 ? "0" : formatNumber(level, step);
}

Contours readContours(const volume::BrickSource& source, const ContourQuery& query, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const ContourNodes nodes = nodesOf(info, query);
    const volume::Channel channel = info.channel(query.channel);
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
    const std::optional<int> label = volume::labelChannel(info, parameter);
    volume::PlaneValues plane;
    plane.size = nodes.size;
    plane.values.assign(nodes.places.size(), std::nan(""));
    if (label) plane.parts.assign(nodes.places.size(), 0);
    const std::size_t band = static_cast<std::size_t>(kBand) * static_cast<std::size_t>(nodes.size.x);
    for (std::size_t first = 0; first < nodes.places.size(); first += band) {
        progress.advance(static_cast<double>(first) / static_cast<double>(nodes.places.size()));
        std::vector<glm::dvec3> places;
        std::vector<std::size_t> indices;
        for (std::size_t k = first; k < std::min(first + band, nodes.places.size()); ++k)
            if (nodes.places[k]) {
                places.push_back(*nodes.places[k]);
                indices.push_back(k);
            }
        const auto each = [&](int which, const auto& take) {
            const auto values = volume::probeAlong(source, which, places, query.time);
            for (std::size_t i = 0; i < values.size(); ++i) take(indices[i], values[i]);
        };
        each(query.channel, [&](std::size_t k, const volume::ProbeValue& value) {
            plane.values[k] = value.interpolated.value_or(std::nan(""));
        });
        if (label)
            each(*label, [&](std::size_t k, const volume::ProbeValue& value) {
                if (value.nearest)
                    plane.parts[k] =
                        static_cast<int>(parameter.parts.partOf(static_cast<int>(std::lround(*value.nearest))));
            });
    }
    // Beside the data values go on as they come from within.
    if (!label && !nodes.mirrored.empty()) {
        const auto mirrored = volume::probeAlong(source, query.channel, nodes.mirrored, query.time);
        for (std::size_t i = 0; i < mirrored.size(); ++i)
            if (double& value = plane.values[nodes.beside[i]]; mirrored[i].interpolated)
                value += value - *mirrored[i].interpolated;
    }
    Contours out;
    for (volume::ContourLine& line : volume::contourLines(plane, query.levels)) {
        for (glm::dvec2& point : line.points) point = glm::dvec2(query.x.lo, query.y.lo) + point * nodes.step;
        if (nodes.within.empty()) {
            out.lines.push_back(std::move(line));
            continue;
        }
        for (std::vector<glm::dvec2>& piece : piecesWithin(line.points, nodes.within))
            out.lines.push_back({line.level, std::move(piece)});
    }
    return out;
}

std::optional<int> contourChannel(const volume::DatasetInfo& info, const ContourSettings& settings, int shown) {
    if (settings.count < 1) return std::nullopt;
    const auto channel = settings.channel.empty() ? std::optional(shown) : info.findChannel(settings.channel);
    if (!channel) return std::nullopt;
    const int parameter = info.channel(*channel).parameter;
    return info.parameters[static_cast<std::size_t>(parameter)].categorical ? std::nullopt : channel;
}

ContourLevels contourLevels(const Session& session, const volume::DatasetInfo& info, int channel, int count) {
    const volume::Channel own = info.channel(channel);
    return contourLevels(vis::effectiveRange(transferOf(session, own.name), info.channelRange(own)), count);
}

std::string contourTitle(const volume::Channel& channel, const ContourLevels& levels) {
    const std::string title = "lines: " + titleWithUnit(channel.name, channel.unit);
    if (levels.values.empty()) return title + ", none in the range";
    if (levels.values.size() == 1) return title + ", at " + contourText(levels.values[0], levels.step);
    return title + ", " + contourText(levels.step, levels.step) + " apart";
}

} // namespace tessera::app
