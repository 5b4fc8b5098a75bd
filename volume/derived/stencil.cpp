#include "volume/derived/stencil.h"

#include "volume/bricks/parts_bricks.h"
#include "volume/bricks/sample_position.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

std::size_t indexIn(glm::ivec3 size, glm::ivec3 at) {
    return (std::size_t(at.z) * std::size_t(size.y) + std::size_t(at.y)) * std::size_t(size.x) + std::size_t(at.x);
}

/// The parts that the samples of a brick with a border belong to.
std::vector<std::uint8_t> partsAround(const BrickGrid& grid, BrickKey key, int reach, const ReadSamples& read,
                                      const PartLabel& label) {
    key.channel = label.channel;
    return partsOfSamples(gather(grid, key, reach, read), label.parts);
}

} // namespace

std::optional<PartLabel> partLabel(const DatasetInfo& info, int channel) {
    const Parameter& parameter = info.parameters[std::size_t(info.channel(channel).parameter)];
    const std::optional<int> label = labelChannel(info, parameter);
    if (!label) return std::nullopt;
    return PartLabel{*label, parameter.parts};
}

Neighbourhood::Neighbourhood(const BrickGrid& grid, const BrickKey& key, int reach, const ReadSamples& read,
                             const std::optional<PartLabel>& label)
    : samples_(gather(grid, key, reach, read)), grid_(grid), level_(key.level),
      size_(grid.brickSamples(key.index, key.level)), first_(grid.levelBegin(key.index, key.level)),
      whole_(grid.levelSamples(key.level)), spacing_(grid.lattice.spacing * double(1 << key.level)), reach_(reach),
      slices_(grid.lattice.kind == LatticeKind::BCC ? 2 : 1) {
    if (label) parts_ = partsAround(grid, key, reach, read, *label);
}

std::optional<double> Neighbourhood::at(glm::ivec3 in, int axis, int steps) const {
    const glm::ivec3 border(reach_, reach_, reach_ * slices_);
    const std::size_t centre = indexIn(samples_.size, in + border);
    in[axis] += steps * (axis == 2 ? slices_ : 1);
    const int global = first_[axis] + in[axis];
    if (global < 0 || global >= whole_[axis]) return std::nullopt;
    const std::size_t index = indexIn(samples_.size, in + border);
    if (!parts_.empty() && parts_[index] != parts_[centre]) return std::nullopt;
    if (!samples_.isPresent(index)) return std::nullopt;
    return double(samples_.values[index]);
}

double Neighbourhood::place(glm::ivec3 in, int axis) const {
    return samplePosition(grid_, first_ + in, level_)[axis];
}

std::optional<double> Neighbourhood::derivative(glm::ivec3 in, int axis) const {
    std::optional<double> lower = at(in, axis, -1), upper = at(in, axis, 1);
    const int step = axis == 2 ? slices_ : 1;
    if (!lower && !upper) return whole_[axis] <= step ? std::optional(0.0) : std::nullopt;
    if (grid_.lattice.axes[axis] != nullptr) {
        glm::ivec3 before = in, after = in;
        before[axis] -= step;
        after[axis] += step;
        const double here = *at(in), middle = place(in, axis);
        const double down = lower ? middle - place(before, axis) : 0, up = upper ? place(after, axis) - middle : 0;
        if (!upper) return (here - *lower) / down;
        if (!lower) return (*upper - here) / up;
        return ((*upper - here) * (down / up) + (here - *lower) * (up / down)) / (down + up);
    }
    double width = 2 * spacing_[axis];
    if (lower.has_value() != upper.has_value()) {
        (lower ? upper : lower) = at(in);
        width = spacing_[axis];
    }
    return (*upper - *lower) / width;
}

