#include "codec/archive/frame_steps.h"

#include "codec/archive/brick_access.h"
#include "codec/brick/predicted_brick.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace tessera::codec {

namespace {

constexpr std::size_t kMostBoxes = 2, kWholeBrick = 1 << 17; // samples of the largest brick tried as a whole
constexpr int kBoxOfBrick = 64;                              // edge of the box tried of a larger brick
constexpr int kMostBits = 29;                                // of codes
constexpr double kUsualQuantum = 3;                          // in units of the error bound
// Factors on the bytes beyond which trials end: with details split along all axes, and with them split along none.
constexpr double kHopeless = 1.6, kHopelessUnsplit = 1.06;

std::uint32_t quantumOf(double bounds) {
    constexpr double kSixteenths = 16;
    return static_cast<std::uint32_t>(std::lround(bounds * kSixteenths * (kReach + 0.5)));
}

/// Width in bits of the differences between the codes of a frame and those of the decoded frame before.
int differenceBits(const volume::Field& now, const volume::Field& before, const NumberCoding& numbers) {
    constexpr std::size_t kRow = 512;
    std::array<std::uint32_t, kRow> codes, from;
    std::uint32_t all = 0;
    for (std::size_t first = 0; first < now.count(); first += kRow) {
        const std::size_t count = std::min(kRow, now.count() - first);
        codesOf(numbers, std::as_bytes(now.as<float>().subspan(first, count)), codes.data());
        codesOf(numbers, std::as_bytes(before.as<float>().subspan(first, count)), from.data());
        for (std::size_t i = 0; i < count; ++i) {
            const auto apart = now.present(first + i) ? static_cast<std::int32_t>(codes[i] - from[i]) : 0;
            all |= static_cast<std::uint32_t>(apart ^ (apart >> 31));
        }
    }
    return int(std::bit_width(all)) + 1;
}

/// Boxes of a frame, coded in different ways.
class StepTrials {
public:
    StepTrials(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameRecord& frame,
               const FrameOptions& options, const SeenFrame* before)
        : type_(samples.type()), maxError_(boundOf(frame, options)) {
        const std::size_t bricks = grid.brickCount(), count = std::min(bricks, kMostBoxes);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t number = (2 * i + 1) * bricks / (2 * count);
            const glm::ivec3 brick = grid.indexOf(number);
            Box box;
            box.format = brickFormat(grid, brick, type_, frame);
            box.number = number;
            glm::ivec3 begin(0);
            if (countOf(box.format.size) > kWholeBrick) {
                const int step = box.format.sublattices();
                const glm::ivec3 most(kBoxOfBrick, kBoxOfBrick, kBoxOfBrick * step),
                    size = glm::min(box.format.size, most);
                begin = (box.format.size - size) / 2;
                begin.z -= begin.z % step; // start on an even slice
                box.whole = size == box.format.size;
                box.format.size = size;
            }
            box.input.take(grid, grid.begin(brick) + begin, box.format.size, samples, frame.mask >= 0);
            if (before && before->depth[number] < options.mostPredicted)
                box.before.take(grid, grid.begin(brick) + begin, box.format.size, before->field, false);
            share_ += double(countOf(box.format.size));
            boxes_.push_back(std::move(box));
        }
        share_ /= double(samples.count());
    }

    /// Whether any brick may be predicted.
    bool predicts() const {
        return std::ranges::any_of(boxes_, [](const Box& box) { return !box.before.samples.empty(); });
    }
    /// The part of the frame that is tried.
    double share() const { return share_; }

    /// Bytes with rounded samples; whole bricks are found in `taken` where it serves.
    double bytesOfSamples(const Model& model, const Taken* taken) {
        const BandEncoder encoder(model);
        return sum([&](Box& box) {
            Compressor compressor(3);
            const BrickInput& input = box.input;
            if (taken && box.whole && taken->bricks[box.number])
                return encodeBrick(box.format, *taken->bricks[box.number], input.samples, input.present, compressor,
                                   encoder);
            return encodeBrick(box.format, input.samples, input.present, maxError_, compressor, encoder);
        });
    }

    /// Bytes with rounded coefficients. Whole bricks are kept if that is less than `least`.
    double bytesOf(const SteppedFrame& how, double least) {
        static const BandEncoder idle(makeModel(Histogram(1, {}), 1)); // codes nothing
        const double bytes = sum([&](Box& box) {
            Compressor compressor(3);
            BrickFormat format = box.format;
            format.numbers = how.numbers;
            format.wavelet = how.wavelet;
            format.codeBits = how.codeBits;
            format.steps = how.steps;
            std::vector<std::uint32_t> from;
            if (how.predicted) from = predictionFrom(how.numbers, box.before.samples);
            box.latest = prepareBrick(format, box.input.samples, box.input.present, maxError_, {}, box.memory, from);
            return encodeBrick(format, box.latest, box.input.samples, box.input.present, compressor, idle);
        });
        if (bytes < least)
            for (Box& box : boxes_) std::swap(box.best, box.latest);
        return bytes;
    }

