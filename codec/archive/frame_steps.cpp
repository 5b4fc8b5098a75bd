#include "codec/archive/frame_steps.h"

#include "codec/archive/step_trials.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace tessera::codec {

namespace {

// Factors on the bytes beyond which trials end: with details split along all axes, and with them split along none.
constexpr double kHopeless = 1.6, kHopelessUnsplit = 1.06;
constexpr double kMeanQuantum = 1.2; // as kUsualQuantum, under a bound of the mean error: few samples are beyond it

/// Width in bits of the differences between the codes of a frame and those of the decoded frame before.
int differenceBits(const volume::Field& now, const volume::Field& before, const NumberCoding& numbers) {
    constexpr std::size_t kRow = 512;
    const std::size_t bytes = volume::byteSize(now.type);
    std::array<std::uint32_t, kRow> codes, from;
    std::uint32_t all = 0;
    for (std::size_t first = 0; first < now.count(); first += kRow) {
        const std::size_t count = std::min(kRow, now.count() - first);
        const auto row = [&](const volume::Field& of) {
            return std::as_bytes(std::span(of.samples)).subspan(first * bytes, count * bytes);
        };
        codesOf(numbers, now.type, row(now), codes.data());
        codesOf(numbers, now.type, row(before), from.data());
        for (std::size_t i = 0; i < count; ++i) {
            const auto apart = now.present(first + i) ? static_cast<std::int32_t>(codes[i] - from[i]) : 0;
            all |= static_cast<std::uint32_t>(apart ^ (apart >> 31));
        }
    }
    return int(std::bit_width(all)) + 1;
}

/// How the time before was coded; nothing is set at the first time and when all is to be tried again.
struct StepsBefore {
    std::optional<StepChoice> steps;                       ///< with these, which are the only ones to be tried
    bool rounded = false;                                  ///< with rounded samples: trials end earlier
    double quantum = 0;                                    ///< in stored units
    double most = std::numeric_limits<double>::infinity(); ///< bytes of another way
    bool parted = false;      ///< whether parts are transformed apart, to be tried, whatever the time before had
    bool bodyCentred = false; ///< transform of BCC to be tried, whatever the time before had
};

/// Tries the best way so far, or `how`, with differences from the time before.
void tryPrediction(StepSearch& search, const SteppedFrame& how, const FrameSamples& samples, const SeenFrame& before,
                   bool allSteps) {
    SteppedFrame differences = std::isfinite(search.least()) ? search.best() : how;
    differences.predicted = true;
    const int bits = differenceBits(*samples.whole(), before.field, differences.numbers) + 1;
    differences.codeBits = std::max(differences.codeBits, bits);
    if (differences.codeBits > kMostBits || !search.attempt(differences) || !allSteps) return;
    search.attemptWith(
        [](StepChoice& steps) { steps.split.axes = steps.split.axes == 0 ? usualSteps().split.axes : 0; });
    search.improveQuantum();
}

/// The same without; at the end as at the beginning nothing may be worth a trial.
void tryOwn(StepSearch& search, const SteppedFrame& how, const StepsBefore& before, double limit) {
    SteppedFrame unsplit = how;
    unsplit.steps.split.axes = 0;
    if (before.rounded) {
        search.attempt(unsplit);
        if (search.least() > kHopelessUnsplit * limit) return;
    }
    search.attempt(how);
    if (before.steps || search.least() > kHopeless * limit) return;
    if (!before.rounded && search.least() > limit) search.attempt(unsplit);
    if (search.least() > kHopelessUnsplit * limit) return;
    search.improveSplit(1);
    search.improveQuantum();
}

/// The best steps found, with the bricks coded in the trials.
SteppedFrame bestOf(StepSearch& search) {
    SteppedFrame best = search.best();
    best.bytes = search.least();
    best.bricks = search.trials().takeBest();
    return best;
}

std::optional<SteppedFrame> trySteps(const volume::BrickGrid& grid, SampleNumbers& of, const FrameRecord& frame,
                                     const Model& model, const FrameOptions& options, const StepsBefore& before,
                                     const SeenFrame* seen, const Taken& taken, const FrameSamples* rounded,
                                     const FrameSamples* parts) {
    const FrameSamples& samples = of.samples();
    const double maxError = std::max(options.maxError - options.spent, 0.0);
    const std::optional<NumberCoding> numbers = steppedCoding(of, maxError);
    if (!numbers) return std::nullopt;
    SteppedFrame how;
    how.numbers = *numbers;
    how.wavelet = options.wavelet.value_or(Wavelet::W44);
    how.bodyCentred = before.bodyCentred;
    how.parted = before.parted;
    how.steps = before.steps.value_or(usualSteps());
    how.maxError = maxError;
    how.codeBits = codeBitsOf(of, how.numbers) + 1;
    if (how.codeBits > kMostBits) return std::nullopt;
    if (seen && seen->mask != frame.mask) seen = nullptr;
    StepSearch search(StepTrials(grid, samples, frame, options, seen, rounded, parts));
    const double ofModel = frame.model < 0 ? double(serialise(model).size()) : 0;
    const double limit =
        std::min(before.most, search.trials().ofSamples(model, taken.serves(frame, model) ? &taken : nullptr).bytes +
                                  ofModel * search.trials().share());
    tryOwn(search, how, before, limit);
    if (seen && search.trials().predicts()) tryPrediction(search, how, samples, *seen, !before.steps);
    if (search.least() >= limit) return std::nullopt;
    return bestOf(search);
}

/// Tries steps for a bound of the mean error. False: none can meet it.
bool tryOwnMean(StepSearch& search, SteppedFrame how, const StepsBefore& before, double limit, double squares) {
    constexpr double kApart = 1.4; // factor between quanta in units of the bound
    constexpr int kRounds = 2;     // of axes: with one, a small gain early can keep it from a large one
    if (before.steps) {
        search.compareAt(squares);
        search.attempt(how);
        return true;
    }
    if (before.rounded) how.steps.split.axes = 0;
    if (!search.findQuantum(how, squares)) return false;
    if (search.least() > (before.rounded ? kHopelessUnsplit : kHopeless) * limit) return true;
    if (before.rounded) search.attemptWith([](StepChoice& steps) { steps.split = usualSteps().split; });
    search.improveSplit(kRounds);
    const auto scale = [&](double fineness) {
        SteppedFrame other = search.best();
        other.mean->fineness = fineness;
        return setQuantum(other.mean->quantum, other) && search.attempt(other);
    };
    const double fineness = how.mean->fineness;
    scale(fineness * kApart) ? scale(fineness * kApart * kApart) : scale(fineness / kApart);
    return true;
}

/// Tries the best way so far with differences from the time before.
void tryMeanPrediction(StepSearch& search, const SeenFrame& before) {
    SteppedFrame differences = search.best();
    const NumberRange own = differences.mean->range, was = rangeOf(before.field);
    differences.predicted = true;
    differences.mean->apart = std::max(own.hi, was.hi) - std::min(own.lo, was.lo);
    if (setQuantum(differences.mean->quantum, differences)) search.attempt(differences);
}

/// Steps for a bound of the mean error.
std::optional<SteppedFrame> tryMeanSteps(const volume::BrickGrid& grid, SampleNumbers& of, const FrameRecord& frame,
                                         const Model& model, const FrameOptions& options, const StepsBefore& before,
                                         const SeenFrame* seen, const Taken& taken, const FrameSamples* rounded,
                                         const FrameSamples* parts) {
    const FrameSamples& samples = of.samples();
    constexpr double kTie = 1e-4;       // a number that far from the middle of two integers rounds to the nearer one
    constexpr double kFirstQuantum = 4; // in units of the mean error
    constexpr double kLeastShare = 1. / 16; // of the allowed squares, below which boxes are background
    SteppedFrame how;
    how.wavelet = options.wavelet.value_or(Wavelet::W44);
    how.bodyCentred = before.bodyCentred;
    how.parted = before.parted;
    how.steps = before.steps.value_or(usualSteps());
    const double quantum = before.steps ? before.quantum : kFirstQuantum * options.rms;
    const RoundingErrors all = rounded ? roundingErrors(samples, *rounded) : roundingErrors(samples, frame.numbers);
    const double mostError = rounded ? reachOfIntegers(options.mostError) - kTie : options.mostError;
    how.mean = {samples.type(),
                of.range(),
                options.rms * options.rms * all.count,
                mostError,
                before.steps ? boundsOf(before.steps->quantum) : kMeanQuantum,
                quantum};
    if (seen && seen->mask != frame.mask) seen = nullptr;
    if (!setQuantum(quantum, how)) return std::nullopt;

    StepSearch search(StepTrials(grid, samples, frame, options, seen, rounded, parts));
    StepTrials& trials = search.trials();
    const double ofModel = frame.model < 0 ? double(serialise(model).size()) : 0;
    const TrialOfSteps ofRounded = trials.ofSamples(model, taken.serves(frame, model) ? &taken : nullptr);
    const double limit = std::min(before.most, ofRounded.bytes + ofModel * trials.share()),
                 mean = how.mean->allowed * trials.share();
    // Errors are not the same everywhere: the boxes get the part of them that they have by rounding samples.
    const double part = all.squares > 0 ? how.mean->allowed / all.squares * ofRounded.squares : 0;
    const double squares = part > kLeastShare * mean ? part : mean;
    if (!tryOwnMean(search, how, before, limit, squares)) return std::nullopt;
    if (seen && trials.predicts()) tryMeanPrediction(search, *seen);
    if (search.least() >= limit) return std::nullopt;
    return bestOf(search);
}

} // namespace

