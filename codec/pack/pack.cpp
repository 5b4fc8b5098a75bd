#include "codec/pack/pack.h"

#include "codec/archive/archive_writer.h"
#include "codec/bytes/stopwatch.h"
#include "codec/pack/continuation.h"
#include "codec/pack/error_bound.h"
#include "codec/pack/frame_queue.h"
#include "codec/pack/given_up.h"
#include "codec/pack/memory_plan.h"
#include "codec/pack/pack_grid.h"
#include "codec/pack/pack_numbers.h"
#include "codec/pack/pack_passes.h"
#include "codec/pack/pack_size.h"
#include "codec/pack/packable.h"
#include "codec/unpack/corrections.h"
#include "volume/field/part_masks.h"
#include "volume/resample/series_dataset.h"
#include "volume/system/mapped_file.h"
#include "volume/system/part_file.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <functional>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::LatticeKind;
using volume::ScalarType;

/// One run of pack or append.
class Packing {
public:
    /// Packs into a new archive, or appends to `grown`, whose options are then `options`.
    Packing(volume::Dataset& source, int slabLayers, const PackedBefore& before, const PackOptions& options,
            const std::string& path, const Archive* grown, SlabTeam* team = nullptr)
        : source_(source), dataset_(source), before_(before), options_(options), path_(path), grown_(grown),
          team_(team) {
        requirePackable(source.info, options);
        assert(!team || (source.read.inParts() && !grown && options.discard == 0 && !hasThreshold(options)));
        metadata_.source =
            before.grid && source.info.lattice.kind == LatticeKind::BCC ? *before.grid : source.info.lattice;
        metadata_.alternating = options.lattice == StoredLattice::D4;
        if (metadata_.alternating) {
            if (grown && bringsTimes(*grown, source.info))
                throw Error("later times cannot be appended to D4*, which is made of a series as a whole", path);
            metadata_.sourceTimes = source.info.times;
            metadata_.sourceQuantities = grown ? grown->metadata().sourceQuantities : source.info.quantities;
            dataset_ = volume::toD4(source, options.resample);
        }
        const volume::DatasetInfo& info = dataset_.info;
        const bool toBcc = options.lattice == StoredLattice::BCC && info.lattice.kind == LatticeKind::CC;
        metadata_.info = info;
        metadata_.info.lattice = toBcc ? volume::bccFor(info.lattice) : info.lattice;
        metadata_.grid = gridFor(metadata_.info.lattice, source.info, options, grown);
        metadata_.lossless = isExact(options) && options.discard == 0 && before.lossless;
        metadata_.program = "tessera";
        metadata_.options = options;
        metadata_.options.memoryMb = 0;                                  // depends on the machine, not on the archive
        if (before.maxError > 0) metadata_.options.ofComponents = false; // former errors are relative to all
        place_ = grown ? continuationOf(*grown, metadata_) : Continuation(info);
        if (grown) {
            metadata_.corrections = grown->metadata().corrections;
            metadata_.numbers = grown->metadata().numbers;
        }
        ranges_.resize(info.parameters.size());
        errors_.assign(info.parameters.size(), 0);
        for (const volume::Parameter& parameter : info.parameters)
            errorsBefore_.push_back(parameter.categorical ? 0 : before.maxError * extentOf(parameter));
        memory_ =
            planMemory(storable(metadata_), source, options, team ? layersOfTeam(metadata_.grid, info) : slabLayers);
        reading_ = {.toBcc = toBcc,
                    .resample = options.resample,
                    .grid = metadata_.grid,
                    .slices = {memory_.slabStep, std::filesystem::path(path).parent_path().string()},
                    .slabLayers = memory_.slabLayers,
                    .ahead = memory_.readAhead,
                    .parts = metadata_.info.lattice.kind == LatticeKind::CC && !metadata_.alternating &&
                             !isExact(options) && !hasThreshold(options),
                    .rangesOnly = false,
                    .team = team};
        if (metadata_.alternating && memory_.slabLayers > 0)
            dataset_.read = volume::toD4(source, options.resample, reading_.slices).read;
        if (toBcc || metadata_.alternating)
            truth_ = source;
        else if (info.lattice.kind == LatticeKind::BCC)
            truth_ = before.source;
    }

