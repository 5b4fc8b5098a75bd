#include "volume/bricks/brick_importance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tessera::volume {

BrickChange changeOfBrick(const BrickGrid& grid, glm::ivec3 brick, const Field& before, const Field& after) {
    assert(before.type == after.type && before.samples.size() == after.samples.size());
    const glm::ivec3 begin = grid.begin(brick), end = grid.end(brick);
    const std::size_t width = std::size_t(end.x - begin.x);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double largest = 0, squares = 0;
    std::size_t samples = 0;
    dispatch(before.type, [&]<class T>(T) {
        const auto first = before.as<T>(), second = after.as<T>();
        for (int z = begin.z; z < end.z; ++z)
            for (int y = begin.y; y < end.y; ++y) {
                const std::size_t row = grid.lattice.index({begin.x, y, z});
                for (std::size_t i = row; i < row + width; ++i) {
                    bool was = before.present(i), is = after.present(i);
                    const auto a = float(before.offset + before.scale * double(first[i]));
                    const auto b = float(after.offset + after.scale * double(second[i]));
                    was = was && std::isfinite(a);
                    is = is && std::isfinite(b);
                    if (was != is) largest = kInfinity;
                    if (!was || !is) continue;
                    const double moved = std::abs(double(b) - double(a));
                    largest = std::max(largest, moved);
                    squares += moved * moved;
                    ++samples;
                }
            }
    });
    if (largest == kInfinity) return {roundedUp(kInfinity), roundedUp(kInfinity)};
    const double rms = samples > 0 ? std::sqrt(squares / double(samples)) : 0.0;
    return {roundedUp(largest), roundedUp(std::min(rms * (1 + 1e-12), largest))};
}

} // namespace tessera::volume
