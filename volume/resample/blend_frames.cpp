#include "volume/resample/blend_frames.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/resample/resample_taps.h"

#include <algorithm>
#include <array>
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

/// The number of a sample's part, 0 where it is absent (volume/field/part_masks.h).
std::uint8_t numberAt(const Field& field, std::size_t i) {
    return field.mask ? (*field.mask)[i] : std::uint8_t(1);
}

/// Where frames differ in presence or parts: the linear blend of the frames that have the sample, in the part that it
/// has in the nearest of them (of two the later one).
void blendPartly(std::span<const WeightedFrame> frames, Field& sum) {
    auto mask = std::make_shared<Mask>(sum.count(), std::uint8_t(1));
    const auto to = sum.as<float>();
    parallelFor(
        sum.count(),
        [&](std::size_t i) {
            double most = -1;
            std::uint8_t own = 0;
            bool alike = true;
            for (const WeightedFrame& frame : frames) {
                const std::uint8_t number = numberAt(*frame.field, i);
                alike = alike && number == numberAt(*frames.front().field, i);
                if (number == 0 || frame.weight.linear < most) continue;
                most = frame.weight.linear;
                own = number;
            }
            (*mask)[i] = own;
            if (alike) return;
            Blend blend;
            for (const WeightedFrame& frame : frames) {
                const bool isOwn = own != 0 && numberAt(*frame.field, i) == own;
                blend.add(frame.weight.linear, {isOwn ? frame.field->value(i) : 0, isOwn});
            }
            const std::optional<double> value = blend.value();
            to[i] = value ? float((*value - sum.offset) / sum.scale) : 0.0f;
            if (!value) (*mask)[i] = 0;
        },
        kBlendGrain);
    if (std::any_of(mask->begin(), mask->end(), [](std::uint8_t number) { return number != 1; }))
        sum.mask = std::move(mask);
}

/// Kernels with negative weights overshoot: held within the present samples of the frames, part by part.
void clampToFrames(std::span<const WeightedFrame> frames, std::span<const StoredExtent> extents, Field& sum) {
    std::array<float, StoredExtent::kNumbers> lo, hi;
    lo.fill(std::numeric_limits<float>::max());
    hi.fill(std::numeric_limits<float>::lowest());
    for (std::size_t f = 0; f < frames.size(); ++f) {
        const Field& frame = *frames[f].field;
        StoredExtent own;
        if (extents.empty()) own.add(frame);
        const StoredExtent& extent = extents.empty() ? own : extents[f];
        const double scale = frame.scale / sum.scale, offset = (frame.offset - sum.offset) / sum.scale;
        for (std::size_t n = 1; n < lo.size(); ++n) {
            const Range& range = extent.byPart[n];
            if (range.lo > range.hi) continue;
            lo[n] = std::min(lo[n], float(scale * range.lo + offset));
            hi[n] = std::max(hi[n], float(scale * range.hi + offset));
        }
    }
    const auto to = sum.as<float>();
    for (std::size_t i = 0; i < to.size(); ++i)
        if (const std::size_t n = numberAt(sum, i) % lo.size(); lo[n] <= hi[n]) to[i] = std::clamp(to[i], lo[n], hi[n]);
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

std::vector<FrameWeight> weightsBeyond(double cells, int count, const ResampleOptions& options) {
    const double last = count - 1;
    if (count < 2 || options.filter == ResampleFilter::Nearest || (cells >= 0 && cells <= last))
        return frameWeights(cells, count, options);
    const int end = cells < 0 ? 0 : count - 1, inner = cells < 0 ? 1 : count - 2;
    const double out = cells < 0 ? -cells : cells - last;
    return {{end, 1 + out, 1, true}, {inner, -out, 0, true}};
}

bool overshoots(std::span<const FrameWeight> weights) {
    return std::any_of(weights.begin(), weights.end(),
                       [](const FrameWeight& frame) { return frame.weight < 0 && !frame.beyond; });
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
        held = held || (frame.weight.weight < 0 && !frame.weight.beyond);
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
