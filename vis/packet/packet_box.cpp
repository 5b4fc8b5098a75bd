#include "vis/packet/packet_box.h"

#include "vis/optics/ray_setup.h"
#include "vis/packed/packet_volume.h"

#include <algorithm>

namespace tessera::vis::packet {

namespace {

/// Moves the positions of the box to where there are samples.
void keepWithin(CastJob& job, const volume::Lattice& lattice) {
    constexpr double kBefore = 0.7;
    const double beyond = lattice.kind == volume::LatticeKind::BCC ? 1.2 : 0.7; // cells
    for (int axis = 0; axis < 3; ++axis) {
        const double reach = job.halfSize[axis] * job.cellsPerWorld[axis], first = kMargin - kBefore,
                     last = double(lattice.texels()[axis] - 1 + kMargin) + beyond;
        const auto within = [&](double at) { return at > first ? std::min(at, last) : first; }; // also if it is NaN
        const double begin = within(job.cellsOffset[axis] - reach), end = within(job.cellsOffset[axis] + reach);
        job.least[axis] = float(std::min(begin, end));
        job.most[axis] = float(std::max(begin, end));
        if (begin == job.cellsOffset[axis] - reach && end == job.cellsOffset[axis] + reach) continue;
        constexpr double kFlat = 1e-6; // not 0: it is divided by
        job.cellsPerWorld[axis] = begin == end ? kFlat : (end - begin) / (2 * job.halfSize[axis]);
        job.cellsOffset[axis] = (begin + end) / 2;
    }
}

} // namespace

void placeBox(CastJob& job, const WorldFrame& frame, const volume::Lattice& lattice) {
    // A data set of a single slice has no thickness; give it enough for rays to meet it.
    job.halfSize = glm::max(frame.halfSize, glm::dvec3(1e-5));
    job.cell = worldCell(lattice, frame);
    job.edges = lattice.spacing * frame.scale;
    job.cellsPerWorld = 1.0 / job.edges;
    job.cellsOffset = (-frame.offset / frame.scale - lattice.origin) / lattice.spacing + double(kMargin);
    keepWithin(job, lattice);
}

} // namespace tessera::vis::packet
