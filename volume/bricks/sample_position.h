#pragma once

#include "volume/bricks/brick_grid.h"

#include <glm/vec3.hpp>

namespace tessera::volume {

/// Place in space of a storage index of a level: on BCC odd z is the moved sublattice.
inline glm::dvec3 samplePosition(const BrickGrid& grid, glm::ivec3 at, int level) {
    const bool bcc = grid.lattice.kind == LatticeKind::BCC;
    const glm::dvec3 index(at.x, at.y, bcc ? at.z >> 1 : at.z);
    const double odd = bcc && (at.z & 1) != 0 ? 0.5 : 0;
    return grid.lattice.fromCells(index * double(1 << level) + grid.levelPhase(level) + odd);
}

/// Physical positions of a brick's samples, in their order.
class SamplePositions {
public:
    SamplePositions(const BrickGrid& grid, glm::ivec3 brick, int level)
        : grid_(grid), first_(grid.levelBegin(brick, level)), end_(first_ + grid.brickSamples(brick, level)),
          now_(first_), level_(level) {}
    glm::dvec3 at() const { return samplePosition(grid_, now_, level_); }
    /// Storage index of the level.
    glm::ivec3 index() const { return now_; }
    void next() {
        if (++now_.x < end_.x) return;
        now_.x = first_.x;
        if (++now_.y < end_.y) return;
        now_.y = first_.y;
        ++now_.z;
    }

private:
    const BrickGrid& grid_;
    glm::ivec3 first_, end_, now_;
    int level_;
};

} // namespace tessera::volume
