#pragma once

#include "app/queries/async_query.h"
#include "volume/analysis/tally.h"
#include "volume/field/time_pair.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// The brushes of a session as a hierarchy: each splits the samples into those inside, those outside, and those that
/// lack a value it asks for. With soft edges a sample is inside where its degree of interest is at least 1/2.
namespace tessera::app {

enum class Outcome : std::uint8_t { Outside, Inside, Lacking };

/// A branch: an outcome for each of the first brushes. The empty one is everything.
using BranchPath = std::vector<Outcome>;

inline constexpr std::size_t kMostLevels = 40; ///< 3^40 outcomes have room in 64 bits

/// What decides how many samples each branch has.
struct BranchesQuery {
    std::vector<int> channels; ///< indices of DatasetInfo::channels() that brushes name
    vis::Selection selection;  ///< all brushes, also those that are switched off, by their regions alone
    vis::LensSpace lenses;
    volume::TimePair time;
    bool operator==(const BranchesQuery&) const = default;
};
/// Of the first kMostLevels brushes of a session, at the time shown.
BranchesQuery branchesQuery(const Session& session, const volume::DatasetInfo& info);

/// Whether the answer to one can stand for the other meanwhile: while a brush is dragged, but not where brushes change
/// places, whose names would stand at the numbers of others.
bool sameButOne(const BranchesQuery& shown, const BranchesQuery& wanted);

/// Samples and volume by outcome of all brushes.
class Branches {
public:
    Branches() = default;
    /// `groups`: the outcome of brush i is digit i of the number in base 3.
    Branches(std::size_t levels, std::map<std::uint64_t, volume::Tally> groups, int level);
    std::size_t levels() const { return levels_; }
    int level() const { return level_; } ///< of detail; 0: all samples are counted
    /// What a path of at most levels() outcomes holds.
    volume::Tally of(const BranchPath& path) const;
    /// What the first `count` brushes select together, as they combine; those that are switched off play no part.
    volume::Tally selected(const std::vector<vis::Brush>& brushes, std::size_t count) const;

private:
    std::size_t levels_ = 0;
    std::map<std::uint64_t, volume::Tally> groups_;
    int level_ = 0;
};

/// Counts at a level of detail. Throws Error, Cancelled.
Branches readBranches(const std::shared_ptr<const volume::BrickSource>& source, const BranchesQuery& query, int level,
                      const Progress& progress = {});

/// The same at every stored time; the time of the query plays no part.
std::vector<Branches> readBranchesOverTime(const std::shared_ptr<const volume::BrickSource>& source,
                                           const BranchesQuery& query, int level, const Progress& progress = {});

/// One per view, in its cache: coarse answers first.
struct AsyncBranches {
    AsyncQuery<BranchesQuery, Branches> now;
    AsyncQuery<BranchesQuery, std::vector<Branches>> overTime;
};
std::shared_ptr<const Branches> branchesNow(ViewContext& context, AsyncBranches& answers, const std::string& pane,
                                            const BranchesQuery& query);
std::shared_ptr<const std::vector<Branches>> branchesOverTime(ViewContext& context, AsyncBranches& answers,
                                                              const std::string& pane, BranchesQuery query);

} // namespace tessera::app
