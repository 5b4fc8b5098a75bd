#pragma once

#include "codec/archive/frame_options.h"
#include "codec/brick/brick_codec.h"
#include "codec/brick/frame_samples.h"
#include "codec/container/index.h"

#include <optional>

/// Selects by trial whether the coefficients of a frame are quantised rather than its samples, and how.
namespace tessera::codec {

struct SteppedFrame {
    NumberCoding numbers;
    Wavelet wavelet{};
    int codeBits = 32;
    StepChoice steps;
};

/// Steps that suit most fields.
StepChoice usualSteps();

/// Quantised coefficients for a frame that would otherwise be coded as in `frame`, with quantised samples and `model`;
/// none if that would be as short, the frame has no error bound, or the bound serves a mean error (keepsSquares).
/// `before`: the only steps that are tried, as those of an earlier time; null: several.
std::optional<SteppedFrame> chooseSteps(const volume::BrickGrid& grid, const FrameSamples& samples,
                                        const FrameRecord& frame, const Model& model, const FrameOptions& options,
                                        const StepChoice* before);

/// Sets the coding of a frame.
void useSteps(const SteppedFrame& steps, FrameRecord& frame);

} // namespace tessera::codec
