#include "volume/flow/sections.h"

#include "volume/base/error.h"
#include "volume/bricks/brick_columns.h"
#include "volume/bricks/sample_cells.h"
#include "volume/bricks/sample_position.h"
#include "volume/flow/box_cut.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>

namespace tessera::volume {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The contribution of a sample to one plane.
struct Share {
    int plane;
    double area;   ///< of its cell in the plane
    double volume; ///< of its cell in the slab, by its thickness
};

/// The planes, and their intersections with the cells of samples.
class Planes {
public:
    Planes(const SectionQuery& query, const SampleCells& cells, const BrickGrid& grid)
        : cells_(cells), axis_(int(query.axis)) {
        if (query.line) {
            onLine((*query.line)[0], (*query.line)[1], query.planes);
            return;
        }
        const int sublattices = cells.sublattices();
        for (int p = 0;; ++p) {
            const int s = p % sublattices, i = p / sublattices;
            if (i >= cells.count(s, axis_)) break;
            glm::ivec3 at(0);
            at[axis_] = i;
            at.z = at.z * sublattices + s;
            place_.push_back(samplePosition(grid, at, 0)[axis_]);
            thickness_.push_back(cells.length(s, axis_, i) / sublattices);
        }
    }

    const std::vector<double>& place() const { return place_; }
    const std::vector<double>& thickness() const { return thickness_; }
    glm::dvec3 direction() const {
        if (line_) return direction_;
        glm::dvec3 along(0);
        along[axis_] = 1;
        return along;
    }

    /// The planes that the cell of a sample meets, in order.
    void sharesOf(glm::ivec3 at, std::vector<Share>& out) const {
        out.clear();
        const glm::dvec3 box = cells_.size(at);
        if (!line_) {
            const int plane = cells_.within(at)[axis_] * cells_.sublattices() + cells_.sublatticeOf(at);
            const double area = box[(axis_ + 1) % 3] * box[(axis_ + 2) % 3];
            out.push_back({plane, area, area});
            return;
        }
        const glm::dvec3 lower = cells_.lower(at) - start_;
        const BoxCut cut(direction_, lower, lower + box);
        const double thick = thickness_.front(), most = double(place_.size()) - 1;
        const auto plane = [&](double s) { return int(std::clamp(std::floor(s / thick), -1.0, most + 1)); };
        const int first = std::max(plane(cut.first()), 0), last = std::min(plane(cut.last()), int(most));
        double below = first <= last ? cut.volume(first * thick) : 0;
        for (int p = first; p <= last; ++p) {
            const double next = cut.volume((p + 1) * thick);
            const double weight = 1.0 / cells_.sublattices();
            out.push_back({p, weight * cut.area((p + 0.5) * thick), weight * (next - below) / thick});
            below = next;
        }
    }

private:
    void onLine(glm::dvec3 from, glm::dvec3 to, int planes) {
        const double length = glm::length(to - from);
        if (!(length > 0) || planes < 1) throw Error("planes across a line need a line that has a length");
        line_ = true;
        start_ = from;
        direction_ = (to - from) / length;
        for (int p = 0; p < planes; ++p) place_.push_back((p + 0.5) * length / planes);
        thickness_.assign(std::size_t(planes), length / planes);
    }

    const SampleCells& cells_;
    int axis_;
    bool line_ = false;
    glm::dvec3 start_{0}, direction_{0};
    std::vector<double> place_, thickness_;
};

/// Along the normal of the planes, with the bound on its error.
struct Speed {
    double value = 0, error = 0;
};

/// Of one region, channel and plane.
struct PlaneSums {
    double samples = 0, area = 0, integral = 0, weight = 0, weighted = 0, flux = 0, flow = 0;
    double fluxError = 0, flowError = 0;
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();

