#pragma once

#include "codec/brick/numbers.h"
#include "codec/wavelet/wavelet.h"
#include "volume/base/describe.h"
#include "volume/bricks/brick_importance.h"

#include <optional>

namespace tessera::codec {

/// How one frame is coded.
struct FrameOptions {
    std::optional<Wavelet> wavelet = Wavelet::W22; ///< none: the best of some, by trial
    std::optional<bool> bodyCentred;     ///< of BCC (codec/wavelet/body_centred.h); none: the shorter by trial
    std::optional<NumberCoding> numbers; ///< none: chosen for the bound
    double maxError = 0;                 ///< absolute, in stored units; 0: every sample exactly
    double spent = 0; ///< of maxError, by what was done to the samples before: codes and repeats have what is left
    /// A brick may repeat an earlier one only if its sum of squared differences is no larger than that of its own codes
    /// would be.
    bool keepsSquares = false;
    bool keepsAbsent = false; ///< also the stored numbers of absent samples
    int zstdLevel = 3;
    Range range{1, 0}; ///< physical, of the component, that importance refers to; lo > hi: that of the frame
    bool categorical = false;
    volume::ImportanceOptions importance;
};

} // namespace tessera::codec
