#include "volume/probe.h"

#include "volume/reconstruct.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
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
        const bool present = samples.present.empty() || samples.present[n] != 0;
        return {present ? double(samples.values[n]) : 0.0, present};
    }

private:
    const BrickSamples& brick(glm::ivec3 index) const {
        for (const Held& held : held_)
            if (held.index == index) return *held.samples;
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
};

ProbeValue probeOne(const BrickSource& source, const Channel& channel, const SourceSamples& samples,
                    glm::dvec3 position) {
    const Box& bounds = source.info().bounds;
    if (glm::any(glm::lessThan(position, bounds.lo)) || glm::any(glm::greaterThan(position, bounds.hi))) return {};
    const LevelGeometry geometry = levelGeometry(source.grid(), 0);
    const Lattice& lattice = source.grid().lattice;
    const Sample near = samples(lattice.nearest(position));
    ProbeValue value;
    if (near.present) value.nearest = near.value;
    value.interpolated = source.info().parameters[std::size_t(channel.parameter)].categorical
                             ? value.nearest
                             : tetrahedral(geometry, samples, lattice.toCells(position)).value();
    return value;
}

} // namespace

std::vector<ProbeValue> probe(const BrickSource& source, glm::dvec3 position, int time) {
    std::vector<ProbeValue> values;
    for (const Channel& channel : source.info().channels())
        values.push_back(probeOne(source, channel, SourceSamples(source, int(values.size()), time), position));
    return values;
}

ProbeValue probeChannel(const BrickSource& source, int channel, glm::dvec3 position, int time) {
    return probeOne(source, source.info().channels()[std::size_t(channel)], SourceSamples(source, channel, time),
                    position);
}

std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   int time) {
    const Channel known = source.info().channels()[std::size_t(channel)];
    const SourceSamples samples(source, channel, time);
    std::vector<ProbeValue> values;
    for (const glm::dvec3& position : positions) values.push_back(probeOne(source, known, samples, position));
    return values;
}

namespace {

std::vector<ProbeValue> mixed(const std::vector<ProbeValue>& earlier, const std::vector<ProbeValue>& later,
                              const TimePair& time) {
    std::vector<ProbeValue> out;
    for (std::size_t i = 0; i < earlier.size(); ++i) {
        const ProbeValue &a = earlier[i], &b = later[i];
        ProbeValue value = time.weight >= 0.5 ? b : a;
        if (a.interpolated && b.interpolated)
            value.interpolated = (1 - time.weight) * *a.interpolated + time.weight * *b.interpolated;
        out.push_back(value);
    }
    return out;
}

} // namespace

std::vector<ProbeValue> probe(const BrickSource& source, glm::dvec3 position, const TimePair& time) {
    std::vector<ProbeValue> earlier = probe(source, position, time.earlier);
    if (!time.between()) return earlier;
    const std::vector<ProbeValue> later = probe(source, position, time.later);
    std::vector<ProbeValue> out = mixed(earlier, later, time);
    const DatasetInfo& info = source.info();
    const std::vector<Channel> channels = info.channels();
    for (std::size_t i = 0; i < out.size(); ++i)
        if (info.parameters[std::size_t(channels[i].parameter)].categorical)
            out[i] = time.weight >= 0.5 ? later[i] : earlier[i];
    return out;
}

std::vector<ProbeValue> probeAlong(const BrickSource& source, int channel, std::span<const glm::dvec3> positions,
                                   const TimePair& time) {
    const DatasetInfo& info = source.info();
    const Channel known = info.channels()[std::size_t(channel)];
    if (!time.between() || info.parameters[std::size_t(known.parameter)].categorical)
        return probeAlong(source, channel, positions, time.nearest());
    return mixed(probeAlong(source, channel, positions, time.earlier),
                 probeAlong(source, channel, positions, time.later), time);
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
