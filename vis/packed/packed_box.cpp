#include "vis/packed/packed_box.h"

#include "vis/packed/packet_volume.h"

#include <algorithm>

namespace tessera::vis::packet {

namespace {

/// Moves the positions of the box to where there are samples.
void keepWithin(PackedBox& box, const volume::Lattice& lattice) {
    constexpr double kBefore = 0.7;
    const double beyond = lattice.kind == volume::LatticeKind::BCC ? 1.2 : 0.7; // cells
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = box.halfSize[axis] * box.cellsPerWorld[axis], first = kMargin - kBefore,
                     last = double(lattice.texels()[axis] - 1 + kMargin) + beyond;
        const auto within = [&](double at) { return at > first ? std::min(at, last) : first; }; // also if it is NaN
        const double begin = within(box.cellsOffset[axis] - reach), end = within(box.cellsOffset[axis] + reach);
        box.least[axis] = float(std::min(begin, end));
        box.most[axis] = float(std::max(begin, end));
        if (begin == box.cellsOffset[axis] - reach && end == box.cellsOffset[axis] + reach) continue;
        constexpr double kFlat = 1e-6; // not 0: it is divided by
        box.cellsPerWorld[axis] = begin == end ? kFlat : (end - begin) / (2 * box.halfSize[axis]);
        box.cellsOffset[axis] = (begin + end) / 2;
    }
}

} // namespace

PackedBox packedBox(const WorldFrame& frame, const volume::Lattice& lattice) {
    PackedBox box;
    // A data set of a single slice has no thickness; give it enough for rays to meet it.
    box.halfSize = glm::max(frame.halfSize, glm::dvec3(1e-5));
    box.edges = lattice.spacing * frame.scale;
    box.cellsPerWorld = 1.0 / box.edges;
    box.cellsOffset = (-frame.offset / frame.scale - lattice.origin) / lattice.spacing + double(kMargin);
    keepWithin(box, lattice);
    return box;
}

} // namespace tessera::vis::packet
