#pragma once

#include "codec/archive/archive_state.h"
#include "codec/archive/frame_options.h"
#include "codec/brick/brick_codec.h"
#include "codec/brick/sample_numbers.h"

#include <optional>
#include <vector>

/// Selects the coding of a frame by trial on some of its bricks: filter, sublattice prediction, entropy tables.
namespace tessera::codec {

/// Bricks that were transformed for the model selection, kept to avoid a second transform.
struct Taken {
    Wavelet wavelet{};
    bool bodyCentred = false;
    Contexts contexts;
    double maxError = 0;
    std::vector<std::optional<PreparedBrick>> bricks; ///< by brick index
    FittedWeights fitted{};

    bool serves(const FrameRecord& frame, const Model& model) const {
        return wavelet == frame.wavelet && bodyCentred == frame.bodyCentred && contexts == model.contexts &&
               fitted == model.fitted;
    }
};

/// Width of |code| over the present samples of a frame, in bits.
int codeBitsOf(SampleNumbers& of, const NumberCoding& numbers);

/// Selects the number coding of a frame of samples `of`; `last` is the model of the previous frame, or none. If
/// decimals or binary fractions would need as many digits as floats have bits, the shorter coding is selected by trial.
NumberCoding chooseNumbers(const volume::BrickGrid& grid, SampleNumbers& of, const KnownModel* last,
                           const FrameOptions& options);

/// The zstd level for the bricks of a frame: higher for small frames, where it costs little time; else low with little
/// effort.
int zstdLevelFor(const FrameSamples& samples, int zstdLevel, int effort);

/// The part of the error bound that remains for rounding samples to codes and for repeating bricks.
double boundOf(const FrameRecord& frame, const FrameOptions& options);

/// Selects the model of a frame: `last`, that of the component's previous frame (or none), if its tables are as good as
/// new ones; otherwise a new one that is not written yet (frame.model is -1). The filter is selected again only if the
/// tables do not fit at all. Sets wavelet, bodyCentred and model of the frame. `byBand`: the archive supports contexts
/// by band.
Model chooseModel(const volume::BrickGrid& grid, const FrameSamples& samples, const KnownModel* last, bool byBand,
                  FrameRecord& frame, const FrameOptions& options, Taken& taken);

/// Estimated bytes of a coded frame, from the tokens of at most `bricks` of its bricks.
double estimateFrameBytes(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameOptions& options,
                          std::size_t bricks);

} // namespace tessera::codec
