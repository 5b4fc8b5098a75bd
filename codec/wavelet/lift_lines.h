#pragma once

#include "codec/wavelet/lifting.h"
#include "volume/base/cpu.h"

#include <cstddef>

/// Lifting along x of lines that fit into a few 64-byte registers; results are identical to codec/wavelet/lift_box.cpp.
namespace tessera::codec {

/// The lines of one slice of a box; all rows are `pitch` words apart.
template <class Word> struct SliceLines {
    const Word* from;
    Word* to;
    int rows;
    std::size_t pitch; ///< in words, all of which may be written; a multiple of 32
};

/// A wavelet for lines of one width.
template <class Word> class LineLifter {
public:
    static constexpr int kWords = 32; ///< half of the widest line

    /// Has no effect if a line or its sums do not fit, or the processor lacks the instructions.
    LineLifter(Wavelet wavelet, int width, bool wide, Cpu cpu);
    bool lifts() const { return split_ != nullptr; }
    /// Forward transform: even samples first, then details; even rows first, too.
    void split(const SliceLines<Word>& lines) const { split_(*this, lines); }
    /// Inverse transform.
    void join(const SliceLines<Word>& lines) const { join_(*this, lines); }

    /// For each word that a step changes, the positions of its inputs: [pair][left, right][word].
    struct Taps {
        alignas(64) Word at[3][2][kWords]{};
    };
    Taps predict, update;
    int width = 0, evens = 0, odds = 0;

private:
    using Loop = void (*)(const LineLifter&, const SliceLines<Word>&);
    template <Wavelet kWavelet> void use();
    Loop split_ = nullptr, join_ = nullptr;
};

} // namespace tessera::codec
