#include "volume/lattice_error.h"

#include "volume/parallel.h"
#include "volume/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tessera::volume {

namespace {

constexpr int kMargin = 3; // cells beyond the box: one for the filter, one for the prefilter, one for rounding

/// Samples on a piece of an endless lattice: the box and a margin around it.
struct Piece {
    Lattice lattice; ///< starts kMargin cells before the box
    std::vector<double> values;

    Sample operator()(glm::ivec3 at) const {
        return {values[lattice.index(clampToLattice(lattice.kind, lattice.size, at))], true};
    }
};

template <class Value> std::vector<double> everySample(const Lattice& lattice, const Value& value) {
    std::vector<double> values(lattice.count());
    parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i) {
                const glm::ivec3 at(i, j, int(k));
                values[lattice.index(at)] = value(at);
            }
    });
    return values;
}

} // namespace

LatticeError latticeError(const std::function<double(glm::dvec3)>& signal, LatticeKind kind, double spacing,
                          LatticeFilter filter, const Box& box, std::size_t points, unsigned seed) {
    const int slices = kind == LatticeKind::BCC ? 2 : 1;
    Piece piece;
    piece.lattice.kind = kind;
    piece.lattice.spacing = glm::dvec3(spacing);
    piece.lattice.origin = box.lo - double(kMargin) * spacing;
    piece.lattice.size = glm::ivec3(glm::ceil(box.size() / spacing)) + 2 * kMargin + 1;
    piece.lattice.size.z *= slices;
    const Lattice& lattice = piece.lattice;
    piece.values = everySample(lattice, [&](glm::ivec3 at) { return signal(lattice.position(at)); });
    const LevelGeometry geometry{kind, 1, 0};
    if (filter == LatticeFilter::Quasi) {
        const Prefiltered filtered(piece, geometry);
        piece.values = everySample(lattice, [&](glm::ivec3 at) { return filtered(at).value; });
    }

    std::mt19937_64 random(seed);
    std::vector<glm::dvec3> positions(points);
    for (glm::dvec3& p : positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = box.lo[axis] + box.size()[axis] * double(random() >> 11) * 0x1p-53;
    std::vector<double> errors(points);
    parallelFor(
        points,
        [&](std::size_t i) {
            const glm::dvec3 cells = lattice.toCells(positions[i]);
            const Blend blend = filter == LatticeFilter::Tetrahedral ? tetrahedral(geometry, piece, cells)
                                                                     : linear(geometry, piece, cells);
            errors[i] = std::abs(blend.sum / blend.coverage - signal(positions[i]));
        },
        1024);
    LatticeError out;
    for (const double error : errors) {
        out.rms += error * error;
        out.max = std::max(out.max, error);
    }
    out.rms = std::sqrt(out.rms / double(points));
    const glm::dvec3 size = box.size();
    out.samples = size.x * size.y * size.z / (spacing * spacing * spacing) * slices;
    return out;
}

} // namespace tessera::volume
