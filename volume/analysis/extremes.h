#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

namespace tessera::volume {

/// Which sample is looked for: the greatest or the least value of a channel.
struct ExtremeQuery {
    int channel = 0;                   ///< index of DatasetInfo::channels()
    bool greatest = true;              ///< else the least
    std::vector<int> times;            ///< of all of them
    int label = -1;                    ///< channel of a label; -1: any region
    int region = 0;                    ///< its value
    std::vector<int> doiChannels = {}; ///< whose values `doi` asks for
    /// Degree of interest 0..1 of a sample, given the values of `doiChannels` (NaN where absent) and its position; only
    /// samples of at least 1/2 are looked at. Called from several threads at once. Empty: all are.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi = {};
};

struct Extreme {
    double value = 0;
    glm::dvec3 position{0}; ///< physical, of the sample
    int time = 0;           ///< index of DatasetInfo::times
};

/// The sample with the extreme value; of equal ones the first in time, then in the order of bricks that bound values
/// furthest; nothing where no sample is looked at. Bricks that cannot hold it are not read. Does not depend on the
/// number of threads. Throws Error when a brick is damaged, Cancelled.
std::optional<Extreme> findExtreme(const BrickSource& source, const ExtremeQuery& query, const Progress& progress = {});

} // namespace tessera::volume
