#pragma once

#include "codec/brick/numbers.h"
#include "codec/wavelet/wavelet.h"
#include "volume/base/describe.h"
#include "volume/bricks/brick_importance.h"

#include <optional>

namespace tessera::codec {

/// Coding options of one frame.
struct FrameOptions {
    std::optional<Wavelet> wavelet = Wavelet::W22; ///< none: selected by trial
    std::optional<bool> bodyCentred;               ///< of BCC (codec/wavelet/body_centred.h); none: selected by trial
    std::optional<NumberCoding> numbers;           ///< none: selected for the error bound
    double maxError = 0;                           ///< absolute, in stored units; 0: lossless
    double spent =
        0; ///< part of maxError used by previous processing of the samples; the rest is for codes and repeats
    /// A brick may repeat an earlier one only if its sum of squared differences does not exceed that of its own codes.
    bool keepsSquares = false;
    bool keepsAbsent = false; ///< also code the stored numbers of absent samples
    int mostPredicted = 0;    ///< longest run of bricks that are predicted from the time before, at most kMostPredicted
    int zstdLevel = 3;
    Range range{1, 0}; ///< physical range of the component that importance refers to; lo > hi: that of the frame
    bool categorical = false;
    volume::ImportanceOptions importance;
};

} // namespace tessera::codec
