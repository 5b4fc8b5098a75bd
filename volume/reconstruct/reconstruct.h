#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/reconstruct/present_coverage.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <optional>

/// Reconstruction between samples, in double: the twins of the shader's filters and the judge of them.
///
/// Everything here works on a *sample accessor*: any callable `Sample operator()(glm::ivec3 at) const` that takes a
/// storage index (Lattice; on BCC even z is the even sublattice, odd z the moved one) with any integers and repeats the
/// nearest sample of the same sublattice beyond the lattice. Positions are `cells`: Lattice::toCells of level 0.
///
/// Absent samples take no part: the result is sum(weight * value) / sum(weight) over the present ones, and absent when
/// they carry less than half of the weight (kPresentCoverage).
///
/// BCC filters: E. Roeber 2002, section 4.1 (average); B. Csebfalvi, An evaluation of prefiltered B-spline
/// reconstruction for quasi-interpolation on the body-centered cubic lattice, TVCG 2010 (prefilter); A. Entezari,
/// R. Dyer, T. Moeller, Linear and cubic box splines for the BCC lattice, Vis 2004 (4-point).
namespace tessera::volume {

struct Sample {
    double value = 0;
    bool present = true;
};

/// A storage index moved to the nearest one of the same sublattice inside a lattice of `size` storage samples.
inline glm::ivec3 clampToLattice(LatticeKind kind, glm::ivec3 size, glm::ivec3 at) {
    const glm::ivec3 last = size - 1;
    if (kind == LatticeKind::CC) return glm::clamp(at, glm::ivec3(0), last);
    const int parity = at.z & 1;
    const int top = last.z - ((last.z ^ parity) & 1); // the last slice of that parity, -1 when there is none
    return {glm::clamp(at.x, 0, last.x), glm::clamp(at.y, 0, last.y), top < 0 ? 0 : glm::clamp(at.z, parity, top)};
}

/// The samples of a field. Refers to the field.
struct FieldSamples {
    const Field& field;
    Sample operator()(glm::ivec3 at) const {
        const std::size_t index = field.lattice.index(clampToLattice(field.lattice.kind, field.lattice.size, at));
        const bool present = field.present(index);
        return {present ? field.value(index) : 0.0, present};
    }
};

/// The samples of a brick whose first one has the storage index `first` (of its level; even z on BCC), as gather()
/// makes them: first = levelBegin(brick) - halo * (1, 1, BCC ? 2 : 1). Refers to the samples.
struct BrickView {
    const BrickSamples& brick;
    LatticeKind kind;
    glm::ivec3 first{0};
    Sample operator()(glm::ivec3 at) const {
        const glm::ivec3 in = clampToLattice(kind, brick.size, at - first);
        const std::size_t index =
            (std::size_t(in.z) * std::size_t(brick.size.y) + std::size_t(in.y)) * std::size_t(brick.size.x) +
            std::size_t(in.x);
        const bool present = brick.isPresent(index);
        return {present ? double(brick.values[index]) : 0.0, present};
    }
};

/// Where the samples of one level lie: sample i of sublattice s at cell i * scale + phase + s / 2. On BCC only level 0
/// is a BCC lattice; at coarser levels the two sublattices lie half a *fine* cell apart.
struct LevelGeometry {
    LatticeKind kind = LatticeKind::CC;
    double scale = 1; ///< 2^level
    double phase = 0; ///< BrickGrid::levelPhase
    bool bccNeighbours() const { return kind == LatticeKind::BCC && scale == 1; }
    /// Continuous index within a sublattice.
    glm::dvec3 toSublattice(glm::dvec3 cells, int sublattice) const {
        return (cells - phase - 0.5 * sublattice) / scale;
    }
};

inline LevelGeometry levelGeometry(const BrickGrid& grid, int level) {
    return {grid.lattice.kind, double(1 << level), grid.levelPhase(level)};
}

/// Filtered samples for quasi-interpolation of order two by the linear filters: 3/2 at the centre and -1/12 on the six
/// neighbours (CC, and each sublattice of coarse BCC levels), 5/3 and -1/12 on the eight neighbours (BCC). An absent
/// neighbour counts as the centre's own value; an absent sample stays absent. Values may leave the range of the data by
/// up to 2/3 (CC: 1/2) of its width.
template <class Samples> struct Prefiltered {
    const Samples& samples;
    bool bccNeighbours = false; ///< LevelGeometry::bccNeighbours()
    int sliceStep = 1;          ///< storage slices between samples of one sublattice: 2 on BCC

    Prefiltered(const Samples& raw, const LevelGeometry& geometry)
        : samples(raw), bccNeighbours(geometry.bccNeighbours()), sliceStep(geometry.kind == LatticeKind::BCC ? 2 : 1) {}

    Sample operator()(glm::ivec3 at) const {
        const Sample centre = samples(at);
        if (!centre.present) return centre;
        double differences = 0; // of the neighbours to the centre
        const auto add = [&](int x, int y, int z) {
            const Sample neighbour = samples(at + glm::ivec3(x, y, z));
            if (neighbour.present) differences += neighbour.value - centre.value;
        };
        if (bccNeighbours) {
            const int lo = (at.z & 1) - 1; // an even sample's neighbours have indices -1 and 0, an odd one's 0 and 1
            for (int z : {-1, 1})
                for (int y : {lo, lo + 1})
                    for (int x : {lo, lo + 1}) add(x, y, z);
        } else {
            for (int side : {-1, 1}) {
                add(side, 0, 0);
                add(0, side, 0);
                add(0, 0, side * sliceStep);
            }
        }
        return {centre.value - differences / 12, true};
    }
};

/// The prefilter above on the samples of a brick gathered with a halo: the result has one sample of each sublattice
/// less on every side. So gather with halo 2 for filtered samples with halo 1. Absent samples get the value 0.
BrickSamples prefilter(const BrickSamples& gathered, const LevelGeometry& geometry);

/// A weighted sum being accumulated: value() is normalised by coverage.
struct Blend {
    double sum = 0, coverage = 0;
    void add(double weight, const Sample& sample) {
        if (!sample.present) return;
        sum += weight * sample.value;
        coverage += weight;
    }
    /// nullopt where less than half of the weight (kPresentCoverage) is present.
    std::optional<double> value() const {
        if (coverage < kPresentCoverage) return std::nullopt;
        return sum / coverage;
    }
    /// In the cell of `own`, whose borders need not lie half-way between samples: wherever that is present, by those
    /// that are. For axes with uneven spacing.
    std::optional<double> valueInCellOf(const Sample& own) const {
        constexpr double kSome = 1e-6;
        if (!own.present) return std::nullopt;
        return coverage > kSome ? sum / coverage : own.value;
    }
};

/// Adds `weight` times the trilinear interpolation within one sublattice at a continuous index of it.
template <class Samples>
void addTrilinear(Blend& blend, const Samples& samples, glm::dvec3 index, int sublattice, int sliceStep,
                  double weight) {
    const glm::dvec3 base = glm::floor(index), f = index - base;
    const glm::ivec3 first(base);
    const double inX[2] = {1 - f.x, f.x}, inY[2] = {1 - f.y, f.y}, inZ[2] = {1 - f.z, f.z};
    Blend sum = blend; // a variable of its own stays in registers
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) {
                const double w = inX[x] * inY[y] * inZ[z];
                if (w == 0) continue;
                sum.add(w * weight,
                        samples(glm::ivec3(first.x + x, first.y + y, (first.z + z) * sliceStep + sublattice)));
            }
    blend = sum;
}

