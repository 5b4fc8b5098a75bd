#pragma once

#include "volume/base/progress.h"
#include "volume/field/slices.h"
#include "volume/field/stored_range.h"
#include "volume/resample/resample_taps.h"

#include <utility>
#include <vector>

/// Resampling of CC fields, any run of slices of the target from the slices of the source that it needs: inside of
/// volume/resample/resample.cpp and volume/resample/resample_slices.cpp.
namespace tessera::volume {

/// Where the samples of a target lie in a CC source. Targets are one or two axis-aligned grids, so the source is
/// filtered axis by axis: z and y over whole rows, then x.
struct CcTaps {
    Lattice source, target;
    std::vector<AxisTaps> kernel; ///< of each sublattice of the target

    CcTaps(const Lattice& source, const Lattice& target, const ResampleOptions& options);
    /// The slices [first, end) of the source that slices [first, first + count) of the target are made of; more where
    /// it has masks.
    std::pair<int, int> slicesFor(int first, int count, bool masked) const;
};

/// Part of a source: slices from `first` on, and of B-splines their coefficients, of the type SumOf<stored type>, where
/// there are none null.
struct CcPart {
    const Field& field;
    int first = 0;
    const void* coefficients = nullptr;
};

/// Slices [first, first + count) of the target, of BCC `first` even. A mask is made where the part has one, though
/// everything in it be present.
Field resampleCc(const CcTaps& taps, const CcPart& part, const StoredExtent& extent, int first, int count,
                 const Progress& progress);

/// Number of target slices on either side that a gap in a mask can influence.
inline constexpr int kGapSlices = 2;

} // namespace tessera::volume
