#pragma once

#include "volume/base/cpu.h"
#include "volume/base/describe.h"
#include "volume/field/field.h"

#include <vector>

namespace tessera::volume {

inline std::size_t countOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

/// One sublattice of a field, smoothed by a Gaussian (binomial, of one sample) and read at every second sample along
/// each axis: values as parts of a range, held within 0..1, with how much of each was there.
struct Smoothed {
    glm::ivec3 size{0};
    std::vector<float> values, coverage; ///< coverage: empty where everything is present
    std::size_t index(glm::ivec3 at) const {
        return (std::size_t(at.z) * std::size_t(size.y) + std::size_t(at.y)) * std::size_t(size.x) + std::size_t(at.x);
    }
    bool has(std::size_t i) const { return coverage.empty() || coverage[i] > 0; }
};

/// Range of a whole frame that a field is a part of.
struct SmoothedRange {
    Range range;         ///< lo < hi
    bool gaps = false;   ///< some are absent, or not finite
    bool inside = false; ///< all lie within the range
};

/// Beyond the ends of a line its last sample is repeated; absent samples take no part. The result does not depend on
/// `cpu`.
Smoothed smoothedHalf(const Field& field, int sublattice, const SmoothedRange& about, Cpu cpu = bestCpu());

} // namespace tessera::volume
