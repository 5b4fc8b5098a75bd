#include "volume/blend_frames.h"

#include "volume/parallel.h"
#include "volume/reconstruct.h"
#include "volume/resample_taps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::volume {

namespace {

constexpr std::size_t kBlendGrain = 1 << 14; // samples per task

/// Adds `weight` times a frame's samples, read in the units of `sum`.
void addWeighted(const Field& frame, double weight, Field& sum) {
    const double scale = weight * frame.scale / sum.scale, offset = weight * (frame.offset - sum.offset) / sum.scale;
    const auto to = sum.as<float>();
    dispatch(frame.type, [&]<class T>(T) {
        const auto from = frame.as<T>();
        parallelRanges(
            to.size(),
            [&](std::size_t begin, std::size_t end) {
                const auto a = float(scale), b = float(offset);
                for (std::size_t i = begin; i < end; ++i) to[i] += a * float(from[i]) + b;
            },
            kBlendGrain);
    });
}

/// Where frames differ in what is present: the linear blend of those that have the sample.
void blendPartly(std::span<const WeightedFrame> frames, Field& sum) {
    auto mask = std::make_shared<Mask>(sum.count(), std::uint8_t(1));
    const auto to = sum.as<float>();
    parallelFor(
        sum.count(),
        [&](std::size_t i) {
            const auto present = [&](const WeightedFrame& frame) { return frame.field->present(i); };
            if (std::all_of(frames.begin(), frames.end(), present)) return;
            Blend blend;
            for (const WeightedFrame& frame : frames)
                blend.add(frame.weight.linear, {present(frame) ? frame.field->value(i) : 0, present(frame)});
            const std::optional<double> value = blend.value();
            to[i] = value ? float((*value - sum.offset) / sum.scale) : 0.0f;
            (*mask)[i] = value ? 1 : 0;
        },
        kBlendGrain);
    if (std::any_of(mask->begin(), mask->end(), [](std::uint8_t p) { return p == 0; })) sum.mask = std::move(mask);
}

/// Kernels with negative weights overshoot: held within the present samples of the frames.
void clampToFrames(std::span<const WeightedFrame> frames, std::span<const StoredExtent> extents, Field& sum) {
    float lo = std::numeric_limits<float>::max(), hi = std::numeric_limits<float>::lowest();
    for (std::size_t f = 0; f < frames.size(); ++f) {
        const Field& frame = *frames[f].field;
        StoredExtent own;
        if (extents.empty()) own.add(frame);
        const StoredExtent& extent = extents.empty() ? own : extents[f];
        const double scale = frame.scale / sum.scale, offset = (frame.offset - sum.offset) / sum.scale;
        if (extent.lo > extent.hi) continue;
        lo = std::min(lo, float(scale * extent.lo + offset));
        hi = std::max(hi, float(scale * extent.hi + offset));
    }
    if (lo > hi) return;
    for (float& value : sum.as<float>()) value = std::clamp(value, lo, hi);
}

} // namespace

ResampleOptions optionsInTime(ResampleOptions options) {
    if (options.filter == ResampleFilter::BSpline3 || options.filter == ResampleFilter::BSpline5)
        options.filter = ResampleFilter::Cubic;
    return options;
}

std::vector<FrameWeight> frameWeights(double cells, int count, const ResampleOptions& options) {
    const Tap tap = tapAt(cells, count, options);
    std::vector<FrameWeight> frames;
    for (int i = 0; i < tap.count; ++i) {
        const double weight = tap.weight[std::size_t(i)];
        const int at = tap.first + i;
        if (weight == 0) continue;
        frames.push_back({at, weight, at == tap.cell[0] ? 1 - tap.fraction : at == tap.cell[1] ? tap.fraction : 0});
    }
    return frames;
}

bool overshoots(std::span<const FrameWeight> weights) {
    return std::any_of(weights.begin(), weights.end(), [](const FrameWeight& frame) { return frame.weight < 0; });
}

Field blendFrames(std::span<const WeightedFrame> frames, std::span<const StoredExtent> extents) {
    if (frames.size() == 1) return *frames.front().field;
    const Field& first = *frames.front().field;
    Field sum = makeField(first.lattice, ScalarType::F32);
    sum.offset = first.offset;
    sum.scale = first.scale;
    bool sameMask = true, held = false;
    for (const WeightedFrame& frame : frames) {
        addWeighted(*frame.field, frame.weight.weight, sum);
        sameMask = sameMask && (frame.field->mask == first.mask ||
                                (frame.field->mask && first.mask && *frame.field->mask == *first.mask));
        held = held || frame.weight.weight < 0;
    }
    sum.mask = first.mask;
    if (!sameMask) {
        sum.mask = nullptr;
        blendPartly(frames, sum);
    }
    if (held) clampToFrames(frames, extents, sum);
    return sum;
}

} // namespace tessera::volume
