#pragma once

#include "volume/field/dataset.h"
#include "volume/field/slices.h"

#include <optional>
#include <vector>

/// The error of resampling to BCC: the stored lattice is interpolated at the samples of the source, as in unpacking.
namespace tessera::codec {

/// Error of one parameter over all components and times, in its unit. For labels each different sample counts as 1.
/// Samples absent on either side are skipped.
struct ResampleError {
    double meanSquare = 0, largest = 0;
    double samples = 0; ///< number compared
    double share = 1;   ///< fraction of the source samples examined

    void add(const ResampleError& more);
    bool operator==(const ResampleError&) const = default;
};

/// Peak signal-to-noise ratio in dB relative to a range; infinite without an error.
double psnrOf(const ResampleError& error, double extent);

/// Upper bound of the error of samples that were resampled twice: errors add up.
ResampleError joined(const std::optional<ResampleError>& before, const ResampleError& then);

/// Compares a frame with its stored version. Frames of up to 32 slices are compared completely, larger ones in at most
/// 32 blocks of 8 slices, evenly distributed along z, with only one block and the stored slices around it in memory.
/// Throws Cancelled and what reading throws.
ResampleError resampleError(const volume::Field& source, const volume::Field& stored, bool categorical);
ResampleError resampleError(const volume::Lattice& source, const volume::SliceReader& readSource,
                            const volume::Lattice& stored, const volume::SliceReader& readStored, bool categorical);

} // namespace tessera::codec
