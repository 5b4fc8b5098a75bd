#include "volume/reconstruct/probe.h"

#include "volume/bricks/parts_bricks.h"
#include "volume/bricks/source_at_time.h"
#include "volume/reconstruct/continued.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <map>
#include <memory>
#include <vector>

namespace tessera::volume {

namespace {

/// Samples of one channel at full resolution; keeps the few bricks that one position touches.
class SourceSamples {
public:
    SourceSamples(const BrickSource& source, int channel, int time)
        : source_(source), grid_(source.grid()), channel_(channel), time_(time) {}

    Sample operator()(glm::ivec3 at) const {
        const glm::ivec3 inside = clampToLattice(grid_.lattice.kind, grid_.lattice.size, at);
        const int slices = grid_.lattice.kind == LatticeKind::BCC ? 2 : 1;
        const glm::ivec3 edge = grid_.brickSize * glm::ivec3(1, 1, slices);
        const glm::ivec3 index = inside / edge, in = inside - index * edge;
        const BrickSamples& samples = brick(index);
        const std::size_t n =
            (std::size_t(in.z) * std::size_t(samples.size.y) + std::size_t(in.y)) * std::size_t(samples.size.x) +
            std::size_t(in.x);
        const bool present = samples.isPresent(n);
        return {present ? samples.exact(n) : 0.0, present};
    }

private:
    const BrickSamples& brick(glm::ivec3 index) const {
        if (last_ < held_.size() && held_[last_].index == index) return *held_[last_].samples;
        for (last_ = 0; last_ < held_.size(); ++last_)
            if (held_[last_].index == index) return *held_[last_].samples;
        held_.push_back({index, std::make_unique<BrickSamples>(source_.read({channel_, time_, 0, index}))});
        return *held_.back().samples;
    }

    struct Held {
        glm::ivec3 index;
        std::unique_ptr<const BrickSamples> samples;
    };
    const BrickSource& source_;
    const BrickGrid& grid_;
    int channel_, time_;
    mutable std::vector<Held> held_;
    mutable std::size_t last_ = 0; ///< of `held_`, read last: the next sample is mostly of the same brick
};

/// One channel, with the label of its parts if it has any.
class ChannelProbe {
public:
    ChannelProbe(const BrickSource& source, int channel, int time)
        : source_(source), channel_(source.info().channel(channel)), samples_(source, channel, time) {
        if (const std::optional<int> label = labelChannel(source.info(), parameter()))
            labels_.emplace(source, *label, time);
    }

    ProbeValue at(glm::dvec3 position) const {
        const Box& bounds = source_.info().bounds;
        if (glm::any(glm::lessThan(position, bounds.lo)) || glm::any(glm::greaterThan(position, bounds.hi))) return {};
        const glm::ivec3 place = source_.grid().lattice.nearest(position);
        const Sample near = samples_(place);
        ProbeValue value;
        if (near.present) value.nearest = near.value;
        // A point between two parts belongs to that of the nearest sample, never to both.
        if (near.present) value.interpolated = parameter().categorical ? value.nearest : between(position, place);
        return value;
    }

    /// The part of the nearest sample.
    int partAt(glm::ivec3 place) const {
        if (!labels_) return 0;
        const Sample label = (*labels_)(place);
        return label.present ? int(parameter().parts.partOf(int(std::lround(label.value)))) : 0;
    }
    int partAt(glm::dvec3 position) const { return partAt(source_.grid().lattice.nearest(position)); }

private:
    const Parameter& parameter() const { return source_.info().parameters[std::size_t(channel_.parameter)]; }

    std::optional<double> between(glm::dvec3 position, glm::ivec3 near) const {
        const LevelGeometry geometry = levelGeometry(source_.grid(), 0);
        const Lattice& lattice = source_.grid().lattice;
        const glm::dvec3 cells = lattice.between(position);
        const auto valueOf = [&](const Blend& blend) {
            return lattice.isEven() ? blend.value() : blend.valueInCellOf(samples_(near));
        };
        if (!labels_) return valueOf(tetrahedral(geometry, samples_, cells));
        const auto partOf = [this](glm::ivec3 place) { return partAt(place); };
        const OwnPart own(lattice, samples_, partOf, near);
        std::optional<double> value = valueOf(tetrahedral(geometry, own, cells));
        if (value && !parameter().ranges.empty()) {
            const Range range = source_.info().channelRange(channel_);
            value = std::clamp(*value, range.lo, std::max(range.lo, range.hi));
        }
        return value;
    }

