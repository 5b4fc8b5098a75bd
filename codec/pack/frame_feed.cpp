#include "codec/pack/frame_feed.h"

#include "codec/bytes/stopwatch.h"
#include "volume/base/number_extent.h"
#include "volume/field/part_masks.h"
#include "volume/resample/resample.h"

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

/// Ranges of one time of a parameter: components, then magnitude.
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

FrameFeed::FrameFeed(volume::Dataset& dataset, FeedOptions options, std::stop_token stop)
    : dataset_(dataset), info_(dataset.info), options_(std::move(options)), stop_(std::move(stop)),
      load_(options_.toBcc ? volume::withParts(dataset).load : dataset.load),
      steps_(info_.times.size() * info_.parameters.size()) {
    if (options_.toBcc) options_.slabs.load = volume::withParts(info_, std::move(options_.slabs.load));
}

FrameFeed::~FrameFeed() {
    if (coming_.valid()) coming_.wait();
}

void FrameFeed::readWhole(FeedStep& step, const volume::Parameter& parameter) {
    std::vector<Field> fields;
    {
        Stopwatch load(step.loadSeconds);
        for (int c = 0; c < parameter.components; ++c)
            fields.push_back(
                checked(load_(step.parameter, c, int(step.time)), parameter, info_.lattice.size, step.time));
        if (parameter.ranges.empty()) step.ranges = rangesOf(fields);
    }
    Stopwatch resample(step.resampleSeconds);
    for (Field& field : fields) {
        if (options_.toBcc) {
            Field stored = volume::toBcc(field, parameter.categorical, options_.resample, Progress{{}, stop_});
            if (options_.measures) step.resampled.add(resampleError(field, stored, parameter.categorical));
            field = std::move(stored);
        }
        step.frames.emplace_back(volume::withoutParts(std::move(field)));
    }
}

/// Reads the frame once for properties of the whole, and again slab by slab.
void FrameFeed::readSlabs(FeedStep& step, const volume::Parameter& parameter) {
    const auto slicesOf = [&](int component, int first, int count) {
        if (stop_.stop_requested()) throw Cancelled();
        glm::ivec3 size = info_.lattice.size;
        size.z = count;
        return checked(options_.slabs.load(step.parameter, component, int(step.time), first, count), parameter, size,
                       step.time);
    };
    const int slices = info_.lattice.size.z;
    std::vector<volume::StoredExtent> extents(std::size_t(parameter.components));
    if (parameter.ranges.empty() || options_.toBcc) {
        Stopwatch load(step.loadSeconds);
        for (int first = 0; first < slices; first += options_.slabs.step) {
            std::vector<Field> parts;
            for (int c = 0; c < parameter.components; ++c) {
                parts.push_back(slicesOf(c, first, std::min(options_.slabs.step, slices - first)));
                extents[std::size_t(c)].add(parts.back());
            }
            if (parameter.ranges.empty()) widenRanges(step.ranges, rangesOf(parts));
        }
    }
    if (options_.rangesOnly) return;
    const Progress progress{{}, stop_};
    Stopwatch rest(options_.toBcc ? step.resampleSeconds : step.loadSeconds);
    for (int c = 0; c < parameter.components; ++c) {
        volume::SlicedFrame frame{info_.lattice, [&, c](int first, int count) { return slicesOf(c, first, count); },
                                  extents[std::size_t(c)]};
        if (options_.toBcc)
            frame = volume::resampled(frame, options_.grid.lattice,
                                      volume::optionsFor(parameter.categorical, options_.resample), options_.slabs.step,
                                      options_.slabs.store.folder, progress);
        const volume::SliceReader inParts = frame.read;
        frame.read = [inParts](int first, int count) { return volume::withoutParts(inParts(first, count)); };
        step.frames.emplace_back(frame, options_.grid, options_.slabs.store, progress);
        if (!options_.toBcc || !options_.measures) continue;
        step.resampled.add(resampleError(
            info_.lattice, [&, c](int first, int count) { return slicesOf(c, first, count); }, frame.lattice, inParts,
            parameter.categorical));
    }
}

FeedStep FrameFeed::read(std::size_t number) {
    if (stop_.stop_requested()) throw Cancelled();
    FeedStep step;
    step.parameter = int(number % info_.parameters.size());
    step.time = number / info_.parameters.size();
    const volume::Parameter& parameter = info_.parameters[std::size_t(step.parameter)];
    step.sourceSamples = info_.lattice.count() * std::uint64_t(parameter.components);
    step.sourceBytes = step.sourceSamples * volume::byteSize(parameter.type);
    if (options_.slabs.load)
        readSlabs(step, parameter);
    else
        readWhole(step, parameter);
    return step;
}

FeedStep FrameFeed::next() {
    FeedStep step = coming_.valid() ? coming_.get() : read(taken_);
    ++taken_;
    if (options_.ahead && taken_ < steps_)
        coming_ = std::async(std::launch::async, [this, number = taken_] { return read(number); });
    return step;
}

} // namespace tessera::codec