    PackSummary run(const Progress& progress);
    /// The unknown ranges of the source, from a pass over it.
    std::vector<std::vector<Range>> ranges(const Progress& progress) {
        return rangesOfAll(dataset_, reading_, summary_, progress);
    }
    /// Estimates the sizes of the archive at several bounds; sets the ranges of the source.
    std::vector<SizeAtBound> estimate(const Progress& progress);

private:
    std::size_t times() const { return dataset_.info.times.size(); }
    bool writes() const { return !team_ || team_->writes(); }
    void sayLimits();
    void gather(const Progress& progress);
    void addStep(ArchiveWriter& writer, QueuedFrames fed, const Progress& progress);
    void addFrame(ArchiveWriter& writer, FrameSamples& samples, int parameter, int component, std::size_t time,
                  const FrameSamples* parts, const Progress& progress);
    Metadata soFar(std::size_t wholeTimes) const;
    bool corrects() const;
    void correct(ArchiveWriter& writer, const Progress& progress);

    volume::Dataset& source_;
    volume::Dataset dataset_;              ///< the data to be stored, before resampling to BCC
    std::optional<volume::Dataset> truth_; ///< what they are made of on the grid of the source, if that is another one
    PackedBefore before_;
    PackOptions options_;
    std::string path_;
    const Archive* grown_;
    SlabTeam* team_; ///< or null
    Metadata metadata_;
    Continuation place_;
    MemoryPlan memory_;
    FrameQueueOptions reading_;
    std::vector<std::vector<Range>> ranges_; ///< found while packing, by parameter
    std::vector<double> errors_;             ///< largest of a sample, by parameter, in its unit
    std::vector<double> errorsBefore_;       ///< previous errors of the source
    std::vector<std::uint8_t> discarded_;    ///< flag per brick
    std::vector<ResampleError> resampled_;   ///< of what has no bound, by parameter; empty: unknown
    PackSummary summary_;
};

/// Computes what must be known of all times before the first one is coded.
void Packing::gather(const Progress& progress) {
    if (metadata_.alternating) { // frames lie between the times of the source, and beyond
        gatherAllRanges(source_, reading_, summary_, progress.part(0, 0.5));
        dataset_.info.parameters = source_.info.parameters;
    } else if (isRelative(options_) && (times() > 1 || grown_)) {
        gatherAllRanges(dataset_, reading_, summary_, progress);
    }
    if (grown_ && isRelative(options_)) place_.widen(dataset_.info, metadata_.info);
    if (options_.discard > 0)
        discarded_ = bricksToDiscard(dataset_, reading_, options_, summary_, progress.part(0.8, 1));
}

/// Metadata with the ranges known so far, since the archive is readable at any time.
Metadata Packing::soFar(std::size_t wholeTimes) const {
    volume::DatasetInfo read = dataset_.info;
    settleRanges(read, ranges_);
    Metadata now = metadata_;
    if (wholeTimes < now.info.times.size()) // D4*: only the source times that the frames so far cover
        std::erase_if(now.sourceTimes, [&](double time) { return time > now.info.times[wholeTimes - 1]; });
    place_.widen(read, now.info);
    place_.noteResampled(before_.resampled, resampled_, now);
    for (std::size_t p = 0; p < errors_.size(); ++p) {
        const double extent = extentOf(now.info.parameters[std::size_t(place_.parameterOf[p])]);
        if (extent > 0) now.maxError = std::max(now.maxError, (errorsBefore_[p] + errors_[p]) / extent);
    }
    return now;
}

