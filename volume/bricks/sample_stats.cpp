#include "volume/bricks/sample_stats.h"

#include <algorithm>
#include <limits>

namespace tessera::volume {

BrickStats statsOfSamples(const BrickSamples& samples) {
    BrickStats stats{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0};
    std::size_t present = 0;
    for (std::size_t i = 0; i < samples.values.size(); ++i) {
        if (!samples.isPresent(i)) continue;
        ++present;
        stats.min = std::min(stats.min, samples.values[i]);
        stats.max = std::max(stats.max, samples.values[i]);
    }
    if (!samples.values.empty()) stats.presentFraction = float(double(present) / double(samples.values.size()));
    return stats;
}

} // namespace tessera::volume
