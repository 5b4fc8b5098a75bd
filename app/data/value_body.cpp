#include "app/data/value_body.h"

#include "app/data/coarse_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tessera::app {

namespace {

constexpr int kBodyBins = 256;

/// Lengths of the cells of a level along each axis as they are drawn, world units.
std::array<std::vector<double>, 3> drawnLengths(const Session& session, const volume::BrickSource& source, int level) {
    const volume::DatasetInfo& info = source.info();
    const volume::Lattice& lattice = source.grid().lattice;
    const vis::WorldFrame frame = vis::worldFrame(info, session.stretch);
    const glm::ivec3 size = source.grid().levelSamples(level);
    const bool scaled = drawsToScale(session.data.lattice, info);
    std::array<std::vector<double>, 3> out;
    for (int axis = 0; axis < 3; ++axis) {
        const double slices = axis == 2 && lattice.kind == volume::LatticeKind::BCC ? 0.5 : 1;
        const volume::AxisMap* const map = scaled ? lattice.axes[axis] : nullptr;
        std::vector<double>& lengths = out[std::size_t(axis)];
        lengths.assign(std::size_t(size[axis]), std::abs(lattice.spacing[axis]) * double(1 << level) * slices);
        for (int i = 0; map && i < size[axis]; ++i)
            lengths[std::size_t(i)] = map->border(std::min((i + 1) << level, map->samples())) - map->border(i << level);
        for (double& length : lengths) length *= std::abs(frame.scale[axis]);
    }
    return out;
}

/// The samples' shadows along the axes, each as one flag per line.
struct Shadows {
    glm::ivec3 size{0};
    std::array<std::vector<std::uint8_t>, 3> met;

    explicit Shadows(glm::ivec3 samples) : size(samples) {
        for (int axis = 0; axis < 3; ++axis)
            met[std::size_t(axis)].assign(std::size_t(size[(axis + 1) % 3]) * std::size_t(size[(axis + 2) % 3]), 0);
    }
    void add(glm::ivec3 at) {
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            met[std::size_t(axis)][std::size_t(at[u]) + std::size_t(at[v]) * std::size_t(size[u])] = 1;
        }
    }
    double area(int axis, const std::array<std::vector<double>, 3>& lengths) const {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        double sum = 0;
        for (int j = 0; j < size[v]; ++j)
            for (int i = 0; i < size[u]; ++i)
                if (met[std::size_t(axis)][std::size_t(i) + std::size_t(j) * std::size_t(size[u])] != 0)
                    sum += lengths[std::size_t(u)][std::size_t(i)] * lengths[std::size_t(v)][std::size_t(j)];
        return sum;
    }
};

} // namespace

ValueBody bodyOf(const Session& session, const volume::BrickSource& source, int channel,
                 std::span<const std::size_t> times, Range range, double from) {
    ValueBody body{.count = std::vector<double>(kBodyBins, 0)};
    if (times.empty() || !(range.hi > range.lo)) return body;
    const int level = source.grid().levelWithin(kQuickSamples / double(times.size()));
    const auto lengths = drawnLengths(session, source, level);
    Shadows shadows(source.grid().levelSamples(level));
    const auto all = [](glm::ivec3, glm::ivec3) { return true; };
    for (const std::size_t time : times)
        forSamples(source, channel, int(time), level, all, [&](glm::ivec3 at, float value) {
            const double share = (double(value) - range.lo) / (range.hi - range.lo);
            if (from > 0 && share < from) return;
            body.count[std::size_t(std::clamp(share * kBodyBins, 0.0, kBodyBins - 1.0))] +=
                lengths[0][std::size_t(at.x)] * lengths[1][std::size_t(at.y)] * lengths[2][std::size_t(at.z)];
            shadows.add(at);
        });
    const double volume = std::accumulate(body.count.begin(), body.count.end(), 0.0) / double(times.size());
    // What the rays meet: of a box exactly the sum of its shadows along the axes, each as far as the view is along it.
    const glm::dvec3 view = glm::abs(vis::forwardOf(session.camera));
    double shadow = 0;
    for (int axis = 0; axis < 3; ++axis) shadow += view[axis] * shadows.area(axis, lengths);
    body.length = shadow > 0 ? volume / shadow : 0;
    return body;
}

double binsFilled(std::span<const double> count) {
    const double all = std::accumulate(count.begin(), count.end(), 0.0);
    if (!(all > 0)) return 0;
    double entropy = 0;
    for (const double each : count)
        if (each > 0) entropy -= each / all * std::log(each / all);
    return std::exp(entropy);
}

} // namespace tessera::app
