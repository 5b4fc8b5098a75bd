#pragma once

#include "codec/brick/numbers.h"
#include "codec/wavelet/wavelet.h"
#include "volume/base/describe.h"
#include "volume/bricks/brick_importance.h"

#include <limits>
#include <optional>

namespace tessera::codec {

/// Up to this effort nothing is tried: a wavelet that is not given is (2,2), and tables are made from few bricks.
inline constexpr int kQuickEffort = 3;
/// From this effort on, samples are also predicted by fitted weights (codec/fitted), if neither a wavelet nor the
/// transform of BCC is given.
inline constexpr int kFittedEffort = 7;
/// With this effort integers get larger bricks, too, and weights are fitted to more samples.
inline constexpr int kLongestEffort = 9;

/// Coding options of one frame.
struct FrameOptions {
    std::optional<Wavelet> wavelet = Wavelet::W22; ///< none: selected by trial
    std::optional<bool> bodyCentred;               ///< of BCC (codec/wavelet/body_centred.h); none: selected by trial
    std::optional<NumberCoding> numbers;           ///< none: selected for the error bound
    double maxError = 0; ///< absolute, in stored units; 0: lossless. Integers are exact unless addFrame gets what they
                         ///< are rounded from, of which it is the bound
    double spent =
        0; ///< part of maxError used by previous processing of the samples; the rest is for codes and repeats
    /// Largest root of the mean square of errors, in stored units; 0: no such bound. maxError is then that of rounding
    /// samples. A brick may repeat an earlier one only if its sum of squared differences does not exceed that of its
    /// own codes (but by little where coefficients are quantised: there the sum of the frame is measured).
    double rms = 0;
    double mostError = std::numeric_limits<double>::infinity(); ///< with `rms`: a bound that holds for all samples, too
    bool keepsAbsent = false;                                   ///< also code the stored numbers of absent samples
    int mostPredicted = 0; ///< longest run of bricks that are predicted from the time before, at most kMostPredicted
    int effort = 5;        ///< 1 to 9: PackOptions::effort
    int zstdLevel = 3;
    Range range{1, 0}; ///< physical range of the component that importance refers to; lo > hi: that of the frame
    bool categorical = false;
    bool mayMix = true; ///< bricks of a single time may be mixed, which are slow to decode
    volume::ImportanceOptions importance;
};

} // namespace tessera::codec