void Packing::addFrame(ArchiveWriter& writer, FrameSamples& samples, int parameter, int component, std::size_t time,
                       const FrameSamples* parts, const Progress& progress) {
    const auto p = std::size_t(parameter), c = std::size_t(component);
    const volume::Parameter& about = dataset_.info.parameters[p];
    const bool exact = isExact(options_), resamples = reading_.toBcc || metadata_.alternating;
    FrameOptions frame;
    frame.wavelet = about.categorical ? Wavelet::N1 : waveletOf(options_.wavelet);
    frame.effort = options_.effort;
    frame.zstdLevel = options_.zstdLevel;
    frame.mostPredicted = options_.mostPredicted;
    frame.keepsAbsent = exact && !resamples && options_.discard == 0;
    frame.categorical = about.categorical;
    frame.mayMix = !before_.ofSeries;
    frame.importance = options_.importance;
    if (options_.bccTransform != BccTransform::Auto)
        frame.bodyCentred = options_.bccTransform == BccTransform::BodyCentred;
    // Bounds are relative to the range over the whole archive, if it is known.
    const volume::Parameter& whole =
        grown_ && isRelative(options_) ? metadata_.info.parameters[std::size_t(place_.parameterOf[p])] : about;
    const std::vector<Range>& known = whole.ranges.empty() ? ranges_[p] : whole.ranges;
    frame.range = c < known.size() ? known[c] : Range{1, 0};

    leaveOut(samples, metadata_.grid, discarded_);
    const volume::Parameter relativeTo = boundedBy(options_, whole, c);
    const FrameBound bound = exact ? FrameBound() : boundFor(options_, relativeTo, samples);
    frame.maxError = bound.error;
    frame.rms = bound.rms;
    frame.mostError = bound.mostError;
    double error = frame.maxError * std::abs(samples.scale());
    std::optional<FrameSamples> rounded; // integers
    if (hasThreshold(options_) && !about.categorical) {
        const double scale = std::abs(samples.scale());
        const Thresholded left = giveUp(samples, metadata_.grid, frame, options_.threshold, extentOf(relativeTo));
        summary_.weakenedBricks += left.weakened;
        frame.numbers = left.numbers;
        frame.maxError = std::max(frame.maxError, left.maxError);
        frame.spent = left.maxError;
        // Bricks of floats may repeat earlier ones within the remaining part of the bound.
        const bool mayRepeat = left.numbers.kind == NumberKind::Quantised && place_.firstTime + time > 0;
        error = (mayRepeat ? frame.maxError : left.maxError) * scale;
    } else if (samples.type() != ScalarType::F32) {
        if (bound.step > 1 || bound.error >= 1 || bound.rms > 0)
            rounded =
                samples.changed("rounded", [&](Field part, Slab) { return countedIn(std::move(part), bound.step); });
        frame.maxError = std::floor(bound.error);
    }
    Stopwatch code(summary_.codeSeconds);
    const std::optional<double> measured =
        writer.addFrame(place_.parameterOf[p], component, int(place_.firstTime + time), rounded ? *rounded : samples,
                        frame, progress, rounded ? &samples : nullptr, parts);
    if (measured) error = *measured * std::abs(samples.scale());
    errors_[p] = std::max(errors_[p], error);
}

void Packing::addStep(ArchiveWriter& writer, QueuedFrames fed, const Progress& progress) {
    const auto p = std::size_t(fed.parameter);
    const volume::Parameter& parameter = dataset_.info.parameters[p];
    summary_.loadSeconds += fed.loadSeconds;
    summary_.resampleSeconds += fed.resampleSeconds;
    widenRanges(ranges_[p], fed.ranges);
    if (times() == 1) settleRanges(dataset_.info, ranges_);
    if (!metadata_.alternating) {
        summary_.sourceSamples += fed.sourceSamples;
        summary_.sourceBytes += fed.sourceBytes;
    } else if (fed.time < source_.info.times.size()) { // as many times as the source has
        const std::uint64_t samples = source_.info.lattice.count() * fed.frames.size();
        summary_.sourceSamples += samples;
        summary_.sourceBytes += samples * volume::byteSize(parameter.type);
    }
    const double frames = double(fed.frames.size());
    for (std::size_t c = 0; c < fed.frames.size(); ++c) {
        summary_.storedSamples += fed.frames[c].count();
        summary_.storedBytes += fed.frames[c].count() * volume::byteSize(parameter.type);
        addFrame(writer, fed.frames[c], fed.parameter, int(c), fed.time, fed.parts ? &*fed.parts : nullptr,
                 progress.part(double(c) / frames, double(c + 1) / frames));
    }
    const std::size_t wholeTimes = place_.firstTime + fed.time + 1, least = metadata_.alternating ? 2 : 1;
    if (p + 1 < dataset_.info.parameters.size() || !place_.wholeTimes || wholeTimes < least || !writes()) return;
    Stopwatch write(summary_.writeSeconds);
    writer.commit(wholeTimes, [&] { return soFar(wholeTimes); });
}

