#include "codec/pack/pack_size.h"

#include "codec/archive/frame_model.h"
#include "codec/pack/error_bound.h"
#include "codec/pack/lossy_field.h"
#include "volume/base/error.h"
#include "volume/resample/resample.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <unistd.h>

namespace tessera::codec {

namespace {

constexpr double kLargestBound = 0.25;

/// A temporary file that is removed by the destructor.
struct Scratch {
    std::string path;
    explicit Scratch(std::string name) : path(std::move(name)) {}
    ~Scratch() { std::remove(path.c_str()); }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
};

/// The bound at which the curve reaches `bytes`, interpolated linearly in the logarithm of the bound.
double boundAt(const std::vector<SizeAtBound>& curve, double bytes) {
    if (bytes >= curve.front().bytes) return 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
        const SizeAtBound &before = curve[i - 1], &at = curve[i];
        if (at.bytes > bytes) continue;
        if (i == 1 || before.bytes <= at.bytes) return at.bound;
        const double part = (before.bytes - bytes) / (before.bytes - at.bytes);
        return before.bound * std::pow(at.bound / before.bound, part);
    }
    return kLargestBound;
}

/// The estimated size for a bound.
double bytesAt(const std::vector<SizeAtBound>& curve, double bound) {
    if (bound <= curve[1].bound) return bound == 0 ? curve[0].bytes : curve[1].bytes;
    for (std::size_t i = 2; i < curve.size(); ++i) {
        const SizeAtBound &before = curve[i - 1], &at = curve[i];
        if (bound > at.bound) continue;
        return before.bytes + (at.bytes - before.bytes) * std::log2(bound / before.bound);
    }
    return curve.back().bytes;
}

/// The next bound to try: between trials on either side, interpolated or, with `halves`, in the middle; else along the
/// estimates from the single trial.
double nextBound(const std::vector<SizeAtBound>& curve, const std::optional<SizeAtBound>& above,
                 const std::optional<SizeAtBound>& below, double aim, bool halves) {
    constexpr double kLeastStep = 1.15, kFinest = 1e-8;
    if (!above && !below) return boundAt(curve, aim);
    if (above && below) {
        const double finer = std::max(above->bound, kFinest);
        const double part = halves ? 0.5 : (above->bytes - aim) / (above->bytes - below->bytes);
        return finer * std::pow(below->bound / finer, std::clamp(part, 0.1, 0.9));
    }
    const SizeAtBound& trial = above ? *above : *below;
    const double guess = boundAt(curve, bytesAt(curve, trial.bound) * aim / trial.bytes);
    return above ? std::max({guess, kLeastStep * trial.bound, kFinest}) : std::min(guess, trial.bound / kLeastStep);
}

/// Adds the estimated bytes of a part of a frame, times `times`, to each point.
void addEstimates(const volume::BrickGrid& grid, const volume::Field& part, const volume::Parameter& parameter,
                  const PackOptions& options, SizeControl control, std::size_t bricks, double times,
                  std::vector<SizeAtBound>& curve) {
    const bool isFloat = part.type == volume::ScalarType::F32, bounded = !parameter.categorical;
    FrameOptions frame;
    frame.wavelet = parameter.categorical ? Wavelet::N1 : waveletOf(options.wavelet).value_or(Wavelet::W22);
    double bytes = 0;
    std::int64_t lastStep = 0;
    std::optional<NumberCounts> counts;
    for (SizeAtBound& point : curve) {
        const FrameBound bound = boundFor(withBound(PackOptions(), control, point.bound), parameter, part, counts);
        if (bounded && !isFloat) {
            if (bound.step != lastStep) bytes = estimateFrameBytes(grid, countedIn(part, bound.step), frame, bricks);
            lastStep = bound.step;
        } else if (bounded || point.bound == 0) {
            frame.maxError = bound.error;
            bytes = estimateFrameBytes(grid, part, frame, bricks);
        }
        point.bytes += bytes * times;
    }
}

/// The same for a whole frame; if it is in a scratch file, two brick layers represent it.
void addEstimates(const volume::BrickGrid& grid, const FrameSamples& samples, const volume::Parameter& parameter,
                  const PackOptions& options, SizeControl control, double times, std::vector<SizeAtBound>& curve) {
    constexpr std::size_t kBricks = 8;
    if (samples.whole())
        return addEstimates(grid, *samples.whole(), parameter, options, control, kBricks, times, curve);
    constexpr int kLayers = 2;
    const int layers = grid.count().z, taken = std::min(kLayers, layers);
    for (int i = 0; i < taken; ++i) {
        const int layer = (2 * i + 1) * layers / (2 * taken);
        const Slab slab = layerOf(grid, layer);
        addEstimates(slab.grid(grid), samples.slices(slab.first, slab.count), parameter, options, control,
                     kBricks / kLayers, times * layers / taken, curve);
    }
}

} // namespace

SizeControl sizeControlFor(const volume::DatasetInfo& info) {
    const auto isWhole = [](const volume::Parameter& parameter) {
        return !parameter.categorical && parameter.type != volume::ScalarType::F32;
    };
    return std::any_of(info.parameters.begin(), info.parameters.end(), isWhole) ? SizeControl::Psnr
                                                                                : SizeControl::LargestError;
}