/// CC: trilinear. BCC: the average of the trilinear interpolations of both sublattices. Over Prefiltered samples these
/// are the quasi-interpolating filters (the default of the renderer).
template <class Samples> Blend linear(const LevelGeometry& geometry, const Samples& samples, glm::dvec3 cells) {
    Blend blend;
    if (geometry.kind == LatticeKind::CC) {
        addTrilinear(blend, samples, geometry.toSublattice(cells, 0), 0, 1, 1);
    } else {
        addTrilinear(blend, samples, geometry.toSublattice(cells, 0), 0, 2, 0.5);
        addTrilinear(blend, samples, geometry.toSublattice(cells, 1), 1, 2, 0.5);
    }
    return blend;
}

/// The linear box spline of BCC: the four corners of the tetrahedron around a position, barycentric weights.
/// Interpolates the samples; exact on linear functions. Level 0 of BCC only (elsewhere falls back to `linear`).
template <class Samples> Blend tetrahedral(const LevelGeometry& geometry, const Samples& samples, glm::dvec3 cells) {
    if (!geometry.bccNeighbours()) return linear(geometry, samples, cells);
    const glm::dvec3 p = cells * 2.0; // lattice points now have all coordinates even or all odd
    const glm::dvec3 skew((p.x + p.y) / 2, (p.x + p.z) / 2, (p.y + p.z) / 2);
    const glm::dvec3 base = glm::floor(skew), f = skew - base;
    const glm::ivec3 n(base);
    glm::ivec3 corner(n.x + n.y - n.z, n.x - n.y + n.z, -n.x + n.y + n.z);
    // Walk from corner to corner, largest fraction first.
    struct Step {
        double fraction;
        glm::ivec3 step;
    } steps[] = {{f.x, {1, 1, -1}}, {f.y, {1, -1, 1}}, {f.z, {-1, 1, 1}}};
    if (steps[0].fraction < steps[1].fraction) std::swap(steps[0], steps[1]);
    if (steps[1].fraction < steps[2].fraction) std::swap(steps[1], steps[2]);
    if (steps[0].fraction < steps[1].fraction) std::swap(steps[0], steps[1]);
    Blend blend;
    const auto add = [&](double weight) {
        if (weight > 0) blend.add(weight, samples(glm::ivec3(corner.x >> 1, corner.y >> 1, corner.z)));
    };
    add(1 - steps[0].fraction);
    for (int i = 0; i < 3; ++i) {
        corner += steps[i].step;
        add(steps[i].fraction - (i < 2 ? steps[i + 1].fraction : 0));
    }
    return blend;
}