    /// The whole bricks as coded in the best of the trials.
    std::vector<std::pair<std::size_t, PreparedBrick>> takeBest() {
        std::vector<std::pair<std::size_t, PreparedBrick>> bricks;
        for (Box& box : boxes_)
            if (box.whole) bricks.emplace_back(box.number, std::move(box.best));
        return bricks;
    }

private:
    struct Box {
        BrickFormat format;
        std::size_t number = 0;
        bool whole = true;        ///< rather than a part of the brick
        BrickInput input, before; ///< before: empty if it is not to be predicted
        SplitMemory memory;
        PreparedBrick latest, best;
    };
    template <class Encode> double sum(const Encode& encode) {
        std::atomic<std::uint64_t> bytes = 0;
        parallelFor(boxes_.size(), [&](std::size_t i) {
            for (const Bytes& segment : encode(boxes_[i])) bytes += segment.size();
        });
        return double(bytes.load());
    }

    volume::ScalarType type_;
    double maxError_, share_ = 0;
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
        const double bytes = trials_.bytesOf(how, least_);
        if (bytes >= least_) return false;
        least_ = bytes;
        best_ = how;
        return true;
    }
    /// Tries the best so far with a change.
    template <class Change> bool attemptWith(const Change& change) {
        SteppedFrame how = best_;
        change(how.steps);
        return attempt(how);
    }
    /// Tries a factor on the usual quantum, and its square if it is better, else its inverse.
    void attemptQuanta() {
        constexpr double kApart = 1.4;
        const auto scale = [&](double bounds) {
            return attemptWith([&](StepChoice& steps) { steps.quantum = quantumOf(bounds); });
        };
        scale(kUsualQuantum * kApart) ? scale(kUsualQuantum * kApart * kApart) : scale(kUsualQuantum / kApart);
    }

private:
    StepTrials trials_;
    SteppedFrame best_;
    double least_ = std::numeric_limits<double>::infinity();
};

/// How the time before was coded; nothing is set at the first time and when all is to be tried again.
struct StepsBefore {
    std::optional<StepChoice> steps; ///< with these, which are the only ones to be tried
    bool rounded = false;            ///< with rounded samples: trials end earlier
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
    search.attemptQuanta();
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
    for (int axis = 0; axis < 3; ++axis) search.attemptWith([&](StepChoice& steps) { steps.split.axes ^= 1 << axis; });
    for (const int length : {2, 10}) {
        if (search.best().steps.split.axes == 0) break; // nothing is split
        if (search.attemptWith([&](StepChoice& steps) { steps.split.least = length; })) break;
    }
    search.attemptQuanta();
}

std::optional<SteppedFrame> trySteps(const volume::BrickGrid& grid, const FrameSamples& samples,
                                     const FrameRecord& frame, const Model& model, const FrameOptions& options,
                                     const StepsBefore& before, const SeenFrame* seen, const Taken& taken) {
    const std::optional<NumberCoding> numbers = steppedCoding(samples, boundOf(frame, options));
    if (!numbers) return std::nullopt;
    SteppedFrame how{*numbers, options.wavelet.value_or(Wavelet::W44), false,
                     0,        before.steps.value_or(usualSteps()),    {}};
    how.codeBits = codeBitsOf(samples, how.numbers) + 1;
    if (how.codeBits > kMostBits) return std::nullopt;
    if (seen && seen->mask != frame.mask) seen = nullptr;
    StepSearch search(StepTrials(grid, samples, frame, options, seen));
    const double ofModel = frame.model < 0 ? double(serialise(model).size()) : 0;
    const double limit = search.trials().bytesOfSamples(model, taken.serves(frame, model) ? &taken : nullptr) +
                         ofModel * search.trials().share();
    tryOwn(search, how, before, limit);
    if (seen && search.trials().predicts()) tryPrediction(search, how, samples, *seen, !before.steps);
    if (search.least() >= limit) return std::nullopt;
    SteppedFrame best = search.best();
    best.bricks = search.trials().takeBest();
    return best;
}

} // namespace

StepChoice usualSteps() {
    return {{7, 4}, quantumOf(kUsualQuantum)};
}

std::optional<SteppedFrame> chooseSteps(const volume::BrickGrid& grid, const FrameSamples& samples,
                                        const FrameRecord& frame, const Model& model, const FrameOptions& options,
                                        const TimeBefore& before, const Taken& taken) {
    constexpr int kAgain = 16; // times between those at which all is tried
    if (frame.numbers.kind != NumberKind::Quantised || options.numbers || options.keepsSquares) return std::nullopt;
    const auto attempt = [&](const StepsBefore& steps) {
        return trySteps(grid, samples, frame, model, options, steps, before.seen, taken);
    };
    if (!before.coding || before.number % kAgain == 0) return attempt({});
    if (before.coding->kind != NumberKind::Stepped) return attempt({.steps = {}, .rounded = true});
    if (auto again = attempt({.steps = before.coding->steps, .rounded = false})) return again;
    return attempt({});
}

void useSteps(const SteppedFrame& steps, FrameRecord& frame) {
    frame.numbers = steps.numbers;
    frame.wavelet = steps.wavelet;
    frame.predicted = steps.predicted;
    frame.codeBits = steps.codeBits;
    frame.steps = steps.steps;
}

} // namespace tessera::codec
