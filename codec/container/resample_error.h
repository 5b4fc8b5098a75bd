#pragma once

#include <optional>
#include <vector>

/// The error of resampling to BCC: the stored lattice is interpolated at the samples of the source, as in unpacking.
namespace tessera::codec {

/// Error of one parameter over all components and times, in its unit. Archives without corrections: for labels each
/// different sample counts as 1, and samples absent on either side are skipped.
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
/// The same where samples were off by up to `bound` before.
ResampleError joined(double bound, const ResampleError& then);

} // namespace tessera::codec
