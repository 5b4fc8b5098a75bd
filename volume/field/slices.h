#pragma once

#include "volume/field/field.h"

#include <functional>

/// Consecutive slices of a frame along z.
namespace tessera::volume {

/// Slices [first, first + count) of a frame; by default all of it. Of BCC `first` is even.
struct SliceRange {
    int first = 0;
    int count = 0; ///< 0: all from `first` on

    /// The same of a frame of so many slices, with their number.
    SliceRange of(const Lattice& whole) const { return {first, count > 0 ? count : whole.size.z - first}; }
    bool isAllOf(const Lattice& whole) const { return of(whole).count == whole.size.z; }
    bool operator==(const SliceRange&) const = default;
};

/// Slices of a lattice, as a lattice of their own.
inline Lattice slicesOf(Lattice lattice, SliceRange slices) {
    const SliceRange taken = slices.of(lattice);
    lattice.origin.z += lattice.spacing.z * taken.first * (lattice.kind == LatticeKind::BCC ? 0.5 : 1.0);
    lattice.size.z = taken.count;
    return lattice;
}
inline Lattice slicesOf(const Lattice& lattice, int first, int count) {
    return slicesOf(lattice, SliceRange{first, count});
}

/// The same of a field.
Field slicesOf(const Field& field, SliceRange slices);
inline Field slicesOf(const Field& field, int first, int count) {
    return slicesOf(field, SliceRange{first, count});
}

/// Gives slices of one component at one time, `count` at least 1, with the same type, offset and scale every time.
using SliceReader = std::function<Field(int first, int count)>;

} // namespace tessera::volume