PackOptions withBound(PackOptions options, SizeControl control, double bound) {
    const bool psnr = control == SizeControl::Psnr && bound > 0;
    options.psnr = psnr ? 20 * std::log10(std::sqrt(3.0) / bound) : 0;
    options.maxError = psnr ? 0 : bound;
    return options;
}

std::vector<SizeAtBound> estimateSizes(const volume::Dataset& dataset, FrameQueueOptions reading,
                                       const PackOptions& options, const Progress& progress) {
    constexpr int kFinest = -26, kCoarsest = -2; // powers of two
    const SizeControl control = sizeControlFor(dataset.info);
    std::vector<SizeAtBound> curve{{0, 0}};
    for (int exponent = kFinest; exponent <= kCoarsest; ++exponent) curve.push_back({std::ldexp(1.0, exponent), 0});
    constexpr std::size_t kTimes = 2;
    const std::size_t all = dataset.info.times.size(), times = std::min(kTimes, all);
    const auto timeOf = [all, times](int t) { return int((2 * std::size_t(t) + 1) * all / (2 * times)); };
    volume::Dataset some = dataset;
    some.info.times.resize(times);
    some.info.quantities.clear();
    some.read = dataset.read.through(
        [timeOf](const volume::FrameReader& read, int parameter, int component, int time, volume::SliceRange slices) {
            return read(parameter, component, timeOf(time), slices);
        });
    reading.ahead = false;
    FrameQueue feed(some, reading, progress.stop);
    const std::size_t steps = times * some.info.parameters.size();
    for (std::size_t step = 0; step < steps; ++step) {
        progress.advance(double(step) / double(steps), "sizes");
        const QueuedFrames fed = feed.next();
        for (const FrameSamples& samples : fed.frames)
            addEstimates(reading.grid, samples, some.info.parameters[std::size_t(fed.parameter)], options, control,
                         double(all) / double(times), curve);
    }
    return curve;
}

PackSummary packToSize(const PackOptions& asked, SizeControl control, const std::string& path,
                       const std::function<std::vector<SizeAtBound>(const Progress&)>& estimate,
                       const std::function<PackSummary(const PackOptions&, const std::string&, const Progress&)>& pack,
                       const Progress& progress) {
    if (asked.maxError > 0 || asked.absError > 0 || asked.psnr > 0)
        throw Error("choose either a size or an error bound, not both");
    if (asked.threshold.kind != ThresholdChoice::None) throw Error("a size cannot be combined with a threshold");
    constexpr int kTrials = 10, kNeighbours = 5;
    constexpr double kFull = 0.96, kAim = 0.98; // fractions of the size
    constexpr double kSame = 1.01;              // ratio of bounds too close for another trial: 0.09 dB
    constexpr double kNextStep = 1.12;          // for integers: a step of 9 is 1.13 times one of 8
    const double wanted = asked.sizeMb * 1e6, aim = kAim * wanted;
    const std::vector<SizeAtBound> curve = estimate(progress.part(0, 0.1));
    const Scratch trial(path + ".trial-" + std::to_string(::getpid()));
    const Scratch best(path + ".best-" + std::to_string(::getpid()));
    PackSummary found;
    double foundBound = 0;
    std::optional<SizeAtBound> above, below; // nearest trials that were too large and small enough
    int trials = 0;
    const auto attempt = [&](double bound) {
        PackOptions options = withBound(asked, control, bound);
        options.sizeMb = 0;
        const double share = 0.9 / (kTrials + kNeighbours), begin = 0.1 + share * trials++;
        const PackSummary summary = pack(options, trial.path, progress.part(begin, begin + share));
        const SizeAtBound came{bound, double(summary.archiveBytes)};
        if (came.bytes <= wanted && (found.archiveBytes == 0 || bound < foundBound)) {
            found = summary;
            foundBound = bound;
            std::filesystem::rename(trial.path, best.path);
        }
        return came;
    };
    while (trials < kTrials) {
        const bool halves = trials >= 4 && trials % 2 == 0; // sizes may jump, and interpolation then stays at one side
        const SizeAtBound came = attempt(std::min(nextBound(curve, above, below, aim, halves), kLargestBound));
        if (came.bytes > wanted) {
            above = came;
            if (came.bound >= kLargestBound) break;
            continue;
        }
        below = came;
        if (came.bound == 0 || came.bytes >= kFull * wanted) break;
        if (above && below && below->bound <= kSame * above->bound) break;
    }
    // Sizes of integers are not monotonic in the step: one or two steps finer than the last one that was too large may
    // fit.
    const bool steps = control == SizeControl::Psnr && above && double(found.archiveBytes) < kFull * wanted;
    for (int n = 1; steps && n <= kNeighbours; ++n)
        if (attempt(above->bound / std::pow(kNextStep, n)).bytes <= wanted) break;
    if (found.archiveBytes == 0)
        throw Error("the archive cannot be made that small: it has " + std::to_string(std::llround(above->bytes)) +
                        " bytes even with the largest error tried (labels are stored exactly)",
                    path);
    std::filesystem::rename(best.path, path);
    found.trials = trials;
    progress.advance(1);
    return found;
}

} // namespace tessera::codec
