#include "codec/frame_feed.h"

#include "codec/stopwatch.h"
#include "volume/number_extent.h"

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

Field loadChecked(volume::Dataset& dataset, int parameter, int component, int time) {
    Field field = dataset.load(parameter, component, time);
    const volume::Parameter& about = dataset.info.parameters[std::size_t(parameter)];
    if (field.lattice.size != dataset.info.lattice.size || field.type != about.type)
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

FrameFeed::FrameFeed(volume::Dataset& dataset, const Resampling& resampling, bool ahead, std::stop_token stop)
    : dataset_(dataset), info_(dataset.info), resampling_(resampling), ahead_(ahead), stop_(std::move(stop)),
      steps_(info_.times.size() * info_.parameters.size()) {}

FrameFeed::~FrameFeed() {
    if (coming_.valid()) coming_.wait();
}

FeedStep FrameFeed::read(std::size_t number) {
    if (stop_.stop_requested()) throw Cancelled();
    FeedStep step;
    step.parameter = int(number % info_.parameters.size());
    step.time = number / info_.parameters.size();
    const volume::Parameter& parameter = info_.parameters[std::size_t(step.parameter)];
    {
        Stopwatch load(step.loadSeconds);
        for (int c = 0; c < parameter.components; ++c)
            step.fields.push_back(loadChecked(dataset_, step.parameter, c, int(step.time)));
        if (parameter.ranges.empty()) step.ranges = rangesOf(step.fields);
    }
    Stopwatch resample(step.resampleSeconds);
    for (Field& field : step.fields) {
        step.sourceSamples += field.count();
        step.sourceBytes += field.samples.size();
        if (resampling_.toBcc)
            field = volume::toBcc(field, parameter.categorical, resampling_.options, Progress{{}, stop_});
    }
    return step;
}

FeedStep FrameFeed::next() {
    FeedStep step = coming_.valid() ? coming_.get() : read(taken_);
    ++taken_;
    if (ahead_ && taken_ < steps_)
        coming_ = std::async(std::launch::async, [this, number = taken_] { return read(number); });
    return step;
}

} // namespace tessera::codec
