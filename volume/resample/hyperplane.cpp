#include "volume/resample/hyperplane.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

struct Box4 {
    glm::dvec4 lo, hi;
};

/// From the first to the last sample of the lattice, both grids of D4* taken together.
Box4 boxOf(const Lattice4& lattice) {
    glm::dvec4 span(lattice.size - 1);
    if (lattice.kind == LatticeKind4::D4) span = {glm::dvec3(span) + 0.5, span.w * 0.5};
    return {lattice.origin, lattice.origin + lattice.spacing * span};
}

/// Weight of a frame at a time: linear between frames of its parity, whose first and last go on beyond the ends.
double frameWeight(const Lattice4& lattice, int frame, double time) {
    const int parities = lattice.kind == LatticeKind4::D4 && lattice.size.w > 1 ? 2 : 1, parity = frame % parities;
    const int count = parities == 1 ? lattice.size.w : lattice.framesOf(parity);
    const double own = frame / parities;
    const double cells = (time - lattice.time(parity)) / lattice.spacing.w;
    const double at = std::clamp(cells, 0.0, double(count - 1));
    return std::max(1 - std::abs(at - own), 0.0) / parities;
}

/// The number of a sample's part (volume/field/part_masks.h), of a CC lattice; beyond it that of the nearest.
std::uint8_t numberOf(const Field& field, glm::ivec3 at) {
    if (!field.mask) return 1;
    return (*field.mask)[field.lattice.index(clampToLattice(field.lattice.kind, field.lattice.size, at))];
}

} // namespace

HyperplaneSlice sliceBy(const Series& series, const Hyperplane& plane, const Progress& progress) {
    const Lattice4& lattice = series.lattice;
    const Box4 box = boxOf(lattice);
    const glm::dvec4 extent = box.hi - box.lo, steep = glm::abs(plane.normal * extent);
    HyperplaneSlice out;
    out.solved = 0;
    for (int axis = 1; axis < 4; ++axis)
        if (steep[axis] >= steep[out.solved]) out.solved = axis;
    if (!(steep[out.solved] > 0)) throw Error("a hyperplane needs a normal that is not 0");

    const double finer = lattice.kind == LatticeKind4::D4 ? 1 / kBccSpacing : 1;
    Lattice grid;
    for (int i = 0, axis = 0; axis < 4; ++axis) {
        if (axis == out.solved) continue;
        out.axes[std::size_t(i)] = axis;
        grid.origin[i] = box.lo[axis];
        grid.spacing[i] = lattice.spacing[axis] * finer;
        grid.size[i] = int(extent[axis] / grid.spacing[i] + 1e-9) + 1;
        ++i;
    }
    const double margin = 1e-9 * extent[out.solved];
    const auto pointAt = [&](glm::ivec3 at) {
        const glm::dvec3 p = grid.position(at);
        glm::dvec4 point(0);
        for (int i = 0; i < 3; ++i) point[out.axes[std::size_t(i)]] = p[i];
        point[out.solved] = -(glm::dot(plane.normal, point) + plane.e) / plane.normal[out.solved];
        return point;
    };

    out.field = makeField(grid, ScalarType::F32);
    std::vector<float> sum(grid.count()), coverage(grid.count()), best(grid.count());
    std::vector<std::uint8_t> part(series.categorical ? 0 : grid.count(), 1); // as the frame nearest in time says
    for (int frame = 0; frame < lattice.size.w; ++frame) {
        progress.advance(double(frame) / lattice.size.w, "slice");
        std::shared_ptr<const Field> samples;
        const Lattice ownGrid = lattice.grid(frame);
        const auto touched = [&](const glm::dvec4& point) {
            return point[out.solved] >= box.lo[out.solved] - margin &&
                   point[out.solved] <= box.hi[out.solved] + margin && frameWeight(lattice, frame, point.w) > 0;
        };
        // Frames that no sample needs are not read.
        std::vector<std::uint8_t> slices(std::size_t(grid.size.z), 0);
        parallelFor(slices.size(), [&](std::size_t k) {
            for (int j = 0; j < grid.size.y && slices[k] == 0; ++j)
                for (int i = 0; i < grid.size.x && slices[k] == 0; ++i)
                    if (touched(pointAt({i, j, int(k)}))) slices[k] = 1;
        });
        if (std::none_of(slices.begin(), slices.end(), [](std::uint8_t s) { return s != 0; })) continue;
        samples = series.frame(frame);
        const FieldSamples values{*samples};
        const LevelGeometry geometry{LatticeKind::CC, 1, 0};
        parallelFor(slices.size(), [&](std::size_t k) {
            if (slices[k] == 0) return;
            std::size_t index = grid.index({0, 0, int(k)});
            for (int j = 0; j < grid.size.y; ++j)
                for (int i = 0; i < grid.size.x; ++i, ++index) {
                    const glm::dvec4 point = pointAt({i, j, int(k)});
                    if (!touched(point)) continue;
                    const double weight = frameWeight(lattice, frame, point.w);
                    const glm::dvec3 cells = ownGrid.toCells(glm::dvec3(point));
                    if (series.categorical) { // the frame nearest in time speaks
                        const Sample label = nearest(geometry, values, cells);
                        if (float(weight) <= best[index]) continue;
                        best[index] = float(weight);
                        sum[index] = float(label.value);
                        coverage[index] = label.present ? 1.0f : 0.0f;
                        continue;
                    }
                    if (const std::uint8_t number = numberOf(*samples, glm::ivec3(glm::round(cells)));
                        float(weight) > best[index]) {
                        best[index] = float(weight);
                        if (number != 0 && number != part[index]) sum[index] = coverage[index] = 0;
                        if (number != 0) part[index] = number;
                    }
                    const auto ownPart = [&](glm::ivec3 at) {
                        const Sample sample = values(at);
                        return Sample{sample.value, sample.present && numberOf(*samples, at) == part[index]};
                    };
                    // Samples of other parts are there, but of the own one's value.
                    const Blend own = linear(geometry, ownPart, cells);
                    if (own.coverage <= 0) continue;
                    const double there = linear(geometry, values, cells).coverage;
                    sum[index] += float(weight * there * own.sum / own.coverage);
                    coverage[index] += float(weight * there);
                }
        });
    }
    auto mask = std::make_shared<Mask>(grid.count(), std::uint8_t(0));
    const auto to = out.field.as<float>();
    for (std::size_t i = 0; i < to.size(); ++i) {
        if (coverage[i] < float(kPresentCoverage)) continue;
        (*mask)[i] = 1;
        to[i] = sum[i] / coverage[i];
    }
    const auto present = std::count(mask->begin(), mask->end(), std::uint8_t(1));
    if (present == 0) throw Error("the hyperplane meets no sample of the data");
    if (std::size_t(present) < mask->size()) out.field.mask = std::move(mask);
    progress.advance(1, "slice");
    return out;
}

} // namespace tessera::volume
