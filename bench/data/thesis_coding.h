#pragma once

#include "codec/wavelet/lifting.h"
#include "codec/wavelet/threshold.h"
#include "volume/field/field.h"

#include <cstddef>

/// Compression as in the thesis: integer wavelet, thresholds, run lengths. A baseline for benchmarks.
namespace tessera::app {

struct ThesisCoding {
    codec::Wavelet wavelet = codec::Wavelet::W22;
    int levels = 3;
    codec::Threshold threshold = codec::Threshold::Soft;
    double value = 0;
    bool threeDirections = false; ///< runs along x, y or z, whichever is shortest in each band; two bits say which
};

struct ThesisResult {
    std::size_t bytes = 0; ///< low frequencies as they are, details as runs
    double rms = 0;        ///< error of the samples, in stored units
};

/// Codes a whole field of 8-bit or 16-bit integers on CC. Throws Error for others, and where samples are absent.
ThesisResult thesisCode(const volume::Field& field, const ThesisCoding& coding);

} // namespace tessera::app
