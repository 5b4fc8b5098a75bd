#pragma once

#include "volume/field.h"
#include "volume/progress.h"

namespace tessera::volume {

enum class ResampleFilter { Nearest, Linear, Cubic };
inline constexpr std::string_view kResampleFilterNames[] = {"nearest", "linear", "cubic"};

/// Samples a field on another lattice. CC sources use nearest, trilinear or Catmull-Rom kernels; BCC sources nearest or
/// the prefiltered average (both other filters). Absent samples take no part: weights of present ones are normalised,
/// and a target sample is absent where the nearest source sample is. Integer types round and clamp to their range; a
/// same-lattice target is the identity. Deterministic on any number of threads.
Field resample(const Field& source, const Lattice& target, ResampleFilter filter, const Progress& progress = {});

/// The field on bccFor(its lattice); nearest for categorical parameters, cubic for others.
Field toBcc(const Field& source, bool categorical, const Progress& progress = {});

} // namespace tessera::volume
