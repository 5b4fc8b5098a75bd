#include "codec/pack/frame_queue.h"

#include "codec/bytes/stopwatch.h"
#include "volume/base/number_extent.h"
#include "volume/field/part_masks.h"
#include "volume/field/stored_range.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

namespace tessera::codec {

namespace {

using volume::Field;

constexpr Range kNothing{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

void include(Range& range, double value) {
    if (!std::isfinite(value)) return;
    range.lo = std::min(range.lo, value);
    range.hi = std::max(range.hi, value);
}

/// Ranges of a parameter at one time: those of the components, then of the magnitude.
std::vector<Range> rangesOf(const std::vector<Field>& components) {
    const std::size_t n = components.size();
    std::vector<Range> ranges(n == 1 ? 1 : n + 1, kNothing);
    for (std::size_t c = 0; c < n; ++c) {
        const Field& field = components[c];
        Range range = kNothing;
        volume::dispatch(field.type, [&]<class T>(T) {
            const auto stored = field.as<T>();
            if constexpr (!std::same_as<T, float>)
                if (!field.mask && !stored.empty()) {
                    const volume::NumberExtent<T> extent = volume::extentOfNumbers(std::span<const T>(stored));
                    range = {static_cast<double>(extent.least), static_cast<double>(extent.most)};
                    return;
                }
            for (std::size_t i = 0; i < stored.size(); ++i)
                if (field.present(i)) include(range, static_cast<double>(stored[i]));
        });
        if (range.lo > range.hi) continue;
        include(ranges[c], field.offset + field.scale * range.lo);
        include(ranges[c], field.offset + field.scale * range.hi);
    }
    for (std::size_t i = 0; n > 1 && i < components.front().count(); ++i) {
        double square = 0;
        bool present = true;
        for (const Field& field : components) {
            present = present && field.present(i);
            const double value = field.value(i);
            square += value * value;
        }
        if (present) include(ranges[n], std::sqrt(square));
    }
    return ranges;
}

/// Of one component in some slices of a frame.
struct ExtentOfRun {
    volume::StoredExtent stored;
    Range range{kNothing}, magnitude{kNothing}; ///< magnitude: of all components together
};

std::vector<ExtentOfRun> extentsOf(const std::vector<Field>& components, bool isRanged) {
    const std::vector<Range> ranges = isRanged ? std::vector<Range>() : rangesOf(components);
    std::vector<ExtentOfRun> extents(components.size());
    for (std::size_t c = 0; c < components.size(); ++c) {
        extents[c].stored.add(components[c]);
        if (!isRanged) extents[c].range = ranges[c], extents[c].magnitude = ranges.back();
    }
    return extents;
}

Field checked(Field field, const volume::Parameter& about, glm::ivec3 size, std::size_t time) {
    if (field.lattice.size != size || field.type != about.type)
        throw Error("frame " + std::to_string(time) + " of " + about.name + " has another size or type");
    return field;
}

} // namespace

void widenRanges(std::vector<Range>& ranges, const std::vector<Range>& more) {
    if (ranges.empty()) ranges.resize(more.size(), kNothing);
    for (std::size_t r = 0; r < more.size(); ++r) {
        ranges[r].lo = std::min(ranges[r].lo, more[r].lo);
        ranges[r].hi = std::max(ranges[r].hi, more[r].hi);
    }
}

FrameQueue::FrameQueue(const volume::Dataset& dataset, FrameQueueOptions options, std::stop_token stop)
    : dataset_(options.toBcc ? volume::withParts(dataset) : dataset), options_(std::move(options)),
      stop_(std::move(stop)), steps_(dataset_.info.times.size() * dataset_.info.parameters.size()) {}

FrameQueue::~FrameQueue() {
    if (coming_.valid()) coming_.wait();
}

std::vector<volume::SlicedFrame> FrameQueue::source(QueuedFrames& step, const volume::Parameter& parameter) const {
    const volume::Lattice& lattice = dataset_.info.lattice;
    std::vector<volume::SlicedFrame> frames;
    for (int c = 0; c < parameter.components; ++c) {
        const auto read = [this, &parameter, number = step.parameter, c, time = step.time](int first, int count) {
            if (stop_.stop_requested()) throw Cancelled();
            const glm::ivec3 all = dataset_.info.lattice.size;
            return checked(dataset_.read(number, c, int(time), {first, count}), parameter, {all.x, all.y, count}, time);
        };
        frames.push_back({lattice, read, {}});
    }
    const bool fits = options_.slices.step == 0, isRanged = !parameter.ranges.empty();
    if (!fits && isRanged && !options_.toBcc) return frames; // no preliminary pass is needed
    const auto partsOf = [&](int first, int count) {
        std::vector<Field> parts;
        for (const volume::SlicedFrame& frame : frames) parts.push_back(frame.read(first, count));
        return parts;
    };
    if (fits) {
        std::vector<Field> parts = partsOf(0, lattice.size.z);
        if (!isRanged) widenRanges(step.ranges, rangesOf(parts));
        for (std::size_t c = 0; c < frames.size(); ++c) frames[c] = volume::inMemory(std::move(parts[c]));
        return frames;
    }
    const int run = options_.slices.step;
    const auto runs = std::size_t((lattice.size.z + run - 1) / run);
    const Pieces pieces = options_.team ? options_.team->pieces("extents") : Pieces(piecesHere);
    std::size_t number = 0;
    for (const ExtentOfRun& part : valuesOf<ExtentOfRun>(pieces, runs, [&](std::size_t piece) {
             const int first = int(piece) * run;
             return extentsOf(partsOf(first, std::min(run, lattice.size.z - first)), isRanged);
         })) {
        const std::size_t c = number++ % frames.size();
        frames[c].extent.add(part.stored);
        if (isRanged) continue;
        std::vector<Range> ranges(frames.size() == 1 ? 1 : frames.size() + 1, kNothing);
        ranges[c] = part.range;
        if (ranges.size() > 1) ranges.back() = part.magnitude;
        widenRanges(step.ranges, ranges);
    }
    return frames;
}

QueuedFrames FrameQueue::read(std::size_t number) const {
    if (stop_.stop_requested()) throw Cancelled();
    QueuedFrames step;
    step.parameter = int(number % dataset_.info.parameters.size());
    step.time = number / dataset_.info.parameters.size();
    const volume::Parameter& parameter = dataset_.info.parameters[std::size_t(step.parameter)];
    step.sourceSamples = dataset_.info.lattice.count() * std::uint64_t(parameter.components);
    step.sourceBytes = step.sourceSamples * volume::byteSize(parameter.type);
    std::vector<volume::SlicedFrame> frames;
    {
        Stopwatch load(step.loadSeconds);
        frames = source(step, parameter);
    }
    if (options_.rangesOnly) return step;
    const Progress progress{{}, stop_};
    const SlabStore store{options_.slabLayers, options_.slices.folder, options_.team};
    Stopwatch rest(options_.toBcc ? step.resampleSeconds : step.loadSeconds);
    for (volume::SlicedFrame& frame : frames) {
        volume::SlicedFrame stored = frame;
        if (options_.toBcc)
            stored = volume::resampled(frame, options_.grid.lattice,
                                       volume::optionsFor(parameter.categorical, options_.resample), options_.slices,
                                       progress);
        frame = {};
        step.frames.emplace_back(std::move(stored), options_.grid, store, progress);
    }
    const int label = options_.parts ? volume::labelOf(dataset_.info, parameter) : -1;
    if (label < 0 || parameter.parts.count() > volume::kMostParts) return step;
    const volume::Lattice& lattice = dataset_.info.lattice;
    const auto read = [&](int first, int count) {
        if (stop_.stop_requested()) throw Cancelled();
        Field field = volume::makeField(volume::slicesOf(lattice, first, count), volume::ScalarType::U8);
        const Field labels = checked(dataset_.read(label, 0, int(step.time), {first, count}),
                                     dataset_.info.parameters[std::size_t(label)], field.lattice.size, step.time);
        const std::vector<std::uint8_t> parts = volume::partsOf(labels, parameter.parts);
        std::ranges::copy(parts, field.as<std::uint8_t>().begin());
        return field;
    };
    step.parts.emplace(options_.slices.step == 0 ? volume::inMemory(read(0, lattice.size.z))
                                                 : volume::SlicedFrame{lattice, read, {}},
                       options_.grid, store, progress);
    return step;
}

QueuedFrames FrameQueue::next() {
    QueuedFrames step = coming_.valid() ? coming_.get() : read(taken_);
    ++taken_;
    if (options_.ahead && taken_ < steps_)
        coming_ = std::async(std::launch::async, [this, number = taken_] { return read(number); });
    return step;
}

} // namespace tessera::codec
