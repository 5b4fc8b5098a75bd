#include "volume/bricks/brick_grid.h"

#include <glm/common.hpp>

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

} // namespace tessera::volume
