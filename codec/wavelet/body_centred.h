#pragma once

#include "codec/wavelet/lift_box.h"

/// A transform of BCC as a whole, not of its two grids one by one: the finer chain of sublattices. A sample of the odd
/// grid lies in the middle of eight samples of the even one; what a cubic through 4 x 4 x 4 of them does not foresee is
/// all that is kept of it (a lifting step from BCC to CC, of index two). The even grid goes on alone; at coarser levels
/// the odd samples lie nearer to even ones and are interpolated between them. (FORMAT.md "Body-centred".)
///
/// Boxes have the sizes of sublattices of one brick: the same along x and y, the odd one has as many slices or one
/// less. At full resolution the even grid repeats its last samples beyond its ends, at coarser levels it goes on as
/// between the last two.
namespace tessera::codec {

/// out = odd - prediction and odd = difference + prediction, at full resolution; modulo the word.
template <class Word> void subtractPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide);
template <class Word> void addPrediction(const Box<const Word>& even, const Box<Word>& odd, bool wide);

/// Odd samples of a coarser level, 2^-(level + 1) of its cells beyond even ones along each axis: trilinear.
template <class Word> void interpolateOdd(const Box<const Word>& even, const Box<Word>& odd, int level);

/// Codes of so many bits keep every sum of the prediction within 32 bits.
inline constexpr int kBitsOfPrediction = 17;

} // namespace tessera::codec
