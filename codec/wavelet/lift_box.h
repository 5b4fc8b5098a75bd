#pragma once

#include "codec/bytes/cpu.h"
#include "codec/wavelet/lifting.h"

#include <cstddef>
#include <cstdint>

/// Lifting of boxes without absent samples: bit for bit the results of codec/wavelet/lifting.h, by rows that compilers
/// vectorise.
namespace tessera::codec {

/// True for the wavelets that this file supports: all but the antisymmetric updates of (1,3) and (1,5).
bool liftsBoxes(Wavelet wavelet);

/// Largest widths of codes, in bits, for which every sum of every wavelet fits into 16-bit words (single pairs) or
/// 32-bit sums: over three axes and all levels values grow less than a hundredfold (tests/codec/lift_box_test.cpp
/// computes it).
inline constexpr int kBitsOfInt16 = 8, kBitsOfInt32 = 16;

/// A box of words: rows of `size.x`, x fastest, `pitch` words apart; words between rows are undefined.
template <class Word> struct Box {
    Word* values = nullptr;
    glm::ivec3 size{0};
    int pitch = 0;

    Word* row(int y, int z) const { return values + (std::ptrdiff_t(z) * size.y + y) * pitch; }
};

/// Pitches are multiples of this many words, and loops run over whole rows.
inline constexpr int kRowWords = 32;
constexpr int pitchFor(int width) {
    return (width + kRowWords - 1) / kRowWords * kRowWords;
}

/// One step of the decomposition: along x, then y, then z; even samples of each axis come to the low half. `out` is a
/// box of the same size and pitch, apart from `in`; the pitch is a multiple of kRowWords. Wide: sums in 64 bits;
/// results modulo the word.
template <class Word>
void splitBox(const Box<const Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu = bestCpu());

/// Undoes splitBox; `in` is used as working memory.
template <class Word>
void joinBox(const Box<Word>& in, const Box<Word>& out, Wavelet wavelet, bool wide, Cpu cpu = bestCpu());

} // namespace tessera::codec
