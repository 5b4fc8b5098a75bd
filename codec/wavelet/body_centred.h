#pragma once

#include "codec/wavelet/lift_box.h"

/// Wavelet transform of BCC as a whole instead of its two sublattices separately. A sample of the odd sublattice lies
/// in the middle of eight samples of the even one; only its difference from a cubic prediction from 4 x 4 x 4 even
/// samples is stored (a lifting step from BCC to CC, of index two). The even sublattice is then transformed alone. At
/// coarser levels the odd samples lie nearer to even ones and are interpolated from them. (FORMAT.md "Body-centred".)
///
/// Boxes have the sizes of the sublattices of one brick: equal along x and y; the odd one has as many slices or one
/// less. At full resolution the even sublattice repeats its last samples beyond its ends; at coarser levels it is
/// extrapolated linearly from the last two.
namespace tessera::codec {

/// out = odd - prediction and odd = difference + prediction, at full resolution; modulo the word.
template <class Word> void subtractPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide);
template <class Word> void addPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide);

/// Odd samples of a coarser level, which lie 2^-(level + 1) of its cells beyond even ones along each axis: trilinear
/// interpolation.
template <class Word> void interpolateOdd(const Box<const Word>& even, const Box<Word>& odd, int level);

/// Largest width of codes, in bits, for which every sum of the prediction fits into 32 bits.
inline constexpr int kBitsOfPrediction = 17;

} // namespace tessera::codec
