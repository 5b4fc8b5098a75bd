#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tessera::codec {

/// Summary of packing.
struct PackSummary {
    std::uint64_t sourceBytes = 0; ///< of all samples read
    std::uint64_t sourceSamples = 0, storedSamples = 0;
    std::uint64_t archiveBytes = 0; ///< of the whole file
    std::uint64_t addedBytes = 0;   ///< of those, added by this run
    std::uint64_t storedBytes = 0;  ///< of the samples on the stored lattice
    std::uint64_t repeatedBricks = 0,
                  repeatedBytes = 0;               ///< bricks stored as repeats of an earlier time, and bytes saved
    std::uint64_t bricks = 0, discardedBricks = 0; ///< number in the grid; omitted in all parameters and times
    std::uint64_t weakenedBricks = 0;              ///< bricks whose threshold was lowered to keep the bound
    double maxError = 0; ///< bound on the error of a sample, relative to its parameter's range
    double seconds = 0;
    /// Seconds per stage. Stages overlap: reading and resampling continue while the previous frame is coded.
    double loadSeconds = 0, resampleSeconds = 0, codeSeconds = 0, writeSeconds = 0;
    double waitSeconds = 0;         ///< waiting for reading and resampling with nothing to code
    int trials = 1;                 ///< number of trials to find the error that fits a size
    std::vector<std::string> notes; ///< messages to the user, one line each
};

} // namespace tessera::codec
