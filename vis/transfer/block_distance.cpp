#include "vis/transfer/block_distance.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

namespace {

/// One row of a chamfer sweep: out = min(out, min(in at x - 1, x, x + 1) + 1).
void nearRow(const std::uint8_t* in, std::uint8_t* out, int count) {
    const auto step = [&](int x, std::uint8_t least) {
        out[x] = std::min(out[x], std::uint8_t(least + (least < 255)));
    };
    if (count == 1) return step(0, in[0]);
    step(0, std::min(in[0], in[1]));
    for (int x = 1; x + 1 < count; ++x) step(x, std::min(std::min(in[x - 1], in[x]), in[x + 1]));
    step(count - 1, std::min(in[count - 2], in[count - 1]));
}

} // namespace

// Two chamfer sweeps over all 26 neighbours are exact.
void spreadDistance(std::vector<std::uint8_t>& distance, glm::ivec3 count) {
    const auto row = [&](int y, int z) {
        return distance.data() + (std::size_t(z) * std::size_t(count.y) + std::size_t(y)) * std::size_t(count.x);
    };
    for (const int way : {1, -1}) {
        const auto first = [&](int n) { return way > 0 ? 0 : n - 1; };
        for (int z = first(count.z); z >= 0 && z < count.z; z += way)
            for (int y = first(count.y); y >= 0 && y < count.y; y += way) {
                std::uint8_t* const out = row(y, z);
                if (z - way >= 0 && z - way < count.z)
                    for (int near = std::max(y - 1, 0); near <= std::min(y + 1, count.y - 1); ++near)
                        nearRow(row(near, z - way), out, count.x);
                if (y - way >= 0 && y - way < count.y) nearRow(row(y - way, z), out, count.x);
                for (int x = first(count.x) + way; x >= 0 && x < count.x; x += way)
                    out[x] = std::min(out[x], std::uint8_t(out[x - way] + (out[x - way] < 255)));
            }
    }
}

OpacityRanges::OpacityRanges(const std::vector<float>& opacity, glm::dvec2 map)
    : map_(map), before_(opacity.size() + 1, 0) {
    for (std::size_t i = 0; i < opacity.size(); ++i) before_[i + 1] = before_[i] + (opacity[i] > 0);
}

bool OpacityRanges::any(float lo, float hi) const {
    const auto place = [&](double sample) {
        return std::clamp(sample * map_.x + map_.y, 0.0, 1.0) * double(before_.size() - 2);
    };
    double a = place(lo), b = place(hi);
    if (a > b) std::swap(a, b);
    return before_[std::size_t(std::ceil(b)) + 1] > before_[std::size_t(std::floor(a))];
}

} // namespace tessera::vis
