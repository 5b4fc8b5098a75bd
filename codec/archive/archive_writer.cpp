#include "codec/archive/archive_writer.h"

#include "codec/archive/archive_impl.h"
#include "codec/archive/archive_state.h"
#include "codec/archive/brick_access.h"
#include "codec/archive/brick_input.h"
#include "codec/archive/coded_bricks.h"
#include "codec/archive/commits.h"
#include "codec/archive/frame_coding.h"
#include "codec/archive/frame_model.h"
#include "codec/archive/frame_steps.h"
#include "codec/archive/mask_frames.h"
#include "codec/brick/quantum_search.h"
#include "codec/container/growing_file.h"
#include "codec/container/mask_hash.h"
#include "volume/base/parallel.h"
#include "volume/field/part_masks.h"

#include <algorithm>
#include <cassert>
#include <map>

namespace tessera::codec {

struct ArchiveWriter::Impl {
    GrowingFile file;
    Metadata metadata;
    Commits commits;
    std::size_t models = 0, masks = 0; ///< written so far
    IndexPage page;                    ///< additions since the last commit
    Index known;                       ///< what was committed
    std::map<MaskHash::Value, int> maskByHash;
    std::map<std::size_t, KnownModel> lastModel; ///< per component
    bool keepsFrames = true;
    Archive::Repeats repeats;
    /// Per component, and on D4* per parity. Missing: changes are unknown.
    std::map<std::pair<std::size_t, int>, SeenFrame> lastFrames;

    int step() const { return metadata.alternating ? 2 : 1; } ///< time steps between frames on the same grid

    explicit Impl(const std::string& path) : file(path) {}
    Impl(const std::string& path, Commits so) : file(path, so.header), commits(std::move(so)) {}

