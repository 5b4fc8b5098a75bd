#pragma once

#include "volume/bricks/brick_source.h"

/// The samples of a whole time at a coarse level, brick by brick, for quick estimates.
namespace tessera::app {

constexpr double kQuickSamples = 4e6; ///< read in well under a second

/// Calls use(index of the first sample at this level, samples) for every brick that wanted(brick, number of bricks)
/// accepts. Throws Error when a brick is damaged.
template <class Wanted, class Use>
void forBricks(const volume::BrickSource& source, int channel, int time, int level, Wanted wanted, Use use) {
    const volume::BrickGrid& grid = source.grid();
    const glm::ivec3 count = grid.count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const glm::ivec3 brick(x, y, z);
                if (wanted(brick, count))
                    use(grid.levelBegin(brick, level), source.read({channel, time, level, brick}));
            }
}

/// The same, calling use(index at this level, value) for every present sample.
template <class Wanted, class Use>
void forSamples(const volume::BrickSource& source, int channel, int time, int level, Wanted wanted, Use use) {
    forBricks(source, channel, time, level, wanted, [&](glm::ivec3 begin, const volume::BrickSamples& samples) {
        std::size_t at = 0;
        for (int k = 0; k < samples.size.z; ++k)
            for (int j = 0; j < samples.size.y; ++j)
                for (int i = 0; i < samples.size.x; ++i, ++at)
                    if (samples.isPresent(at)) use(begin + glm::ivec3(i, j, k), samples.values[at]);
    });
}

} // namespace tessera::app
