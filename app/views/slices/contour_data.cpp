#include "app/views/slices/contour_data.h"

#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr int kFewNodes = 160, kMostNodes = 512; ///< along the longer and along any edge of the grid of lines
constexpr int kBand = 16;                        ///< rows of it that are read at once

/// Nodes along an axis: on the samples where there are not too many, and between them where there are few.
int nodesAlong(const volume::DatasetInfo& info, int axis, int finer) {
    const double cell = info.lattice.spacing[axis] * (info.lattice.kind == volume::LatticeKind::BCC ? 0.5 : 1);
    const double cells = cell > 0 ? info.bounds.size()[axis] / cell : 0;
    return std::clamp(static_cast<int>(std::lround(cells)) * finer, 1, kMostNodes - 1) + 1;
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
    const auto& [right, up, normal] = query.axes;
    const int most = std::max(nodesAlong(info, right, 1), nodesAlong(info, up, 1));
    const int finer = std::clamp((kFewNodes + most - 1) / most, 1, 4);
    volume::PlaneValues plane;
    plane.size = {nodesAlong(info, right, finer), nodesAlong(info, up, finer)};
    const glm::dvec3 size = info.bounds.size();
    const glm::dvec2 node(size[right] / (plane.size.x - 1), size[up] / (plane.size.y - 1));
    const volume::Channel channel = info.channel(query.channel);
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
    const std::optional<int> label = volume::labelChannel(info, parameter);
    for (int first = 0; first < plane.size.y; first += kBand) {
        progress.advance(static_cast<double>(first) / plane.size.y);
        std::vector<glm::dvec3> places;
        for (int j = first; j < std::min(first + kBand, plane.size.y); ++j)
            for (int i = 0; i < plane.size.x; ++i) {
                glm::dvec3 at(0);
                at[normal] = query.position;
                at[right] = std::min(info.bounds.lo[right] + node.x * i, info.bounds.hi[right]);
                at[up] = std::min(info.bounds.lo[up] + node.y * j, info.bounds.hi[up]);
                places.push_back(at);
            }
        for (const volume::ProbeValue& value : volume::probeAlong(source, query.channel, places, query.time))
            plane.values.push_back(value.interpolated.value_or(std::nan("")));
        if (!label) continue;
        for (const volume::ProbeValue& value : volume::probeAlong(source, *label, places, query.time))
            plane.parts.push_back(
                value.nearest ? static_cast<int>(parameter.parts.partOf(static_cast<int>(std::lround(*value.nearest))))
                              : 0);
    }
    Contours out{volume::contourLines(plane, query.levels)};
    const glm::dvec2 corner(info.bounds.lo[right], info.bounds.lo[up]);
    for (volume::ContourLine& line : out.lines)
        for (glm::dvec2& point : line.points) point = corner + point * node;
    return out;
}

std::optional<int> contourChannel(const volume::DatasetInfo& info, const SlicesView& view, int shown) {
    if (view.contours < 1) return std::nullopt;
    const auto channel = view.contourOf.empty() ? std::optional(shown) : info.findChannel(view.contourOf);
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