namespace {

/// Makes samples absent that do not lie in a lattice of `whole` samples; the first one lies at `first`.
void leaveOutBeyond(BrickSamples& samples, glm::ivec3 first, glm::ivec3 whole) {
    const glm::ivec3 end = first + samples.size;
    if (first.x >= 0 && first.y >= 0 && first.z >= 0 && end.x <= whole.x && end.y <= whole.y && end.z <= whole.z)
        return;
    if (samples.present.empty()) samples.present.assign(samples.values.size(), 1);
    const auto within = [&](int axis, int at) { return at + first[axis] >= 0 && at + first[axis] < whole[axis]; };
    std::size_t i = 0;
    for (int z = 0; z < samples.size.z; ++z)
        for (int y = 0; y < samples.size.y; ++y)
            for (int x = 0; x < samples.size.x; ++x, ++i)
                if (!within(0, x) || !within(1, y) || !within(2, z)) samples.present[i] = 0;
}

/// The interior of a brick with a border of `reach` samples, `own` of them, smoothed by weights along each axis.
BrickSamples smoothedWithin(const BrickSamples& wide, glm::ivec3 own, int reach, int slices,
                            const std::vector<double>& weights) {
    // Smooth weighted values and weights along one axis after the other; each pass consumes its border.
    glm::ivec3 size = wide.size;
    std::vector<double> sum(wide.values.size()), coverage(wide.values.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const bool present = wide.isPresent(i);
        coverage[i] = present ? 1 : 0;
        sum[i] = present ? double(wide.values[i]) : 0;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const int step = axis == 2 ? slices : 1;
        glm::ivec3 smaller = size;
        smaller[axis] = own[axis];
        std::vector<double> nextSum(std::size_t(smaller.x) * std::size_t(smaller.y) * std::size_t(smaller.z));
        std::vector<double> nextCoverage(nextSum.size());
        const std::size_t stride = std::size_t(step) * (axis == 0   ? 1
                                                        : axis == 1 ? std::size_t(size.x)
                                                                    : std::size_t(size.x) * std::size_t(size.y));
        std::size_t to = 0;
        for (int z = 0; z < smaller.z; ++z)
            for (int y = 0; y < smaller.y; ++y)
                for (int x = 0; x < smaller.x; ++x, ++to) {
                    std::size_t from = indexIn(size, {x, y, z});
                    for (std::size_t k = 0; k < weights.size(); ++k, from += stride) {
                        nextSum[to] += weights[k] * sum[from];
                        nextCoverage[to] += weights[k] * coverage[from];
                    }
                }
        size = smaller;
        sum = std::move(nextSum);
        coverage = std::move(nextCoverage);
    }
    BrickSamples out;
    out.size = own;
    out.values.resize(sum.size());
    if (!wide.present.empty()) out.present.assign(sum.size(), 1);
    std::size_t i = 0;
    for (int z = 0; z < own.z; ++z)
        for (int y = 0; y < own.y; ++y)
            for (int x = 0; x < own.x; ++x, ++i) {
                const bool present = wide.isPresent(indexIn(wide.size, {x + reach, y + reach, z + reach * slices}));
                if (!present) out.present[i] = 0;
                out.values[i] = present ? float(sum[i] / coverage[i]) : 0;
            }
    return out;
}

BrickSamples withoutNeedlessFlags(BrickSamples samples) {
    if (std::ranges::find(samples.present, std::uint8_t(0)) == samples.present.end()) samples.present.clear();
    return samples;
}

} // namespace

BrickSamples smoothed(const BrickGrid& grid, const BrickKey& key, double width, const ReadSamples& read,
                      const std::optional<PartLabel>& label) {
    const double sigma = width / (1 << key.level); // in samples of this level
    const int reach = std::max(1, int(std::ceil(3 * sigma)));
    std::vector<double> weights;
    for (int i = -reach; i <= reach; ++i) weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    BrickSamples wide = gather(grid, key, reach, read);
    const glm::ivec3 own = grid.brickSamples(key.index, key.level);
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1;
    leaveOutBeyond(wide, grid.levelBegin(key.index, key.level) - reach * glm::ivec3(1, 1, slices),
                   grid.levelSamples(key.level));
    if (!label) return withoutNeedlessFlags(smoothedWithin(wide, own, reach, slices, weights));
    const std::vector<std::uint8_t> parts = partsAround(grid, key, reach, read, *label);
    BrickSamples out;
    for (std::size_t part = 0; part < label->parts.count(); ++part) {
        if (std::ranges::find(parts, std::uint8_t(part)) == parts.end()) continue;
        BrickSamples alone = wide;
        if (alone.present.empty()) alone.present.assign(parts.size(), 1);
        for (std::size_t i = 0; i < parts.size(); ++i)
            if (parts[i] != part) alone.present[i] = 0;
        BrickSamples made = smoothedWithin(alone, own, reach, slices, weights);
        if (out.values.empty()) {
            out = std::move(made);
            continue;
        }
        for (std::size_t i = 0; i < made.values.size(); ++i)
            if (made.present[i] != 0) out.values[i] = made.values[i], out.present[i] = 1;
    }
    return withoutNeedlessFlags(std::move(out));
}

} // namespace tessera::volume
