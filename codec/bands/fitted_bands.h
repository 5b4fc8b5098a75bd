#pragma once

#include "codec/bands/band_coder.h"
#include "codec/fitted/predict_row.h"
#include "codec/fitted/weight_fit.h"
#include "codec/wavelet/lift_box.h"

#include <array>
#include <span>
#include <vector>

/// Coding of the samples of a level as differences from predictions out of the next coarser level.
namespace tessera::codec {

/// Working memory, reused between levels and bricks.
template <class Word> struct FittedMemory {
    PaddedBox<Word> even, odd;                        ///< columns of a level
    PaddedBox<Word> sublattice, other;                ///< the sublattices of BCC at full resolution
    std::array<PaddedBox<Word>, kPasses> differences; ///< of the passes; in writing only
};

/// The samples of a level: every 2^level-th of `samples` along each axis. At level 0 of BCC, `other` has the odd
/// sublattice, else nothing.
template <class Word> struct FittedLevel {
    int level = 0;
    Box<const Word> samples, other;
};

template <class Word>
TokenRun fittedTokens(const FittedLevel<Word>& of, Contexts contexts, const FittedWeights& weights, CodeRange range,
                      FittedMemory<Word>& memory);

/// Adds every `every`-th row of each pass to a fit.
template <class Word>
void addToFit(const FittedLevel<Word>& of, int shift, int every, FittedMemory<Word>& memory, WeightFit& fit);

/// Decodes the samples of a level, and of the odd sublattice unless `other` is empty, from those of the next coarser
/// level. `in` must end with them; `nothing`: all differences are 0, and there is no stream.
template <class Word>
DecodeStatus decodeFitted(std::span<const std::byte> in, bool nothing, int level, const Box<const Word>& coarse,
                          const Box<Word>& samples, const Box<Word>& other, const BandDecoder& decoder, CodeRange range,
                          FittedMemory<Word>& memory);

} // namespace tessera::codec
