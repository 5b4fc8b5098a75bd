#include "volume/flow/flow.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/continued.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

namespace tessera::volume {

namespace {

constexpr std::size_t kSeriesBytes = std::size_t(1) << 30;
constexpr double kShortestStep = 1.0 / 256; ///< cells: how near to its end a line comes

struct Step {
    glm::dvec3 end, slope; ///< slope: the field at the end
    double error;          ///< cells
};

/// One step of Dormand and Prince from a place and a time with the slope `k1`; empty if the field is absent on the way.
std::optional<Step> tryStep(const ChangingField& field, glm::dvec3 from, double time, glm::dvec3 k1, double h,
                            glm::dvec3 cell) {
    const auto k2 = field(from + h * (k1 / 5.0), time + h / 5);
    if (!k2) return std::nullopt;
    const auto k3 = field(from + h * (k1 * (3.0 / 40) + *k2 * (9.0 / 40)), time + h * 0.3);
    if (!k3) return std::nullopt;
    const auto k4 = field(from + h * (k1 * (44.0 / 45) - *k2 * (56.0 / 15) + *k3 * (32.0 / 9)), time + h * 0.8);
    if (!k4) return std::nullopt;
    const auto k5 = field(
        from + h * (k1 * (19372.0 / 6561) - *k2 * (25360.0 / 2187) + *k3 * (64448.0 / 6561) - *k4 * (212.0 / 729)),
        time + h * (8.0 / 9));
    if (!k5) return std::nullopt;
    const auto k6 = field(from + h * (k1 * (9017.0 / 3168) - *k2 * (355.0 / 33) + *k3 * (46732.0 / 5247) +
                                      *k4 * (49.0 / 176) - *k5 * (5103.0 / 18656)),
                          time + h);
    if (!k6) return std::nullopt;
    const glm::dvec3 end = from + h * (k1 * (35.0 / 384) + *k3 * (500.0 / 1113) + *k4 * (125.0 / 192) -
                                       *k5 * (2187.0 / 6784) + *k6 * (11.0 / 84));
    const auto k7 = field(end, time + h);
    if (!k7) return std::nullopt;
    const glm::dvec3 difference = k1 * (71.0 / 57600) - *k3 * (71.0 / 16695) + *k4 * (71.0 / 1920) -
                                  *k5 * (17253.0 / 339200) + *k6 * (22.0 / 525) - *k7 * (1.0 / 40);
    return Step{end, *k7, glm::length(h * difference / cell)};
}

/// Edges of a cell for the next step from a place along a direction: of uneven axes the smaller ones of both ends.
glm::dvec3 cellFor(const StreamlineSettings& s, glm::dvec3 place, glm::dvec3 direction) {
    if (!s.lattice) return s.cell;
    const glm::dvec3 here = s.lattice->lengthsAt(place);
    if (s.lattice->isEven()) return here;
    const glm::dvec3 end = place + direction * (s.longestStep / glm::length(direction / here));
    return glm::min(here, s.lattice->lengthsAt(end));
}

/// The most of a direction that a step goes: over `longestStep` cells of uneven axes, whatever their lengths.
double mostOf(const StreamlineSettings& s, glm::dvec3 place, glm::dvec3 direction) {
    double most = std::numeric_limits<double>::infinity();
    if (!s.lattice || s.lattice->isEven()) return most;
    const glm::dvec3 cells = s.lattice->toCells(place);
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        glm::dvec3 to = cells;
        to[axis] += std::copysign(s.longestStep, direction[axis] * s.lattice->spacing[axis]);
        most = std::min(most, std::abs((s.lattice->fromCells(to)[axis] - place[axis]) / direction[axis]));
    }
    return most;
}

/// From a point with the vector `slope`, along the field (sign 1) or against it (-1), until time `last`; without the
/// point itself.
Pathline halfLine(const ChangingField& field, glm::dvec3 place, double time, glm::dvec3 slope, double sign, double last,
                  const StreamlineSettings& s) {
    Pathline out;
    double length = 0, wanted = 0.25; // step in cells
    for (int steps = 0; steps < s.mostSteps && length < s.longest && glm::length(slope) > s.slowest;) {
        const glm::dvec3 cell = cellFor(s, place, sign * slope);
        const double cells = glm::length(slope / cell), physical = glm::length(slope);
        if (!(cells > 0)) break;
        const double room = std::min((s.longest - length) / physical, std::abs(last - time)) * cells;
        const double taken = std::min({wanted, s.longestStep, room, mostOf(s, place, sign * slope) * cells});
        if (!(taken > 0)) break;
        const std::optional<Step> step = tryStep(field, place, time, slope, sign * taken / cells, cell);
        if (!step || step->error > s.tolerance) {
            if (taken <= kShortestStep) break;
            wanted = step ? taken * std::max(0.2, 0.9 * std::pow(s.tolerance / step->error, 0.2)) : taken / 2;
            wanted = std::max(wanted, kShortestStep * 0.99);
            continue;
        }
        const double moved = glm::distance(step->end, place);
        if (!(moved > 0)) break;
        length += moved;
        place = step->end;
        slope = step->slope;
        time += sign * taken / cells;
        out.places.push_back(place);
        out.times.push_back(time);
        ++steps;
        wanted = taken * std::clamp(0.9 * std::pow(s.tolerance / std::max(step->error, 1e-300), 0.2), 0.2, 5.0);
        if (taken == room) break;
    }
    return out;
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
    if (glm::any(glm::lessThan(position, bounds.lo)) || glm::any(glm::greaterThan(position, bounds.hi)))
        return std::nullopt;
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
          kSeriesBytes,
          [&source, parameter, level](std::size_t time) {
              return std::make_shared<const VectorGrid>(readVector(source, parameter, int(time), level));
          },
          [](const VectorGrid& grid) { return 3 * grid.x.values.size() * sizeof(grid.x.values[0]); }) {}

std::optional<glm::dvec3> VectorSeries::at(glm::dvec3 position, double time) const {
    if (!(time >= times_.front() && time <= times_.back())) return std::nullopt;
    const auto after = std::size_t(std::lower_bound(times_.begin(), times_.end(), time) - times_.begin());
    const auto b = frames_.get(after)->at(position);
    if (times_[after] == time || !b) return b;
    const auto a = frames_.get(after - 1)->at(position);
    if (!a) return std::nullopt;
    const double share = (time - times_[after - 1]) / (times_[after] - times_[after - 1]);
    return *a * (1 - share) + *b * share;
}

Pathline pathline(const ChangingField& field, glm::dvec3 seed, double time, double begin, double end,
                  const StreamlineSettings& settings) {
    const std::optional<glm::dvec3> slope = field(seed, time);
    if (!slope || !(glm::length(*slope) > settings.slowest)) return {};
    Pathline line = halfLine(field, seed, time, *slope, -1, begin, settings);
    std::reverse(line.places.begin(), line.places.end());
    std::reverse(line.times.begin(), line.times.end());
    line.places.push_back(seed);
    line.times.push_back(time);
    const Pathline onward = halfLine(field, seed, time, *slope, 1, end, settings);
    line.places.insert(line.places.end(), onward.places.begin(), onward.places.end());
    line.times.insert(line.times.end(), onward.times.begin(), onward.times.end());
    return line;
}

std::vector<Pathline> pathlines(const ChangingField& field, std::span<const glm::dvec3> seeds, double time,
                                double begin, double end, const StreamlineSettings& settings,
                                const Progress& progress) {
    std::vector<Pathline> out(seeds.size());
    parallelFor(seeds.size(), [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        out[i] = pathline(field, seeds[i], time, begin, end, settings);
    });
    progress.advance(1);
    return out;
}

std::vector<glm::dvec3> streamline(const VectorField& field, glm::dvec3 seed, const StreamlineSettings& settings) {
    constexpr double kEver = std::numeric_limits<double>::infinity();
    const ChangingField same = [&](glm::dvec3 place, double) { return field(place); };
    return pathline(same, seed, 0, -kEver, kEver, settings).places;
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
