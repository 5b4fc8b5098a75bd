#pragma once

#include "codec/archive/frame_model.h"

#include <optional>
#include <utility>
#include <vector>

/// Selects by trial whether the coefficients of a frame are quantised rather than its samples, and how.
namespace tessera::codec {

struct SteppedFrame {
    NumberCoding numbers;
    Wavelet wavelet{};
    bool predicted = false;
    int codeBits = 32;
    StepChoice steps;
    std::vector<std::pair<std::size_t, PreparedBrick>> bricks; ///< coded in the trials, by brick index
};

/// Steps that suit most fields.
StepChoice usualSteps();

/// What is known of the component at the time before.
struct TimeBefore {
    const KnownModel* coding = nullptr; ///< null: there is none
    const SeenFrame* seen = nullptr;    ///< null: not in memory
    int number = 0;                     ///< of its frames before
};

/// Quantised coefficients for a frame that would otherwise be coded as in `frame`, with quantised samples and `model`;
/// none if that would be as short, the frame has no error bound, or the bound serves a mean error (keepsSquares).
/// At every sixteenth time all steps are tried, at others first those of the time before. What is best then is also
/// tried with differences from the time before. `taken`: bricks transformed for the model.
std::optional<SteppedFrame> chooseSteps(const volume::BrickGrid& grid, const FrameSamples& samples,
                                        const FrameRecord& frame, const Model& model, const FrameOptions& options,
                                        const TimeBefore& before, const Taken& taken);

/// Sets the coding of a frame.
void useSteps(const SteppedFrame& steps, FrameRecord& frame);

} // namespace tessera::codec
