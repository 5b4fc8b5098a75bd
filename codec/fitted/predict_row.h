#pragma once

#include "codec/fitted/fitted_weights.h"
#include "codec/fitted/pass_rows.h"
#include "volume/base/cpu.h"

namespace tessera::codec {

/// The codes that can occur: predictions are clamped to them.
struct CodeRange {
    std::int32_t least = 0, most = 0;
};

/// Largest activity; larger ones are counted as this.
inline constexpr std::uint32_t kMostActivity = 32767;
/// Rows are predicted in blocks of this many samples: buffers have room for whole blocks.
inline constexpr int kPredictedBlock = 32;

/// Predicts the samples of a row of `width` by
///
///     (bias[c] + sum over taps of weight[tap][c] * sample[tap] + 128) / 256, rounded down,
///
/// where c is the class of the activity: the sum of |sample[tap] - guess| over the near taps, divided by 2^shift. Sums
/// are modulo 2^32. Fills the predictions and half of each activity. The results do not depend on `cpu`, for 16-bit
/// words as long as codes have at most kBitsOfInt16 bits.
template <class Word>
void predictRow(Pass pass, const TapRows<Word>& taps, const PassWeights& weights, CodeRange range, int shift, int width,
                Word* predicted, std::uint16_t* activity, Cpu cpu = bestCpu());

} // namespace tessera::codec