    /// Whether coarse coefficients of a component mix samples that a reader must not mix (in more than one brick).
    bool mixesParts(std::size_t component) const;
    int maskFor(const FrameSamples& samples, int zstdLevel);
    /// Or the steps of a frame. `idle`: the frame codes no token with the model.
    void writeModel(const Model& model, bool idle, std::size_t component, FrameRecord& frame);
    const SeenFrame* frameBefore(const FrameRecord& frame, const FrameSamples& samples) const;
    /// `steps`: of the frame, or null.
    std::vector<std::uint8_t> repeated(const SeenFrame* before, const FrameSamples& samples, const FrameRecord& frame,
                                       const FrameOptions& options, const SteppedFrame* steps) const;
    /// Determines all coding parameters of a frame. `unrounded`: as of addFrame.
    FrameCoding prepare(int time, std::size_t component, const FrameSamples& samples, const FrameOptions& options,
                        const FrameSamples* unrounded, const FrameSamples* parts);
    /// Codes coefficients that are quantised.
    void useSteps(FrameCoding& coding, SteppedFrame steps, const FrameOptions& options,
                  const FrameSamples* unrounded) const;
    /// Index of the steps of a frame; -1: they are not written yet.
    std::int32_t modelOfSteps(const FrameRecord& frame) const;
    /// Codes a frame, as often as it takes to meet a bound of its mean error; true if no token was coded.
    bool codeFrame(FrameCoding& coding, const FrameOptions& options, CodedBricks& coded, const Progress& progress);
};

bool ArchiveWriter::Impl::mixesParts(std::size_t component) const {
    const volume::BrickGrid& grid = metadata.grid;
    if (grid.levels == 1 || grid.count() == glm::ivec3(1)) return false;
    const volume::Parameter& parameter = metadata.info.parameters[parameterOf(metadata.info, component)];
    return parameter.categorical ? parameter.components == 1 : volume::labelOf(metadata.info, parameter) >= 0;
}

/// Index of a frame's mask, which is written if it is new; -1 if all samples are present.
int ArchiveWriter::Impl::maskFor(const FrameSamples& samples, int zstdLevel) {
    if (!samples.masked()) return -1;
    MaskHash hash;
    samples.forSlabs([&](const volume::Field& part, Slab) {
        hash.add(part);
        return true;
    });
    if (!hash.gaps()) return -1;
    const auto [found, isNew] = maskByHash.try_emplace(hash.value(), int(masks));
    if (!isNew) return found->second;

    ++masks;
    page.masks.push_back(writeMask(samples, metadata.grid, zstdLevel, file));
    return found->second;
}

void ArchiveWriter::Impl::writeModel(const Model& chosen, bool idle, std::size_t component, FrameRecord& frame) {
    const Model model = idle ? makeModel(Histogram(metadata.grid.levels, {}), 1) : chosen;
    const bool isStepped = frame.numbers.kind == NumberKind::Stepped;
    const Bytes bytes = isStepped                                           ? serialise(frame.steps)
                        : idle && (commits.header.features & kCompact) != 0 ? Bytes()
                                                                            : serialise(model);
    if (!isStepped && !model.fitted.empty()) commits.header.features |= kFittedModels;
    frame.model = static_cast<std::int32_t>(models++);
    page.models.push_back({file.position(), bytes.size(), checksum(bytes)});
    file.append(bytes);
    lastModel[component] = {frame.model, model, frame.wavelet, frame.numbers.kind, frame.codeBits, frame.bodyCentred,
                            frame.steps, 0};
}

/// The previous frame of the component on the same grid, if it is in memory and has the same scale and offset.
const SeenFrame* ArchiveWriter::Impl::frameBefore(const FrameRecord& frame, const FrameSamples& samples) const {
    const int time = int(frame.time);
    const auto found = lastFrames.find({frame.component, time % step()});
    if (found == lastFrames.end() || found->second.time != time - step()) return nullptr;
    const volume::Field& before = found->second.field;
    return before.offset == samples.offset() && before.scale == samples.scale() ? &found->second : nullptr;
}

/// Flags of the bricks that can be stored as repeats.
std::vector<std::uint8_t> ArchiveWriter::Impl::repeated(const SeenFrame* before, const FrameSamples& samples,
                                                        const FrameRecord& frame, const FrameOptions& options,
                                                        const SteppedFrame* steps) const {
    constexpr int kFurthest = 65535;
    // The quantum of the time before may have been larger, and the bound only serves the mean.
    constexpr double kLarger = 1.5, kWorse = 1.25;
    const double ofCodes = steps ? steps->maxError : boundOf(frame, options);
    const double maxError = steps ? std::min(options.mostError, kLarger * ofCodes) : ofCodes;
    std::vector<std::uint8_t> flags(metadata.grid.brickCount(), 0);
    if (!before || (commits.header.features & kBrickNotes) == 0) return flags;
    parallelRanges(flags.size(), [&](std::size_t begin, std::size_t end) {
        BrickInput was, is, coded;
        PreparedBrick prepared;
        SplitMemory memory;
        for (std::size_t b = begin; b < end; ++b) {
            if (before->bricks[b].notes.repeats + step() > kFurthest) continue;
            const glm::ivec3 brick = metadata.grid.indexOf(b);
            was.take(metadata.grid, brick, before->field, before->field.mask != nullptr);
            is.take(metadata.grid, brick, samples, frame.mask >= 0);
            const bool absentToo = frame.keepsAbsent && !is.present.empty();
            if (absentToo && !before->keepsAbsent) continue;
            flags[b] = mayStandFor(samples.type(), was, is, maxError, absentToo) ? 1 : 0;
            if (flags[b] == 0 || !(options.rms > 0)) continue;
            coded = is;
            const BrickFormat format = brickFormat(metadata.grid, brick, samples.type(), frame);
            if (steps)
                prepared = prepareBrick(format, is.samples, is.present, ofCodes, {}, memory); // as if of one part
            roundAsDecoded(format, ofCodes, prepared.decoded, coded);
            const double squares = errorsOf(samples.type(), coded, is).squares;
            flags[b] = errorsOf(samples.type(), was, is).squares <= (steps ? kWorse : 1) * squares ? 1 : 0;
        }
    });
    return flags;
}

std::int32_t ArchiveWriter::Impl::modelOfSteps(const FrameRecord& frame) const {
    const auto last = lastModel.find(frame.component);
    const bool same =
        last != lastModel.end() && last->second.kind == NumberKind::Stepped && last->second.steps == frame.steps;
    return same ? last->second.number : -1;
}

ArchiveWriter::ArchiveWriter(const std::string& path, const Metadata& metadata, bool keepsFrames)
    : impl_(std::make_unique<Impl>(path)) {
    impl_->metadata = storable(metadata);
    impl_->keepsFrames = keepsFrames;
    // A volume of one brick is read as quickly as its statistics would be, and they would be a large part of its size.
    if (metadata.grid.count() == glm::ivec3(1)) impl_->commits.header.features &= ~kBrickStatistics;
    if (!metadata.source.isEven()) impl_->commits.header.features |= kUnevenAxes;
}

ArchiveWriter::ArchiveWriter(const Archive& archive, const Metadata& metadata, bool keepsFrames) {
    const bool laterTimes = metadata.info.times.size() > archive.info().times.size();
    ArchiveState state = stateOf(archive, keepsFrames && laterTimes);
    impl_ = std::make_unique<Impl>(archive.path(), commitsOf(archive, state));
    impl_->metadata = storable(metadata);
    impl_->known = archive.impl_->index;
    impl_->keepsFrames = keepsFrames;
    impl_->models = state.models;
    impl_->masks = state.masks;
    for (const auto& [number, hash] : state.lastMasks) impl_->maskByHash.emplace(hash, number);
    for (std::size_t c = 0; c < state.lastModels.size(); ++c)
        impl_->lastModel.emplace(c, std::move(state.lastModels[c]));
    for (auto& [component, frame] : state.lastFrames)
        impl_->lastFrames.emplace(std::pair(component, frame.time % impl_->step()), std::move(frame));
}

ArchiveWriter::~ArchiveWriter() = default;

void ArchiveWriter::Impl::useSteps(FrameCoding& coding, SteppedFrame steps, const FrameOptions& options,
                                   const FrameSamples* unrounded) const {
    FrameRecord& frame = coding.frame;
    coding.rounded = {frame, coding.samples, coding.before, coding.repeated};
    codec::useSteps(steps, frame);
    coding.maxError = steps.maxError;
    if (unrounded) {
        coding.samples = unrounded;
        coding.before = frameBefore(frame, *unrounded);
        frame.valueOffset = unrounded->offset();
        frame.valueScale = unrounded->scale();
        frame.mixed = false;
    }
    if (steps.mean || unrounded)
        coding.repeated = repeated(coding.before, *coding.samples, frame, options, steps.mean ? &steps : nullptr);
    coding.taken.bricks.clear();
    coding.taken.bricks.resize(coding.grid.brickCount());
    for (auto& [number, brick] : steps.bricks) coding.taken.bricks[number] = std::move(brick);
    frame.model = modelOfSteps(frame);
    coding.steps = std::move(steps);
    coding.errors.resize(coding.grid.brickCount());
}

FrameCoding ArchiveWriter::Impl::prepare(int time, std::size_t component, const FrameSamples& samples,
                                         const FrameOptions& options, const FrameSamples* unrounded,
                                         const FrameSamples* parts) {
    const volume::BrickGrid& grid = metadata.grid;
    FrameCoding coding(grid);
    coding.samples = &samples;
    coding.parts = parts;
    FrameRecord& frame = coding.frame;
    frame.time = static_cast<std::uint32_t>(time);
    frame.component = static_cast<std::uint32_t>(component);
    frame.mask = maskFor(samples, options.zstdLevel);
    const auto found = lastModel.find(component);
    const KnownModel* const last = found == lastModel.end() ? nullptr : &found->second;
    SampleNumbers numbers(samples);
    frame.numbers = options.numbers ? *options.numbers : chooseNumbers(grid, numbers, last, options);
    frame.wavelet = options.wavelet.value_or(Wavelet::W22);
    frame.keepsAbsent = options.keepsAbsent && frame.mask >= 0;
    frame.valueOffset = samples.offset();
    frame.valueScale = samples.scale();
    frame.codeBits = codeBitsOf(numbers, frame.numbers);
    if (mixesParts(component)) {
        frame.subsampled = true;
        commits.header.features |= kSubsamples;
    }
    // Series are played, for which mixed bricks are decoded too slowly.
    frame.mixed = options.mayMix && metadata.info.times.size() == 1 && frame.numbers.kind == NumberKind::Integer;
    coding.maxError = boundOf(frame, options);
    coding.before = frameBefore(frame, samples);
    coding.repeated = repeated(coding.before, samples, frame, options, nullptr);
    coding.importance = importanceOfBricks(grid, samples, options.range, options.categorical, options.importance);
    const bool byBand = (commits.header.features & kBandContexts) != 0;
    coding.model = chooseModel(grid, samples, last, byBand, frame, options, coding.taken);
    const TimeBefore earlier{last, unrounded ? frameBefore(frame, *unrounded) : coding.before, time / step()};
    SampleNumbers ofUnrounded(unrounded ? *unrounded : samples);
    if (auto steps = chooseSteps(grid, unrounded ? ofUnrounded : numbers, frame, coding.model, options, earlier,
                                 coding.taken, unrounded ? &samples : nullptr, parts)) {
        useSteps(coding, std::move(*steps), options, unrounded);
    } else if (!coding.taken.serves(frame, coding.model)) {
        coding.taken.bricks.clear();
    }
    coding.step = step();
    coding.mostPredicted = options.mostPredicted;
    coding.statistics = (commits.header.features & kBrickStatistics) != 0;
    // The last frame only needs its change, not to be kept.
    const bool isLast = std::size_t(time + step()) >= metadata.info.times.size();
    coding.keeps = keepsFrames && (coding.before || !isLast);
    coding.seen = {
        time, frame.keepsAbsent, frame.mask, coding.keeps ? *coding.samples->whole() : volume::Field(), {}, {}, {}};
    const std::size_t bricks = grid.brickCount();
    coding.taken.bricks.resize(bricks);
    coding.seen.bytes.resize(bricks);
    coding.seen.depth.resize(bricks);
    coding.whole.resize(bricks);
    coding.mixed.resize(bricks);
    frame.bricks.resize(bricks);
    frame.segments.resize(bricks * std::size_t(grid.levels));
    return coding;
}

bool ArchiveWriter::Impl::codeFrame(FrameCoding& coding, const FrameOptions& options, CodedBricks& coded,
                                    const Progress& progress) {
    constexpr int kTrials = 8;
    const ZstdUse zstd{zstdLevelFor(*coding.samples, options.zstdLevel, options.effort),
                       (commits.header.features & kCompact) != 0};
    if (!coding.measures()) return codeBricks(coding, *coding.samples, zstd, coded, progress);
    double done = 0;
    const auto code = [&] {
        const double half = (1 + done) / 2; // of what is left, since nobody knows how often it takes
        coded.clear();
        const bool allWhole = codeBricks(coding, *coding.samples, zstd, coded, progress.part(done, half));
        done = half;
        return allWhole;
    };
    const MeanBound& mean = *coding.steps->mean;
    const auto isRepeat = [](std::uint8_t flag) { return flag != 0; };
    bool allWhole = false;
    const auto meets = [&](double first) {
        QuantumSearch search(mean.allowed, kTrials, mean.largestQuantum(), mean.power);
        for (std::optional<double> next = first; next;) {
            if (!coding.restart(*next)) return false;
            allWhole = code();
            const auto [own, ofRepeats] = coding.squares();
            if (std::ranges::all_of(coding.repeated, isRepeat)) return ofRepeats <= mean.allowed;
            next = search.next(mean.quantum, own, ofRepeats);
        }
        if (search.best() == mean.quantum) return true;
        if (search.best() == 0 || !coding.restart(search.best())) return false;
        allWhole = code();
        return true;
    };
    bool met = meets(mean.quantum);
    if (!met && std::ranges::any_of(coding.repeated, isRepeat)) {
        // Repeated bricks may leave too little of the error to the others.
        std::ranges::fill(coding.repeated, std::uint8_t(0));
        met = meets(mean.quantum);
    }
    if (!met) {
        coding.restartRounded(boundOf(coding.rounded.frame, options));
        return code();
    }
    coding.frame.model = modelOfSteps(coding.frame);
    return allWhole;
}

std::optional<double> ArchiveWriter::addFrame(int parameter, int component, int time, const FrameSamples& samples,
                                              const FrameOptions& options, const Progress& progress,
                                              const FrameSamples* unrounded, const FrameSamples* parts) {
    const volume::BrickGrid& grid = impl_->metadata.grid;
    const volume::DatasetInfo& info = impl_->metadata.info;
    const std::size_t ofTime = firstComponent(info, parameter) + std::size_t(component);
    assert(samples.lattice().size == grid.lattice.size && samples.lattice().kind == grid.lattice.kind);
    assert(samples.type() == info.parameters[std::size_t(parameter)].type);
    assert(samples.whole() || !impl_->keepsFrames);

    FrameCoding coding = impl_->prepare(time, ofTime, samples, options, unrounded, parts);
    FrameRecord& frame = coding.frame;
    const std::size_t bricks = grid.brickCount(), levels = std::size_t(grid.levels);
    CodedBricks coded(bricks, levels, samples.store() ? &samples.store()->folder : nullptr);
    const bool allWhole = impl_->codeFrame(coding, options, coded, progress);
    const auto measured = [&]() -> std::optional<double> {
        if (!coding.measures()) return std::nullopt;
        double largest = 0;
        for (const SampleErrors& errors : coding.errors) largest = std::max(largest, errors.largest);
        return largest;
    };
    if (coding.steps) impl_->commits.header.features |= kSteppedBricks;
    if (coding.steps && unrounded) impl_->commits.header.features |= kSteppedIntegers;
    if (frame.predicted) impl_->commits.header.features |= kPredictedFrames;
    if (frame.parted) impl_->commits.header.features |= kPartedFrames;
    if (std::ranges::any_of(coding.mixed, [](std::uint8_t flag) { return flag != 0; }))
        impl_->commits.header.features |= kMixedBricks;
    // Without bands the frame needs no tables.
    const bool idle = allWhole || frame.numbers.kind == NumberKind::Stepped;
    if (frame.model < 0) impl_->writeModel(coding.model, idle, ofTime, frame);
    impl_->lastModel[ofTime].quantum = quantumOf(frame, frame.steps);
    impl_->lastModel[ofTime].parted = frame.parted;
    if (samples.team() && !samples.team()->writes()) return measured(); // models are known alike, for later times
    GrowingFile& file = impl_->file;
    frame.offset = file.position();
    for (std::size_t s = 0; s < levels; ++s)
        for (std::size_t b = 0; b < bricks; ++b) {
            const Bytes bytes = coded.take(b, s);
            frame.segments[s * bricks + b] = {file.position(), static_cast<std::uint32_t>(bytes.size()),
                                              checksum(bytes)};
            file.append(bytes);
        }
    frame.length = file.position() - frame.offset;
    for (std::size_t b = 0; b < bricks; ++b)
        if (coding.repeated[b] != 0) impl_->repeats.bricks += 1, impl_->repeats.bytes += coding.seen.bytes[b];
    const bool isLast = std::size_t(time + impl_->step()) >= info.times.size();
    if (coding.keeps && !isLast) {
        coding.seen.bricks = frame.bricks;
        impl_->lastFrames[{ofTime, time % impl_->step()}] = std::move(coding.seen);
    }
    impl_->page.frames.push_back(std::move(frame));
    return measured();
}

Archive::Repeats ArchiveWriter::repeats() const {
    return impl_->repeats;
}

std::shared_ptr<const Archive> ArchiveWriter::written(const Metadata& metadata) const {
    const std::string& path = impl_->file.readablePath();
    auto impl = std::make_unique<Archive::Impl>(path, impl_->commits.header);
    Index index = impl_->known;
    add(impl_->page, index);
    std::ranges::sort(index.frames, {},
                      [](const FrameRecord& frame) { return std::pair(frame.time, frame.component); });
    index.times = metadata.info.times;
    impl->metadata = metadata;
    impl->index = std::move(index);
    impl->settle();
    return std::shared_ptr<const Archive>(new Archive(std::move(impl)));
}

FileRange ArchiveWriter::addPart(std::span<const std::byte> bytes, std::uint32_t feature) {
    const FileRange range{impl_->file.position(), bytes.size()};
    impl_->file.append(bytes);
    impl_->commits.header.features |= feature;
    return range;
}

void ArchiveWriter::commit(std::size_t times, const std::function<Metadata()>& metadata) {
    if (impl_->commits.waits(impl_->file)) return;
    const auto page = impl_->commits.commit(impl_->file, impl_->page, metadata(), times, false);
    if (page) add(*page, impl_->known);
}

std::uint64_t ArchiveWriter::finish(const Metadata& metadata) {
    impl_->commits.commit(impl_->file, impl_->page, metadata, metadata.info.times.size(), true);
    impl_->file.finish();
    return impl_->commits.header.fileSize;
}

} // namespace tessera::codec
