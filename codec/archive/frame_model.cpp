#include "codec/archive/frame_model.h"

#include "codec/archive/brick_access.h"
#include "codec/wavelet/filter.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <mutex>

namespace tessera::codec {

namespace {

constexpr std::size_t kTrialBricks = 6, kModelBricks = 32;
constexpr int kMostTables = 24;

/// Histogram of the tokens of some bricks, spread over the frame; the bricks are kept in `taken` if it is not null.
Histogram sampleTokens(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameRecord& frame,
                       std::size_t most, Contexts contexts, double maxError = 0, Taken* taken = nullptr,
                       const FittedWeights* fitted = nullptr, bool quick = false) {
    const std::size_t bricks = grid.brickCount(), count = std::min(bricks, most);
    // Large frames are subsampled. The step is coprime to the number of chunks per row, to cover all positions of a
    // row.
    constexpr std::size_t kMany = 2 << 20, kQuickMany = 1 << 19;
    const std::size_t sampled = samples.count() / bricks * count;
    const int every = sampled >= kMany ? 5 : quick && sampled >= kQuickMany ? 3 : 1;
    Histogram sum(grid.levels, contexts);
    std::mutex mutex;
    if (taken) {
        *taken = {frame.wavelet, frame.bodyCentred, contexts, maxError, {}, fitted ? *fitted : FittedWeights()};
        taken->bricks.resize(bricks);
    }
    parallelRanges(count, [&](std::size_t begin, std::size_t end) {
        BrickInput input;
        SplitMemory memory;
        Histogram part(grid.levels, contexts);
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t number = i * bricks / count;
            const glm::ivec3 brick = grid.indexOf(number);
            input.take(grid, brick, samples, frame.mask >= 0);
            PreparedBrick prepared = prepareBrick(brickFormat(grid, brick, samples.type(), frame), input.samples,
                                                  input.present, maxError, contexts, memory, {}, fitted);
            countBrick(prepared, part, every);
            if (taken) taken->bricks[number] = std::move(prepared);
        }
        const std::lock_guard lock(mutex); // the order does not matter, since counts are integers
        sum.add(part);
    });
    return sum;
}

/// The same for the central boxes of some bricks, which suffices to compare filters.
Histogram sampleMiddles(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameRecord& frame,
                        std::size_t most) {
    constexpr int kMiddle = 32, kMiddleLevels = 3, kEvery = 3;
    const std::size_t bricks = grid.brickCount(), count = std::min(bricks, most);
    const int levels = std::min(grid.levels, kMiddleLevels);
    Histogram sum(levels, {});
    std::mutex mutex;
    parallelRanges(count, [&](std::size_t begin, std::size_t end) {
        BrickInput input;
        SplitMemory memory;
        Histogram part(levels, {});
        for (std::size_t i = begin; i < end; ++i) {
            const glm::ivec3 brick = grid.indexOf(i * bricks / count);
            BrickFormat format = brickFormat(grid, brick, samples.type(), frame);
            const int depth = kMiddle * format.sublattices();
            const glm::ivec3 whole = format.size, size = glm::min(whole, glm::ivec3(kMiddle, kMiddle, depth));
            glm::ivec3 first = (whole - size) / 2;
            first.z -= first.z % format.sublattices(); // start on an even slice
            format.size = size;
            format.levels = levels;
            input.take(grid, grid.begin(brick) + first, size, samples, frame.mask >= 0);
            countBrick(prepareBrick(format, input.samples, input.present, 0, {}, memory), part, kEvery);
        }
        const std::lock_guard lock(mutex);
        sum.add(part);
    });
    return sum;
}

/// The shift that scales typical details of full resolution to some tens, where contexts separate magnitudes well.
int shiftFor(const Histogram& histogram) {
    double count = 0, octaves = 0;
    for (std::size_t c = 0; c < std::size_t(kClasses) && c < histogram.counts.size(); ++c)
        for (std::uint32_t t = 0; t < kTokens; ++t) {
            count += histogram.counts[c][t];
            octaves += histogram.counts[c][t] * double(std::bit_width(symbolBase(t) / 2));
        }
    constexpr double kWanted = 6;
    return count == 0 ? 0 : std::max(0, int(std::lround(octaves / count - kWanted)));
}

/// Weights fitted to about `most` samples of a frame.
FittedWeights fittedTo(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameRecord& frame, int shift,
                       std::size_t most) {
    const std::size_t bricks = grid.brickCount(), count = std::min(bricks, kModelBricks);
    const int every = int(std::max<std::size_t>(1, samples.count() / bricks * count / most));
    WeightFit sum;
    std::mutex mutex;
    parallelRanges(count, [&](std::size_t begin, std::size_t end) {
        BrickInput input;
        SplitMemory memory;
        WeightFit part;
        for (std::size_t i = begin; i < end; ++i) {
            const glm::ivec3 brick = grid.indexOf(i * bricks / count);
            input.take(grid, brick, samples, false);
            addToFit(brickFormat(grid, brick, samples.type(), frame), input.samples, shift, every, memory, part);
        }
        const std::lock_guard lock(mutex); // the order does not matter, since all sums are exact
        sum.add(part);
    });
    return sum.solved();
}

/// Bitwise coded floats do not profit from contexts by band: their low bits are noise in all bands.
bool prefersByBand(const FrameRecord& frame) {
    return frame.numbers.kind != NumberKind::Float;
}

/// Selects the filter by trial on some bricks: first the prediction, then the update. Filters without update alias in
/// coarse levels, so they must be clearly better.
Wavelet waveletFor(const volume::BrickGrid& grid, const FrameSamples& samples, FrameRecord frame) {
    constexpr double kPredictionHandicap = 1.015;
    if (frame.numbers.kind == NumberKind::Float) return Wavelet::W22; // floats are only predicted
    double best = std::numeric_limits<double>::infinity();
    Wavelet chosen = Wavelet::W22;
    const auto tryOne = [&](Wavelet wavelet) {
        frame.wavelet = wavelet;
        double bits = sampleMiddles(grid, samples, frame, kTrialBricks).bits();
        if (!filterOf(wavelet).updates) bits *= kPredictionHandicap;
        if (bits < best) best = bits, chosen = wavelet;
    };
    tryOne(Wavelet::W22);
    tryOne(Wavelet::W42);
    if (chosen == Wavelet::W22) {
        tryOne(Wavelet::N2);
    } else {
        tryOne(Wavelet::W44);
        tryOne(Wavelet::N4);
    }
    return chosen;
}

/// Whether predicting the odd sublattice of BCC from the even one takes fewer bytes, by trial on some bricks.
bool prefersBodyCentred(const volume::BrickGrid& grid, const FrameSamples& samples, FrameRecord frame) {
    if (grid.lattice.kind != volume::LatticeKind::BCC || frame.numbers.kind == NumberKind::Float) return false;
    const auto bits = [&](bool bodyCentred) {
        frame.bodyCentred = bodyCentred;
        double least = std::numeric_limits<double>::infinity();
        for (const Wavelet wavelet : {Wavelet::W22, Wavelet::W44}) {
            frame.wavelet = wavelet;
            least = std::min(least, sampleMiddles(grid, samples, frame, kTrialBricks).bits());
        }
        return least;
    };
    return bits(true) < bits(false);
}

/// Replaces a model by one with fitted predictions if that is shorter, and sets wavelet and bodyCentred of the frame:
/// coarse samples are then every second one, as with (2,0).
void tryFitted(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameOptions& options,
               FrameRecord& frame, Model& model, Taken* taken) {
    constexpr std::size_t kSome = 1 << 19, kMany = 3 << 19; // samples to fit weights to
    FrameRecord predicted = frame;
    predicted.wavelet = Wavelet::N2;
    predicted.bodyCentred = grid.lattice.kind == volume::LatticeKind::BCC;
    const bool possible = frame.mask < 0 && frame.codeBits <= kBitsOfFit && grid.levels > 1 &&
                          canBeFitted(brickFormat(grid, glm::ivec3(0), samples.type(), predicted), false);
    if (!possible) return;
    const Contexts contexts = model.contexts;
    const double usual = bitsWith(model, sampleTokens(grid, samples, frame, kModelBricks, contexts));
    const FittedWeights weights =
        fittedTo(grid, samples, predicted, contexts.shift, options.effort < kLongestEffort ? kSome : kMany);
    Taken own;
    const Histogram tokens = sampleTokens(grid, samples, predicted, kModelBricks, contexts, boundOf(frame, options),
                                          taken ? &own : nullptr, &weights);
    Model fitted = makeModel(tokens, kMostTables);
    fitted.fitted = weights;
    const auto bytesOf = [](const Model& of) { return 8.0 * double(serialise(of).size()); };
    if (bitsWith(fitted, tokens) + bytesOf(fitted) >= usual + bytesOf(model)) return;
    frame.wavelet = predicted.wavelet;
    frame.bodyCentred = predicted.bodyCentred;
    model = std::move(fitted);
    if (taken) *taken = std::move(own);
}

} // namespace

