#pragma once

#include "codec/archive/brick_input.h"
#include "codec/archive/frame_model.h"
#include "codec/brick/quantum_search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

/// Trials of quantised coefficients on some bricks of a frame.
namespace tessera::codec {

/// What is known of a frame whose mean error is bounded: its quantum is found by coding.
struct MeanBound {
    volume::ScalarType type{};
    NumberRange range;
    double allowed = 0;                        ///< largest sum of squared errors, in stored units
    double mostError = 0;                      ///< bound that is stated for every sample; infinite: none
    double fineness = 0;                       ///< quantum in units of the error bound, if that is not the stated one
    double quantum = 0;                        ///< of coefficients whose waveforms have length 1, in stored units
    double power = QuantumSearch::kUsualPower; ///< with which squared errors grow with it

    double apart = 0; ///< no sample is further from the one it is predicted from, if it is

    double largestQuantum() const;
};

struct SteppedFrame {
    NumberCoding numbers;
    Wavelet wavelet{};
    bool bodyCentred = false;
    bool predicted = false;
    bool parted = false;
    int codeBits = 32;
    StepChoice steps;
    double maxError = 0; ///< samples further away are corrected
    double bytes = 0;    ///< of the bricks tried
    std::optional<MeanBound> mean;
    std::vector<std::pair<std::size_t, PreparedBrick>> bricks; ///< coded in the trials, by brick index
};

/// Steps that suit most fields.
StepChoice usualSteps();

/// Sets the quantum of a frame with a bound of its mean error, and with it the numbers. False: floats or codes are too
/// coarse for it.
bool setQuantum(double quantum, SteppedFrame& steps);

/// Sets the coding of a frame.
void useSteps(const SteppedFrame& steps, FrameRecord& frame);

inline constexpr double kUsualQuantum = 3; ///< in units of the error bound
inline constexpr int kMostBits = 29;       ///< of the codes of a stepped frame

/// A quantum in units of the error bound, as it is stored.
std::uint32_t quantumOf(double bounds);
/// The inverse.
double boundsOf(std::uint32_t quantum);

/// What came of a trial.
struct TrialOfSteps {
    double bytes = 0, squares = 0; ///< squares: of errors, if they are measured
};

/// Boxes of a frame, coded in different ways.
class StepTrials {
public:
    /// `before`: the frame before, or null if nothing is to be predicted from it. `rounded`: of integers, what they
    /// are stored as if coefficients are not quantised. `parts`: numbers of the parts of its samples, or null.
    StepTrials(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameRecord& frame,
               const FrameOptions& options, const SeenFrame* before, const FrameSamples* rounded,
               const FrameSamples* parts);

    /// The part of the frame that is tried.
    double share() const { return share_; }
    /// Whether any brick may be predicted.
    bool predicts() const;
    /// With rounded samples; whole bricks are found in `taken` where it serves.
    TrialOfSteps ofSamples(const Model& model, const Taken* taken);
    /// With rounded coefficients.
    TrialOfSteps of(const SteppedFrame& how);
    /// The latest trial is the best one so far.
    void keepLatest();
    /// The whole bricks as coded in the best of the trials.
    std::vector<std::pair<std::size_t, PreparedBrick>> takeBest();

private:
    struct Box {
        BrickFormat format;
        std::size_t number = 0;
        bool whole = true;        ///< rather than a part of the brick
        BrickInput input, before; ///< before: empty if it is not to be predicted
        BrickInput rounded;       ///< of integers
        SplitMemory memory;
        PreparedBrick latest, best;
        double squares = 0; ///< of the latest trial
    };
    template <class Encode> TrialOfSteps sum(const Encode& encode);
    void measure(Box& box, const BrickFormat& format, double maxError, std::span<const std::uint32_t> codes) const;

    void measureRounded(Box& box) const;

    volume::ScalarType type_;
    double times_ = 0; ///< samples per rounded integer; 0: of floats
    double maxError_, share_ = 0;
    bool measures_;
    int zstdLevel_; ///< of rounded samples; integers often are few, which thorough compression finds
    std::vector<Box> boxes_;
};

/// The best of the steps tried so far.
class StepSearch {
public:
    explicit StepSearch(StepTrials trials) : trials_(std::move(trials)) {}
    StepTrials& trials() { return trials_; }
    const SteppedFrame& best() const { return best_; }
    double least() const { return least_; } ///< bytes of the best
    /// True if the steps are better than all before.
    bool attempt(const SteppedFrame& how) {
        const double bytes = bytesAtMean(trials_.of(how));
        if (bytes >= least_) return false;
        take(how, bytes);
        return true;
    }
    /// Finds the quantum with which the boxes have this sum of squared errors. False: there is none.
    bool findQuantum(SteppedFrame how, double squares);
    /// Trials are compared as if all had this sum.
    void compareAt(double squares) { squares_ = squares; }
    /// Tries the best so far with a change.
    template <class Change> bool attemptWith(const Change& change) {
        SteppedFrame how = best_;
        change(how.steps);
        return attempt(how);
    }

    /// Tries to split along other axes, `rounds` times each unless nothing changes, and shorter or longer lines.
    void improveSplit(int rounds);
    /// Tries a factor on the usual quantum, and its square if that is better, else its inverse.
    void improveQuantum();

private:
    void take(const SteppedFrame& how, double bytes) {
        least_ = bytes;
        best_ = how;
        trials_.keepLatest();
    }
    /// The bytes that a trial would take with the sum of squares at which all are compared.
    double bytesAtMean(const TrialOfSteps& trial) const {
        constexpr double kFurthest = 16;
        if (squares_ == 0 || trial.squares == 0) return trial.bytes; // errors of integers may begin with a jump
        return trial.bytes * std::pow(std::clamp(trial.squares / squares_, 1 / kFurthest, kFurthest), power_);
    }

    StepTrials trials_;
    SteppedFrame best_;
    double least_ = std::numeric_limits<double>::infinity();
    double squares_ = 0;  ///< 0: errors are not compared
    double power_ = 0.25; ///< bytes grow with this power of 1 / squares
};

} // namespace tessera::codec
