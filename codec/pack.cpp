#include "codec/pack.h"

#include "codec/archive_writer.h"
#include "codec/brick_access.h"
#include "codec/continuation.h"
#include "codec/frame_feed.h"
#include "codec/lossy_field.h"
#include "codec/memory_plan.h"
#include "codec/pack_size.h"
#include "codec/stopwatch.h"
#include "volume/resample.h"
#include "volume/series_dataset.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::LatticeKind;
using volume::ScalarType;

void settleRanges(volume::DatasetInfo& info, const std::vector<std::vector<Range>>& gathered) {
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        std::vector<Range>& ranges = info.parameters[p].ranges;
        if (!ranges.empty() || gathered[p].empty()) continue; // known, or not read yet
        ranges = gathered[p];
        for (Range& range : ranges)
            if (range.lo > range.hi) range = {0, 0}; // no sample is present anywhere
    }
}

int defaultLevels(const volume::Lattice& lattice, int brickSize) {
    const glm::ivec3 texels = lattice.texels();
    const int longest = std::min(brickSize, std::max({texels.x, texels.y, texels.z}));
    int levels = 1;
    while (longest >> levels >= 4) ++levels;
    return levels;
}

/// The edge of bricks, where options leave it to us: samples that repeat themselves, which only integers that were not
/// resampled do, are found within a brick alone. What grows keeps its bricks.
int brickSizeFor(const volume::Lattice& lattice, const volume::DatasetInfo& info, const PackOptions& options,
                 const Archive* grown) {
    constexpr int kUsual = 64, kLargest = 128;
    constexpr std::size_t kSmall = 1 << 19; // samples
    if (options.brickSize != 0) return options.brickSize;
    if (grown) return grown->grid().brickSize;
    const glm::ivec3 size = lattice.size;
    const int longest = std::max({size.x, size.y, size.z});
    const auto isInteger = [](const volume::Parameter& parameter) { return parameter.type != ScalarType::F32; };
    const bool one = lattice.kind == LatticeKind::CC && lattice == info.lattice && info.times.size() == 1 &&
                     lattice.count() <= kSmall && longest > kUsual && longest <= kLargest &&
                     std::all_of(info.parameters.begin(), info.parameters.end(), isInteger);
    return one ? kLargest : kUsual;
}

volume::BrickGrid gridFor(const volume::Lattice& lattice, const volume::DatasetInfo& info, const PackOptions& options,
                          const Archive* grown = nullptr) {
    const int brickSize = brickSizeFor(lattice, info, options, grown);
    volume::BrickGrid grid{lattice, brickSize, options.levels,
                           levelPhase(waveletOf(options.wavelet).value_or(Wavelet::W22))};
    if (brickSize < 4 || brickSize > 128 || !std::has_single_bit(unsigned(brickSize)))
        throw Error("the brick size must be a power of two from 4 to 128, not " + std::to_string(brickSize));
    if (grid.levels == 0) grid.levels = defaultLevels(lattice, grid.brickSize);
    if (grid.levels < 1 || grid.levels > int(std::bit_width(unsigned(grid.brickSize))))
        throw Error(std::to_string(grid.levels) + " levels do not fit bricks of " + std::to_string(grid.brickSize));
    return grid;
}

/// Extent of all components of a parameter: what an error bound refers to.
double extentOf(const volume::Parameter& parameter) {
    double extent = 0;
    for (std::size_t c = 0; c < std::min(parameter.ranges.size(), std::size_t(parameter.components)); ++c)
        extent = std::max(extent, parameter.ranges[c].hi - parameter.ranges[c].lo);
    return extent;
}

/// The same for integers, whose step is 1 at least.
double integerBoundForPsnr(const Field& field, double wanted) {
    double bound = std::sqrt(3.0) * wanted;
    for (int step = stepWithin(field.type, bound); step > 1; step = stepWithin(field.type, bound)) {
        const double squares = volume::dispatch(field.type, [&]<class T>(T) {
            double sum = 0;
            const auto samples = field.as<T>();
            for (std::size_t i = 0; i < samples.size(); ++i) {
                if (!field.present(i)) continue;
                const double apart = std::remainder(double(samples[i]), double(step));
                sum += apart * apart;
            }
            return sum;
        });
        std::size_t count = 0;
        for (std::size_t i = 0; i < field.count(); ++i) count += field.present(i) ? 1 : 0;
        if (std::sqrt(squares / double(std::max<std::size_t>(count, 1))) <= wanted) return bound;
        bound = step / 2 - 0.5;
    }
    return 0;
}

