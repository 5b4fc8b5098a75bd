#pragma once

#include "volume/bricks/brick_grid.h"
#include "volume/bricks/cell_lengths.h"
#include "volume/field/dataset.h"

#include <array>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera::volume {

/// The cells of samples: boxes that tile DatasetInfo::bounds, those of each sublattice by themselves, so that every
/// sample of a BCC lattice counts with half of its box.
class SampleCells {
public:
    SampleCells(const BrickGrid& grid, const Box& bounds, int level)
        : sublattices_(grid.lattice.kind == LatticeKind::BCC ? 2 : 1) {
        for (std::size_t s = 0; s < std::size_t(sublattices_); ++s)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                lengths_[s][axis] = cellLengths(grid, bounds, level, int(s), int(axis));
                double sum = 0;
                for (const double length : lengths_[s][axis]) sum += length;
                // A box without extent along an axis: its one cell lies around it.
                const bool flat = bounds.hi[int(axis)] <= bounds.lo[int(axis)];
                double border = bounds.lo[int(axis)] - (flat ? 0.5 * sum : 0);
                for (const double length : lengths_[s][axis]) {
                    borders_[s][axis].push_back(border);
                    border += length;
                }
            }
    }

    int sublattices() const { return sublattices_; }
    /// 0 or 1, by the storage index of a sample.
    int sublatticeOf(glm::ivec3 at) const { return at.z % sublattices_; }
    /// Index within its sublattice.
    glm::ivec3 within(glm::ivec3 at) const { return {at.x, at.y, at.z / sublattices_}; }
    /// Samples of a sublattice along an axis.
    int count(int sublattice, int axis) const {
        return int(lengths_[std::size_t(sublattice)][std::size_t(axis)].size());
    }
    double length(int sublattice, int axis, int index) const {
        return lengths_[std::size_t(sublattice)][std::size_t(axis)][std::size_t(index)];
    }
    double border(int sublattice, int axis, int index) const {
        return borders_[std::size_t(sublattice)][std::size_t(axis)][std::size_t(index)];
    }
    /// Size and lower corner of a sample's box.
    glm::dvec3 size(glm::ivec3 at) const {
        const int s = sublatticeOf(at);
        const glm::ivec3 i = within(at);
        return {length(s, 0, i.x), length(s, 1, i.y), length(s, 2, i.z)};
    }
    glm::dvec3 lower(glm::ivec3 at) const {
        const int s = sublatticeOf(at);
        const glm::ivec3 i = within(at);
        return {border(s, 0, i.x), border(s, 1, i.y), border(s, 2, i.z)};
    }
    /// Volume that a sample stands for.
    double volume(glm::ivec3 at) const {
        const glm::dvec3 box = size(at);
        return box.x * box.y * box.z / sublattices_;
    }

private:
    int sublattices_;
    std::array<std::array<std::vector<double>, 3>, 2> lengths_, borders_; ///< [sublattice][axis][sample]
};

} // namespace tessera::volume
