#include "app/views/hierarchy/branch_values.h"

#include "app/pane/plot.h"
#include "app/ui/time_text.h"
#include "app/values/place_text.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

std::string brushName(const vis::Brush& brush) {
    return brush.name.empty() ? "brush" : brush.name;
}

constexpr Outcome kOutcomes[] = {Outcome::Inside, Outcome::Outside, Outcome::Lacking};

void divide(const Branches& branches, const BranchArea& area, std::size_t levels, std::vector<BranchArea>& out) {
    const bool ends = !area.path.empty() && area.path.back() == Outcome::Lacking;
    if (ends || area.path.size() >= levels) {
        out.push_back(area);
        return;
    }
    const bool across = area.path.size() % 2 == 0;
    double from = across ? area.x0 : area.y0;
    const double length = across ? area.x1 - area.x0 : area.y1 - area.y0;
    for (const Outcome outcome : kOutcomes) {
        BranchArea part = area;
        part.path.push_back(outcome);
        part.own = branches.of(part.path);
        if (!(part.own.samples > 0)) continue;
        const double to = from + length * part.own.volume / area.own.volume;
        (across ? part.x0 : part.y0) = from;
        (across ? part.x1 : part.y1) = to;
        from = to;
        divide(branches, part, levels, out);
    }
}

/// Every branch below a path, itself first.
void listBranches(const Branches& branches, const BranchPath& path, std::size_t levels, std::vector<BranchPath>& out) {
    if (!(branches.of(path).samples > 0)) return;
    out.push_back(path);
    if (path.size() >= levels || (!path.empty() && path.back() == Outcome::Lacking)) return;
    for (const Outcome outcome : kOutcomes) {
        BranchPath longer = path;
        longer.push_back(outcome);
        listBranches(branches, longer, levels, out);
    }
}

} // namespace

std::string levelName(const vis::Brush& brush) {
    return (brush.inverted ? "not " : "") + brushName(brush);
}

std::vector<BranchLevel> branchLevels(const std::vector<vis::Brush>& brushes, const Branches& branches) {
    std::vector<BranchLevel> levels;
    for (std::size_t i = 0; i < std::min(brushes.size(), branches.levels()); ++i)
        levels.push_back({levelName(brushes[i]), brushes[i].enabled, branches.selected(brushes, i + 1),
                          branches.selected(brushes, i)});
    return levels;
}

std::vector<BranchArea> branchAreas(const Branches& branches, std::size_t levels) {
    std::vector<BranchArea> areas;
    BranchArea all;
    all.own = branches.of({});
    if (all.own.volume > 0) divide(branches, all, std::min({levels, branches.levels(), kMostBranchLevels}), areas);
    return areas;
}

std::string branchText(const std::vector<vis::Brush>& brushes, const BranchPath& path) {
    std::string text;
    for (std::size_t i = 0; i < path.size() && i < brushes.size(); ++i) {
        text += text.empty() ? "" : ", ";
        text += path[i] == Outcome::Inside ? "" : path[i] == Outcome::Outside ? "not " : "without a value for ";
        text += brushName(brushes[i]);
    }
    return text.empty() ? "everything" : text;
}

Table branchTable(const std::vector<vis::Brush>& brushes, const Branches& branches, const volume::DatasetInfo& info) {
    std::vector<BranchPath> paths;
    listBranches(branches, {}, std::min(branches.levels(), kMostBranchLevels), paths);
    const volume::Tally all = branches.of({});
    Table table{.columns = {}, .names = 2};
    addColumn(table, paths, {.name = "level", .head = "Level", .kind = NumberKind::Count}, &BranchPath::size);
    addColumn(table, paths, {.name = "branch", .head = "Branch"},
              [&](const BranchPath& path) { return branchText(brushes, path); });
    addColumn(table, paths, {.name = "samples", .head = "Samples", .kind = NumberKind::Count},
              [&](const BranchPath& path) { return branches.of(path).samples; });
    const LengthUnit volumes = volumeUnit(info);
    addColumn(table, paths,
              {.name = "volume",
               .head = "Volume",
               .unit = volumes.name,
               .kind = info.timeAxis() ? NumberKind::Plain : NumberKind::Volume},
              [&](const BranchPath& path) { return branches.of(path).volume * volumes.perUnit; });
    addColumn(table, paths,
              {.name = "share of the level above", .head = "Of the level above", .kind = NumberKind::Share},
              [&](BranchPath path) {
                  const double own = branches.of(path).volume;
                  if (!path.empty()) path.pop_back();
                  return own / branches.of(path).volume;
              });
    addColumn(table, paths, {.name = "share of the box", .head = "Of the box", .kind = NumberKind::Share},
              [&](const BranchPath& path) { return branches.of(path).volume / all.volume; });
    if (branches.level() > 0) table.notes.push_back("estimated from a coarser level");
    if (branches.levels() > kMostBranchLevels)
        table.notes.push_back("of the first " + std::to_string(kMostBranchLevels) + " brushes");
    table.notes.push_back("shares are of volume; with soft edges a sample is inside where its degree of interest is "
                          "at least 1/2");
    return table;
}

Plot branchesPlot(const std::vector<vis::Brush>& brushes, const std::vector<Branches>& overTime,
                  const volume::DatasetInfo& info, double time, bool dark) {
    Plot plot;
    const std::size_t levels = overTime.empty() ? 0 : std::min(overTime.front().levels(), brushes.size());
    double most = 0;
    for (std::size_t i = 0; i < levels; ++i) {
        if (!brushes[i].enabled) continue;
        PlotSeries line{.name = levelName(brushes[i]),
                        .points = {},
                        .color = brushes[i].color * (dark ? 1 : kBrightOnWhite),
                        .dots = overTime.size() < 40};
        for (std::size_t t = 0; t < overTime.size(); ++t) {
            const double share =
                100 * overTime[t].selected(brushes, i + 1).volume / std::max(1e-300, overTime[t].of({}).volume);
            line.points.push_back({info.times[t], share});
            most = std::max(most, share);
        }
        plot.series.push_back(std::move(line));
    }
    plot.x = {.title = timeWord(info), .range = {info.times.front(), info.times.back()}, .unit = info.timeUnit};
    plot.y = {.title = overTime.empty() || overTime.front().level() == 0 ? "share of the box"
                                                                         : "share of the box, estimated",
              .range = {0, most > 0 ? most * 1.06 : 1},
              .unit = "%"};
    plot.cursorX = time;
    return plot;
}

} // namespace tessera::app
