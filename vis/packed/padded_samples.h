#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/reconstruct/reconstruct.h"

#include <limits>
#include <optional>
#include <stop_token>

/// The samples of one channel at one time in one array, before they are laid out for packets of rays.
namespace tessera::vis::packet {

struct Extent {
    float lo = std::numeric_limits<float>::infinity(), hi = -lo; ///< lo > hi: of nothing
    void add(const Extent& other);
};

/// Of the present samples.
Extent extentOf(const volume::BrickSamples& samples);

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

/// The samples of these texels at full resolution, in the order of a lattice of their own; beyond the lattice the
/// nearest sample of the same sublattice, an absent one is 0. `present` is empty where all are. Throws Error when the
/// source does, Cancelled once a stop is requested.
volume::BrickSamples readPadded(const volume::BrickSource& source, const PaddedRead& what, std::stop_token stop);

} // namespace tessera::vis::packet