/// The two sublattices' trilinear interpolations, mixed by cosines so that each counts alone at its own samples: weight
/// 1/2 + (cos 2 pi x + cos 2 pi y + cos 2 pi z) / 6 of the even one, x, y, z in cells. Interpolates; exact on linear
/// functions. Level 0 of BCC only (elsewhere falls back to `linear`). (B. Csebfalvi, Cosine-weighted B-spline
/// interpolation, 2013.)
template <class Samples> Blend cosineWeighted(const LevelGeometry& geometry, const Samples& samples, glm::dvec3 cells) {
    if (!geometry.bccNeighbours()) return linear(geometry, samples, cells);
    const glm::dvec3 turn = glm::cos(cells * 2.0 * std::numbers::pi);
    const double even = 0.5 + (turn.x + turn.y + turn.z) / 6;
    Blend blend;
    addTrilinear(blend, samples, geometry.toSublattice(cells, 0), 0, 2, even);
    addTrilinear(blend, samples, geometry.toSublattice(cells, 1), 1, 2, 1 - even);
    return blend;
}

/// The quintic box spline of BCC, the linear one convolved with itself, at a place in half cells; the values at all
/// lattice points sum to 1. Twice continuously differentiable, 0 from |x| + |y| = 4 on (any two coordinates).
/// A. Entezari, D. Van De Ville, T. Moeller, Practical box splines for reconstruction on the body centered cubic
/// lattice, TVCG 2008; evaluated here as differences of truncated powers.
double quinticBoxSpline(glm::dvec3 halfCells);

/// Reconstruction by the quintic box spline, 32 samples: over Prefiltered samples of order four (cubics are exact),
/// over samples as they are a smoothing filter. Level 0 of BCC only (elsewhere falls back to `linear`).
template <class Samples> Blend quinticBox(const LevelGeometry& geometry, const Samples& samples, glm::dvec3 cells) {
    if (!geometry.bccNeighbours()) return linear(geometry, samples, cells);
    const glm::dvec3 p = cells * 2.0;
    const glm::ivec3 first(glm::floor(p));
    Blend blend;
    for (int z = first.z - 3; z <= first.z + 4; ++z)
        for (int y = first.y - 3; y <= first.y + 4; ++y)
            for (int x = first.x - 3; x <= first.x + 4; ++x) {
                if (((x ^ z) & 1) != 0 || ((y ^ z) & 1) != 0) continue; // all even or all odd
                const double weight = quinticBoxSpline(p - glm::dvec3(x, y, z));
                if (weight != 0) blend.add(weight, samples(glm::ivec3(x >> 1, y >> 1, z)));
            }
    return blend;
}

/// The sample nearest to a position, measured in cells as Lattice::nearest does; of a tie the even sublattice.
template <class Samples> Sample nearest(const LevelGeometry& geometry, const Samples& samples, glm::dvec3 cells) {
    Sample best;
    double bestDistance = 0;
    const int sublattices = geometry.kind == LatticeKind::BCC ? 2 : 1;
    for (int s = 0; s < sublattices; ++s) {
        const glm::dvec3 index = geometry.toSublattice(cells, s);
        const glm::dvec3 at = glm::floor(index + 0.5);
        const glm::dvec3 apart = at - index;
        const double distance = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
        if (s > 0 && distance >= bestDistance) continue;
        bestDistance = distance;
        best = samples(glm::ivec3(int(at.x), int(at.y), int(at.z) * sublattices + s));
    }
    return best;
}

} // namespace tessera::volume
