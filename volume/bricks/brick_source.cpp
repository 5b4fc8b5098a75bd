#include "volume/bricks/brick_source.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace tessera::volume {

std::optional<BrickDistribution> BrickSource::distribution(const BrickKey&) const {
    return std::nullopt;
}

std::optional<BrickImportance> BrickSource::importance(const BrickKey&) const {
    return std::nullopt;
}

std::optional<BrickChange> BrickSource::change(const BrickKey& key, int toTime) const {
    if (key.time == toTime) return BrickChange{};
    return std::nullopt;
}

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

void keepRest(BrickSamples& samples, const std::function<double(std::size_t)>& exactly) {
    constexpr float kHeld = 16777216; // integers up to here are floats
    const auto beyond = [&](float value) { return std::abs(value) >= kHeld; };
    samples.rest.clear();
    if (std::ranges::none_of(samples.values, beyond)) return;
    samples.rest.resize(samples.values.size());
    for (std::size_t i = 0; i < samples.rest.size(); ++i)
        samples.rest[i] = beyond(samples.values[i]) ? float(exactly(i) - double(samples.values[i])) : 0.0f;
}

BrickSamples gather(const BrickGrid& grid, const BrickKey& key, int halo,
                    const std::function<BrickSamples(const BrickKey&)>& read) {
    const bool bcc = grid.lattice.kind == LatticeKind::BCC;
    const glm::ivec3 whole = grid.levelSamples(key.level), own = grid.brickSamples(key.index, key.level);
    const glm::ivec3 first = grid.levelBegin(key.index, key.level);
    const int perTexel = bcc ? 2 : 1;
    const int edge = grid.brickSize >> key.level;
    BrickSamples out;
    out.size = {own.x + 2 * halo, own.y + 2 * halo, perTexel * ((own.z + perTexel - 1) / perTexel + 2 * halo)};

    // For each axis, the origin of each output sample: brick offset (-1, 0, 1, ...) and sample within that brick.
    struct Origin {
        int brick, sample;
    };
    std::vector<Origin> axes[3];
    for (int axis = 0; axis < 3; ++axis) {
        const int step = axis == 2 ? perTexel : 1;
        for (int i = 0; i < out.size[axis]; ++i) {
            int at = first[axis] + i - halo * step;
            if (step == 1) {
                at = glm::clamp(at, 0, whole[axis] - 1);
            } else { // clamp within the sublattice
                const int parity = ((at % 2) + 2) % 2;
                const int count = (whole[axis] + 1 - parity) / 2;
                const int texel = glm::clamp((at - parity) / 2, 0, glm::max(count - 1, 0));
                at = count > 0 ? 2 * texel + parity : glm::clamp(at, 0, whole[axis] - 1);
            }
            const int length = edge * step;
            axes[axis].push_back({at / length, at % length});
        }
    }
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);

    // Runs of equal brick per axis, so that each neighbour is read once.
    struct Run {
        int brick, begin, end;
    };
    std::vector<Run> runs[3];
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < out.size[axis]; ++i) {
            const int brick = axes[axis][std::size_t(i)].brick;
            if (runs[axis].empty() || runs[axis].back().brick != brick) runs[axis].push_back({brick, i, i});
            runs[axis].back().end = i + 1;
        }
    for (const Run& rz : runs[2])
        for (const Run& ry : runs[1])
            for (const Run& rx : runs[0]) {
                BrickKey neighbour = key;
                neighbour.index = {rx.brick, ry.brick, rz.brick};
                const BrickSamples from = read(neighbour);
                if (!from.present.empty() && out.present.empty()) out.present.assign(total, 1);
                for (int z = rz.begin; z < rz.end; ++z)
                    for (int y = ry.begin; y < ry.end; ++y)
                        for (int x = rx.begin; x < rx.end; ++x) {
                            const std::size_t to =
                                (std::size_t(z) * std::size_t(out.size.y) + std::size_t(y)) * std::size_t(out.size.x) +
                                std::size_t(x);
                            const std::size_t source =
                                (std::size_t(axes[2][std::size_t(z)].sample) * std::size_t(from.size.y) +
                                 std::size_t(axes[1][std::size_t(y)].sample)) *
                                    std::size_t(from.size.x) +
                                std::size_t(axes[0][std::size_t(x)].sample);
                            out.values[to] = from.values[source];
                            if (!from.present.empty()) out.present[to] = from.present[source];
                        }
            }
    return out;
}

} // namespace tessera::volume
