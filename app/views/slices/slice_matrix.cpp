#include "app/views/slices/slice_matrix.h"

#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// What one slice shows.
struct MatrixSlice {
    int channel = 0;
    volume::SpaceAxis axis = volume::SpaceAxis::Z;
    std::optional<int> plane;   ///< of SliceMatrixView::planes; nothing: through the cross-hair
    std::optional<double> time; ///< nothing: the session's
};

/// Position of plane `index` of `count`: the middle of its share of the box as it is drawn.
double evenPosition(const volume::DatasetInfo& info, int axis, int index, int count) {
    const volume::Box& bounds = info.bounds;
    return info.lattice.axes.toSpace(axis, bounds.lo[axis] + bounds.size()[axis] * (index + 0.5) / count);
}

PlanePicture pictureOfSlice(const Session& session, const volume::DatasetInfo& info, const SliceMatrixView& view,
                            const MatrixSlice& slice) {
    const SliceAxes axes = longAxesAcross(slice.axis, vis::worldFrame(info, session.stretch));
    const double position =
        slice.plane ? evenPosition(info, axes.normal, *slice.plane, view.planes) : session.cursor[axes.normal];
    PlanePicture picture =
        axisPlane(session, info, axes, position, {.channel = slice.channel, .plain = true, .crossed = !slice.plane});
    return slice.time ? atTime(std::move(picture), info, *slice.time) : picture;
}

/// Directions across which a slice has an extent.
std::vector<volume::SpaceAxis> directionsOf(const vis::WorldFrame& world) {
    std::vector<volume::SpaceAxis> out;
    for (int axis = 0; axis < 3; ++axis)
        if (world.halfSize[(axis + 1) % 3] > 0 && world.halfSize[(axis + 2) % 3] > 0)
            out.push_back(static_cast<volume::SpaceAxis>(axis));
    return out;
}

/// The slices along one side of the matrix, each like `base` but in what they differ.
std::vector<MatrixSlice> slicesAlong(MatrixAxis what, const MatrixSlice& base, const SliceMatrixView& view,
                                     const std::vector<int>& channels, const std::vector<volume::SpaceAxis>& directions,
                                     const std::vector<double>& times) {
    std::vector<MatrixSlice> out;
    const auto add = [&](const auto& change) { change(out.emplace_back(base)); };
    switch (what) {
    case MatrixAxis::Parameters:
        for (const int channel : channels) add([&](MatrixSlice& slice) { slice.channel = channel; });
        break;
    case MatrixAxis::Directions:
        for (const volume::SpaceAxis axis : directions) add([&](MatrixSlice& slice) { slice.axis = axis; });
        break;
    case MatrixAxis::Positions:
        for (int plane = 0; plane < view.planes; ++plane) add([&](MatrixSlice& slice) { slice.plane = plane; });
        break;
    case MatrixAxis::Times:
        for (const double time : times) add([&](MatrixSlice& slice) { slice.time = time; });
        break;
    }
    return out;
}

/// Planes across several directions have no position in common, but a share of the way.
std::string nameOfSlice(MatrixAxis what, const volume::DatasetInfo& info, const SliceMatrixView& view,
                        const MatrixSlice& slice, const PlanePicture& picture) {
    const bool crossed = view.over(MatrixAxis::Directions) && view.over(MatrixAxis::Positions);
    switch (what) {
    case MatrixAxis::Parameters:
        return titleWithUnit(info.channel(slice.channel).name, info.channel(slice.channel).unit);
    case MatrixAxis::Directions:
        return crossed ? "across " + picture.positions[static_cast<std::size_t>(slice.axis)].name : picture.place;
    case MatrixAxis::Positions:
        return crossed ? "at " + formatNumber(100 * (slice.plane.value_or(0) + 0.5) / view.planes, 1) + " %"
                       : picture.place;
    case MatrixAxis::Times:
        return timeText(info, slice.time.value_or(0));
    }
    return {};
}

} // namespace

SliceAxes longAxesAcross(volume::SpaceAxis axis, const vis::WorldFrame& world) {
    const int normal = static_cast<int>(axis);
    SliceAxes out{normal == 0 ? 1 : 0, normal == 2 ? 1 : 2, normal};
    if (world.halfSize[out.up] > world.halfSize[out.right]) std::swap(out.right, out.up);
    return out;
}