    void add(const PlaneSums& other) {
        samples += other.samples;
        area += other.area;
        integral += other.integral;
        weight += other.weight;
        weighted += other.weighted;
        flux += other.flux;
        flow += other.flow;
        fluxError += other.fluxError;
        flowError += other.flowError;
        least = std::min(least, other.least);
        most = std::max(most, other.most);
    }
    SectionValues values() const {
        SectionValues out{samples, area, kNone, kNone, kNone, kNone, flux, flow, fluxError, flowError};
        if (!(area > 0)) return out;
        out.integral = integral;
        if (weight > 0) out.mean = weighted / weight;
        if (least <= most) {
            out.least = least;
            out.most = most;
        }
        return out;
    }
};

/// The planes that a brick meets: sums[(region * channels + channel) * planes + plane - first].
struct BrickSections {
    int first = 0, planes = 0;
    std::vector<PlaneSums> sums;
};

class Sectioner {
public:
    Sectioner(const BrickSource& source, const SectionQuery& query)
        : source_(source), query_(query), grid_(source.grid()), cells_(grid_, source.info().bounds, 0),
          planes_(query, cells_, grid_), regions_(std::max<std::size_t>(1, query.regions.size())) {}

    Sections run(const Progress& progress) {
        const std::size_t channels = query_.channels.size(), planes = planes_.place().size();
        std::vector<PlaneSums> all(regions_ * channels * planes);
        inBrickOrder(
            allBricks(grid_), [&](glm::ivec3 at) { return brick(at); },
            [&](const BrickSections& part) {
                for (std::size_t rc = 0; rc < regions_ * channels; ++rc)
                    for (std::size_t p = 0; p < std::size_t(part.planes); ++p)
                        all[rc * planes + std::size_t(part.first) + p].add(
                            part.sums[rc * std::size_t(part.planes) + p]);
            },
            [&](double fraction) { progress.advance(fraction, "sections"); });
        Sections out{planes_.place(), planes_.thickness(), query_.regions, {}};
        out.values.resize(regions_);
        for (std::size_t r = 0; r < regions_; ++r)
            for (std::size_t c = 0; c < channels; ++c) {
                std::vector<SectionValues>& values = out.values[r].emplace_back();
                for (std::size_t p = 0; p < planes; ++p)
                    values.push_back(all[(r * channels + c) * planes + p].values());
            }
        return out;
    }

private:
    /// Planes that the cells of a brick can meet.
    void boundPlanes(glm::ivec3 index, BrickSections& out) const {
        const glm::ivec3 begin = grid_.levelBegin(index, 0), end = begin + grid_.brickSamples(index, 0) - 1;
        const int step = cells_.sublattices();
        if (!query_.line) {
            const int axis = int(query_.axis);
            out.first = axis == 2 ? begin.z : begin[axis] * step;
            out.planes = (axis == 2 ? end.z : end[axis] * step + step - 1) - out.first + 1;
            return;
        }
        glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi(-lo);
        for (const int z : {begin.z, std::min(begin.z + step - 1, end.z), end.z, std::max(end.z - step + 1, begin.z)})
            for (const glm::ivec3 at : {glm::ivec3(begin.x, begin.y, z), glm::ivec3(end.x, end.y, z)}) {
                lo = glm::min(lo, cells_.lower(at));
                hi = glm::max(hi, cells_.lower(at) + cells_.size(at));
            }
        const glm::dvec3 start = (*query_.line)[0];
        const BoxCut box(planes_.direction(), lo - start, hi - start);
        const double thick = planes_.thickness().front(), count = double(planes_.place().size());
        const double first = std::clamp(std::floor(box.first() / thick) - 1, 0.0, count);
        out.first = int(first);
        out.planes = int(std::max(0.0, std::clamp(std::floor(box.last() / thick) + 2, 0.0, count) - first));
    }

