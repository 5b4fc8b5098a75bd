#pragma once

#include "codec/bands/band.h"
#include "codec/bands/rans_model.h"
#include "volume/base/cpu.h"

#include <span>

namespace tessera::codec {

/// Tokens of the rows of all bands in coding order. `predictor`: of predicted bands, or null. The result does not
/// depend on `cpu`.
template <class Word>
TokenRun tokensOf(std::span<const Band<const Word>> bands, Contexts contexts, Cpu cpu = bestCpu(),
                  RowPredictor<Word>* predictor = nullptr);

/// Adds the tokens to a histogram with the same contexts at `level`. Long runs are subsampled: only every `every`-th
/// chunk counts, with that weight.
void countTokens(const TokenRun& run, int level, Histogram& histogram, int every = 1);

} // namespace tessera::codec
