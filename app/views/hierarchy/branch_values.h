#pragma once

#include "app/queries/branches.h"
#include "app/values/plot.h"
#include "app/values/table.h"

/// What the hierarchy of brushes says, as values: its levels, its branches as areas, and both over time.
namespace tessera::app {

/// Of a brush: "not T" of an inverted one.
std::string levelName(const vis::Brush& brush);

/// A level of the chain: the brush at that place, with what is selected down to it.
struct BranchLevel {
    std::string name;
    bool enabled = true;
    volume::Tally own, above; ///< selected by the brushes up to this one, and by those before it
};
std::vector<BranchLevel> branchLevels(const std::vector<vis::Brush>& brushes, const Branches& branches);

/// Levels that are shown as areas and in tables of all branches.
inline constexpr std::size_t kMostBranchLevels = 6;

/// A branch as an area of the unit square, y downwards: as large, beside its neighbours, as the volume it holds. Each
/// level divides the areas of the one before, across and along in turn.
struct BranchArea {
    BranchPath path;
    double x0 = 0, y0 = 0, x1 = 1, y1 = 1;
    volume::Tally own;
};
/// Those of the last of `levels` levels, and of branches that end before: samples that lack a value. Empty branches are
/// left out.
std::vector<BranchArea> branchAreas(const Branches& branches, std::size_t levels);

/// "T, not dry"; "everything" of the empty path.
std::string branchText(const std::vector<vis::Brush>& brushes, const BranchPath& path);

/// A row for each branch with a sample, those of a branch below it.
Table branchTable(const std::vector<vis::Brush>& brushes, const Branches& branches, const volume::DatasetInfo& info);

/// The share of the volume that every level holds, over the stored times.
Plot branchesPlot(const std::vector<vis::Brush>& brushes, const std::vector<Branches>& overTime,
                  const volume::DatasetInfo& info, double time, bool dark);

} // namespace tessera::app
