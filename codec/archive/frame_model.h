#pragma once

#include "codec/archive/archive_state.h"
#include "codec/archive/archive_writer.h"
#include "codec/brick/brick_codec.h"

#include <optional>
#include <vector>

/// How a frame is to be coded, found by trial on some of its bricks: filter, sublattices, tables.
namespace tessera::codec {

/// Bricks of a frame that were taken apart for its model, to be coded without doing that again.
struct Taken {
    Wavelet wavelet{};
    bool bodyCentred = false;
    Contexts contexts;
    double maxError = 0;
    std::vector<std::optional<PreparedBrick>> bricks; ///< by number

    bool serves(const FrameRecord& frame, const Model& model) const {
        return wavelet == frame.wavelet && bodyCentred == frame.bodyCentred && contexts == model.contexts;
    }
};

/// Bits of |code| over the present samples of a frame of floats.
int codeBitsOf(const FrameSamples& samples, const NumberCoding& numbers);

/// How the numbers of a frame are coded; `last` is the model of the frame before, or none. Where decimals or fractions
/// have as many digits as floats have bits they are no disguise, and what is shorter by trial is taken.
NumberCoding chooseNumbers(const volume::BrickGrid& grid, const FrameSamples& samples, const KnownModel* last,
                           const FrameOptions& options);

/// Effort of zstd for the bricks of a frame: small frames take no time worth saving.
int effortFor(const FrameSamples& samples, int zstdLevel);

/// What is left of the bound for samples of a frame, beside their codes and beside those of a brick they repeat.
double boundOf(const FrameRecord& frame, const FrameOptions& options);

/// The model of a frame: `last`, that of the component's frame before (or none), where its tables serve as well as new
/// ones would, else a new one, not written yet (frame.model is -1). The filter is tried again only where the tables do
/// not fit at all. Sets wavelet, bodyCentred and model of the frame. `byBand`: the archive knows such contexts.
Model chooseModel(const volume::BrickGrid& grid, const FrameSamples& samples, const KnownModel* last, bool byBand,
                  FrameRecord& frame, const FrameOptions& options, Taken& taken);

} // namespace tessera::codec
