#include "volume/bricks/brick_source.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace tessera::volume {

namespace {

int ceilShift(int n, int level) {
    return (n + (1 << level) - 1) >> level;
}

/// Storage size at a level of `fine` storage samples that start on an even slice.
glm::ivec3 atLevel(LatticeKind kind, glm::ivec3 fine, int level) {
    glm::ivec3 size(ceilShift(fine.x, level), ceilShift(fine.y, level), ceilShift(fine.z, level));
    if (kind == LatticeKind::BCC) size.z = ceilShift((fine.z + 1) / 2, level) + ceilShift(fine.z / 2, level);
    return size;
}

} // namespace

glm::ivec3 BrickGrid::count() const {
    return (lattice.texels() + brickSize - 1) / brickSize;
}

glm::ivec3 BrickGrid::begin(glm::ivec3 brick) const {
    return brick * brickSize * glm::ivec3(1, 1, lattice.kind == LatticeKind::BCC ? 2 : 1);
}

std::size_t BrickGrid::brickCount() const {
    const glm::ivec3 bricks = count();
    return std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z);
}

std::size_t BrickGrid::numberOf(glm::ivec3 brick) const {
    const glm::ivec3 bricks = count();
    return (std::size_t(brick.z) * std::size_t(bricks.y) + std::size_t(brick.y)) * std::size_t(bricks.x) +
           std::size_t(brick.x);
}

glm::ivec3 BrickGrid::indexOf(std::size_t number) const {
    const glm::ivec3 bricks = count();
    const std::size_t nx = std::size_t(bricks.x), ny = std::size_t(bricks.y);
    return {int(number % nx), int(number / nx % ny), int(number / (nx * ny))};
}

glm::ivec3 BrickGrid::end(glm::ivec3 brick) const {
    return glm::min(begin(brick + 1), lattice.size);
}

glm::ivec3 BrickGrid::brickSamples(glm::ivec3 brick, int level) const {
    return atLevel(lattice.kind, end(brick) - begin(brick), level);
}

glm::ivec3 BrickGrid::levelSamples(int level) const {
    return atLevel(lattice.kind, lattice.size, level);
}

int BrickGrid::levelWithin(double samples) const {
    int level = 0;
    for (; level + 1 < levels; ++level) {
        const glm::dvec3 size(levelSamples(level));
        if (size.x * size.y * size.z <= samples) break;
    }
    return level;
}

glm::ivec3 BrickGrid::levelBegin(glm::ivec3 brick, int level) const {
    const glm::ivec3 fine = begin(brick);
    return {fine.x >> level, fine.y >> level, fine.z >> level};
}

double BrickGrid::levelPhase(int level) const {
    return phase * ((1 << level) - 1);
}

BrickChange accumulated(const BrickChange& first, const BrickChange& second) {
    return {roundedUp(double(first.max) + double(second.max)), roundedUp(double(first.rms) + double(second.rms))};
}

float roundedUp(double value) {
    const auto rounded = static_cast<float>(value);
    return double(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

BrickChange magnitudeChange(std::span<const BrickChange> components) {
    double max = 0, rms = 0;
    for (const BrickChange& component : components) {
        max += double(component.max) * double(component.max);
        rms += double(component.rms) * double(component.rms);
    }
    // A magnitude is rounded to float separately, but only if a component changes.
    constexpr double kRounding = 1 + 1e-6;
    return {roundedUp(std::sqrt(max) * kRounding), roundedUp(std::sqrt(rms) * kRounding)};
}

BrickImportance magnitudeImportance(std::span<const BrickImportance> components) {
    BrickImportance most;
    for (const BrickImportance& component : components)
        most = {std::max(most.importance, component.importance), std::max(most.detail, component.detail)};
    return most;
}

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
