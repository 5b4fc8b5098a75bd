#pragma once

#include "codec/archive/frame_model.h"
#include "codec/brick/quantum_search.h"

#include <optional>
#include <utility>
#include <vector>

/// Selects by trial whether the coefficients of a frame are quantised rather than its samples, and how.
namespace tessera::codec {

/// What is known of a frame whose mean error is bounded: its quantum is found by coding.
struct MeanBound {
    FloatRange range;
    double allowed = 0;                        ///< largest sum of squared errors, in stored units
    double mostError = 0;                      ///< bound that is stated for every sample; infinite: none
    double fineness = 0;                       ///< quantum in units of the error bound, if that is not the stated one
    double quantum = 0;                        ///< of coefficients whose waveforms have length 1, in stored units
    double power = QuantumSearch::kUsualPower; ///< with which squared errors grow with it

    double largestQuantum() const;
};

struct SteppedFrame {
    NumberCoding numbers;
    Wavelet wavelet{};
    bool predicted = false;
    int codeBits = 32;
    StepChoice steps;
    double maxError = 0; ///< samples further away are corrected
    std::optional<MeanBound> mean;
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
/// none if that would be as short, or the frame has no error bound. For a mean error (options.rms) the quantum is one
/// with which the boxes tried have the same error as with rounded samples; the frame as a whole may need another one.
/// At every sixteenth time all steps are tried, at others first those of the time before. With a bound of the largest
/// error, what is best then is also tried with differences from the time before. `taken`: bricks transformed for the
/// model.
std::optional<SteppedFrame> chooseSteps(const volume::BrickGrid& grid, const FrameSamples& samples,
                                        const FrameRecord& frame, const Model& model, const FrameOptions& options,
                                        const TimeBefore& before, const Taken& taken);

/// Sets the quantum of a frame with a bound of its mean error, and with it the numbers. False: floats or codes are too
/// coarse for it.
bool setQuantum(double quantum, SteppedFrame& steps);

/// Sets the coding of a frame.
void useSteps(const SteppedFrame& steps, FrameRecord& frame);

} // namespace tessera::codec
