#pragma once

#include "codec/bands/band.h"
#include "codec/bands/rans_model.h"
#include "codec/bytes/cpu.h"

#include <span>

namespace tessera::codec {

/// Tokens of the rows of all bands, alternating between the bands. Every choice of `cpu` gives the same.
template <class Word>
TokenRun tokensOf(std::span<const Band<const Word>> bands, Contexts contexts, Cpu cpu = bestCpu());

/// Adds the tokens to a histogram of the same contexts at `level`. In long runs only every `every`-th chunk is counted,
/// with that weight.
void countTokens(const TokenRun& run, int level, Histogram& histogram, int every = 1);

} // namespace tessera::codec
