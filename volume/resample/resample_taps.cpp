#include "volume/resample/resample_taps.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera::volume {

namespace {

/// Samples on either side of a position that the kernel spans; 0: the nearest alone.
int radiusOf(const ResampleOptions& options) {
    switch (options.filter) {
    case ResampleFilter::Nearest:
        return 0;
    case ResampleFilter::Linear:
        return 1;
    case ResampleFilter::Cubic:
    case ResampleFilter::BSpline3:
        return 2;
    case ResampleFilter::BSpline5:
        return 3;
    case ResampleFilter::Lagrange:
        return (options.order + 2) / 2;
    case ResampleFilter::Sinc:
        break;
    }
    return options.order;
}

double catmullRom(double x) {
    x = std::abs(x);
    if (x < 1) return (1.5 * x - 2.5) * x * x + 1;
    return x < 2 ? ((-0.5 * x + 2.5) * x - 4) * x + 2 : 0;
}

double cubicSpline(double x) {
    x = std::abs(x);
    if (x < 1) return (0.5 * x - 1) * x * x + 2.0 / 3;
    return x < 2 ? (2 - x) * (2 - x) * (2 - x) / 6 : 0;
}

double quinticSpline(double x) {
    x = std::abs(x);
    const auto power = [](double v) { return v > 0 ? v * v * v * v * v : 0; };
    return (power(3 - x) - 6 * power(2 - x) + 15 * power(1 - x)) / 120;
}

double lanczos(double x, int radius) {
    if (x == std::round(x)) return x == 0 ? 1 : 0;
    if (std::abs(x) >= radius) return 0;
    const double t = std::numbers::pi * x;
    return radius * std::sin(t) * std::sin(t / radius) / (t * t);
}

double kernel(double x, const ResampleOptions& options) {
    switch (options.filter) {
    case ResampleFilter::Cubic:
        return catmullRom(x);
    case ResampleFilter::BSpline3:
        return cubicSpline(x);
    case ResampleFilter::BSpline5:
        return quinticSpline(x);
    case ResampleFilter::Sinc:
        return lanczos(x, options.order);
    default:
        return std::max(1 - std::abs(x), 0.0);
    }
}

/// Adds the weight of a sample. Beyond a face, the data are continued by point reflection.
void addReflected(Tap& tap, int index, double weight, int count) {
    const int last = count - 1;
    while (index < 0 || index > last) {
        const int face = index < 0 ? 0 : last;
        tap.weight[std::size_t(face - tap.first)] += 2 * weight;
        weight = -weight;
        index = 2 * face - index;
        if (last == 0) index = 0; // every reflection of the only sample is the sample
    }
    tap.weight[std::size_t(index - tap.first)] += weight;
}

/// The Lagrange polynomial through `tap.count` samples from tap.first on.
void addLagrange(Tap& tap, double cells) {
    for (int k = 0; k < tap.count; ++k) {
        double weight = 1;
        for (int m = 0; m < tap.count; ++m)
            if (m != k) weight *= (cells - (tap.first + m)) / (k - m);
        tap.weight[std::size_t(k)] = weight;
    }
}

} // namespace

void checkOrder(const ResampleOptions& options) {
    if (options.order < kLeastOrder || options.order > kMostOrder)
        throw Error("the order of a filter must be from " + std::to_string(kLeastOrder) + " to " +
                    std::to_string(kMostOrder));
}

int tapCount(const ResampleOptions& options, int count) {
    if (options.filter == ResampleFilter::Lagrange) return std::min(options.order + 1, count);
    return std::min(std::max(2 * radiusOf(options), 1), count);
}

Tap tapAt(double cells, int count, const ResampleOptions& options) {
    Tap tap;
    const double inside = std::clamp(cells, 0.0, double(count - 1));
    const int base = std::min(int(inside), std::max(count - 2, 0)), radius = radiusOf(options);
    tap.nearest = int(std::floor(inside + 0.5));
    tap.cell = {base, std::min(base + 1, count - 1)};
    tap.fraction = inside - base;
    tap.count = tapCount(options, count);
    if (options.filter == ResampleFilter::Nearest) {
        tap.first = tap.nearest;
        tap.weight[0] = 1;
        return tap;
    }
    // An even number of samples lies around the cell, an odd one around the nearest sample.
    const bool odd = options.filter == ResampleFilter::Lagrange && tap.count % 2 != 0;
    tap.first = std::clamp(odd ? tap.nearest - tap.count / 2 : base + 1 - radius, 0, count - tap.count);
    if (options.filter == ResampleFilter::Lagrange) {
        if (!odd) tap.first = std::clamp(base + 1 - tap.count / 2, 0, count - tap.count);
        addLagrange(tap, inside);
        return tap;
    }
    double sum = 0;
    for (int i = base + 1 - radius; i <= base + radius; ++i) sum += kernel(inside - i, options);
    for (int i = base + 1 - radius; i <= base + radius; ++i)
        addReflected(tap, i, kernel(inside - i, options) / sum, count);
    return tap;
}

Tap countedFrom(Tap tap, int first) {
    tap.first -= first;
    tap.nearest -= first;
    for (int& cell : tap.cell) cell -= first;
    return tap;
}

namespace {

bool sameAxis(const Lattice& a, const Lattice& b, int axis) {
    const AxisMap *own = a.axes[axis], *other = b.axes[axis];
    return own == other || (own && other && *own == *other);
}

/// The place in space of sample `i` of a sublattice; the other coordinates mean nothing.
glm::dvec3 placeAlong(const Lattice& lattice, int sublattice, int axis, int i) {
    glm::dvec3 cells(0);
    cells[axis] = i + sublattice * 0.5;
    return lattice.fromCells(cells);
}

} // namespace

double sourceCells(const Lattice& source, const Lattice& target, int sublattice, int axis, int i) {
    if (!sameAxis(source, target, axis)) return source.toCells(placeAlong(target, sublattice, axis, i))[axis];
    const double half = sublattice * 0.5;
    const double cells =
        (target.origin[axis] - source.origin[axis] + target.spacing[axis] * (i + half)) / source.spacing[axis];
    const double whole = std::round(cells);
    return std::abs(cells - whole) < 1e-9 * (1 + std::abs(cells)) ? whole : cells; // same grid, rounded origin
}

AxisTaps tapsFor(const Lattice& source, const Lattice& target, int sublattice, const ResampleOptions& options) {
    const glm::ivec3 size = target.sublatticeSize(sublattice);
    AxisTaps taps;
    std::vector<Tap>* const axes[] = {&taps.x, &taps.y, &taps.z};
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < size[axis]; ++i) {
            const double cells = sourceCells(source, target, sublattice, axis, i);
            const int count = source.size[axis];
            if (sameAxis(source, target, axis) || options.filter == ResampleFilter::Nearest) {
                axes[axis]->push_back(tapAt(cells, count, options));
                continue;
            }
            Tap tap = tapAt(source.between(placeAlong(target, sublattice, axis, i))[axis], count, options);
            tap.nearest = std::clamp(int(std::floor(cells + 0.5)), tap.cell[0], tap.cell[1]);
            axes[axis]->push_back(tap);
        }
    return taps;
}

} // namespace tessera::volume