    BrickSections brick(glm::ivec3 index) const {
        BrickSections out;
        boundPlanes(index, out);
        if (out.planes == 0) return out;
        const std::size_t channels = query_.channels.size(), planes = std::size_t(out.planes);
        out.sums.resize(regions_ * channels * planes);
        const auto columns = brickColumns(source_, query_.channels, query_.time, index);
        const auto interest = brickColumns(source_, query_.doiChannels, query_.time, index);
        const std::vector<double> label = brickColumn(source_, query_.label, query_.time, index);
        const std::vector<double> density = brickColumn(source_, query_.density, query_.time, index);
        const bool moving = query_.velocity[0] >= 0;
        const auto velocity =
            moving ? brickColumns(source_, query_.velocity, query_.time, index) : std::vector<std::vector<double>>();
        const glm::dvec3 along = planes_.direction();
        std::vector<float> values(query_.doiChannels.size());
        std::vector<Share> shares;
        forSamples(grid_, index, 0, [&](std::size_t i, glm::ivec3 at) {
            const int region = regionOf(query_.regions, label.empty() ? 0.0 : label[i]);
            if (region < 0) return;
            double doi = 1;
            if (query_.doi) {
                for (std::size_t c = 0; c < values.size(); ++c) values[c] = float(interest[c][i]);
                doi = std::clamp(query_.doi(values, samplePosition(grid_, at, 0)), 0.0, 1.0);
                if (doi <= 0) return;
            }
            Speed speed;
            for (int axis = 0; moving && axis < 3; ++axis)
                if (along[axis] != 0) {
                    speed.value += along[axis] * velocity[std::size_t(axis)][i];
                    speed.error += std::abs(along[axis]) * query_.velocityError[std::size_t(axis)];
                }
            if (std::isnan(speed.value)) speed = {};
            const double rho = density.empty() ? 1.0 : density[i];
            planes_.sharesOf(at, shares);
            for (std::size_t c = 0; c < channels; ++c) {
                const double value = columns[c][i];
                if (std::isnan(value)) continue;
                for (const Share& share : shares)
                    add(out.sums[(std::size_t(region) * channels + c) * planes + std::size_t(share.plane - out.first)],
                        share, value, query_.errors.empty() ? 0 : query_.errors[c], doi, speed, rho);
            }
        });
        return out;
    }

    void add(PlaneSums& sums, const Share& share, double value, double error, double doi, Speed along,
             double rho) const {
        const double area = (query_.weight == SectionWeight::Volume ? share.volume : share.area) * doi;
        if (!(area > 0)) return;
        const double f = value, speed = along.value, mass = std::abs(rho * speed);
        const double weight = query_.weight == SectionWeight::MassFlow ? (std::isnan(mass) ? 0 : mass * area) : area;
        sums.samples += doi;
        sums.area += area;
        sums.integral += f * area;
        sums.weight += weight;
        sums.weighted += f * weight;
        sums.flux += f * speed * area;
        sums.flow += speed * area;
        sums.fluxError += (std::abs(speed) * error + std::abs(f) * along.error + error * along.error) * area;
        sums.flowError += along.error * area;
        if (doi < 0.5) return;
        sums.least = std::min(sums.least, value);
        sums.most = std::max(sums.most, value);
    }

    const BrickSource& source_;
    const SectionQuery& query_;
    const BrickGrid grid_;
    const SampleCells cells_;
    const Planes planes_;
    std::size_t regions_;
};

} // namespace

Sections computeSections(const BrickSource& source, const SectionQuery& query, const Progress& progress) {
    assert(query.regions.empty() || query.label >= 0);
    return Sectioner(source, query).run(progress);
}

std::vector<int> labelValues(const BrickSource& source, int label, int time, const Progress& progress) {
    std::set<int> all;
    inBrickOrder(
        allBricks(source.grid()),
        [&](glm::ivec3 at) {
            std::set<int> values;
            for (const double value : brickColumn(source, label, time, at))
                if (std::abs(value) < 2e9) values.insert(int(std::lround(value)));
            return values;
        },
        [&](const std::set<int>& values) { all.insert(values.begin(), values.end()); },
        [&](double fraction) { progress.advance(fraction, "regions"); });
    return {all.begin(), all.end()};
}

} // namespace tessera::volume
