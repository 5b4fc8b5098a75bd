#include "volume/analysis/lattice_error.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/resample/series.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>
#include <random>
#include <vector>

namespace tessera::volume {

namespace {

constexpr int kMargin = 4; // cells beyond the box: two for the filter, one for the prefilter, one for rounding

/// Samples on a part of an endless lattice: the box and a margin around it.
struct SampledPart {
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

/// The samples of a signal, prefiltered if the filter requires it.
SampledPart samplesOf(const std::function<double(glm::dvec3)>& signal, LatticeKind kind, double spacing,
                      LatticeFilter filter, const Box& box) {
    SampledPart part;
    part.lattice.kind = kind;
    part.lattice.spacing = glm::dvec3(spacing);
    part.lattice.origin = box.lo - double(kMargin) * spacing;
    part.lattice.size = glm::ivec3(glm::ceil(box.size() / spacing)) + 2 * kMargin + 1;
    part.lattice.size.z *= kind == LatticeKind::BCC ? 2 : 1;
    const Lattice& lattice = part.lattice;
    part.values = everySample(lattice, [&](glm::ivec3 at) { return signal(lattice.position(at)); });
    if (filter == LatticeFilter::Quasi || filter == LatticeFilter::Quintic) {
        const Prefiltered filtered(part, LevelGeometry{kind, 1, 0});
        part.values = everySample(lattice, [&](glm::ivec3 at) { return filtered(at).value; });
    }
    return part;
}

double reconstructed(const SampledPart& part, LatticeFilter filter, glm::dvec3 cells) {
    const LevelGeometry geometry{part.lattice.kind, 1, 0};
    const Blend blend = filter == LatticeFilter::Tetrahedral ? tetrahedral(geometry, part, cells)
                        : filter == LatticeFilter::Cosine    ? cosineWeighted(geometry, part, cells)
                        : filter == LatticeFilter::Quintic   ? quinticBox(geometry, part, cells)
                                                             : linear(geometry, part, cells);
    return blend.sum / blend.coverage;
}

std::vector<glm::dvec3> randomPoints(const Box& box, std::size_t points, unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<glm::dvec3> positions(points);
    for (glm::dvec3& p : positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = box.lo[axis] + box.size()[axis] * double(random() >> 11) * 0x1p-53;
    return positions;
}

} // namespace

LatticeError latticeError(const std::function<double(glm::dvec3)>& signal, LatticeKind kind, double spacing,
                          LatticeFilter filter, const Box& box, std::size_t points, unsigned seed) {
    const SampledPart part = samplesOf(signal, kind, spacing, filter, box);
    const std::vector<glm::dvec3> positions = randomPoints(box, points, seed);
    std::vector<double> errors(points);
    parallelFor(
        points,
        [&](std::size_t i) {
            errors[i] =
                std::abs(reconstructed(part, filter, part.lattice.toCells(positions[i])) - signal(positions[i]));
        },
        1024);
    LatticeError out;
    for (const double error : errors) {
        out.rms += error * error;
        out.max = std::max(out.max, error);
    }
    out.rms = std::sqrt(out.rms / double(points));
    const glm::dvec3 size = box.size();
    out.samples = size.x * size.y * size.z / (spacing * spacing * spacing) * (kind == LatticeKind::BCC ? 2 : 1);
    return out;
}

double latticeGradientError(const std::function<double(glm::dvec3)>& signal,
                            const std::function<glm::dvec3(glm::dvec3)>& slope, LatticeKind kind, double spacing,
                            LatticeFilter filter, GradientSpan span, const Box& box, std::size_t points,
                            unsigned seed) {
    const SampledPart part = samplesOf(signal, kind, spacing, filter, box);
    const std::vector<glm::dvec3> positions = randomPoints(box, points, seed);
    const GradientStencil stencil = gradientStencil(kind, span);
    std::vector<glm::dvec2> angles(points); // times weight; weight
    parallelFor(
        points,
        [&](std::size_t i) {
            const auto value = [&](glm::dvec3 cells) { return std::optional(reconstructed(part, filter, cells)); };
            const glm::dvec3 found = gradient(value, part.lattice.toCells(positions[i]), stencil);
            const glm::dvec3 wanted = slope(positions[i]);
            const double angle = std::atan2(glm::length(glm::cross(found, wanted)), glm::dot(found, wanted));
            angles[i] = glm::dvec2(angle, 1) * glm::length(wanted);
        },
        1024);
    const glm::dvec2 sum = std::accumulate(angles.begin(), angles.end(), glm::dvec2(0));
    return glm::degrees(sum.x / sum.y);
}

LatticeError latticeError4(const std::function<double(glm::dvec4)>& signal, LatticeKind4 kind, double spacing,
                           LatticeFilter4 filter, std::size_t points, unsigned seed) {
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
    if (filter == LatticeFilter4::Quasi) series = prefiltered(series);
    const bool drawn = filter == LatticeFilter4::Drawn;
    series = remembering(series, drawn ? 8 : 4);

    constexpr std::size_t kTimes =
        64; // number of distinct times: points share them, so that frames are blended once per time
    std::mt19937_64 random(seed);
    const auto uniform = [&] { return 0.25 + 0.5 * double(random() >> 11) * 0x1p-53; };
    std::vector<double> times(kTimes);
    for (double& time : times) time = uniform();
    std::sort(times.begin(), times.end());
    LatticeError out;
    const std::size_t each = points / kTimes;
    for (const double time : times) {
        const Field field = atTime(series, time, drawn ? TimeFilter::Cubic : TimeFilter::Linear);
        const FieldSamples samples{field};
        const LevelGeometry geometry{field.lattice.kind, 1, 0};
        const Prefiltered<FieldSamples> prefilteredSamples(samples, geometry);
        for (std::size_t i = 0; i < each; ++i) {
            const glm::dvec3 p(uniform(), uniform(), uniform());
            const glm::dvec3 cells = field.lattice.toCells(p);
            const Blend blend = drawn ? linear(geometry, prefilteredSamples, cells) : linear(geometry, samples, cells);
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
