#pragma once

#include "volume/field/field.h"

#include <functional>

/// Frames that are read a part at a time, for those larger than memory.
namespace tessera::volume {

/// Slices [first, first + count) along z of a lattice, as a lattice of their own; of BCC `first` is even.
inline Lattice slicesOf(Lattice lattice, int first, int count) {
    lattice.origin.z += lattice.spacing.z * first * (lattice.kind == LatticeKind::BCC ? 0.5 : 1.0);
    lattice.size.z = count;
    return lattice;
}

/// The same of a field.
Field slicesOf(const Field& field, int first, int count);

/// Gives slices of one component at one time, `count` at least 1, with the same type, offset and scale every time.
using SliceReader = std::function<Field(int first, int count)>;

/// The same of any frame of a data set. Null where frames can only be read whole. As Dataset::load it may be called
/// from any thread, one call at a time, and throws Error.
using SliceLoad = std::function<Field(int parameter, int component, int time, int first, int count)>;

} // namespace tessera::volume
