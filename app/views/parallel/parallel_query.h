#pragma once

#include "app/queries/async_query.h"
#include "app/queries/statistics_query.h"
#include "volume/analysis/axis_densities.h"

#include <glm/vec3.hpp>
#include <imgui.h>
#include <memory>
#include <string>
#include <vector>

/// What parallel coordinates are drawn from, counted in the background, the coarsest level first.
namespace tessera::app {

struct ParallelQuery {
    std::vector<volume::DensityAxis> axes;
    int bins = 128;
    bool together = false; ///< of three axes: every triple of bins, too
    int groups = 0;        ///< colours of the selection: brushGroups(); 0: nothing is selected
    BrushedQuery brushed;  ///< its channels begin with those of the axes; the group of each brush is its colour's red
    bool operator==(const ParallelQuery&) const = default;
};

/// The colours that selected samples have: several where brushes are alternatives ("or"), each sample that of the brush
/// that holds it most, the first that of samples held by none; else one.
struct BrushGroups {
    std::vector<ImU32> colors;
    std::vector<int> ofBrush; ///< by enabled brush
};
BrushGroups brushGroups(const Session& session);

ParallelQuery parallelQuery(const Session& session, const volume::DatasetInfo& info,
                            const std::vector<volume::DensityAxis>& axes, int bins);

struct ParallelResult {
    ParallelQuery query;
    volume::AxisDensities densities;
    bool brushed() const { return query.groups > 0; }
    /// Samples with a value on any axis.
    double samples() const;
    /// Memory that its numbers take.
    std::size_t bytes() const;
};

/// Counts at a level of detail. Channels a brush names but the data lack count as absent. Throws Error, Cancelled.
ParallelResult readDensities(const std::shared_ptr<const volume::BrickSource>& source, const ParallelQuery& query,
                             int level, const Progress& progress = {});

constexpr std::size_t kKeptDensities = std::size_t(256) << 20; ///< bytes, of the answers that a view keeps

/// One per view, in its cache.
class AsyncDensities {
public:
    /// The best answer so far: of this very query, else the last one of the same axes while it is being computed, else
    /// null. Sets context.answers.awaiting while better ones are on their way; headless, computes to the end.
    std::shared_ptr<const ParallelResult> get(ViewContext& context, const std::string& jobKey,
                                              const ParallelQuery& query);
    std::string failure() const { return query_.failure(); }

private:
    using Answers = AsyncQuery<ParallelQuery, ParallelResult>;
    /// One of 12 axes, 512 bins and 3 colours is 93 MB.
    Answers query_{
        {.answers = 8, .size = kKeptDensities, .sizeOf = [](const ParallelResult& result) { return result.bytes(); }}};
    LevelledSamples samples_;
};

/// The order of axes that their correlations ask for, which takes a moment to find: kept until others are asked for.
class KeptOrder {
public:
    /// These channels in their order; the answer is of them and of all their pairs.
    const std::vector<int>& of(const std::shared_ptr<const StatisticsResult>& result, const std::vector<int>& channels);

private:
    std::shared_ptr<const StatisticsResult> result_;
    std::vector<int> channels_, order_;
};

} // namespace tessera::app