std::optional<SteppedFrame> chooseSteps(const volume::BrickGrid& grid, SampleNumbers& of, const FrameRecord& frame,
                                        const Model& model, const FrameOptions& options, const TimeBefore& before,
                                        const Taken& taken, const FrameSamples* rounded, const FrameSamples* parts) {
    constexpr int kAgain = 16;        // times between those at which all is tried
    constexpr double kFarther = 1.25; // on the bytes of another way, beyond which a way may not yet be given up
    const bool mean = options.rms > 0;
    // Samples may be exact under a bound of their mean error, if rounding them does not pay.
    const bool bounded = rounded || frame.numbers.kind == NumberKind::Quantised;
    const bool exact = frame.numbers.kind == NumberKind::Integer && !rounded;
    if ((!bounded && !mean) || exact || options.numbers) return std::nullopt;
    const KnownModel* const last = before.coding;
    // The transform of BCC that suits rounded samples often is the worse one here.
    const bool both = grid.lattice.kind == volume::LatticeKind::BCC && grid.levels > 1 && !options.bodyCentred;
    const auto attemptOne = [&](const StepsBefore& steps) {
        return mean ? tryMeanSteps(grid, of, frame, model, options, steps, before.seen, taken, rounded, parts)
                    : trySteps(grid, of, frame, model, options, steps, before.seen, taken, rounded, parts);
    };
    const auto attempt = [&](StepsBefore steps) {
        std::optional<SteppedFrame> best;
        for (int way = 0; way < 4; ++way) {
            const bool otherTransform = way % 2 == 1, together = way / 2 == 1;
            if ((otherTransform && !both) || (together && (!parts || steps.steps))) continue;
            steps.bodyCentred = otherTransform != frame.bodyCentred;
            if (together && best) steps.most = kFarther * best->bytes;
            steps.parted = parts && (steps.steps ? last->parted : !together);
            std::optional<SteppedFrame> found = attemptOne(steps);
            if (found && (!best || found->bytes < best->bytes)) best = std::move(found);
        }
        return best;
    };
    if (!last || before.number % kAgain == 0) return attempt({});
    if (last->kind != NumberKind::Stepped) return attempt({.steps = {}, .rounded = true});
    const double quantum = last->quantum / std::abs(of.samples().scale());
    if (!mean || quantum > 0)
        if (auto again = attempt({.steps = last->steps, .rounded = false, .quantum = quantum})) return again;
    return attempt({});
}

} // namespace tessera::codec