std::vector<SizeAtBound> Packing::estimate(const Progress& progress) {
    gatherAllRanges(dataset_, reading_, summary_, progress.part(0, 0.5));
    source_.info.parameters = dataset_.info.parameters;
    return estimateSizes(dataset_, reading_, options_, progress.part(0.5, 1));
}

void Packing::sayLimits() {
    if (!memory_.keepFrames && times() > 1)
        summary_.notes.push_back(
            std::string(team_ ? "slabs are packed apart" : "too little memory to keep the previous time") +
            ": changes of bricks between times are not stored");
    if (truth_ && !memory_.corrects)
        summary_.notes.push_back(
            "too little memory for corrections: bounds and labels are those of the stored lattice");
    if (memory_.slabLayers > 0 && !team_)
        summary_.notes.push_back("too little memory for a whole time; slabs in memory at once: " +
                                 std::to_string(memory_.slabLayers));
}

/// Whether the archive gets corrections. They need whole frames, of the same parts that a reader sees.
bool Packing::corrects() const {
    const auto knowsParts = [&](const volume::Parameter& parameter) {
        return parameter.categorical || parameter.parts.count() < 2 || volume::labelOf(metadata_.info, parameter) >= 0;
    };
    return truth_ && memory_.corrects && options_.discard == 0 && (!grown_ || isCorrected(*grown_)) &&
           std::ranges::all_of(metadata_.info.parameters, knowsParts);
}

/// Adds the corrections of all that was added.
void Packing::correct(ArchiveWriter& writer, const Progress& progress) {
    Corrections made = correctionsOf(writer.written(soFar(metadata_.info.times.size())), *truth_,
                                     {place_.parameterOf, int(place_.firstTime)}, options_);
    struct Removed {
        std::string path;
        ~Removed() {
            std::error_code ignored;
            std::filesystem::remove(path, ignored);
        }
    } const file{path_ + ".corrections"}; // of this name: what a killed process left is replaced
    (void)pack(made.data, made.options, file.path, progress, {.keepsNumbers = false});
    const MappedFile inner(file.path);
    metadata_.corrections.push_back(writer.addPart(inner.part({0, inner.size()}).bytes(), kCorrections));
    for (std::size_t p = 0; p < errors_.size(); ++p) {
        errors_[p] = std::max(errors_[p], made.bounds[p]);
        (*made.errors)[p] = joined(errorsBefore_[p], (*made.errors)[p]);
    }
    if (std::ranges::all_of(made.bounds, [](double bound) { return bound == 0; })) resampled_ = *made.errors;
}

