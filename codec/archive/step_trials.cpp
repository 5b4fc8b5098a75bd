#include "codec/archive/step_trials.h"

#include "codec/archive/brick_access.h"
#include "codec/brick/predicted_brick.h"
#include "codec/brick/quantum_search.h"
#include "volume/base/parallel.h"

#include <cstring>
#include <glm/common.hpp>

namespace tessera::codec {

namespace {

constexpr std::size_t kMostBoxes = 2, kWholeBrick = 1 << 17; // samples of the largest brick tried as a whole
constexpr int kUsualZstdLevel = 3;
constexpr int kBoxOfBrick = 64;                      // edge of the box tried of a larger brick
constexpr double kQuantumUnit = 16 * (kReach + 0.5); // of an error bound in the unit of quanta

/// Bricks to be tried, spread over the frame. For a mean error, of which they stand for the rest of the frame, there
/// are more of them if bricks are small, and none of the thin ones at the end of the volume unless all are tried.
std::vector<std::size_t> bricksToTry(const volume::BrickGrid& grid, bool mean) {
    const auto samplesOf = [&](std::size_t brick) {
        const glm::ivec3 at = grid.indexOf(brick), size = grid.end(at) - grid.begin(at);
        return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    };
    std::vector<std::size_t> from;
    const std::size_t all = grid.brickCount(), usual = samplesOf(0); // the first one is a whole one
    const std::size_t most = mean ? std::max(kMostBoxes, 2 * kWholeBrick / usual) : kMostBoxes;
    const std::size_t least = mean && all > most ? usual / 2 : 0;
    for (std::size_t brick = 0; brick < all; ++brick)
        if (samplesOf(brick) >= least) from.push_back(brick);
    const std::size_t count = std::min(from.size(), most);
    std::vector<std::size_t> bricks;
    for (std::size_t i = 0; i < count; ++i) bricks.push_back(from[(2 * i + 1) * from.size() / (2 * count)]);
    return bricks;
}

} // namespace

std::uint32_t quantumOf(double bounds) {
    return static_cast<std::uint32_t>(std::lround(bounds * kQuantumUnit));
}
double boundsOf(std::uint32_t quantum) {
    return quantum / kQuantumUnit;
}

StepChoice usualSteps() {
    return {{7, 4}, quantumOf(kUsualQuantum)};
}

double MeanBound::largestQuantum() const {
    constexpr double kMost = kUsualQuantum; // a coarser one only makes more corrections
    return kMost * mostError;
}

bool setQuantum(double quantum, SteppedFrame& steps) {
    MeanBound& mean = *steps.mean;
    mean.quantum = std::min(quantum, mean.largestQuantum());
    steps.maxError = std::min(mean.quantum / mean.fineness, mean.mostError);
    const std::optional<NumberCoding> numbers = steppedCoding(mean.type, mean.range, steps.maxError);
    if (!numbers) return false;
    steps.numbers = *numbers;
    steps.codeBits = codeBitsOf(mean.range, *numbers) + 1;
    if (steps.predicted)
        steps.codeBits = std::max(steps.codeBits, int(std::ceil(std::log2(mean.apart / numbers->step + 2))) + 2);
    steps.steps.quantum = quantumOf(mean.quantum / steps.maxError);
    return steps.codeBits <= kMostBits;
}

void useSteps(const SteppedFrame& steps, FrameRecord& frame) {
    frame.numbers = steps.numbers;
    frame.wavelet = steps.wavelet;
    frame.bodyCentred = steps.bodyCentred;
    frame.parted = steps.parted;
    frame.predicted = steps.predicted;
    frame.codeBits = steps.codeBits;
    frame.steps = steps.steps;
}

StepTrials::StepTrials(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameRecord& frame,
                       const FrameOptions& options, const SeenFrame* before, const FrameSamples* rounded,
                       const FrameSamples* parts)
    : type_(samples.type()), times_(rounded ? rounded->scale() / samples.scale() : 0),
      maxError_(boundOf(frame, options)), measures_(options.rms > 0),
      zstdLevel_(measures_ || rounded ? zstdLevelFor(samples, options.zstdLevel, options.effort) : kUsualZstdLevel) {
    for (const std::size_t number : bricksToTry(grid, measures_)) {
        const glm::ivec3 brick = grid.indexOf(number);
        Box box;
        box.format = brickFormat(grid, brick, type_, frame);
        box.number = number;
        glm::ivec3 begin(0);
        if (countOf(box.format.size) > kWholeBrick) {
            const int step = box.format.sublattices();
            const glm::ivec3 most(kBoxOfBrick, kBoxOfBrick, kBoxOfBrick * step), size = glm::min(box.format.size, most);
            begin = (box.format.size - size) / 2;
            begin.z -= begin.z % step; // start on an even slice
            box.whole = size == box.format.size;
            box.format.size = size;
        }
        box.input.take(grid, grid.begin(brick) + begin, box.format.size, samples, frame.mask >= 0);
        if (parts) box.input.takeParts(grid, grid.begin(brick) + begin, box.format.size, *parts);
        if (rounded) box.rounded.take(grid, grid.begin(brick) + begin, box.format.size, *rounded, frame.mask >= 0);
        if (before && before->depth[number] < options.mostPredicted)
            box.before.take(grid, grid.begin(brick) + begin, box.format.size, before->field, false);
        share_ += double(countOf(box.format.size));
        boxes_.push_back(std::move(box));
    }
    share_ /= double(samples.count());
}

bool StepTrials::predicts() const {
    return std::ranges::any_of(boxes_, [](const Box& box) { return !box.before.samples.empty(); });
}

template <class Encode> TrialOfSteps StepTrials::sum(const Encode& encode) {
    std::atomic<std::uint64_t> bytes = 0;
    parallelFor(boxes_.size(), [&](std::size_t i) {
        for (const Bytes& segment : encode(boxes_[i])) bytes += segment.size();
    });
    TrialOfSteps trial{double(bytes.load()), 0};
    for (const Box& box : boxes_) trial.squares += box.squares;
    return trial;
}

TrialOfSteps StepTrials::ofSamples(const Model& model, const Taken* taken) {
    const BandEncoder encoder(model);
    return sum([&](Box& box) {
        Compressor compressor(zstdLevel_, zstdLevel_ != kUsualZstdLevel);
        if (measures_) times_ > 0 ? measureRounded(box) : measure(box, box.format, maxError_, {});
        const BrickInput& input = times_ > 0 ? box.rounded : box.input;
        if (taken && box.whole && taken->bricks[box.number])
            return encodeBrick(box.format, *taken->bricks[box.number], input.samples, input.present, compressor,
                               encoder);
        return encodeBrick(box.format, input.samples, input.present, maxError_, compressor, encoder);
    });
}

TrialOfSteps StepTrials::of(const SteppedFrame& how) {
    static const BandEncoder idle(makeModel(Histogram(1, {}), 1)); // codes nothing
    return sum([&](Box& box) {
        Compressor compressor(kUsualZstdLevel);
        BrickFormat format = box.format;
        format.numbers = how.numbers;
        format.wavelet = how.wavelet;
        format.bodyCentred = how.bodyCentred;
        format.codeBits = how.codeBits;
        format.steps = how.steps;
        std::vector<std::uint32_t> from;
        if (how.predicted) from = predictionFrom(how.numbers, type_, box.before.samples);
        box.latest = prepareBrick(format, box.input.samples, box.input.present, how.maxError, {}, box.memory, from,
                                  nullptr, how.parted ? box.input.parts : std::vector<std::uint8_t>());
        if (measures_) measure(box, format, how.maxError, box.latest.decoded);
        return encodeBrick(format, box.latest, box.input.samples, box.input.present, compressor, idle);
    });
}

void StepTrials::keepLatest() {
    for (Box& box : boxes_) std::swap(box.best, box.latest);
}

std::vector<std::pair<std::size_t, PreparedBrick>> StepTrials::takeBest() {
    std::vector<std::pair<std::size_t, PreparedBrick>> bricks;
    for (Box& box : boxes_)
        if (box.whole) bricks.emplace_back(box.number, std::move(box.best));
    return bricks;
}

void StepTrials::measure(Box& box, const BrickFormat& format, double maxError,
                         std::span<const std::uint32_t> codes) const {
    BrickInput decoded = box.input;
    roundAsDecoded(format, maxError, codes, decoded);
    box.squares = errorsOf(type_, decoded, box.input).squares;
}

void StepTrials::measureRounded(Box& box) const {
    box.squares = 0;
    volume::dispatch(type_, [&]<class T>(T) {
        for (std::size_t i = 0; i < box.input.samples.size() / sizeof(T); ++i) {
            if (!volume::isPresent(box.input.present, i)) continue;
            T sample, rounded;
            std::memcpy(&sample, box.input.samples.data() + i * sizeof(T), sizeof(T));
            std::memcpy(&rounded, box.rounded.samples.data() + i * sizeof(T), sizeof(T));
            const double apart = double(rounded) * times_ - double(sample);
            box.squares += apart * apart;
        }
    });
}

void StepSearch::improveSplit(int rounds) {
    // It ends when all axes but the last one that was changed have been tried since.
    for (int i = 0, changed = 0; i < 3 * rounds && i < changed + 3; ++i)
        if (attemptWith([&](StepChoice& steps) { steps.split.axes ^= 1 << i % 3; })) changed = i;
    for (const int length : {2, 10}) {
        if (best_.steps.split.axes == 0) break; // nothing is split
        if (attemptWith([&](StepChoice& steps) { steps.split.least = length; })) break;
    }
}

void StepSearch::improveQuantum() {
    constexpr double kApart = 1.4;
    const auto scale = [&](double bounds) {
        return attemptWith([&](StepChoice& steps) { steps.quantum = quantumOf(bounds); });
    };
    scale(kUsualQuantum * kApart) ? scale(kUsualQuantum * kApart * kApart) : scale(kUsualQuantum / kApart);
}

bool StepSearch::findQuantum(SteppedFrame how, double squares) {
    constexpr int kTrials = 5;
    constexpr double kLeast = 0.02, kMost = 1, kFurther = 0.9, kApart = 0.05;
    squares_ = squares;
    QuantumSearch search(squares, kTrials, how.mean->largestQuantum());
    TrialOfSteps first, latest;
    const auto attemptWith = [&](double quantum) {
        if (!setQuantum(quantum, how)) return false;
        latest = trials_.of(how);
        if (first.squares == 0) first = latest; // integers may all be exact at first
        const double apart = first.squares > 0 && latest.squares > 0 ? std::log(latest.squares / first.squares) : 0;
        if (std::abs(apart) > kApart && latest.bytes > 0)
            power_ = std::clamp(-std::log(latest.bytes / first.bytes) / apart, kLeast, kMost);
        return true;
    };
    bool isFirst = true;
    for (std::optional<double> next = how.mean->quantum; next; isFirst = false) {
        if (!attemptWith(*next)) return false;
        next = search.next(how.mean->quantum, latest.squares);
        if (!next && isFirst) next = kFurther * how.mean->quantum; // shows how bytes depend on errors
    }
    // The others are compared with the one that comes nearest.
    if (search.best() > 0 && search.best() != how.mean->quantum && !attemptWith(search.best())) return false;
    how.mean->power = search.power();
    take(how, bytesAtMean(latest));
    return true;
}

} // namespace tessera::codec