int codeBitsOf(SampleNumbers& of, const NumberCoding& numbers) {
    const FrameSamples& samples = of.samples();
    if (isBounded(numbers)) return codeBitsOf(of.range(), numbers); // larger samples have larger codes
    if (samples.type() != volume::ScalarType::F32) return codec::codeBitsOf(samples.type());
    if (numbers.kind == NumberKind::Float) return 32;
    const auto ofPart = [&](const volume::Field& part, Slab) {
        constexpr std::size_t kRow = 512;
        std::array<std::uint32_t, kRow> codes;
        std::uint32_t all = 0;
        for (std::size_t first = 0; first < part.count(); first += kRow) {
            const std::size_t count = std::min(kRow, part.count() - first);
            codesOf(numbers, std::as_bytes(part.as<float>().subspan(first, count)), codes.data());
            for (std::size_t i = 0; part.mask && i < count; ++i)
                if (!part.present(first + i)) codes[i] = 0;
            for (std::size_t i = 0; i < count; ++i)
                all |= codes[i] ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(codes[i]) >> 31);
        }
        return all;
    };
    std::uint32_t all = 0;
    for (const std::uint32_t part : samples.ofSlabs<std::uint32_t>("bits", ofPart)) all |= part;
    return std::max(1, int(std::bit_width(all)) + 1);
}

