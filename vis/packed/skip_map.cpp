#include "vis/packed/skip_map.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis::packet {

namespace {

/// Edges of the cubes of equal blocks of one octant, found from those of the seven neighbours further on.
class OctantCounts {
public:
    OctantCounts(const SkipMap& map, int octant, std::uint8_t* out)
        : map_(map), octant_(octant), out_(out), kind_(std::size_t(map.count.x)), least_(std::size_t(map.count.x)) {}

    void run() {
        for (int n = 0; n < map_.count.z; ++n)
            for (int m = 0; m < map_.count.y; ++m)
                row(forwards(1) ? map_.count.y - 1 - m : m, forwards(2) ? map_.count.z - 1 - n : n);
    }

private:
    bool forwards(int axis) const { return (octant_ >> axis & 1) != 0; }
    std::size_t start(int y, int z) const {
        return (std::size_t(z) * std::size_t(map_.count.y) + std::size_t(y)) * std::size_t(map_.count.x);
    }
    /// What a block adds to the count of one of the kind `own` (0 or kFull): its count if it is of the same kind, else
    /// 0.
    static std::uint8_t share(std::uint8_t other, std::uint8_t own) {
        const auto same = std::uint8_t(other ^ own);
        return same < SkipMap::kFull ? same : std::uint8_t(0);
    }

    void row(int y, int z) {
        const std::uint8_t* const full = map_.full.data() + start(y, z);
        std::uint8_t* const out = out_ + start(y, z);
        const int count = map_.count.x, way = forwards(0) ? 1 : -1;
        std::uint8_t *const kind = kind_.data(), *const least = least_.data();
        for (int x = 0; x < count; ++x) kind[x] = full[x] != 0 ? SkipMap::kFull : 0;
        std::ranges::fill(least_, std::uint8_t(SkipMap::kMost));
        const auto lower = [&](const std::uint8_t* other, int begin, int end) { // without branches: by vector units
            for (int x = begin; x < end; ++x) least[x] = std::min(least[x], share(other[x], kind[x]));
        };
        for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1, 1)}) {
            const int nearY = y + (forwards(1) ? step.x : -step.x), nearZ = z + (forwards(2) ? step.y : -step.y);
            if (nearY < 0 || nearY >= map_.count.y || nearZ < 0 || nearZ >= map_.count.z) continue;
            const std::uint8_t* const other = out_ + start(nearY, nearZ);
            lower(other, 0, count);
            lower(other + way, way > 0 ? 0 : 1, way > 0 ? count - 1 : count);
        }
        int ahead = SkipMap::kMost; // beyond the volume
        for (int n = 0; n < count; ++n) {
            const int x = way > 0 ? count - 1 - n : n;
            if (n > 0) ahead = share(out[x + way], kind[x]);
            out[x] = std::uint8_t(kind[x] + std::min(std::min(int(least[x]), ahead) + 1, SkipMap::kMost));
        }
    }

    const SkipMap& map_;
    int octant_;
    std::uint8_t* out_;
    std::vector<std::uint8_t> kind_, least_; ///< of a row: 0 or kFull, and the least shares of the rows further on
};

} // namespace

SkipMap fullBlocks(const PacketVolume& volume, const std::function<bool(float, float)>& shows) {
    SkipMap out;
    out.count = volume.blocks;
    out.full.resize(out.blocks());
    parallelRanges(
        out.blocks(),
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                out.full[i] = volume.lo[i] <= volume.hi[i] && shows(volume.lo[i], volume.hi[i]);
        },
        4096);
    return out;
}

SkipMap united(SkipMap a, const SkipMap& b) {
    if (a.full.empty()) return b;
    for (std::size_t i = 0; i < a.full.size(); ++i) a.full[i] = std::uint8_t(a.full[i] | b.full[i]);
    return a;
}

std::vector<std::uint8_t> scoreBounds(const PacketVolume& volume, const std::function<double(float)>& score) {
    std::vector<std::uint8_t> out(volume.lo.size() + 3);
    parallelRanges(
        volume.lo.size(),
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (!(volume.lo[i] <= volume.hi[i])) continue;
                const double best = std::max(score(volume.lo[i]), score(volume.hi[i]));
                out[i] = std::uint8_t(std::min(255.0, std::ceil(best * 255 + 0.01)));
            }
        },
        4096);
    return out;
}

void widen(SkipMap& map) {
    std::size_t step = 1; // from one block to the next along an axis
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<std::uint8_t> before = map.full;
        const std::size_t length = step * std::size_t(map.count[axis]);
        for (std::size_t first = 0; first < before.size(); first += length) {
            const std::uint8_t* const from = before.data() + first;
            std::uint8_t* const to = map.full.data() + first;
            for (std::size_t i = step; i < length; ++i) to[i] |= from[i - step];
            for (std::size_t i = step; i < length; ++i) to[i - step] |= from[i];
        }
        step = length;
    }
}

void countAlike(SkipMap& map, unsigned octants) {
    const std::size_t blocks = map.blocks();
    map.alike.resize(blocks * 8 + 3);
    std::vector<int> missing;
    for (int octant = 0; octant < 8; ++octant)
        if ((octants & ~map.counted) >> octant & 1) missing.push_back(octant);
    parallelFor(missing.size(), [&](std::size_t i) {
        OctantCounts(map, missing[i], map.alike.data() + std::size_t(missing[i]) * blocks).run();
    });
    map.counted |= octants;
}

} // namespace tessera::vis::packet