/// A bound on the error of stored numbers that gives at least `psnr` dB, found by trial on the frame itself: the error
/// of a quantised number is spread about evenly, so the first guess is rarely far off.
double boundForPsnr(const Field& field, double extent, double psnr) {
    const double wanted = extent * std::pow(10.0, -psnr / 20);
    if (field.type != ScalarType::F32) return integerBoundForPsnr(field, wanted);
    double bound = std::sqrt(3.0) * wanted;
    const auto samples = field.as<float>();
    for (int trial = 0; trial < 200; ++trial, bound *= 0.97) {
        const NumberCoding numbers = chooseCoding(field, bound);
        if (numbers.kind != NumberKind::Quantised) return bound;
        double squares = 0, count = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!field.present(i) || !std::isfinite(samples[i])) continue;
            const double error = double(sampleOf<float>(numbers, codeOf(numbers, samples[i]))) - double(samples[i]);
            squares += error * error, ++count;
        }
        if (count == 0 || std::sqrt(squares / count) <= wanted) return bound;
    }
    return 0;
}

/// The strictest of the bounds asked for, in stored numbers; 0: exact.
double boundFor(const PackOptions& options, const volume::Parameter& parameter, const Field& field) {
    if (parameter.categorical) return 0;
    double bound = std::numeric_limits<double>::infinity();
    const double scale = std::abs(field.scale), extent = extentOf(parameter);
    if (options.maxError > 0) bound = std::min(bound, options.maxError * extent / scale);
    if (options.absError > 0) bound = std::min(bound, options.absError / scale);
    if (options.psnr > 0) bound = std::min(bound, boundForPsnr(field, extent / scale, options.psnr));
    return std::isfinite(bound) ? bound : 0;
}

/// Gives up details of a frame, of the least important bricks the most.
Thresholded giveUp(Field field, const volume::BrickGrid& grid, const FrameOptions& frame,
                   const ThresholdOptions& options, double extent) {
    std::vector<float> strength(brickCount(grid), 1);
    if (options.byImportance) {
        const auto importance =
            volume::importanceOfBricks(grid, field, frame.range, frame.categorical, frame.importance);
        float most = 0;
        for (const volume::BrickImportance& brick : importance) most = std::max(most, brick.importance);
        for (std::size_t b = 0; b < strength.size() && most > 0; ++b) strength[b] = 1 - importance[b].importance / most;
    }
    const auto kind = static_cast<Threshold>(static_cast<int>(options.kind) - 1);
    const double value = kind == Threshold::Quantile ? options.value : options.value * extent / std::abs(field.scale);
    return thresholded(grid, std::move(field), frame.wavelet.value_or(Wavelet::W22), kind, value, strength,
                       frame.maxError);
}

/// Makes every sample of the bricks that are left out absent.
void leaveOut(Field& field, const volume::BrickGrid& grid, const std::vector<std::uint8_t>& discarded) {
    if (std::find(discarded.begin(), discarded.end(), std::uint8_t(1)) == discarded.end()) return;
    volume::Mask mask = field.mask ? *field.mask : volume::Mask(field.count(), 1);
    for (std::size_t b = 0; b < discarded.size(); ++b)
        if (discarded[b] != 0)
            forBrickRows(grid, brickIndex(grid, b), [&](std::size_t from, std::size_t, std::size_t n) {
                std::fill_n(mask.begin() + std::ptrdiff_t(from), n, std::uint8_t(0));
            });
    field.mask = std::make_shared<const volume::Mask>(std::move(mask));
}

/// The parameters with the ranges known so far.
std::vector<volume::Parameter> withRanges(std::vector<volume::Parameter> parameters,
                                          const std::vector<std::vector<Range>>& gathered) {
    volume::DatasetInfo info;
    info.parameters = std::move(parameters);
    settleRanges(info, gathered);
    return std::move(info.parameters);
}

} // namespace

PackOptions resolved(PackOptions options) {
    const PackOptions defaults;
    const auto set = [](auto& value, const auto& before, const auto& wanted) {
        if (value == before) value = wanted;
    };
    switch (options.preset) {
    case PackPreset::None:
        break;
    case PackPreset::Lossless:
        set(options.lattice, defaults.lattice, StoredLattice::CC);
        break;
    case PackPreset::Visual:
        set(options.maxError, defaults.maxError, 1e-3);
        break;
    case PackPreset::Small:
        set(options.maxError, defaults.maxError, 1e-2);
        set(options.zstdLevel, defaults.zstdLevel, 19);
        break;
    case PackPreset::Thesis:
        set(options.wavelet, defaults.wavelet, WaveletChoice::W22);
        set(options.brickSize, defaults.brickSize, 16);
        set(options.levels, defaults.levels, 3);
        set(options.bccTransform, defaults.bccTransform, BccTransform::Separable);
        set(options.threshold, defaults.threshold, ThresholdOptions{ThresholdChoice::Soft, 1.5 / 255, true});
        break;
    }
    options.preset = PackPreset::None;
    return options;
}

