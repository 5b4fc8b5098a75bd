#pragma once

#include "volume/resample/series.h"

#include <array>
#include <span>

/// Three-dimensional slices of a field in space and time, in any direction (Röber 2002, section 4.1.3).
namespace tessera::volume {

/// The points (x, y, z, t) with a x + b y + c z + d t + e = 0; `normal` = (a, b, c, d), in units of the lattice.
struct Hyperplane {
    glm::dvec4 normal{0, 0, 0, 1};
    double e = 0;
};

/// A slice as a field over three of the four axes; the fourth follows from the plane.
struct HyperplaneSlice {
    Field field;             ///< float, CC; its x, y, z are the axes below; absent outside the lattice
    std::array<int, 3> axes; ///< which of x, y, z, t (0..3) they are, in this order
    int solved = 3;          ///< the axis that follows
};

/// Samples the slice at the distances of the CC lattice that a series stands for (D4*: cell edges / sqrt 2); uneven
/// axes keep their maps, but for the one solved for. The plane is one of space. The axis solved for is the one whose
/// share of the normal, times its extent, is largest. Linear in space and time, on D4* the mean of both grids: give a
/// prefiltered() series for quasi-interpolation. One frame is held at a time. Throws Error when the normal is 0 or the
/// plane misses the lattice.
///
/// `times`: the time of each frame, rising; t is then a time, not a frame number, and along it the slice has as many
/// even steps as the frames have. Empty: t is in units of the lattice.
HyperplaneSlice sliceBy(const Series& series, const Hyperplane& plane, std::span<const double> times = {},
                        const Progress& progress = {});

} // namespace tessera::volume