NumberCoding chooseNumbers(const volume::BrickGrid& grid, SampleNumbers& of, const KnownModel* last,
                           const FrameOptions& options) {
    constexpr int kBitsOfFloat = 25; // sign and 24 digits
    const FrameSamples& samples = of.samples();
    FrameRecord frame;
    frame.mask = samples.masked() ? 0 : -1;
    frame.numbers = chooseCoding(of, options.maxError);
    frame.codeBits = codeBitsOf(of, frame.numbers);
    if (frame.numbers.kind != NumberKind::Scaled || frame.codeBits <= kBitsOfFloat) return frame.numbers;
    const NumberCoding scaled = frame.numbers, bits{NumberKind::Float, 0, 1};
    if (last && last->kind == NumberKind::Float) return bits;
    const double asScaled = sampleMiddles(grid, samples, frame, kTrialBricks).bits();
    frame.numbers = bits;
    frame.codeBits = codeBitsOf(of, bits);
    return sampleMiddles(grid, samples, frame, kTrialBricks).bits() < asScaled ? bits : scaled;
}

int zstdLevelFor(const FrameSamples& samples, int zstdLevel, int effort) {
    constexpr std::size_t kSmallFrame = 1 << 19; // samples
    constexpr int kQuickLevel = 3;
    if (samples.count() <= kSmallFrame) return kMostZstdLevel;
    return effort <= kQuickEffort ? std::min(zstdLevel, kQuickLevel) : zstdLevel;
}

