#include "volume/sources/alternating_source.h"

#include "volume/bricks/brick_cache.h"
#include "volume/bricks/magnitude.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/resample/resample_taps.h"
#include "volume/sources/axis_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tessera::volume {

namespace {

constexpr std::size_t kFrameBudget = std::size_t(64) << 20; ///< bytes of cached bricks of frames

struct WeightedTime {
    int time = 0;
    double weight = 1, linear = 1; ///< linear: where a frame lacks the sample
};

BrickStats unionOf(const BrickStats& a, const BrickStats& b) {
    if (a.presentFraction == 0 || b.presentFraction == 0) { // a brick without samples has no range
        BrickStats one = a.presentFraction == 0 ? b : a;
        one.presentFraction *= 0.5f;
        return one;
    }
    return {std::min(a.min, b.min), std::max(a.max, b.max), 0.5f * (a.presentFraction + b.presentFraction)};
}

/// Weighted sums of the values of several bricks, held within a range.
void blendValues(const std::vector<std::shared_ptr<const BrickSamples>>& bricks, const std::vector<WeightedTime>& times,
                 const BrickStats& range, std::vector<float>& out) {
    constexpr std::size_t kRun = 1024; // sums that stay in the cache
    std::array<double, kRun> sums;
    for (std::size_t first = 0; first < out.size(); first += kRun) {
        const std::size_t n = std::min(kRun, out.size() - first);
        for (std::size_t b = 0; b < bricks.size(); ++b) {
            const float* from = bricks[b]->values.data() + first;
            const double weight = times[b].weight;
            for (std::size_t i = 0; i < n; ++i) sums[i] = (b == 0 ? 0 : sums[i]) + weight * double(from[i]);
        }
        for (std::size_t i = 0; i < n; ++i) out[first + i] = std::min(std::max(float(sums[i]), range.min), range.max);
    }
}

/// One brick from that of several frames, all of the same size; the result is clamped to `range`.
BrickSamples blendBricks(const std::vector<std::shared_ptr<const BrickSamples>>& bricks,
                         const std::vector<WeightedTime>& times, const BrickStats& range) {
    BrickSamples out = *bricks.front();
    out.rest.clear();
    blendValues(bricks, times, range, out.values);
    const auto isWhole = [](const auto& brick) { return brick->present.empty(); };
    if (std::all_of(bricks.begin(), bricks.end(), isWhole)) return out;
    std::vector<std::uint8_t> present(out.values.size(), 1);
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        if (std::all_of(bricks.begin(), bricks.end(), [&](const auto& brick) { return brick->isPresent(i); })) continue;
        Blend blend;
        for (std::size_t b = 0; b < bricks.size(); ++b)
            blend.add(times[b].linear, {double(bricks[b]->values[i]), bricks[b]->isPresent(i)});
        const std::optional<double> value = blend.value();
        present[i] = value ? 1 : 0;
        out.values[i] = value ? float(*value) : 0.0f;
    }
    const bool whole = std::find(present.begin(), present.end(), std::uint8_t(0)) == present.end();
    out.present = whole ? std::vector<std::uint8_t>() : std::move(present);
    return out;
}

/// Slices of both bricks in turn.
BrickSamples interleaved(const BrickSamples& even, const BrickSamples& odd) {
    BrickSamples out;
    out.size = {even.size.x, even.size.y, 2 * even.size.z};
    out.values.resize(2 * even.values.size());
    if (!even.present.empty() || !odd.present.empty()) out.present.resize(out.values.size(), 1);
    const std::size_t slice = std::size_t(even.size.x) * std::size_t(even.size.y);
    for (std::size_t k = 0; k < std::size_t(out.size.z); ++k) {
        const BrickSamples& from = k % 2 == 0 ? even : odd;
        std::copy_n(&from.values[k / 2 * slice], slice, &out.values[k * slice]);
        if (!from.present.empty()) std::copy_n(&from.present[k / 2 * slice], slice, &out.present[k * slice]);
    }
    return out;
}