    const BrickSource& source_;
    Channel channel_;
    SourceSamples samples_;
    std::optional<SourceSamples> labels_;
};

} // namespace

std::vector<ProbeValue> probe(const BrickSource& source, glm::dvec3 position, int time) {
    std::vector<ProbeValue> values;
    for (std::size_t channel = 0, count = source.info().channels().size(); channel < count; ++channel)
        values.push_back(probeChannel(source, int(channel), position, time));
    return values;
}

ProbeValue probeChannel(const BrickSource& source, int channel, glm::dvec3 position, int time) {
    return ChannelProbe(source, channel, time).at(position);
}

std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   int time) {
    const ChannelProbe samples(source, channel, time);
    std::vector<ProbeValue> values;
    for (const glm::dvec3& position : positions) values.push_back(samples.at(position));
    return values;
}

namespace {

/// A value between two times. If the part of the point changes, that of the nearer time.
ProbeValue mixedAt(const ChannelProbe& earlier, const ChannelProbe& later, glm::dvec3 position, double weight) {
    const ProbeValue a = earlier.at(position), b = later.at(position);
    ProbeValue value = weight >= 0.5 ? b : a;
    if (a.interpolated && b.interpolated && earlier.partAt(position) == later.partAt(position))
        value.interpolated = (1 - weight) * *a.interpolated + weight * *b.interpolated;
    return value;
}

/// One channel between two times.
std::vector<ProbeValue> mixed(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                              const TimePair& time) {
    const ChannelProbe earlier(source, channel, time.earlier), later(source, channel, time.later);
    std::vector<ProbeValue> out;
    for (const glm::dvec3& position : positions) out.push_back(mixedAt(earlier, later, position, time.weight));
    return out;
}

} // namespace

std::vector<ProbeValue> probe(const BrickSource& source, glm::dvec3 position, const TimePair& time) {
    if (!time.between()) return probe(source, position, time.earlier);
    std::vector<ProbeValue> out;
    for (std::size_t channel = 0, count = source.info().channels().size(); channel < count; ++channel)
        out.push_back(probeAlong(source, int(channel), {&position, 1}, time).front());
    return out;
}

std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   const TimePair& time) {
    const DatasetInfo& info = source.info();
    const Channel known = info.channel(channel);
    if (!time.between() || info.parameters[std::size_t(known.parameter)].categorical)
        return probeAlong(source, channel, positions, time.nearest());
    if (!isComputedBetween(source, channel)) return mixed(source, channel, positions, time);
    const std::shared_ptr<const BrickSource> borrowed(std::shared_ptr<const BrickSource>(), &source);
    return probeAlong(*sourceAt(borrowed, time).source, channel, positions, 0);
}

std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   std::span<const TimePair> times) {
    std::vector<ProbeValue> out;
    out.reserve(positions.size());
    const bool label = source.info().parameters[std::size_t(source.info().channel(channel).parameter)].categorical;
    std::map<int, ChannelProbe> frames;
    const auto frame = [&](int time) -> const ChannelProbe& {
        return frames.try_emplace(time, source, channel, time).first->second;
    };
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const TimePair& time = times[i];
        out.push_back(time.between() && !label
                          ? mixedAt(frame(time.earlier), frame(time.later), positions[i], time.weight)
                          : frame(time.nearest()).at(positions[i]));
    }
    return out;
}

std::vector<glm::dvec3> alongPolyline(std::span<const glm::dvec3> corners, int count) {
    std::vector<glm::dvec3> out;
    if (corners.empty() || count < 1) return out;
    double length = 0;
    for (std::size_t i = 1; i < corners.size(); ++i) length += glm::distance(corners[i - 1], corners[i]);
    std::size_t part = 1;
    double before = 0; // length of the parts before this one
    for (int i = 0; i < count; ++i) {
        const double at = count > 1 ? length * i / (count - 1) : 0;
        while (part + 1 < corners.size() && before + glm::distance(corners[part - 1], corners[part]) < at)
            before += glm::distance(corners[part - 1], corners[part]), ++part;
        if (corners.size() < 2) {
            out.push_back(corners[0]);
            continue;
        }
        const double own = glm::distance(corners[part - 1], corners[part]);
        const double share = own > 0 ? std::min(1.0, (at - before) / own) : 0;
        out.push_back(corners[part - 1] + (corners[part] - corners[part - 1]) * share);
    }
    return out;
}

} // namespace tessera::volume
