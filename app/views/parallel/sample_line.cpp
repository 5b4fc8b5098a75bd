#include "app/views/parallel/sample_line.h"

#include "app/pane/axis_label.h"
#include "volume/bricks/sample_position.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kSearchedSamples = 4e6; ///< of each axis; of more those of a coarser level

/// 0..1 from below where the axis shows the value, else nothing.
std::optional<double> shownHeight(const SampleQuery& query, std::size_t axis, double value) {
    const double share = volume::axisShare(query.axes[axis], value);
    if (!(share >= 0 && share <= 1)) return std::nullopt;
    return query.flipped[axis] ? 1 - share : share;
}

} // namespace

std::optional<SampleQuery> sampleQuery(const std::vector<ParallelAxis>& axes, std::size_t left, double x, double y,
                                       const volume::TimePair& time) {
    if (left >= axes.size() || !(axes[left].bottom > axes[left].top)) return std::nullopt;
    SampleQuery query;
    for (const ParallelAxis& axis : axes) {
        query.axes.push_back(axis.density);
        query.flipped.push_back(axis.flipped);
    }
    query.left = static_cast<int>(left);
    if (left + 1 < axes.size()) {
        const double gap = double(axes[left + 1].x - axes[left].x);
        query.along = std::clamp((x - double(axes[left].x)) / std::max(1.0, gap), 0.0, 1.0);
    }
    query.height = (double(axes[left].bottom) - y) / double(axes[left].bottom - axes[left].top);
    query.time = time;
    return query.height >= 0 && query.height <= 1 ? std::optional(query) : std::nullopt;
}

std::optional<SampleLine> nearestSample(const volume::BrickSource& source, const SampleQuery& query, int level,
                                        const Progress& progress) {
    const auto left = static_cast<std::size_t>(query.left);
    const bool between = query.along > 0 && left + 1 < query.axes.size();
    const volume::BrickGrid& grid = source.grid();
    std::optional<SampleLine> best;
    volume::BrickKey bestBrick;
    std::size_t bestIndex = 0;
    const auto brick = [&](volume::BrickKey key, std::size_t axis) {
        key.channel = query.axes[axis].channel;
        return source.read(key);
    };
    for (std::size_t n = 0; n < grid.brickCount(); ++n) {
        progress.advance(double(n) / double(grid.brickCount()));
        const volume::BrickKey key{0, query.time.earlier, level, grid.indexOf(n)};
        const volume::BrickSamples a = brick(key, left), b = between ? brick(key, left + 1) : volume::BrickSamples{};
        volume::SamplePositions place(grid, key.index, level);
        for (std::size_t i = 0; i < a.values.size(); ++i, place.next()) {
            if (!a.isPresent(i) || (between && !b.isPresent(i))) continue;
            const auto from = shownHeight(query, left, a.exact(i));
            const auto to = between ? shownHeight(query, left + 1, b.exact(i)) : from;
            if (!from || !to) continue;
            const double away = std::abs(std::lerp(*from, *to, query.along) - query.height);
            if (best && away >= best->away) continue;
            best = SampleLine{.values = {}, .position = place.at(), .level = level, .away = away};
            bestBrick = key;
            bestIndex = i;
        }
    }
    for (std::size_t axis = 0; best && axis < query.axes.size(); ++axis) {
        const volume::BrickSamples samples = brick(bestBrick, axis);
        best->values.push_back(samples.isPresent(bestIndex) ? std::optional(samples.exact(bestIndex)) : std::nullopt);
    }
    return best;
}

std::shared_ptr<const std::optional<SampleLine>> AsyncSample::get(ViewContext& context, const std::string& pane,
                                                                  const SampleQuery& query) {
    samples_.follow(context);
    const int level = samples_.coarse()->grid().levelWithin(kSearchedSamples);
    return query_.get(
        context, samples_.coarse(),
        {.key = "parallel sample " + pane, .title = "Sample under the mouse", .quiet = true, .lowPriority = true},
        query,
        [level](const std::shared_ptr<const volume::BrickSource>& source, const SampleQuery& asked, int,
                const Progress& progress) {
            const volume::SourceAtTime shown = volume::sourceAt(source, asked.time);
            SampleQuery own = asked;
            own.time = {shown.time, shown.time, 0};
            return nearestSample(*shown.source, own, level, progress);
        },
        [](const SampleQuery& previous, const SampleQuery& now) {
            return previous.axes == now.axes && previous.time == now.time && previous.left == now.left;
        });
}

std::string sampleText(const Session& session, const volume::DatasetInfo& info, const SampleLine& sample) {
    const AxisLabels labels = axisLabels(session, info);
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
        const AxisLabel& label = labels[static_cast<std::size_t>(axis)];
        const double digits = tellingLength(info, axis, sample.position, 0.01) * label.unit.perUnit;
        text += (text.empty() ? "" : ", ") + label.name + " " +
                formatQuantity(sample.position[axis] * label.unit.perUnit, label.unit.name, digits);
    }
    return "nearest line: the sample at " + text + (sample.level > 0 ? " (of a coarser level)" : "");
}

} // namespace tessera::app
