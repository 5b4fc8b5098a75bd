#pragma once

#include "volume/base/progress.h"
#include "volume/field/field.h"
#include "volume/resample/resample_options.h"
#include "volume/resample/sharpen.h"

namespace tessera::volume {

/// Samples a field on another lattice. CC sources use the kernels above; BCC sources nearest or the prefiltered average
/// (all other filters; volume/reconstruct/reconstruct.h). Positions outside the box of the source samples take the
/// value of its nearest face; inside, kernels continue the data beyond a face by point reflection (sample -i is 2 *
/// sample 0 - sample i), so that all but nearest and sinc reproduce linear functions up to the last sample; Lagrange
/// moves its samples inside and reproduces its degree everywhere.
///
/// Absent samples take no part, nor do those of other parts where the mask says parts (volume/field/part_masks.h): a
/// target sample is absent where the nearest source sample is, else of the part of that one, and where the kernel meets
/// any others Catmull-Rom's takes its place (of the linear one itself), with the part continued beyond its border from
/// its own samples (volume/reconstruct/continued.h). B-splines treat every run of samples of one part along an axis as
/// a signal of its own. From CC to BCC a gap of one absent sample along an axis stays a gap: where a sublattice would
/// step over it, its sample nearer to the gap is absent too.
///
/// Between lattices on one sheet (volume/field/axis_map.h) all of this is in cells of the sheet. Where their axes
/// differ, samples are taken at their places in space and only linearly (optionsBetween): exact for linear
/// functions of space between the samples of CC.
///
/// Results stay within the range of the source's present samples of their part, integer types round; a same-lattice
/// target without edge enhancement is the identity. Deterministic on any number of threads. Throws Cancelled.
Field resample(const Field& source, const Lattice& target, const ResampleOptions& options,
               const Progress& progress = {});
inline Field resample(const Field& source, const Lattice& target, ResampleFilter filter,
                      const Progress& progress = {}) {
    return resample(source, target, ResampleOptions{.filter = filter}, progress);
}

/// A BCC field on another lattice whose samples' parts are known: `own` has the number of each, 0 where it is absent
/// (volume/field/part_masks.h). As resample() with the usual filter where the nearest sample of the source has that
/// number; else from the nearest sample that has it, kLineReach samples away at most (volume/reconstruct/continued.h);
/// else the mean of the part, or of all samples if the source has none of it. The mask of the result is `own`.
Field resampleOnto(const Field& bcc, const Lattice& target, std::shared_ptr<const Mask> own);

/// The field on bccFor(its lattice); nearest for categorical parameters.
Field toBcc(const Field& source, bool categorical, const ResampleOptions& options, const Progress& progress = {});
inline Field toBcc(const Field& source, bool categorical, const Progress& progress = {}) {
    return toBcc(source, categorical, ResampleOptions{}, progress);
}

} // namespace tessera::volume
