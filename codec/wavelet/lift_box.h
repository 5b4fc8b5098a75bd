#pragma once

#include "codec/wavelet/lifting.h"
#include "volume/base/cpu.h"

#include <cstddef>
#include <cstdint>
#include <functional>

/// Lifting of boxes without absent samples, in loops over rows that compilers vectorise; results are identical to those
/// of codec/wavelet/lifting.h.
namespace tessera::codec {

/// Whether this file supports a wavelet: all but (1,3) and (1,5) with their antisymmetric updates.
bool liftsBoxes(Wavelet wavelet);

/// Largest code widths in bits for which every sum of every wavelet fits into 16-bit words (single pairs) or 32-bit
/// sums: over three axes and all levels values grow less than a hundredfold (computed by
/// tests/codec/lift_box_test.cpp).
inline constexpr int kBitsOfInt16 = 8, kBitsOfInt32 = 16;

/// A box of words: rows of `size.x`, x fastest, `pitch` words apart; padding is undefined.
template <class Word> struct Box {
    Word* values = nullptr;
    glm::ivec3 size{0};
    int pitch = 0;

    Word* row(int y, int z) const { return values + (std::ptrdiff_t(z) * size.y + y) * pitch; }
};

/// Pitches are multiples of this many words; loops run over whole blocks.
inline constexpr int kRowWords = 32;
constexpr int pitchFor(int width) {
    return (width + kRowWords - 1) / kRowWords * kRowWords;
}

/// One step of the forward transform: along x, then y, then z; even samples of each axis go to the low half. `out` has
/// the same size and pitch as `in` and must not overlap it; the pitch is a multiple of kRowWords. `wide`: sums in 64
/// bits; results modulo the word.
template <class Word>
void splitBox(const Box<const Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu = bestCpu());

/// The same for slices that `sliceOf(z)` gives, for z from 0 on, each once; rows are as far apart as in `out`.
template <class Word>
void splitSlices(const std::function<const Word*(int z)>& sliceOf, const Box<Word>& out, Wavelet wavelet, bool wide,
                 Cpu cpu = bestCpu());

/// Inverse of splitBox; `in` is used as working memory.
template <class Word>
void joinBox(const Box<Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu = bestCpu());

} // namespace tessera::codec
