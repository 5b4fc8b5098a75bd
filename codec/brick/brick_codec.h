#pragma once

#include "codec/bands/band_coder.h"
#include "codec/brick/decoded_brick.h"
#include "codec/brick/stepped_brick.h"
#include "codec/bytes/entropy.h"

#include <span>
#include <vector>

/// Coding of one brick of one component, level by level. (FORMAT.md "Bricks".)
namespace tessera::codec {

/// The tokens of a brick: the part of coding that does not depend on a model.
struct PreparedBrick {
    std::vector<Bytes> stepped;         ///< numbers of kind Stepped: the coded segments, without what is exact
    std::vector<std::uint32_t> decoded; ///< the same: the codes that they decode to
    std::vector<TokenRun> levels;       ///< the last is the coarsest
    std::vector<std::uint32_t> exactIndex, exactBits, absentBits; ///< stored in addition
};

/// Working memory of the transform, reused between bricks.
struct SplitMemory {
    std::vector<LevelBox<std::int16_t>> boxes16;
    std::vector<LevelBox<std::int32_t>> boxes32;
    FittedMemory<std::int16_t> fitted16;
    FittedMemory<std::int32_t> fitted32;
};

/// Transforms a brick. `samples` are numbers of format.type, x fastest; `present` has one flag per sample, or is empty:
/// all present. Quantised numbers with an error above `maxError` are stored exactly in addition. `prediction`: codes
/// that those of a stepped brick are coded as differences from (codec/brick/predicted_brick.h), or empty. `fitted`: the
/// weights of the model, or null for none. `parts`: of a stepped brick, as of encodeStepped.
PreparedBrick prepareBrick(const BrickFormat& format, std::span<const std::byte> samples,
                           std::span<const std::uint8_t> present, double maxError, Contexts contexts,
                           SplitMemory& memory, std::span<const std::uint32_t> prediction = {},
                           const FittedWeights* fitted = nullptr, std::span<const std::uint8_t> parts = {});
/// Adds samples of a brick that can be fitted to a fit of its weights: every `every`-th row.
void addToFit(const BrickFormat& format, std::span<const std::byte> samples, int shift, int every, SplitMemory& memory,
              WeightFit& fit);
/// Adds the tokens of a brick to a histogram; long runs are subsampled (countTokens).
void countBrick(const PreparedBrick& brick, Histogram& histogram, int every = 1);

/// Codes a brick: segment 0 has the coarsest level, segment i the details of level `levels - 1 - i`. `brick` must be
/// prepared from the same samples with the contexts of the model. Deterministic.
std::vector<Bytes> encodeBrick(const BrickFormat& format, const PreparedBrick& brick,
                               std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                               Compressor& compressor, const BandEncoder& bands);

/// prepareBrick and encodeBrick in one call.
std::vector<Bytes> encodeBrick(const BrickFormat& format, std::span<const std::byte> samples,
                               std::span<const std::uint8_t> present, double maxError, Compressor& compressor,
                               const BandEncoder& bands);

/// Decodes `level` from the segments up to it (levels - level segments, coarsest first). Never throws because of the
/// contents of the bytes and never reads beyond them. `parts`: with which a stepped brick was coded.
DecodeStatus decodeBrick(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                         std::span<const std::uint8_t> present, const BandDecoder& bands, DecodedBrick& out,
                         std::span<const std::uint8_t> parts = {});

} // namespace tessera::codec
