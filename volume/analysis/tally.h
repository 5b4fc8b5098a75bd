#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

/// How many samples, and how much of space, belong to each of several groups.
namespace tessera::volume {

/// Samples, and the volume of their cells within DatasetInfo::bounds, in cubic length units.
struct Tally {
    double samples = 0, volume = 0;
    Tally& operator+=(const Tally& other) {
        samples += other.samples;
        volume += other.volume;
        return *this;
    }
    bool operator==(const Tally&) const = default;
};

struct TallyQuery {
    std::vector<int> channels; ///< indices of DatasetInfo::channels()
    int time = 0, level = 0;   ///< level: of detail
    /// The group of a sample, given the physical values of `channels` (NaN where absent) and its position. Called from
    /// several threads at once.
    std::function<std::uint64_t(std::span<const double> values, glm::dvec3 position)> groupOf;
};

/// Every group with a sample. The result does not depend on the number of threads. Throws Error when a brick is
/// damaged, Cancelled.
std::map<std::uint64_t, Tally> tallySamples(const BrickSource& source, const TallyQuery& query,
                                            const Progress& progress = {});

} // namespace tessera::volume
