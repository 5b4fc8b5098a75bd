#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/system/unfilled.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <vector>

/// The samples of one channel at one time in one array, before they are laid out for packets of rays.
namespace tessera::vis::packet {

struct Extent {
    float lo = std::numeric_limits<float>::infinity(), hi = -lo; ///< lo > hi: of nothing
    void add(const Extent& other);
};

/// Of the present ones of so many samples; `present` is null where all are.
Extent extentOf(const float* values, const std::uint8_t* present, std::size_t count);

/// One part of a parameter.
struct OnePart {
    int label; ///< channel
    const volume::Parts& parts;
    std::size_t part;
};

/// What is read: all samples, or those of one part with the others absent.
struct PaddedRead {
    int channel = 0, time = 0;
    std::optional<OnePart> only = {};
    glm::ivec3 first{0}, count{1}; ///< texels (one sample of each sublattice); the whole lattice is among them
};

/// Samples in the order of a lattice of their own.
struct PaddedSamples {
    glm::ivec3 size{0};
    volume::UnfilledVector<float> values; ///< an absent one is 0
    std::vector<std::uint8_t> present;    ///< 1 or 0 each; empty: all are
};

/// The samples of these texels at full resolution; beyond the lattice the nearest sample of the same sublattice. Throws
/// Error when the source does, Cancelled once a stop is requested.
PaddedSamples readPadded(const volume::BrickSource& source, const PaddedRead& what, std::stop_token stop);

} // namespace tessera::vis::packet
