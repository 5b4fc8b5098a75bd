#include "volume/analysis/lattice_error.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/cubic.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/resample/resample.h"
#include "volume/resample/series.h"
#include "volume/sources/centred_field.h"

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

/// Cells beyond the box: for the filter two, one more for rounding, and for the prefilter.
int marginOf(LatticeKind kind, LatticeFilter filter) {
    const Prefilter prefilter = filter == LatticeFilter::Cubic ? Prefilter::Cubic : Prefilter::Linear;
    return 3 + prefilterReach(prefilter, LevelGeometry{kind, 1, 0});
}

/// Samples on a part of an endless lattice: the box and a margin around it.
struct SampledPart {
    Lattice lattice;
    std::vector<double> values;
    std::vector<std::uint8_t> present = {}; ///< empty: all

    Sample operator()(glm::ivec3 at) const {
        const std::size_t index = lattice.index(clampToLattice(lattice.kind, lattice.size, at));
        return {values[index], isPresent(present, index)};
    }
};

bool isOfGrid(LatticeFilter filter) {
    return filter == LatticeFilter::Resampled || filter == LatticeFilter::Corrected;
}

/// The CC grid that a filter's samples come from, else the lattice itself, with a margin around the box.
Lattice latticeAround(const Box& box, LatticeKind kind, double spacing, LatticeFilter filter) {
    constexpr int kMarginOfGrid = 12; // what corrected samples are made of lies up to eight cells away
    Lattice lattice;
    lattice.kind = isOfGrid(filter) ? LatticeKind::CC : kind;
    lattice.spacing = glm::dvec3(isOfGrid(filter) ? spacing / kBccSpacing : spacing);
    const int margin = isOfGrid(filter) ? kMarginOfGrid : marginOf(kind, filter);
    lattice.origin = box.lo - double(margin) * lattice.spacing;
    lattice.size = glm::ivec3(glm::ceil(box.size() / lattice.spacing)) + 2 * margin + 1;
    lattice.size.z *= lattice.kind == LatticeKind::BCC ? 2 : 1;
    return lattice;
}

Field onPictures(const Field& grid, LatticeFilter filter) {
    return filter == LatticeFilter::Corrected ? toCentred(grid, false) : toBcc(grid, false);
}

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

bool isPrefiltered(LatticeFilter filter) {
    return filter == LatticeFilter::Quasi || filter == LatticeFilter::Quintic || isOfGrid(filter);
}

void prefilter(SampledPart& part) {
    const Prefiltered filtered(part, LevelGeometry{part.lattice.kind, 1, 0});
    part.values = everySample(part.lattice, [&](glm::ivec3 at) { return filtered(at).value; });
}

/// The part inside what its coefficients depend on.
SampledPart coefficients(const SampledPart& part) {
    const LevelGeometry geometry{part.lattice.kind, 1, 0};
    BrickSamples samples;
    samples.size = part.lattice.size;
    samples.values.assign(part.values.begin(), part.values.end());
    const BrickSamples found = cubicCoefficients(samples, geometry);
    SampledPart out{part.lattice, {found.values.begin(), found.values.end()}};
    out.lattice.size = found.size;
    out.lattice.origin += double(prefilterReach(Prefilter::Cubic, geometry)) * part.lattice.spacing;
    return out;
}

/// The samples of a signal, prefiltered if the filter requires it.
SampledPart samplesOf(const std::function<double(glm::dvec3)>& signal, LatticeKind kind, double spacing,
                      LatticeFilter filter, const Box& box) {
    SampledPart part{latticeAround(box, kind, spacing, filter), {}};
    part.values = everySample(part.lattice, [&](glm::ivec3 at) { return signal(part.lattice.position(at)); });
    if (isOfGrid(filter)) {
        Field grid = makeField(part.lattice, ScalarType::F32);
        std::copy(part.values.begin(), part.values.end(), grid.as<float>().begin());
        const Field made = onPictures(grid, filter);
        part = {made.lattice, physicalValues(made)};
    }
    if (filter == LatticeFilter::Cubic) return coefficients(part);
    if (isPrefiltered(filter)) prefilter(part);
    return part;
}

double reconstructed(const SampledPart& part, LatticeFilter filter, glm::dvec3 cells) {
    const LevelGeometry geometry{part.lattice.kind, 1, 0};
    const Blend blend = filter == LatticeFilter::Tetrahedral ? tetrahedral(geometry, part, cells)
                        : filter == LatticeFilter::Cosine    ? cosineWeighted(geometry, part, cells)
                        : filter == LatticeFilter::Quintic   ? quinticBox(geometry, part, cells)
                        : filter == LatticeFilter::Cubic     ? cubic(geometry, part, cells)
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

LatticeError latticeErrorOfRegions(const std::function<double(glm::dvec3, int)>& signal,
                                   const std::function<double(glm::dvec3)>& border, LatticeKind kind, double spacing,
                                   LatticeFilter filter, const Box& box, double reach, std::size_t points,
                                   unsigned seed) {
    const auto regionAt = [&](glm::dvec3 p) { return border(p) > 0 ? 1 : 0; };
    Field field = makeField(latticeAround(box, kind, spacing, filter), ScalarType::F32);
    auto numbers = std::make_shared<Mask>(field.count());
    const std::vector<double> values = everySample(field.lattice, [&](glm::ivec3 at) {
        const glm::dvec3 p = field.lattice.position(at);
        (*numbers)[field.lattice.index(at)] = std::uint8_t(1 + regionAt(p));
        return signal(p, regionAt(p));
    });
    std::copy(values.begin(), values.end(), field.as<float>().begin());
    field.mask = std::move(numbers);
    if (isOfGrid(filter)) field = onPictures(field, filter);
    std::array<SampledPart, 2> parts;
    for (std::size_t region = 0; region < 2; ++region) {
        SampledPart& part = parts[region];
        part = {field.lattice, physicalValues(field)};
        for (const std::uint8_t number : *field.mask) part.present.push_back(number == 1 + region ? 1 : 0);
        if (isPrefiltered(filter)) prefilter(part);
    }
    LatticeError out;
    for (const glm::dvec3 p : randomPoints(box, points, seed)) {
        if (std::abs(border(p)) > reach) continue;
        const int region = regionAt(p);
        const SampledPart& part = parts[std::size_t(region)];
        const Blend blend = linear({part.lattice.kind, 1, 0}, part, part.lattice.toCells(p));
        const std::optional<double> value = blend.value();
        if (!value) continue;
        const double error = std::abs(*value - signal(p, region));
        out.rms += error * error;
        out.max = std::max(out.max, error);
        ++out.samples;
    }
    out.rms = std::sqrt(out.rms / out.samples);
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
