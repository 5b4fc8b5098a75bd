#pragma once

#include "volume/reconstruct/reconstruct.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>

/// Extrapolation of a part of a field (volume/field/parts.h) beyond its border, from its own samples.
namespace tessera::volume {

/// Directions to neighbours on a lattice, in half cells, and how far these are, nearest first.
struct LineDirection {
    glm::ivec3 step{0};
    double length = 0; ///< half cells
};
inline std::array<LineDirection, 26> lineDirections(LatticeKind kind) {
    std::array<LineDirection, 26> out;
    std::size_t n = 0;
    const auto add = [&](int least, int most, int scale) { // so many components that are not 0
        for (int i = 0; i < 27; ++i) {
            const glm::ivec3 d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            const int parts = d.x * d.x + d.y * d.y + d.z * d.z;
            if (parts >= least && parts <= most) out[n++] = {d * scale, std::sqrt(double(parts)) * scale};
        }
    };
    if (kind == LatticeKind::BCC) add(3, 3, 1);
    add(1, 1, 2);
    add(2, 2, 2);
    if (kind == LatticeKind::CC) add(3, 3, 2);
    return out;
}

/// Storage index of a place in half cells (all even, on BCC or all odd), and back.
inline glm::ivec3 halfCellsOf(LatticeKind kind, glm::ivec3 at) {
    if (kind == LatticeKind::CC) return at * 2;
    return {2 * at.x + (at.z & 1), 2 * at.y + (at.z & 1), at.z};
}
inline glm::ivec3 storageOf(LatticeKind kind, glm::ivec3 half) {
    if (kind == LatticeKind::CC) return {half.x >> 1, half.y >> 1, half.z >> 1};
    return {half.x >> 1, half.y >> 1, half.z};
}

/// minmod: the number with the smaller magnitude if both have the same sign, else 0.
inline double lesserOf(double a, double b) {
    return a * b <= 0 ? 0 : std::abs(a) < std::abs(b) ? a : b;
}

/// The two lattices' directions, made once.
inline const std::array<LineDirection, 26>& directionsOf(LatticeKind kind) {
    static const std::array<LineDirection, 26> kDirections[] = {lineDirections(LatticeKind::CC),
                                                                lineDirections(LatticeKind::BCC)};
    return kDirections[kind == LatticeKind::BCC ? 1 : 0];
}

/// Slope per half cell at a sample of value `here`: least squares over its neighbours, 0 in directions that they do not
/// span. `sampleAt(place)` returns the sample at a place in half cells.
template <class Sampled>
glm::dvec3 slopeAround(LatticeKind kind, glm::ivec3 place, double here, const Sampled& sampleAt) {
    glm::dmat3 squares(0);
    glm::dvec3 changes(0);
    for (const LineDirection& direction : directionsOf(kind)) {
        const std::optional<double> there = sampleAt(place + direction.step);
        if (!there) continue;
        const glm::dvec3 step = glm::dvec3(direction.step) / direction.length;
        squares += glm::outerProduct(step, step);
        changes += step * ((*there - here) / direction.length);
    }
    constexpr double kUnspanned = 1e-9; // of the trace: what makes the slope across these directions 0
    const double trace = squares[0][0] + squares[1][1] + squares[2][2];
    if (trace == 0) return glm::dvec3(0);
    return glm::inverse(squares + glm::dmat3(kUnspanned * trace)) * changes;
}

/// The value extrapolated to a storage index where the part has no sample. `own(index)` returns samples of the part,
/// empty elsewhere and beyond the lattice. Extrapolates along the lines to neighbours; the lines with the nearest
/// samples count, averaged over equals. Two samples on a line extrapolate linearly, four with the minmod of their two
/// second differences, so that constant curvature is kept while noise and kinks add none. Lines with a single sample,
/// as in a layer one sample thick, are used only if no other is as near, with the slope around that sample.
/// `counts(index)`: whether a line may start at a sample, so that none starts beyond a gap. Empty if no sample lies
/// within kLineReach steps.
inline constexpr int kLineReach = 3;
template <class Own, class Counts>
std::optional<double> continued(LatticeKind kind, glm::ivec3 at, const Own& own, const Counts& counts) {
    constexpr double kSame = 1e-6;
    struct Mean {
        double sum = 0, distance = 1e300;
        int count = 0;
        void add(double value, double from) {
            if (from > distance + kSame) return;
            if (from < distance - kSame) sum = 0, count = 0, distance = from;
            sum += value;
            ++count;
        }
    } lines, single;
    const glm::ivec3 place = halfCellsOf(kind, at);
    const auto sampleAt = [&](glm::ivec3 half) { return own(storageOf(kind, half)); };
    for (const LineDirection& direction : directionsOf(kind))
        for (int m = 1; m <= kLineReach && m * direction.length < lines.distance + kSame; ++m) {
            const auto sample = [&](int n) { return sampleAt(place + n * direction.step); };
            const std::optional<double> a = sample(m);
            if (!a) continue;
            const glm::ivec3 first = place + m * direction.step;
            if (!counts(storageOf(kind, first))) break;
            if (const std::optional<double> b = sample(m + 1)) {
                const std::optional<double> c = sample(m + 2), d = c ? sample(m + 3) : std::nullopt;
                const double bend = d ? lesserOf(*a - 2 * *b + *c, *b - 2 * *c + *d) : 0;
                lines.add(*a + m * (*a - *b) + m * (m + 1) / 2.0 * bend, m * direction.length);
            } else if (m * direction.length < single.distance + kSame) {
                const glm::dvec3 slope = slopeAround(kind, first, *a, sampleAt);
                single.add(*a - glm::dot(slope, glm::dvec3(m * direction.step)), m * direction.length);
            }
            break;
        }
    const Mean& best = lines.count > 0 && lines.distance <= single.distance + kSame ? lines : single;
    if (best.count == 0) return std::nullopt;
    return best.sum / best.count;
}

/// The same on a CC lattice of uneven axes, in space: linear along an axis by the distances of samples, else with the
/// slope around the nearest sample, so that linear functions go on exactly.
template <class Own, class Counts>
std::optional<double> continuedInSpace(const Lattice& lattice, glm::ivec3 at, const Own& own, const Counts& counts) {
    constexpr double kSame = 1e-6, kUnspanned = 1e-9;
    struct Nearest {
        double sum = 0, distance = 1e300;
        int count = 0;
        void add(double value, double from) {
            if (from > distance + kSame) return;
            if (from < distance - kSame) sum = 0, count = 0, distance = from;
            sum += value;
            ++count;
        }
    } lines, single;
    const glm::dvec3 place = lattice.position(at);
    const auto slopeAt = [&](glm::ivec3 first, double here, glm::dvec3 cell) { // per cell
        const glm::dvec3 from = lattice.position(first);
        glm::dmat3 squares(0);
        glm::dvec3 changes(0);
        for (const LineDirection& direction : directionsOf(LatticeKind::CC)) {
            const glm::ivec3 index = first + direction.step / 2;
            const std::optional<double> there = own(index);
            if (!there) continue;
            const glm::dvec3 way = (lattice.position(index) - from) / cell;
            const double length = glm::length(way);
            squares += glm::outerProduct(way / length, way / length);
            changes += way / length * ((*there - here) / length);
        }
        const double trace = squares[0][0] + squares[1][1] + squares[2][2];
        return trace == 0 ? glm::dvec3(0) : glm::inverse(squares + glm::dmat3(kUnspanned * trace)) * changes;
    };
    for (const LineDirection& direction : directionsOf(LatticeKind::CC))
        for (int m = 1; m <= kLineReach && m * direction.length < lines.distance + kSame; ++m) {
            const glm::ivec3 step = direction.step / 2, first = at + m * step;
            const std::optional<double> a = own(first);
            if (!a) continue;
            if (!counts(first)) break;
            const bool alongAxis = step.x * step.x + step.y * step.y + step.z * step.z == 1;
            const glm::dvec3 from = lattice.position(first);
            if (const std::optional<double> b = alongAxis ? own(first + step) : std::nullopt) {
                const double known = glm::length(lattice.position(first + step) - from);
                lines.add(*a + (*a - *b) * glm::length(place - from) / known, m * direction.length);
            } else if (m * direction.length < single.distance + kSame) {
                const glm::dvec3 cell = lattice.lengthsAt(from);
                single.add(*a + glm::dot(slopeAt(first, *a, cell), (place - from) / cell), m * direction.length);
            }
            break;
        }
    const Nearest& best = lines.count > 0 && lines.distance <= single.distance + kSame ? lines : single;
    if (best.count == 0) return std::nullopt;
    return best.sum / best.count;
}

/// Whether two storage indices lie within a cell of each other along each axis: no absent sample lies between them.
inline bool isBeside(LatticeKind kind, glm::ivec3 a, glm::ivec3 b) {
    const glm::ivec3 apart = glm::abs(halfCellsOf(kind, a) - halfCellsOf(kind, b));
    return apart.x <= 2 && apart.y <= 2 && apart.z <= 2;
}

/// How far from a sample OwnPart looks for its neighbours, in samples of a sublattice.
inline constexpr int kOwnPartReach = 4;

/// A sample accessor (volume/reconstruct/reconstruct.h) that shows one part of another accessor: that of the sample at
/// `near`, a storage index inside a lattice of `size`, extrapolated to samples of other parts. `partOf(at)` accepts the
/// same indices as `samples`. Keeps references to both.
template <class Samples, class PartOf> class OwnPart {
public:
    OwnPart(LatticeKind kind, glm::ivec3 size, const Samples& samples, const PartOf& partOf, glm::ivec3 near)
        : kind_(kind), size_(size), samples_(samples), partOf_(partOf), near_(near), here_(samples(near)),
          own_(partOf(near)) {}
    /// Of a lattice, which must outlive this: in space where its axes are uneven (of BCC in cells).
    OwnPart(const Lattice& lattice, const Samples& samples, const PartOf& partOf, glm::ivec3 near)
        : OwnPart(lattice.kind, lattice.size, samples, partOf, near) {
        if (lattice.kind == LatticeKind::CC && !lattice.isEven()) uneven_ = &lattice;
    }

    Sample operator()(glm::ivec3 at) const {
        if (partOf_(at) == own_) return samples_(at);
        if (!here_.present) return {0, false};
        const auto own = [&](glm::ivec3 there) -> std::optional<double> {
            if (clampToLattice(kind_, size_, there) != there || partOf_(there) != own_) return std::nullopt;
            const Sample sample = samples_(there);
            return sample.present ? std::optional(sample.value) : std::nullopt;
        };
        const auto counts = [&](glm::ivec3 there) { return isBeside(kind_, there, near_); };
        const std::optional<double> value =
            uneven_ ? continuedInSpace(*uneven_, at, own, counts) : continued(kind_, at, own, counts);
        return {value.value_or(here_.value), true};
    }

private:
    const Lattice* uneven_ = nullptr;
    LatticeKind kind_;
    glm::ivec3 size_;
    const Samples& samples_;
    const PartOf& partOf_;
    glm::ivec3 near_;
    Sample here_;
    int own_;
};

} // namespace tessera::volume
