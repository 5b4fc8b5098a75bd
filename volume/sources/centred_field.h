#pragma once

#include "volume/base/progress.h"
#include "volume/field/field.h"

namespace tessera::volume {

/// A field of a regular grid on bccFor(its lattice) as pictures show it (volume/sources/centred_samples.h), as 32-bit
/// floats; labels take the nearest sample. Its mask, and that of the result, may hold parts. Deterministic on any
/// number of threads. Throws Cancelled.
Field toCentred(const Field& source, bool categorical, const Progress& progress = {});

} // namespace tessera::volume