class AlternatingSource final : public BrickSource {
public:
    AlternatingSource(std::shared_ptr<const BrickSource> frames, TimeFilter filter)
        : frames_(std::make_shared<const BrickCache>(std::move(frames), kFrameBudget)), info_(frames_->info()),
          grid_(frames_->grid()), channels_(info_.channels()) {
        if (info_.lattice.kind != LatticeKind::CC || info_.times.size() < 2)
            throw Error("a D4* lattice needs regular grids at two times or more", info_.name);
        info_.lattice.kind = LatticeKind::BCC;
        info_.lattice.size.z *= 2;
        grid_.lattice = info_.lattice;
        options_.filter = filter == TimeFilter::Cubic ? ResampleFilter::Cubic : ResampleFilter::Linear;
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }

    BrickStats stats(const BrickKey& key) const override {
        const Channel& channel = channelOf(key);
        if (channel.magnitude && channel.component == 3)
            return magnitudeStats(componentStats(key, channel, 0), componentStats(key, channel, 1),
                                  componentStats(key, channel, 2));
        return unionOf(rangeOf(key, timesOf(key, 0)), rangeOf(key, timesOf(key, 1)));
    }

    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        (void)channelOf(key);
        return frames_->importance(key);
    }

    /// The change between two frames of a parity is at most the sum of the changes of the frames between them; what two
    /// blends of them differ by is at most that, times the sums of the weights where some are negative.
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        (void)channelOf(key);
        if (toTime == key.time) return BrickChange{};
        const bool linear = options_.filter == ResampleFilter::Linear;
        const int reach = linear ? 1 : 3; // of a blend, in times to either side
        const int times = int(info_.times.size()), lo = std::min(key.time, toTime), hi = std::max(key.time, toTime);
        BrickChange most;
        for (int parity = 0; parity < 2; ++parity) {
            const int last = times - 1 - (times - 1 + parity) % 2; // of the parity
            const int first = std::max(lo - (lo + parity) % 2 * reach, parity),
                      end = std::min(hi + (hi + parity) % 2 * reach, last);
            BrickChange sum;
            BrickKey step = key;
            for (step.time = std::min(first, last); step.time < end; step.time += 2) {
                const std::optional<BrickChange> own = frames_->change(step, step.time + 2);
                if (!own) return std::nullopt;
                sum = accumulated(sum, *own);
            }
            if (!linear) {
                const double factor = weightsOf(key, lo, parity) + weightsOf(key, hi, parity);
                sum = {roundedUp(factor * double(sum.max)), roundedUp(factor * double(sum.rms))};
            }
            most = {std::max(most.max, sum.max), std::max(most.rms, sum.rms)};
        }
        return most;
    }

    BrickSamples read(const BrickKey& key) const override {
        const Channel& channel = channelOf(key);
        if (channel.magnitude && channel.component == 3)
            return magnitude(read(componentKey(key, channel, 0)), read(componentKey(key, channel, 1)),
                             read(componentKey(key, channel, 2)));
        return interleaved(*readParity(key, 0), *readParity(key, 1));
    }

