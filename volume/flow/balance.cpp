#include "volume/flow/balance.h"

#include "volume/bricks/brick_cache.h"
#include "volume/bricks/brick_columns.h"
#include "volume/bricks/sample_cells.h"
#include "volume/bricks/sample_position.h"
#include "volume/derived/stencil.h"

#include <map>
#include <optional>

namespace tessera::volume {

namespace {

/// A product of a carried quantity and a speed, with the bound on its error and on that of the speed.
struct Carried {
    double value = 0, speed = 0, error = 0, speedError = 0;
    Carried(double c, double u, double cError, double uError)
        : value(c * u), speed(u), error(std::abs(u) * cError + std::abs(c) * uError + cError * uError),
          speedError(uError) {}
    Carried times(double factor) const {
        Carried out = *this;
        out.value *= factor;
        out.speed *= factor;
        out.error *= std::abs(factor);
        out.speedError *= std::abs(factor);
        return out;
    }
    Carried plus(const Carried& other) const {
        Carried out = *this;
        out.value += other.value;
        out.speed += other.speed;
        out.error += other.error;
        out.speedError += other.speedError;
        return out;
    }
};

/// Adds what flows out through a face of this area.
void add(Crossing& to, const Carried& through, double side, double area) {
    const double carried = through.value * side * area;
    to.area += area;
    (carried > 0 ? to.out : to.in) += std::abs(carried);
    to.flow += through.speed * side * area;
    to.error += through.error * area;
    to.flowError += through.speedError * area;
}

void add(Crossing& to, const Crossing& other) {
    to.area += other.area;
    to.in += other.in;
    to.out += other.out;
    to.flow += other.flow;
    to.error += other.error;
    to.flowError += other.flowError;
}

/// Of one region in one brick.
struct Part {
    std::array<Crossing, 6> faces;
    std::map<int, Crossing> borders;
    Crossing absent, unlabelled;
    double volume = 0, amount = 0, amountError = 0;

    void add(const Part& other) {
        for (std::size_t f = 0; f < 6; ++f) tessera::volume::add(faces[f], other.faces[f]);
        for (const auto& [value, crossing] : other.borders) tessera::volume::add(borders[value], crossing);
        tessera::volume::add(absent, other.absent);
        tessera::volume::add(unlabelled, other.unlabelled);
        volume += other.volume;
        amount += other.amount;
        amountError += other.amountError;
    }
};

/// A brick of each channel with a border of one sample.
class Around {
public:
    Around(const BrickSource& source, const BalanceQuery& query, glm::ivec3 index) {
        const auto of = [&](int channel) {
            return Neighbourhood(source.grid(), {channel, query.time, 0, index}, 1,
                                 [&](const BrickKey& key) { return source.read(key); });
        };
        value_.push_back(of(query.channel));
        for (const int channel : query.velocity) value_.push_back(of(channel));
        if (query.label >= 0) label_.push_back(of(query.label));
    }
    glm::ivec3 size() const { return value_.front().size(); }
    /// The label of a sample, 0 if the data have no label; nothing if it is absent or outside of the lattice.
    std::optional<int> region(glm::ivec3 in, int axis = 0, int steps = 0) const {
        if (label_.empty()) return 0;
        const auto label = label_.front().at(in, axis, steps);
        if (!label) return std::nullopt;
        return int(std::lround(*label));
    }
    std::optional<double> carried(glm::ivec3 in, int axis = 0, int steps = 0) const {
        return value_[0].at(in, axis, steps);
    }
    /// Component of the velocity along `along`.
    std::optional<double> velocity(glm::ivec3 in, int along, int axis = 0, int steps = 0) const {
        return value_[std::size_t(1 + along)].at(in, axis, steps);
    }

private:
    std::vector<Neighbourhood> value_, label_;
};

/// Where borders of cells lie between samples along an axis.
class Between {
public:
    Between(const BrickGrid& grid, const SampleCells& cells) : grid_(grid), cells_(cells) {}

    /// The share of the sample beyond in the value at the border on a side of a sample.
    double share(glm::ivec3 at, int axis, int side) const {
        if (!grid_.lattice.axes[axis]) return 0.5;
        const double own = distance(at, axis, side);
        return own / (own + distance(next(at, axis, side), axis, -side));
    }
    /// How far the border on a side is, in distances to the sample on the other side.
    double beyond(glm::ivec3 at, int axis, int side) const {
        if (!grid_.lattice.axes[axis]) return 0.5;
        return distance(at, axis, side) / std::abs(place(next(at, axis, -side), axis) - place(at, axis));
    }

private:
    glm::ivec3 next(glm::ivec3 at, int axis, int side) const {
        at[axis] += side * (axis == 2 ? cells_.sublattices() : 1);
        return at;
    }
    double place(glm::ivec3 at, int axis) const { return samplePosition(grid_, at, 0)[axis]; }
    /// From a sample to the border of its cell.
    double distance(glm::ivec3 at, int axis, int side) const {
        const double lower = cells_.lower(at)[axis], border = side > 0 ? lower + cells_.size(at)[axis] : lower;
        return std::abs(border - place(at, axis));
    }