double boundOf(const FrameRecord& frame, const FrameOptions& options) {
    const bool bounded = frame.numbers.kind == NumberKind::Quantised || frame.numbers.kind == NumberKind::Stepped;
    return bounded ? std::max(options.maxError - options.spent, 0.0) : 0;
}

double estimateFrameBytes(const volume::BrickGrid& grid, const FrameSamples& samples, const FrameOptions& options,
                          std::size_t bricks) {
    FrameRecord frame;
    frame.mask = samples.masked() ? 0 : -1;
    SampleNumbers of(samples);
    frame.numbers = chooseNumbers(grid, of, nullptr, options);
    frame.wavelet = options.wavelet.value_or(Wavelet::W22);
    frame.codeBits = codeBitsOf(of, frame.numbers);
    const int shift = frame.codeBits > 16 ? shiftFor(sampleTokens(grid, samples, frame, bricks, {})) : 0;
    const double all = double(grid.brickCount());
    return sampleTokens(grid, samples, frame, bricks, {shift, prefersByBand(frame)}).bits() / 8 * all /
           std::min(all, double(bricks));
}

Model chooseModel(const volume::BrickGrid& grid, const FrameSamples& samples, const KnownModel* last, bool byBand,
                  FrameRecord& frame, const FrameOptions& options, Taken& taken) {
    constexpr double kStillAlike = 1.05;
    const double maxError = boundOf(frame, options);
    byBand = byBand && prefersByBand(frame);
    Taken* const kept = samples.whole() ? &taken : nullptr;
    std::optional<Model> fresh;
    const bool serves = last && last->resembles(frame) && last->model.contexts.byBand == byBand &&
                        (last->model.fitted.empty() || frame.mask < 0); // absent samples cannot be predicted
    if (serves) {
        const Model& model = last->model;
        frame.wavelet = options.wavelet.value_or(last->wavelet);
        frame.bodyCentred = options.bodyCentred.value_or(last->bodyCentred);
        const Histogram histogram =
            sampleTokens(grid, samples, frame, kModelBricks, model.contexts, maxError, kept, &model.fitted);
        fresh = makeModel(histogram, kMostTables);
        fresh->fitted = model.fitted;
        const double before = bitsWith(model, histogram), now = bitsWith(*fresh, histogram);
        if (before <= now + 8.0 * double(serialise(*fresh).size())) {
            frame.model = last->number;
            return model;
        }
        if (before > kStillAlike * now) fresh.reset();
    }
    if (!fresh) {
        const bool quick = options.effort <= kQuickEffort;
        frame.bodyCentred =
            options.bodyCentred ? *options.bodyCentred
            : !quick            ? prefersBodyCentred(grid, samples, frame)
                     : grid.lattice.kind == volume::LatticeKind::BCC && frame.numbers.kind != NumberKind::Float;
        if (!options.wavelet) frame.wavelet = quick ? Wavelet::W22 : waveletFor(grid, samples, frame);
        const int shift = frame.codeBits > 16 ? shiftFor(sampleMiddles(grid, samples, frame, kTrialBricks)) : 0;
        const Contexts contexts{shift, byBand};
        const std::size_t of = quick ? kTrialBricks : kModelBricks;
        fresh =
            makeModel(sampleTokens(grid, samples, frame, of, contexts, maxError, kept, nullptr, quick), kMostTables);
        if (options.effort >= kFittedEffort && !options.wavelet && !options.bodyCentred)
            tryFitted(grid, samples, options, frame, *fresh, kept);
    }
    return *fresh;
}

} // namespace tessera::codec
