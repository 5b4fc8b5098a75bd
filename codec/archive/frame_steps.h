#pragma once

#include "codec/archive/step_trials.h"

#include <optional>

/// Selects by trial whether the coefficients of a frame are quantised rather than its samples, and how.
namespace tessera::codec {

/// What is known of the component at the time before.
struct TimeBefore {
    const KnownModel* coding = nullptr; ///< null: there is none
    const SeenFrame* seen = nullptr;    ///< null: not in memory
    int number = 0;                     ///< of its frames before
};

/// Quantised coefficients for a frame that would otherwise be coded as in `frame`, with quantised samples and `model`;
/// none if that would be as short, or the frame has no error bound. For a mean error (options.rms) the quantum is one
/// with which the boxes tried have the same error as with rounded samples; the frame as a whole may need another one.
/// At every sixteenth time all steps are tried, at others first those of the time before. What is best then is also
/// tried with differences from the time before. `taken`: bricks transformed for the model.
/// `rounded`: of integers, what would be stored otherwise, which `frame` and `model` are for; null: integers are exact.
/// `parts`: numbers of the parts of the samples, which are transformed apart if that is shorter; null: there are none.
std::optional<SteppedFrame> chooseSteps(const volume::BrickGrid& grid, SampleNumbers& of, const FrameRecord& frame,
                                        const Model& model, const FrameOptions& options, const TimeBefore& before,
                                        const Taken& taken, const FrameSamples* rounded, const FrameSamples* parts);

} // namespace tessera::codec
