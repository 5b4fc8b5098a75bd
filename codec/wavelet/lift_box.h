#pragma once

#include "codec/bytes/cpu.h"
#include "codec/wavelet/lifting.h"

#include <cstddef>
#include <cstdint>

/// The lifting of boxes in which every sample is present: the same numbers as codec/wavelet/lifting.h gives, by rows
/// that compilers vectorise.
namespace tessera::codec {

/// True for the wavelets that this file knows: all but the antisymmetric updates of (1,3) and (1,5).
bool liftsBoxes(Wavelet wavelet);

/// Codes of so many bits keep every sum of every wavelet within words of 16 bits (single pairs) or sums of 32 bits:
/// what three axes of all levels make of them grows less than a hundredfold. (tests/codec/lift_box_test.cpp computes
/// it.)
inline constexpr int kBitsOfInt16 = 8, kBitsOfInt32 = 16;

/// A box of words: rows of `size.x`, x fastest, `pitch` words apart, what lies between them is nobody's.
template <class Word> struct Box {
    Word* values = nullptr;
    glm::ivec3 size{0};
    int pitch = 0;

    Word* row(int y, int z) const { return values + (std::ptrdiff_t(z) * size.y + y) * pitch; }
};

/// Rows of boxes are a multiple of this many words apart, and loops run over whole rows.
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