private:
    const Channel& channelOf(const BrickKey& key) const {
        if (key.channel < 0 || std::size_t(key.channel) >= channels_.size() || key.time < 0 ||
            std::size_t(key.time) >= info_.times.size())
            throw Error("no such brick", info_.name);
        return channels_[std::size_t(key.channel)];
    }

    BrickKey componentKey(BrickKey key, const Channel& magnitude, int component) const {
        key.channel += component - magnitude.component; // the components come right before their magnitude
        return key;
    }
    BrickStats componentStats(const BrickKey& key, const Channel& magnitude, int component) const {
        return stats(componentKey(key, magnitude, component));
    }

    /// Frames that are blended to the grid of a parity at the time of a key.
    std::vector<WeightedTime> timesOf(const BrickKey& key, int parity) const {
        if (key.time % 2 == parity) return {{key.time}};
        const int count = (int(info_.times.size()) + 1 - parity) / 2;
        const bool label = info_.parameters[std::size_t(channels_[std::size_t(key.channel)].parameter)].categorical;
        const double cells = (key.time - parity) * 0.5;
        if (label) return {{2 * std::max(int(std::floor(cells)), 0) + parity}};
        const Tap tap = tapAt(cells, count, options_);
        std::vector<WeightedTime> times;
        for (int i = 0; i < tap.count; ++i) {
            const double weight = tap.weight[std::size_t(i)];
            const int at = tap.first + i;
            const double linear = at == tap.cell[0] ? 1 - tap.fraction : at == tap.cell[1] ? tap.fraction : 0;
            if (weight != 0) times.push_back({2 * at + parity, weight, linear});
        }
        return times;
    }

    /// Sum of the absolute weights of the frames blended at a time.
    double weightsOf(BrickKey key, int time, int parity) const {
        key.time = time;
        double sum = 0;
        for (const WeightedTime& each : timesOf(key, parity)) sum += std::abs(each.weight);
        return sum;
    }

    BrickStats rangeOf(BrickKey key, const std::vector<WeightedTime>& times) const {
        BrickStats range;
        for (std::size_t i = 0; i < times.size(); ++i) {
            key.time = times[i].time;
            const BrickStats own = frames_->stats(key);
            range = i == 0 ? own : unionOf(range, own);
        }
        return range;
    }

    std::shared_ptr<const BrickSamples> readParity(BrickKey key, int parity) const {
        const std::vector<WeightedTime> times = timesOf(key, parity);
        const BrickStats range = times.size() > 1 ? rangeOf(key, times) : BrickStats{};
        const int wanted = key.time;
        std::vector<std::shared_ptr<const BrickSamples>> bricks;
        for (const WeightedTime& time : times) {
            key.time = time.time;
            bricks.push_back(frames_->get(key));
        }
        if (bricks.size() == 1) return bricks.front();
        key.time = wanted;
        keepParts(key, parity, times, bricks);
        BrickSamples blended = blendBricks(bricks, times, range);
        return std::make_shared<const BrickSamples>(std::move(blended));
    }

    /// Makes samples absent whose part differs from the label at the time of a key.
    void keepParts(BrickKey key, int parity, const std::vector<WeightedTime>& times,
                   std::vector<std::shared_ptr<const BrickSamples>>& bricks) const {
        const Parameter& parameter = info_.parameters[std::size_t(channels_[std::size_t(key.channel)].parameter)];
        const std::optional<int> label = labelChannel(info_, parameter);
        if (!label) return;
        key.channel = *label;
        const auto partsAt = [&](int time) {
            key.time = time;
            return partsOfSamples(*frames_->get(key), parameter.parts);
        };
        const std::vector<std::uint8_t> own = partsAt(timesOf(key, parity).front().time);
        for (std::size_t b = 0; b < bricks.size(); ++b) {
            const std::vector<std::uint8_t> parts = partsAt(times[b].time);
            if (parts == own) continue;
            BrickSamples kept = *bricks[b];
            if (kept.present.empty()) kept.present.assign(own.size(), 1);
            for (std::size_t i = 0; i < own.size(); ++i)
                if (parts[i] != own[i]) kept.present[i] = 0;
            bricks[b] = std::make_shared<const BrickSamples>(std::move(kept));
        }
    }

    std::shared_ptr<const BrickCache> frames_; ///< each frame is also used for the ones before and after it
    DatasetInfo info_;
    BrickGrid grid_;
    std::vector<Channel> channels_;
    ResampleOptions options_;
};

} // namespace

std::shared_ptr<const BrickSource> makeAlternatingSource(std::shared_ptr<const BrickSource> frames, TimeFilter filter) {
    return std::make_shared<const AlternatingSource>(std::move(frames), filter);
}

std::shared_ptr<const BrickSource> makeOneGridSource(std::shared_ptr<const BrickSource> frames, int parity) {
    OtherAxis axis{frames->info(), {}};
    const DatasetInfo& all = frames->info();
    if (all.lattice.kind != LatticeKind::CC || int(all.times.size()) <= parity)
        throw Error("a grid of a D4* lattice needs a time of its own", all.name);
    for (int t = parity; t < int(all.times.size()); t += 2) axis.order.push_back(t);
    const auto own = [&](std::vector<double>& values) {
        std::vector<double> kept;
        for (const int t : axis.order) kept.push_back(values[std::size_t(t)]);
        values = std::move(kept);
    };
    own(axis.info.times);
    for (Quantity& quantity : axis.info.quantities) own(quantity.values);
    if (parity == 1) axis.info.lattice.origin += 0.5 * axis.info.lattice.spacing;
    return onAxis(std::move(frames), std::move(axis));
}

} // namespace tessera::volume
