#pragma once

#include "volume/base/parallel.h"
#include "volume/base/progress.h"
#include "volume/field/lattice.h"

#include <algorithm>

namespace tessera::volume {

/// Runs `slice(k)` for every slice of a lattice in parallel, with progress between groups of them.
template <class Body> void forSlices(const Lattice& lattice, const Progress& progress, const Body& slice) {
    constexpr int kGroup = 32; // slices between two looks at the stop token
    for (int first = 0; first < lattice.size.z; first += kGroup) {
        progress.advance(double(first) / lattice.size.z, "resample");
        const int count = std::min(kGroup, lattice.size.z - first);
        parallelFor(std::size_t(count), [&](std::size_t i) { slice(first + int(i)); });
    }
    progress.advance(1, "resample");
}

} // namespace tessera::volume
