#pragma once

#include "volume/field.h"
#include "volume/progress.h"

namespace tessera::volume {

enum class ResampleFilter { Nearest, Linear, Cubic };
inline constexpr std::string_view kResampleFilterNames[] = {"nearest", "linear", "cubic"};

/// Samples a field on another lattice. CC sources use nearest, trilinear or Catmull-Rom kernels; BCC sources nearest or
/// the prefiltered average (both other filters; volume/reconstruct.h). Positions outside the box of the source samples
/// take the value of its nearest face; inside, Catmull-Rom continues the data linearly over a face, so that linear
/// functions are reproduced up to the last sample.
///
/// Absent samples take no part: a target sample is absent where the nearest source sample is, and where the kernel
/// meets an absent sample the weights of the present ones are normalised, for Catmull-Rom those of the trilinear kernel
/// (a sum of its own, partly negative weights could vanish). From CC to BCC a gap of one absent sample along an axis
/// stays a gap: where a sublattice would step over it, its sample nearer to the gap is absent too.
///
/// Results stay within the range of the source's present samples, integer types round; a same-lattice target is the
/// identity. Deterministic on any number of
/// threads. Throws Cancelled.
Field resample(const Field& source, const Lattice& target, ResampleFilter filter, const Progress& progress = {});

/// The field on bccFor(its lattice); nearest for categorical parameters, cubic for others.
Field toBcc(const Field& source, bool categorical, const Progress& progress = {});

} // namespace tessera::volume