namespace {

/// The ranges of every parameter where they are not known yet, by reading everything once.
void gatherAllRanges(volume::Dataset& dataset, bool ahead, PackSummary& summary, const Progress& progress) {
    volume::DatasetInfo& info = dataset.info;
    const auto isKnown = [](const volume::Parameter& parameter) { return !parameter.ranges.empty(); };
    if (std::all_of(info.parameters.begin(), info.parameters.end(), isKnown)) return;
    std::vector<std::vector<Range>> ranges(info.parameters.size());
    FrameFeed feed(dataset, {}, ahead, progress.stop);
    const std::size_t steps = info.parameters.size() * info.times.size();
    for (std::size_t step = 0; step < steps; ++step) {
        progress.advance(double(step) / double(steps), "ranges");
        const FeedStep fed = feed.next();
        summary.loadSeconds += fed.loadSeconds;
        widenRanges(ranges[std::size_t(fed.parameter)], fed.ranges);
    }
    settleRanges(info, ranges);
}

/// Flags of bricks that are not important enough in any parameter at any time. Ranges must be known.
std::vector<std::uint8_t> bricksToDiscard(volume::Dataset& dataset, const volume::BrickGrid& grid,
                                          const FrameFeed::Resampling& resampling, const PackOptions& options,
                                          bool ahead, const Progress& progress, PackSummary& summary) {
    const volume::DatasetInfo& info = dataset.info;
    std::vector<float> most(brickCount(grid), 0);
    FrameFeed feed(dataset, resampling, ahead, progress.stop);
    const std::size_t steps = info.parameters.size() * info.times.size();
    for (std::size_t step = 0; step < steps; ++step) {
        progress.advance(double(step) / double(steps), "importance");
        const FeedStep fed = feed.next();
        const volume::Parameter& parameter = info.parameters[std::size_t(fed.parameter)];
        for (std::size_t c = 0; c < fed.fields.size(); ++c) {
            const std::vector<Range>& known = parameter.ranges.empty() ? fed.ranges : parameter.ranges;
            const auto importance =
                volume::importanceOfBricks(grid, fed.fields[c], c < known.size() ? known[c] : Range{1, 0},
                                           parameter.categorical, options.importance);
            for (std::size_t b = 0; b < most.size(); ++b) most[b] = std::max(most[b], importance[b].largest());
        }
    }
    std::vector<std::uint8_t> discarded;
    for (const float importance : most) discarded.push_back(double(importance) < options.discard ? 1 : 0);
    summary.discardedBricks = std::uint64_t(std::count(discarded.begin(), discarded.end(), std::uint8_t(1)));
    if (summary.discardedBricks == discarded.size()) throw Error("no brick is important enough to be kept");
    return discarded;
}

/// Packs into a new archive, or behind what is in `grown`, whose options `asked` are then.
PackSummary packInto(volume::Dataset& source, const PackOptions& asked, const std::string& path, const Archive* grown,
                     const Progress& progress) {
    const PackOptions options = resolved(asked);
    PackSummary summary;
    if (source.info.parameters.empty() || source.info.times.empty()) throw Error("there is nothing to pack");
    if (!(options.maxError >= 0 && options.maxError < 1)) throw Error("the error bound must be from 0 to below 1");
    if (!(options.absError >= 0) || !(options.psnr >= 0)) throw Error("error bounds must not be negative");
    const bool thresholds = options.threshold.kind != ThresholdChoice::None && options.threshold.value > 0;
    if (thresholds && (options.psnr > 0 || options.sizeMb > 0))
        throw Error("a threshold goes with a bound on the error of samples, not with a PSNR or a size");
    const bool exact = options.maxError == 0 && options.absError == 0 && options.psnr == 0 && !thresholds;
    if (!options.lossless && exact && options.discard == 0)
        throw Error("without lossless an error bound, a threshold or a part to discard is needed");
    if (options.lattice == StoredLattice::CC && source.info.lattice.kind == LatticeKind::BCC)
        throw Error("the data lies on BCC; it cannot be packed as CC");

    Metadata metadata;
    metadata.source = source.info.lattice;
    metadata.alternating = options.lattice == StoredLattice::D4;
    volume::Dataset dataset = source;
    if (metadata.alternating && grown && bringsTimes(*grown, source.info)) {
        volume::ContinuedD4 later =
            volume::continueD4(source, grown->metadata().sourceTimes, grown->info().times, options.resample);
        metadata.sourceTimes = std::move(later.times);
        dataset = std::move(later.frames);
    } else if (metadata.alternating) {
        metadata.sourceTimes = source.info.times;
        dataset = volume::toD4(source, options.resample);
    }
    volume::DatasetInfo& info = dataset.info;
    const bool toBcc = options.lattice == StoredLattice::BCC && info.lattice.kind == LatticeKind::CC;
    const bool resamples = toBcc || metadata.alternating;
    metadata.info = info;
    metadata.info.lattice = toBcc ? volume::bccFor(info.lattice) : info.lattice;
    metadata.grid = gridFor(metadata.info.lattice, source.info, options, grown);
    metadata.lossless = exact && options.discard == 0;
    metadata.program = "tessera";
    metadata.options = options;
    metadata.options.memoryMb = 0; // of this machine, not of the archive
    const Continuation place = grown ? continuationOf(*grown, metadata) : Continuation(info);

    const std::size_t parameters = info.parameters.size(), times = info.times.size();
    std::vector<std::vector<Range>> ranges(parameters);
    std::vector<double> errors(parameters, 0); ///< largest of a sample, in the unit of the parameter
    const FrameFeed::Resampling resampling{toBcc, options.resample};
    const MemoryPlan memory = planMemory(metadata, source.info, options);
    Progress work = progress;
    {
        Stopwatch all(summary.seconds);
        // A bound relative to the range of all times needs a pass of its own; one time is read once.
        const bool relative = options.maxError > 0 || options.psnr > 0 || thresholds || options.discard > 0;
        if (relative && (times > 1 || grown)) {
            work = progress.part(0.3, 1);
            gatherAllRanges(dataset, memory.readAhead, summary, progress.part(0, 0.3));
            if (grown) place.widen(info, metadata.info);
        }

        const std::vector<std::uint8_t> discarded =
            options.discard > 0 ? bricksToDiscard(dataset, metadata.grid, resampling, options, memory.readAhead,
                                                  progress.part(0.25, 0.3), summary)
                                : std::vector<std::uint8_t>();
        summary.bricks = brickCount(metadata.grid);
        const auto opened = grown ? std::make_unique<ArchiveWriter>(*grown, metadata, memory.keepFrames)
                                  : std::make_unique<ArchiveWriter>(path, metadata, memory.keepFrames);
        ArchiveWriter& writer = *opened;
        const double frames = double(times) * double(componentCount(info));
        double done = 0;
        // With the ranges known so far; a reader may come at any time.
        const auto soFar = [&](std::size_t wholeTimes) {
            volume::DatasetInfo read = info;
            read.parameters = withRanges(info.parameters, ranges);
            Metadata now = metadata;
            if (wholeTimes < now.info.times.size()) // of D4*: what the frames so far reach
                std::erase_if(now.sourceTimes, [&](double time) { return time > now.info.times[wholeTimes - 1]; });
            place.widen(read, now.info);
            for (std::size_t p = 0; p < parameters; ++p) {
                const double extent = extentOf(now.info.parameters[std::size_t(place.parameterOf[p])]);
                if (extent > 0) now.maxError = std::max(now.maxError, errors[p] / extent);
            }
            return now;
        };
        FrameFeed feed(dataset, resampling, memory.readAhead, progress.stop);
        for (std::size_t step = 0; step < times * parameters; ++step) {
            work.advance(done / frames, info.parameters[step % parameters].name);
            FeedStep fed = [&] {
                Stopwatch wait(summary.waitSeconds);
                return feed.next();
            }();
            const std::size_t t = fed.time, p = std::size_t(fed.parameter);
            const volume::Parameter& parameter = info.parameters[p];
            summary.loadSeconds += fed.loadSeconds;
            summary.resampleSeconds += fed.resampleSeconds;
            widenRanges(ranges[p], fed.ranges);
            if (times == 1) settleRanges(info, ranges);
            if (!metadata.alternating) {
                summary.sourceSamples += fed.sourceSamples;
                summary.sourceBytes += fed.sourceBytes;
            } else if (t < source.info.times.size()) { // as many times as the source has
                const std::uint64_t samples = source.info.lattice.count() * fed.fields.size();
                summary.sourceSamples += samples;
                summary.sourceBytes += samples * volume::byteSize(parameter.type);
            }
            FrameOptions frame;
            frame.wavelet = parameter.categorical ? Wavelet::N1 : waveletOf(options.wavelet);
            frame.zstdLevel = options.zstdLevel;
            frame.keepsAbsent = exact && !resamples && options.discard == 0;
            frame.categorical = parameter.categorical;
            frame.importance = options.importance;
            if (options.bccTransform != BccTransform::Auto)
                frame.bodyCentred = options.bccTransform == BccTransform::BodyCentred;
            for (std::size_t c = 0; c < fed.fields.size(); ++c, ++done) {
                Field field = std::move(fed.fields[c]);
                leaveOut(field, metadata.grid, discarded);
                summary.storedSamples += field.count();
                summary.storedBytes += field.samples.size();
                // Bounds refer to the range of the whole archive, where that is known by now.
                const volume::Parameter& whole =
                    grown && relative ? metadata.info.parameters[std::size_t(place.parameterOf[p])] : parameter;
                frame.maxError = exact ? 0 : boundFor(options, whole, field);
                frame.numbers.reset();
                const std::vector<Range>& known = whole.ranges.empty() ? ranges[p] : whole.ranges;
                frame.range = c < known.size() ? known[c] : Range{1, 0};
                const double extent = extentOf(whole);
                double error = frame.maxError * std::abs(field.scale);
                if (thresholds && !parameter.categorical) {
                    Thresholded left = giveUp(std::move(field), metadata.grid, frame, options.threshold, extent);
                    field = std::move(left.field);
                    error = left.maxError * std::abs(field.scale);
                    summary.weakenedBricks += left.weakened;
                    frame.numbers = left.numbers;
                    frame.maxError = std::max(frame.maxError, left.maxError);
                } else if (frame.maxError > 0 && field.type != ScalarType::F32) {
                    field = inSteps(std::move(field), frame.maxError);
                    frame.maxError = 0;
                }
                errors[p] = std::max(errors[p], error);
                Stopwatch code(summary.codeSeconds);
                writer.addFrame(place.parameterOf[p], int(c), int(place.firstTime + t), field, frame,
                                work.part(done / frames, (done + 1) / frames));
            }
            const std::size_t wholeTimes = place.firstTime + t + 1, least = metadata.alternating ? 2 : 1;
            if (p + 1 < parameters || !place.wholeTimes || wholeTimes < least) continue;
            Stopwatch write(summary.writeSeconds);
            writer.commit(soFar(wholeTimes), wholeTimes);
        }
        settleRanges(info, ranges);
        source.info.parameters = info.parameters;
        Stopwatch write(summary.writeSeconds);
        if (!memory.keepFrames && times > 1)
            summary.notes.push_back("memory is too tight to keep frames: what changes from time to time is not noted");
        summary.repeatedBricks = writer.repeats().bricks;
        summary.repeatedBytes = writer.repeats().bytes;
        const Metadata known = soFar(metadata.info.times.size());
        summary.maxError = known.maxError;
        summary.archiveBytes = writer.finish(known);
        summary.addedBytes = summary.archiveBytes - (grown ? grown->fileBytes() : 0);
    }
    progress.advance(1);
    return summary;
}

} // namespace