PackSummary Packing::run(const Progress& progress) {
    {
        Stopwatch all(summary_.seconds);
        const bool passes =
            metadata_.alternating || (isRelative(options_) && (times() > 1 || grown_ || options_.discard > 0));
        const double begin = passes ? 0.3 : 0;
        gather(progress.part(0, begin));
        const bool hasNumbers = !metadata_.lossless && before_.keepsNumbers;
        const double numbersBegin = hasNumbers ? 0.9 : 1;
        const Progress work = progress.part(begin, corrects() ? 0.6 : numbersBegin);
        summary_.bricks = metadata_.grid.brickCount();
        const auto writer = grown_ ? std::make_unique<ArchiveWriter>(*grown_, metadata_, memory_.keepFrames)
                                   : std::make_unique<ArchiveWriter>(path_, metadata_, memory_.keepFrames);
        FrameQueue feed(dataset_, reading_, progress.stop);
        const std::vector<volume::Parameter>& parameters = dataset_.info.parameters;
        const std::size_t steps = times() * parameters.size();
        const double frames = double(times()) * double(componentCount(dataset_.info));
        double done = 0;
        for (std::size_t step = 0; step < steps; ++step) {
            work.advance(done / frames, parameters[step % parameters.size()].name);
            QueuedFrames fed = [&] {
                Stopwatch wait(summary_.waitSeconds);
                return feed.next();
            }();
            const double more = double(fed.frames.size());
            addStep(*writer, std::move(fed), work.part(done / frames, (done + more) / frames));
            done += more;
        }
        settleRanges(dataset_.info, ranges_);
        source_.info.parameters = dataset_.info.parameters;
        if (!writes()) return summary_;
        if (corrects()) correct(*writer, progress.part(0.6, numbersBegin));
        if (hasNumbers) {
            volume::Dataset original = truth_ ? *truth_ : source_;
            original.info.parameters = source_.info.parameters; // with ranges
            const std::string note =
                addNumbers(*writer, original, before_, grown_, memory_, metadata_, progress.part(numbersBegin, 1));
            if (!note.empty()) summary_.notes.push_back(note);
        }
        Stopwatch write(summary_.writeSeconds);
        sayLimits();
        summary_.repeatedBricks = writer->repeats().bricks;
        summary_.repeatedBytes = writer->repeats().bytes;
        const Metadata known = soFar(metadata_.info.times.size());
        summary_.maxError = known.maxError;
        summary_.archiveBytes = writer->finish(known);
        summary_.addedBytes = summary_.archiveBytes - (grown_ ? grown_->fileBytes() : 0);
    }
    progress.advance(1);
    return summary_;
}

} // namespace

PackSummary pack(volume::Dataset& source, const PackOptions& options, const std::string& output,
                 const Progress& progress, const PackedBefore& before, int slabLayers, SlabTeam* team) {
    const std::string path = replacedFile(output);
    if (std::filesystem::is_directory(path)) throw Error("is a folder", path);
    const auto packing = [&](const PackOptions& with, const std::string& to) {
        return Packing(source, slabLayers, before, with, to, nullptr, team);
    };
    if (options.sizeMb == 0) return packing(options, path).run(progress);
    const auto trial = [&](const PackOptions& with, const std::string& to, const Progress& part) {
        return packing(with, to).run(part);
    };
    const auto bytesAt = [&](const Progress& part) {
        PackOptions plain = options;
        plain.lossless = true;
        return packing(plain, path).estimate(part);
    };
    return packToSize(options, sizeControlFor(source.info), path, bytesAt, trial, progress);
}

std::vector<std::vector<Range>> unknownRanges(volume::Dataset& source, const PackOptions& options,
                                              const std::string& path, const Progress& progress, SlabTeam* team) {
    return Packing(source, 0, {}, options, path, nullptr, team).ranges(progress);
}

PackSummary append(volume::Dataset& source, const std::string& path, double memoryMb, const Progress& progress,
                   const PackedBefore& before, int slabLayers) {
    const auto grown = std::make_shared<const Archive>(path);
    PackOptions options = grown->metadata().options;
    options.memoryMb = memoryMb;
    std::optional<volume::Dataset> further = withoutKnownLabels(source, grown);
    if (!further) return Packing(source, slabLayers, before, options, path, grown.get()).run(progress);
    PackedBefore beside = before;
    beside.whole = source;
    PackSummary summary = Packing(*further, slabLayers, beside, options, path, grown.get()).run(progress);
    for (volume::Parameter& parameter : source.info.parameters)
        for (const volume::Parameter& made : further->info.parameters)
            if (made.name == parameter.name) parameter.ranges = made.ranges;
    return summary;
}

} // namespace tessera::codec
