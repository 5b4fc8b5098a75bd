#include "volume/flow/flow.h"

#include "volume/base/parallel.h"
#include "volume/flow/step_cells.h"
#include "volume/reconstruct/continued.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

namespace tessera::volume {

namespace {

/// From a point with the vector `slope`, along the field (sign 1) or against it (-1), without the point itself.
std::vector<glm::dvec3> halfLine(const ChangingField& field, glm::dvec3 place, glm::dvec3 slope, double sign,
                                 const StreamlineSettings& s) {
    const StepCells cells{s.cell, s.lattice ? &*s.lattice : nullptr, s.longestStep};
    std::vector<glm::dvec3> out;
    double length = 0, wanted = 0.25; // step in cells
    while (length < s.longest && glm::length(slope) > s.slowest) {
        if (int(out.size()) == s.mostSteps) {
            if (s.stopped) ++*s.stopped;
            break;
        }
        const glm::dvec3 cell = cells.at(place, sign * slope);
        const double speed = glm::length(slope / cell);
        if (!(speed > 0)) break;
        const double room = (s.longest - length) / glm::length(slope) * speed;
        const double taken = std::min({wanted, s.longestStep, room, cells.most(place, sign * slope) * speed});
        if (!(taken > 0)) break;
        const FlowStep step = flowStep(field, place, 0, slope, sign * taken / speed, cell);
        if (!step.present || step.error > s.tolerance) {
            if (taken <= kShortestStep) break;
            wanted = step.present ? taken * std::min(stepFactor(s.tolerance, step.error), 0.9) : taken / 2;
            wanted = std::max(wanted, kShortestStep * 0.99);
            continue;
        }
        const double moved = glm::distance(step.end, place);
        if (!(moved > 0)) break;
        length += moved;
        place = step.end;
        slope = step.slope;
        out.push_back(place);
        wanted = taken * stepFactor(s.tolerance, step.error);
        if (taken == room) break;
    }
    return out;
}

/// The samples around a place in a CC lattice and their weights, which are those of all components and times: the
/// interpolation of valueAt() where no sample is of a part.
struct CellCorners {
    std::size_t near = 0, indices[8] = {};
    double weights[8] = {};
    int count = 0;
    bool even = true;