PackSummary pack(volume::Dataset& source, const PackOptions& asked, const std::string& path, const Progress& progress) {
    const PackOptions options = resolved(asked);
    if (options.sizeMb == 0) return packInto(source, options, path, nullptr, progress);
    const auto trial = [&](const PackOptions& with, const std::string& to, const Progress& part) {
        return packInto(source, with, to, nullptr, part);
    };
    const auto bytesAt = [&](const Progress& part) {
        PackSummary reading;
        gatherAllRanges(source, planMemory({}, source.info, options).readAhead, reading, part.part(0, 0.5));
        const bool toBcc = options.lattice == StoredLattice::BCC && source.info.lattice.kind == LatticeKind::CC;
        const volume::Lattice lattice = toBcc ? volume::bccFor(source.info.lattice) : source.info.lattice;
        return estimateSizes(source, gridFor(lattice, source.info, options), options, toBcc, part.part(0.5, 1));
    };
    return packToSize(options, path, bytesAt, trial, progress);
}

PackSummary append(volume::Dataset& source, const std::string& path, double memoryMb, const Progress& progress) {
    const Archive grown(path);
    PackOptions options = grown.metadata().options;
    options.memoryMb = memoryMb;
    return packInto(source, options, path, &grown, progress);
}

} // namespace tessera::codec
