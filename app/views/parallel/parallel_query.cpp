#include "app/views/parallel/parallel_query.h"

#include "app/pane/view_context.h"
#include "app/tools/brush_edit.h"
#include "app/views/parallel/parallel_axes.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kFirstSamples = 3e5; ///< of all axes, in the first picture

bool addsToSelection(const vis::Brush& brush) {
    return !brush.inverted && brush.combine != vis::BrushCombine::Minus;
}

/// Which class of the selection samples are in, by the values of the query's channels.
std::function<volume::DensityInterest(std::span<const float>, glm::dvec3)> interestOf(const ParallelQuery& query,
                                                                                      const volume::DatasetInfo& info) {
    const vis::DoiFunction doi(query.brushed.selection, query.brushed.lenses);
    std::vector<int> positions; // of its channels in the values, -1: unknown, absent everywhere
    for (const std::string& name : doi.channels()) {
        const auto channel = info.findChannel(name);
        const auto found = channel ? std::ranges::find(query.brushed.channels, *channel) : query.brushed.channels.end();
        positions.push_back(
            found == query.brushed.channels.end() ? -1 : static_cast<int>(found - query.brushed.channels.begin()));
    }
    return [doi, positions, groups = query.groups](std::span<const float> values, glm::dvec3 position) {
        constexpr std::size_t kMost = 32;
        double few[kMost];
        std::vector<double> many(positions.size() > kMost ? positions.size() : 0);
        double* given = many.empty() ? few : many.data();
        for (std::size_t i = 0; i < positions.size(); ++i)
            given[i] =
                positions[i] < 0 ? std::nan("") : static_cast<double>(values[static_cast<std::size_t>(positions[i])]);
        volume::DensityInterest out{0, doi({given, positions.size()}, position)};
        if (groups < 2 || out.degree <= 0) return out;
        const vis::DoiFunction::Holder holder = doi.holder({given, positions.size()}, position);
        if (holder.interest > 0) out.group = static_cast<int>(std::lround(holder.color.r));
        return out;
    };
}

} // namespace

BrushGroups brushGroups(const Session& session) {
    BrushGroups out;
    std::vector<glm::vec3> colors;
    bool first = true, alternatives = false;
    for (const vis::Brush& brush : session.selection.brushes) {
        if (!brush.enabled) continue;
        alternatives = alternatives || (!first && brush.combine == vis::BrushCombine::Or);
        first = false;
        out.ofBrush.push_back(0);
        if (!addsToSelection(brush)) continue;
        const auto known = std::ranges::find(colors, brush.color);
        out.ofBrush.back() = static_cast<int>(known - colors.begin()) + 1;
        if (known == colors.end()) colors.push_back(brush.color);
    }
    out.colors = {focusColor(session)};
    if (!alternatives || colors.size() < 2) {
        std::ranges::fill(out.ofBrush, 0);
        return out;
    }
    for (const glm::vec3& color : colors) out.colors.push_back(brushColor(color));
    return out;
}

ParallelQuery parallelQuery(const Session& session, const volume::DatasetInfo& info,
                            const std::vector<volume::DensityAxis>& axes, int bins) {
    ParallelQuery query{.axes = axes, .bins = bins, .brushed = {}};
    std::vector<int> channels;
    std::vector<Range> ranges;
    for (const volume::DensityAxis& axis : axes) {
        channels.push_back(axis.channel);
        ranges.push_back(axis.range);
    }
    query.brushed = brushedQuery(session, info, channels, ranges, bins, false);
    if (!query.brushed.selection.active()) return query;
    const BrushGroups groups = brushGroups(session);
    query.groups = static_cast<int>(groups.colors.size());
    std::vector<vis::Brush>& brushes = query.brushed.selection.brushes;
    for (std::size_t i = 0; i < brushes.size() && i < groups.ofBrush.size(); ++i)
        brushes[i].color = {float(groups.ofBrush[i]), 0, 0};
    return query;
}

double ParallelResult::samples() const {
    double sum = 0;
    if (densities.axes.empty()) return sum;
    for (const std::uint64_t count : densities.axes.front().all) sum += double(count);
    return sum;
}

std::size_t ParallelResult::bytes() const {
    std::size_t sum = 0;
    const auto add = [&](const volume::PlaceCounts& counts) {
        sum += counts.all.size() * sizeof(counts.all.front());
        for (const std::vector<double>& group : counts.selected) sum += group.size() * sizeof(double);
    };
    for (const volume::PlaceCounts& axis : densities.axes) add(axis);
    for (const volume::PlaceCounts& gap : densities.gaps) add(gap);
    add(densities.cube);
    return sum;
}

ParallelResult readDensities(const std::shared_ptr<const volume::BrickSource>& source, const ParallelQuery& query,
                             int level, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.brushed.time);
    volume::AxisDensitiesQuery asked{.axes = query.axes, .further = {}, .bins = query.bins, .interest = {}};
    const std::vector<int>& channels = query.brushed.channels;
    asked.further.assign(channels.begin() + static_cast<std::ptrdiff_t>(query.axes.size()), channels.end());
    asked.time = shown.time;
    asked.level = level;
    asked.groups = query.groups;
    asked.together = query.together;
    if (query.groups > 0) asked.interest = interestOf(query, source->info());
    return {query, volume::axisDensities(*shown.source, asked, progress)};
}

std::shared_ptr<const ParallelResult> AsyncDensities::get(ViewContext& context, const std::string& jobKey,
                                                          const ParallelQuery& query) {
    const auto& samples = samples_.follow(context);
    const int first = samples->grid().levelWithin(kFirstSamples / double(std::max<std::size_t>(1, query.axes.size())));
    return query_.get(
        context, samples,
        plotOptions(jobKey, "Parallel coordinates", first, [](int level) { return std::max(0, level - 2); }), query,
        [coarse = samples_.coarse()](const std::shared_ptr<const volume::BrickSource>& source,
                                     const ParallelQuery& asked, int level, const Progress& progress) {
            return readDensities(level > 0 ? coarse : source, asked, level, progress);
        },
        [](const ParallelQuery& previous, const ParallelQuery& now) {
            const auto sameAxis = [](const volume::DensityAxis& a, const volume::DensityAxis& b) {
                return a.channel == b.channel && a.logarithmic == b.logarithmic;
            };
            return previous.bins == now.bins && previous.together == now.together &&
                   std::ranges::equal(previous.axes, now.axes, sameAxis);
        });
}

const std::vector<int>& KeptOrder::of(const std::shared_ptr<const StatisticsResult>& result,
                                      const std::vector<int>& channels) {
    if (result_ == result && channels_ == channels) return order_;
    const std::size_t size = channels.size();
    std::vector<double> matrix(size * size);
    for (const volume::JointHistogram& joint : result->statistics.joint)
        for (const auto& [a, b] : {std::pair{joint.x, joint.y}, std::pair{joint.y, joint.x}})
            matrix[std::size_t(a) * size + std::size_t(b)] = joint.correlation;
    order_.clear();
    for (const int position : correlationOrder(matrix, static_cast<int>(size)))
        order_.push_back(channels[std::size_t(position)]);
    result_ = result;
    channels_ = channels;
    return order_;
}

} // namespace tessera::app