std::vector<double> matrixTimes(const volume::DatasetInfo& info, int count, double sessionTime) {
    const std::vector<double>& all = info.times;
    const int shown = std::min(count, static_cast<int>(all.size()));
    if (shown < 1) return {};
    if (shown == 1) return {all[static_cast<std::size_t>(volume::timesAround(all, sessionTime).nearest())]};
    std::vector<double> out;
    for (int i = 0; i < shown; ++i)
        out.push_back(all[static_cast<std::size_t>(
            std::lround(static_cast<double>(i) * static_cast<double>(all.size() - 1) / (shown - 1)))]);
    return out;
}

SliceMatrix sliceMatrix(const Session& session, const volume::DatasetInfo& info, const SliceMatrixView& view,
                        const std::vector<int>& channels) {
    SliceMatrix out;
    if (channels.empty()) return out;
    const std::vector<volume::SpaceAxis> directions = directionsOf(vis::worldFrame(info, session.stretch));
    const std::vector<double> times = matrixTimes(info, view.times, session.time);
    const MatrixSlice base{.channel = channels.front(), .axis = view.axis, .plane = {}, .time = {}};
    std::vector<MatrixSlice> rows = slicesAlong(view.rows, base, view, channels, directions, times);
    if (view.rows == view.columns) rows = {base};
    out.rows = static_cast<int>(rows.size());
    for (const MatrixSlice& row : rows) {
        const std::size_t first = out.pictures.size();
        const std::vector<MatrixSlice> slices = slicesAlong(view.columns, row, view, channels, directions, times);
        out.columns = static_cast<int>(slices.size());
        for (const MatrixSlice& slice : slices) {
            out.pictures.push_back(pictureOfSlice(session, info, view, slice));
            if (first == 0)
                out.columnNames.push_back(nameOfSlice(view.columns, info, view, slice, out.pictures.back()));
        }
        if (slices.empty()) continue;
        out.rowNames.push_back(
            view.rows == view.columns ? "" : nameOfSlice(view.rows, info, view, row, out.pictures[first]));
    }
    return out;
}

bool showsValues(const volume::BrickSource& source, const PlanePicture& slice, const Progress& progress) {
    constexpr int kMost = 256;
    const auto [right, up, normal] = slice.axes.value_or(SliceAxes{});
    const glm::ivec3 size = source.info().lattice.size;
    const auto share = [](int i, int count) { return (i + 0.5) / count; };
    const int columns = std::clamp(size[right], 1, kMost), rows = std::clamp(size[up], 1, kMost);
    for (int j = 0; j < rows; ++j) {
        progress.advance(share(j, rows));
        std::vector<glm::dvec3> row;
        for (int i = 0; i < columns; ++i)
            row.push_back(slice.placeAt({std::lerp(slice.x.lo, slice.x.hi, share(i, columns)),
                                         std::lerp(slice.y.lo, slice.y.hi, share(j, rows))}));
        const auto values = volume::probeAlong(source, slice.shows.channel, row, slice.time);
        if (std::ranges::any_of(values, [](const volume::ProbeValue& value) { return value.nearest.has_value(); }))
            return true;
    }
    return false;
}

std::string commonText(const Session& session, const volume::DatasetInfo& info, const SliceMatrixView& view,
                       const SliceMatrix& matrix) {
    if (matrix.pictures.empty()) return {};
    const PlanePicture& first = matrix.pictures.front();
    std::vector<std::string> parts;
    if (!view.over(MatrixAxis::Parameters)) parts.push_back(info.channel(first.shows.channel).name);
    if (!view.over(MatrixAxis::Directions))
        parts.push_back(first.right.name + " to the right, " + first.up.name + " up");
    if (!view.over(MatrixAxis::Positions) && !view.over(MatrixAxis::Directions)) parts.push_back(first.place);
    if (info.times.size() > 1 && !view.over(MatrixAxis::Times) && view.columns != MatrixAxis::Positions)
        parts.push_back(timeText(info, session.time));
    std::string out;
    for (const std::string& part : parts) out += (out.empty() ? "" : ", ") + part;
    return out;
}

} // namespace tessera::app