    const BrickGrid& grid_;
    const SampleCells& cells_;
};

/// Fluxes out of the cell of one sample.
void addSample(const Around& around, const SampleCells& cells, const Between& between, const BalanceQuery& query,
               glm::ivec3 in, glm::ivec3 at, int own, Part& part) {
    const auto c = around.carried(in);
    if (!c) return;
    const double volume = cells.volume(at);
    part.volume += volume;
    part.amount += *c * volume;
    part.amountError += query.carriedError * volume;
    const glm::dvec3 box = cells.size(at);
    const int s = cells.sublatticeOf(at);
    for (int axis = 0; axis < 3; ++axis) {
        const auto u = around.velocity(in, axis);
        if (!u) continue;
        const double area = box[(axis + 1) % 3] * box[(axis + 2) % 3] / cells.sublattices();
        const auto carriedBy = [&](double carried, double speed) {
            return Carried(carried, speed, query.carriedError, query.velocityError[std::size_t(axis)]);
        };
        const Carried here = carriedBy(*c, *u);
        for (const int side : {-1, 1}) {
            const int next = cells.within(at)[axis] + side;
            if (next < 0 || next >= cells.count(s, axis)) {
                add(part.faces[std::size_t(2 * axis + (side > 0 ? 1 : 0))], here, side, area);
                continue;
            }
            const auto otherC = around.carried(in, axis, side), otherU = around.velocity(in, axis, axis, side);
            if (!otherC || !otherU) {
                // Half a cell on along the straight line through the sample before: nothing flows through a wall.
                const auto innerC = around.carried(in, axis, -side), innerU = around.velocity(in, axis, axis, -side);
                const bool line = innerC && innerU;
                const double on = line ? between.beyond(at, axis, side) : 0;
                add(part.absent, line ? here.times(1 + on).plus(carriedBy(*innerC, *innerU).times(-on)) : here, side,
                    area);
                continue;
            }
            const auto other = around.region(in, axis, side);
            if (other && *other == own) continue;
            const double share = between.share(at, axis, side);
            const Carried there = carriedBy(*otherC, *otherU);
            add(other ? part.borders[*other] : part.unlabelled,
                share == 0.5 ? here.plus(there).times(0.5) : here.times(1 - share).plus(there.times(share)), side,
                area);
        }
    }
}

} // namespace

Crossing RegionBalance::total() const {
    Crossing sum;
    for (const Crossing& face : faces) add(sum, face);
    for (const BorderCrossing& border : borders) add(sum, border.crossing);
    add(sum, absent);
    add(sum, unlabelled);
    return sum;
}

std::vector<RegionBalance> computeBalance(const BrickSource& source, const BalanceQuery& query,
                                          const Progress& progress) {
    const std::vector<int> regions = query.label >= 0 ? query.regions : std::vector<int>{0};
    // Caches bricks, which are read again as neighbours; does not own the source.
    const BrickCache cache(std::shared_ptr<const BrickSource>(std::shared_ptr<void>(), &source), query.cacheBytes);
    const BrickGrid grid = source.grid();
    const SampleCells cells(grid, source.info().bounds, 0);
    const Between between(grid, cells);
    std::vector<Part> total(regions.size());
    inBrickOrder(
        allBricks(grid),
        [&](glm::ivec3 index) {
            std::vector<Part> parts(regions.size());
            const Around around(cache, query, index);
            const glm::ivec3 first = grid.levelBegin(index, 0);
            forSamples(grid, index, 0, [&](std::size_t, glm::ivec3 at) {
                const auto own = around.region(at - first);
                if (!own) return;
                for (std::size_t r = 0; r < regions.size(); ++r)
                    if (regions[r] == *own) addSample(around, cells, between, query, at - first, at, *own, parts[r]);
            });
            return parts;
        },
        [&](const std::vector<Part>& parts) {
            for (std::size_t r = 0; r < parts.size(); ++r) total[r].add(parts[r]);
        },
        [&](double fraction) { progress.advance(fraction, "balance"); });
    std::vector<RegionBalance> out;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        RegionBalance balance{regions[r],      total[r].faces,      {},
                              total[r].absent, total[r].unlabelled, total[r].volume,
                              total[r].amount, total[r].amountError};
        for (const auto& [value, crossing] : total[r].borders) balance.borders.push_back({value, crossing});
        out.push_back(std::move(balance));
    }
    return out;
}

} // namespace tessera::volume
