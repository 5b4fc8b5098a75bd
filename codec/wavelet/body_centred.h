#pragma once

#include "codec/wavelet/lift_box.h"

/// Wavelet transform of BCC as a whole instead of its two sublattices separately. A sample of the odd sublattice lies
/// at the centre of eight samples of the even one; it is replaced by the residual of a cubic prediction from 4 x 4 x 4
/// even samples (a lifting step from BCC to CC, of index two). Then only the even sublattice is transformed further. At
/// coarser levels the odd samples lie closer to even ones and are interpolated from them. (FORMAT.md "Body-centred".)
///
/// Boxes have the sizes of the sublattices of one brick: equal along x and y; the odd one has as many slices or one
/// less. At full resolution the even sublattice is clamped at its ends; at coarser levels it is extrapolated linearly
/// from the last two samples.
namespace tessera::codec {

/// out = odd - prediction and odd = difference + prediction, at full resolution; modulo the word.
template <class Word> void subtractPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide);
template <class Word> void addPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide);

/// Trilinear interpolation of the odd samples of a coarser level, which lie 2^-(level + 1) of its cells beyond even
/// ones along each axis.
template <class Word> void interpolateOdd(const Box<const Word>& even, const Box<Word>& odd, int level);

/// Largest code width in bits for which all sums of the prediction fit into 32 bits.
inline constexpr int kBitsOfPrediction = 17;

} // namespace tessera::codec
