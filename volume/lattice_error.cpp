#include "volume/lattice_error.h"

#include "volume/parallel.h"
#include "volume/reconstruct.h"
#include "volume/series.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tessera::volume {

namespace {

constexpr int kMargin = 4; // cells beyond the box: two for the filter, one for the prefilter, one for rounding

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
    if (filter == LatticeFilter::Quasi || filter == LatticeFilter::Quintic) {
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
                                : filter == LatticeFilter::Cosine    ? cosineWeighted(geometry, piece, cells)
                                : filter == LatticeFilter::Quintic   ? quinticBox(geometry, piece, cells)
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

LatticeError latticeError4(const std::function<double(glm::dvec4)>& signal, LatticeKind4 kind, double spacing,
                           bool prefilter, std::size_t points, unsigned seed) {
    Series series;
    series.lattice.kind = kind;
    series.lattice.spacing = glm::dvec4(spacing);
    series.lattice.size = glm::ivec4(int(std::ceil(1 / spacing)) + 1);
    if (kind == LatticeKind4::D4) series.lattice.size.w = 2 * series.lattice.size.w;
    series.frame = [&signal, lattice = series.lattice](int frame) {
        Field field = makeField(lattice.grid(frame), ScalarType::F32);
        const double time = lattice.time(frame);
        const std::vector<double> values = everySample(
            field.lattice, [&](glm::ivec3 at) { return signal(glm::dvec4(field.lattice.position(at), time)); });
        std::copy(values.begin(), values.end(), field.as<float>().begin());
        return std::make_shared<const Field>(std::move(field));
    };
    if (prefilter) series = prefiltered(series);
    series = remembering(series, 4);

    constexpr std::size_t kTimes = 64; // points share times, so that frames are blended once
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return 0.25 + 0.5 * double(random() >> 11) * 0x1p-53; };
    std::vector<double> times(kTimes);
    for (double& time : times) time = uniform();
    std::sort(times.begin(), times.end());
    LatticeError out;
    const std::size_t each = points / kTimes;
    for (const double time : times) {
        const Field field = atTime(series, time, TimeFilter::Linear);
        const FieldSamples samples{field};
        for (std::size_t i = 0; i < each; ++i) {
            const glm::dvec3 p(uniform(), uniform(), uniform());
            const LevelGeometry geometry{field.lattice.kind, 1, 0};
            const Blend blend = linear(geometry, samples, field.lattice.toCells(p));
            const double error = std::abs(blend.sum / blend.coverage - signal(glm::dvec4(p, time)));
            out.rms += error * error;
            out.max = std::max(out.max, error);
        }
    }
    out.rms = std::sqrt(out.rms / double(each * kTimes));
    out.samples = (kind == LatticeKind4::D4 ? 2 : 1) / std::pow(spacing, 4);
    return out;
}

} // namespace tessera::volume
