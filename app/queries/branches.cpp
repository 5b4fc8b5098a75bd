#include "app/queries/branches.h"

#include "app/queries/scene_query.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// A brush as a test of one sample.
struct BranchTest {
    vis::DoiFunction inside;
    std::vector<int> places; ///< of its channels in the values; -1: the data lack it

    Outcome of(std::span<const double> values, glm::dvec3 position, std::vector<double>& own) const {
        own.clear();
        for (const int place : places) {
            own.push_back(place < 0 ? std::nan("") : values[std::size_t(place)]);
            if (std::isnan(own.back())) return Outcome::Lacking;
        }
        return inside(own, position) >= 0.5 ? Outcome::Inside : Outcome::Outside;
    }
};

std::vector<BranchTest> branchTests(const BranchesQuery& query, const volume::DatasetInfo& info) {
    std::vector<BranchTest> tests;
    for (const vis::Brush& brush : query.selection.brushes) {
        vis::Selection alone;
        alone.brushes = {brush};
        BranchTest test{vis::DoiFunction(alone, query.lenses), {}};
        for (const std::string& name : test.inside.channels()) {
            const auto channel = info.findChannel(name);
            const auto found = channel ? std::ranges::find(query.channels, *channel) : query.channels.end();
            test.places.push_back(found == query.channels.end() ? -1 : int(found - query.channels.begin()));
        }
        tests.push_back(std::move(test));
    }
    return tests;
}

/// A level of detail with few enough samples to answer within a few milliseconds, for each of `times`.
int branchesLevel(const volume::BrickGrid& grid, std::size_t times) {
    constexpr double kSamples = 2e5, kFewest = 4096;
    return grid.levelWithin(std::max(kFewest, kSamples / double(std::max<std::size_t>(1, times))));
}

} // namespace

bool sameButOne(const BranchesQuery& shown, const BranchesQuery& wanted) {
    const std::vector<vis::Brush>&a = shown.selection.brushes, &b = wanted.selection.brushes;
    std::size_t others = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) others += a[i] == b[i] ? 0 : 1;
    return a.size() == b.size() && others < 2;
}

BranchesQuery branchesQuery(const Session& session, const volume::DatasetInfo& info) {
    BranchesQuery query;
    query.time = volume::timesAround(info.times, session.time);
    for (const vis::Brush& own : session.selection.brushes) {
        if (query.selection.brushes.size() == kMostLevels) break;
        query.selection.brushes.push_back({.name = "", .color = {}, .region = own.region});
        for (const std::string& name : vis::regionChannels(own.region))
            if (const auto channel = info.findChannel(name);
                channel && std::ranges::find(query.channels, *channel) == query.channels.end())
                query.channels.push_back(*channel);
    }
    query.lenses = vis::selectsLens(query.selection) ? lensSpace(session, info) : brushSpace(session, info);
    return query;
}

Branches::Branches(std::size_t levels, std::map<std::uint64_t, volume::Tally> groups, int level)
    : levels_(levels), groups_(std::move(groups)), level_(level) {}

volume::Tally Branches::of(const BranchPath& path) const {
    std::uint64_t wanted = 0, all = 1;
    for (const Outcome outcome : path) {
        wanted += all * std::uint64_t(outcome);
        all *= 3;
    }
    volume::Tally sum;
    for (const auto& [group, tally] : groups_)
        if (group % all == wanted) sum += tally;
    return sum;
}

volume::Tally Branches::selected(const std::vector<vis::Brush>& brushes, std::size_t count) const {
    count = std::min({count, levels_, brushes.size()});
    const auto holds = [&](std::uint64_t group) {
        std::optional<bool> chosen;
        for (std::size_t i = 0; i < count; ++i, group /= 3) {
            const vis::Brush& brush = brushes[i];
            if (!brush.enabled) continue;
            const auto outcome = Outcome(group % 3);
            // What lacks a value is inside of nothing, also of what is inverted; minus that leaves what is inside.
            const bool inside = outcome == Outcome::Lacking
                                    ? brush.inverted && brush.combine == vis::BrushCombine::Minus
                                    : (outcome == Outcome::Inside) != brush.inverted;
            const bool before = chosen.value_or(brush.combine != vis::BrushCombine::Or);
            chosen = brush.combine == vis::BrushCombine::And  ? before && inside
                     : brush.combine == vis::BrushCombine::Or ? before || inside
                                                              : before && !inside;
        }
        return chosen.value_or(true);
    };
    volume::Tally sum;
    for (const auto& [group, tally] : groups_)
        if (holds(group)) sum += tally;
    return sum;
}

Branches readBranches(const std::shared_ptr<const volume::BrickSource>& source, const BranchesQuery& query, int level,
                      const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    const std::vector<BranchTest> tests = branchTests(query, source->info());
    volume::TallyQuery asked{query.channels, shown.time, level, {}};
    asked.groupOf = [&tests](std::span<const double> values, glm::dvec3 position) {
        thread_local std::vector<double> own;
        std::uint64_t group = 0, digit = 1;
        for (const BranchTest& test : tests) {
            group += digit * std::uint64_t(test.of(values, position, own));
            digit *= 3;
        }
        return group;
    };
    return {tests.size(), volume::tallySamples(*shown.source, asked, progress), level};
}

std::vector<Branches> readBranchesOverTime(const std::shared_ptr<const volume::BrickSource>& source,
                                           const BranchesQuery& query, int level, const Progress& progress) {
    std::vector<Branches> all;
    const std::size_t times = source->info().times.size();
    for (std::size_t t = 0; t < times; ++t) {
        BranchesQuery at = query;
        at.time = {int(t), int(t), 0};
        all.push_back(
            readBranches(source, at, level, progress.part(double(t) / double(times), double(t + 1) / double(times))));
    }
    return all;
}

std::shared_ptr<const Branches> branchesNow(ViewContext& context, AsyncBranches& answers, const std::string& pane,
                                            const BranchesQuery& query) {
    const int first = branchesLevel(context.numbers->grid(), 1);
    return answers.now.get(
        context, context.numbers,
        {.key = "branches " + pane,
         .title = "Hierarchy",
         .quiet = first == 0,
         .lowPriority = true,
         .duringEdits = true,
         .firstLevel = first},
        query,
        [](const auto& source, const BranchesQuery& asked, int level, const Progress& progress) {
            return readBranches(source, asked, level, progress);
        },
        sameButOne);
}

std::shared_ptr<const std::vector<Branches>> branchesOverTime(ViewContext& context, AsyncBranches& answers,
                                                              const std::string& pane, BranchesQuery query) {
    const std::size_t times = context.numbers->info().times.size();
    const int first = branchesLevel(context.numbers->grid(), times);
    query.time = {};
    return answers.overTime.get(
        context, context.numbers,
        {.key = "branches over time " + pane,
         .title = "Hierarchy over time",
         .quiet = first == 0,
         .lowPriority = true,
         .firstLevel = first},
        query,
        [](const auto& source, const BranchesQuery& asked, int level, const Progress& progress) {
            return readBranchesOverTime(source, asked, level, progress);
        },
        sameButOne);
}

} // namespace tessera::app