    CellCorners(const Lattice& lattice, glm::dvec3 position) : even(lattice.isEven()) {
        near = lattice.index(lattice.nearest(position));
        const glm::dvec3 cells = lattice.between(position), base = glm::floor(cells), f = cells - base;
        const glm::ivec3 first(base), last = lattice.size - 1;
        const glm::ivec3 sides[2] = {glm::clamp(first, glm::ivec3(0), last),
                                     glm::clamp(first + 1, glm::ivec3(0), last)};
        const glm::dvec3 shares[2] = {1.0 - f, f};
        for (int z = 0; z < 2; ++z)
            for (int y = 0; y < 2; ++y)
                for (int x = 0; x < 2; ++x) {
                    const double weight = shares[x].x * shares[y].y * shares[z].z;
                    if (weight == 0) continue;
                    indices[count] = lattice.index({sides[x].x, sides[y].y, sides[z].z});
                    weights[count++] = weight;
                }
    }
    std::optional<double> valueOf(const SampleGrid& grid) const {
        Blend blend;
        for (int i = 0; i < count; ++i)
            blend.add(weights[i], {double(grid.values[indices[i]]), grid.isPresent(indices[i])});
        return even ? blend.value() : blend.valueInCellOf({double(grid.values[near]), grid.isPresent(near)});
    }
    std::optional<glm::dvec3> vectorOf(const VectorGrid& grid) const {
        const auto a = valueOf(grid.x);
        const auto b = a ? valueOf(grid.y) : std::nullopt;
        const auto c = b ? valueOf(grid.z) : std::nullopt;
        return c ? std::optional(glm::dvec3(*a, *b, *c)) : std::nullopt;
    }
};

bool contains(const Box& box, glm::dvec3 place) {
    return !glm::any(glm::lessThan(place, box.lo)) && !glm::any(glm::greaterThan(place, box.hi));
}

/// Whether CellCorners does for this grid.
bool isPlain(const VectorGrid& grid) {
    return grid.x.lattice.kind == LatticeKind::CC && grid.x.parts.empty() && grid.y.parts.empty() &&
           grid.z.parts.empty();
}

} // namespace

std::optional<double> valueAt(const SampleGrid& grid, glm::dvec3 position) {
    const Lattice& lattice = grid.lattice;
    const auto sample = [&](glm::ivec3 place) -> Sample {
        const std::size_t index = lattice.index(clampToLattice(lattice.kind, lattice.size, place));
        const bool present = grid.isPresent(index);
        return {present ? double(grid.values[index]) : 0.0, present};
    };
    const LevelGeometry geometry{lattice.kind, 1, 0};
    const glm::ivec3 near = lattice.nearest(position);
    const auto valueOf = [&](const Blend& blend) {
        return lattice.isEven() ? blend.value() : blend.valueInCellOf(sample(near));
    };
    if (grid.parts.empty()) return valueOf(tetrahedral(geometry, sample, lattice.between(position)));
    const auto partOf = [&](glm::ivec3 place) {
        return int(grid.parts[lattice.index(clampToLattice(lattice.kind, lattice.size, place))]);
    };
    const OwnPart own(lattice, sample, partOf, near);
    return valueOf(tetrahedral(geometry, own, lattice.between(position)));
}

std::optional<glm::dvec3> VectorGrid::at(glm::dvec3 position) const {
    if (!contains(bounds, position)) return std::nullopt;
    if (isPlain(*this)) return CellCorners(x.lattice, position).vectorOf(*this);
    const auto a = valueAt(x, position);
    const auto b = a ? valueAt(y, position) : std::nullopt;
    const auto c = b ? valueAt(z, position) : std::nullopt;
    if (!c) return std::nullopt;
    return glm::dvec3(*a, *b, *c);
}

VectorGrid readVector(const BrickSource& source, int parameter, int time, int level, const Progress& progress) {
    const std::vector<Channel> channels = source.info().channels();
    VectorGrid out;
    out.bounds = source.info().bounds;
    SampleGrid* const grids[] = {&out.x, &out.y, &out.z};
    for (std::size_t i = 0; i < channels.size(); ++i)
        if (const Channel& channel = channels[i]; channel.parameter == parameter && channel.component < 3)
            *grids[channel.component] = readSamples(
                source, int(i), time, level, progress.part(channel.component / 3.0, (channel.component + 1) / 3.0));
    return out;
}

VectorSeries::VectorSeries(const BrickSource& source, int parameter, int level)
    : times_(source.info().times),
      frames_(
          std::numeric_limits<std::size_t>::max(),
          [&source, parameter, level](std::size_t time) {
              return std::make_shared<const VectorGrid>(readVector(source, parameter, int(time), level));
          },
          [](const VectorGrid& grid) { return 3 * grid.x.values.size() * sizeof(grid.x.values[0]); }),
      loaded_(times_.size()) {}

const VectorGrid& VectorSeries::frame(std::size_t time) const {
    if (const VectorGrid* const here = loaded_[time].load(std::memory_order_acquire)) return *here;
    const VectorGrid* const loaded = frames_.get(time).get();
    loaded_[time].store(loaded, std::memory_order_release);
    return *loaded;
}

std::optional<glm::dvec3> VectorSeries::at(glm::dvec3 position, double time) const {
    if (times_.size() == 1) return frame(0).at(position);
    if (!(time >= times_.front() && time <= times_.back())) return std::nullopt;
    const auto after = std::size_t(std::lower_bound(times_.begin(), times_.end(), time) - times_.begin());
    const VectorGrid& later = frame(after);
    if (times_[after] == time) return later.at(position);
    const VectorGrid& earlier = frame(after - 1);
    if (!contains(later.bounds, position)) return std::nullopt;
    std::optional<glm::dvec3> a, b;
    if (isPlain(later) && isPlain(earlier)) {
        const CellCorners corners(later.x.lattice, position);
        b = corners.vectorOf(later);
        if (b) a = corners.vectorOf(earlier);
    } else {
        b = later.at(position);
        if (b) a = earlier.at(position);
    }
    if (!a || !b) return std::nullopt;
    const double share = (time - times_[after - 1]) / (times_[after] - times_[after - 1]);
    return *a * (1 - share) + *b * share;
}

std::vector<glm::dvec3> streamline(const VectorField& field, glm::dvec3 seed, const StreamlineSettings& settings) {
    const std::optional<glm::dvec3> slope = field(seed);
    if (!slope || !(glm::length(*slope) > settings.slowest)) return {};
    const ChangingField same = [&](glm::dvec3 place, double) { return field(place); };
    std::vector<glm::dvec3> line = halfLine(same, seed, *slope, -1, settings);
    std::reverse(line.begin(), line.end());
    line.push_back(seed);
    const std::vector<glm::dvec3> onward = halfLine(same, seed, *slope, 1, settings);
    line.insert(line.end(), onward.begin(), onward.end());
    return line;
}

std::vector<std::vector<glm::dvec3>> streamlines(const VectorField& field, std::span<const glm::dvec3> seeds,
                                                 const StreamlineSettings& settings, const Progress& progress) {
    std::vector<std::vector<glm::dvec3>> out(seeds.size());
    parallelFor(seeds.size(), [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        out[i] = streamline(field, seeds[i], settings);
    });
    progress.advance(1);
    return out;
}

} // namespace tessera::volume
