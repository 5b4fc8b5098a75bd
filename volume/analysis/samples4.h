#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <glm/vec3.hpp>
#include <vector>

namespace tessera::volume {

/// Samples of several channels in space and time, for pictures made of points.
struct Samples4 {
    std::vector<glm::vec3> positions; ///< physical
    std::vector<float> times;
    std::vector<float> values; ///< [sample * channels + channel]; NaN where that channel is absent
    int channels = 0;
    int level = 0;      ///< of detail they were read at
    double skipped = 0; ///< share of that level's samples left out for the budget
    std::size_t count() const { return positions.size(); }
};

struct SamplesQuery {
    std::vector<int> channels; ///< of DatasetInfo::channels(); samples without the first are left out
    std::vector<int> times;    ///< indices
    std::size_t budget = 200000;
    bool operator==(const SamplesQuery&) const = default;
};

/// Uses the finest level with at most eight samples per sample of the budget, and of it as many samples as the budget
/// allows, chosen by a hash of their position (equal queries give equal results), in an order of which every prefix is
/// a fair sample. Bricks are read completely, one after the other. `coarsest`: use the coarsest level instead, for a
/// first picture. Throws Error, Cancelled.
Samples4 gatherSamples(const BrickSource& source, const SamplesQuery& query, bool coarsest,
                       const Progress& progress = {});

} // namespace tessera::volume
