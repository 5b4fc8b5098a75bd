#include "volume/resample/hyperplane.h"

#include "volume/base/parallel.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/resample/series_dataset.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

namespace tessera::volume {

namespace {

struct Box4 {
    glm::dvec4 lo, hi;
};

/// Extent from the first to the last sample of the lattice, over both grids of D4*: on its sheet.
Box4 boxOf(const Lattice4& lattice) {
    glm::dvec4 span(lattice.size - 1);
    if (lattice.kind == LatticeKind4::D4) span = {glm::dvec3(span) + 0.5, span.w * 0.5};
    return {lattice.origin, lattice.origin + lattice.spacing * span};
}

/// The same in space.
Box4 spaceOf(const Lattice4& lattice, Box4 box) {
    for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = lattice.axes.toSpace(axis, box.lo[axis]);
        box.hi[axis] = lattice.axes.toSpace(axis, box.hi[axis]);
    }
    return box;
}

/// Weight of a frame at a time: linear between frames of the same parity, constant beyond the first and the last.
double frameWeight(const Lattice4& lattice, int frame, double time) {
    const int parities = lattice.kind == LatticeKind4::D4 && lattice.size.w > 1 ? 2 : 1, parity = frame % parities;
    const int count = parities == 1 ? lattice.size.w : lattice.framesOf(parity);
    const int own = frame / parities; // among the frames of its parity
    const double cells = (time - lattice.time(parity)) / lattice.spacing.w;
    const double at = std::clamp(cells, 0.0, double(count - 1));
    return std::max(1 - std::abs(at - own), 0.0) / parities;
}

/// The number of a sample's part (volume/field/part_masks.h), of a CC lattice; beyond it that of the nearest.
std::uint8_t numberOf(const Field& field, glm::ivec3 at) {
    if (!field.mask) return 1;
    return (*field.mask)[field.lattice.index(clampToLattice(field.lattice.kind, field.lattice.size, at))];
}

/// A slice in progress: its grid, and the sums of the frames so far.
class Slicing {
public:
    Slicing(const Series& series, const Hyperplane& plane, std::span<const double> times)
        : lattice_(series.lattice), categorical_(series.categorical), box_(boxOf(series.lattice)), plane_(plane),
          times_(times) {
        const double frames = box_.hi.w - box_.lo.w;
        if (!times.empty()) box_.lo.w = times.front(), box_.hi.w = times.back();
        space_ = spaceOf(lattice_, box_);
        const double perLattice = frames > 0 ? (box_.hi.w - box_.lo.w) / frames : 1; // units of the plane's t
        const glm::dvec4 extent = box_.hi - box_.lo, reach = space_.hi - space_.lo,
                         steep = glm::abs(plane.normal * reach);
        out_.solved = 0;
        for (int axis = 1; axis < 4; ++axis)
            if (steep[axis] >= steep[out_.solved]) out_.solved = axis;
        if (!(steep[out_.solved] > 0)) throw Error("a hyperplane needs a normal that is not 0");

        const double finer = lattice_.kind == LatticeKind4::D4 ? 1 / kBccSpacing : 1;
        for (int i = 0, axis = 0; axis < 4; ++axis) {
            if (axis == out_.solved) continue;
            out_.axes[std::size_t(i)] = axis;
            grid_.origin[i] = box_.lo[axis];
            grid_.spacing[i] = lattice_.spacing[axis] * finer * (axis == 3 ? perLattice : 1);
            grid_.size[i] = int(extent[axis] / grid_.spacing[i] + 1e-9) + 1;
            if (axis < 3) grid_.axes.of[std::size_t(i)] = lattice_.axes.of[std::size_t(axis)];
            ++i;
        }
        margin_ = 1e-9 * reach[out_.solved];
        out_.field = makeField(grid_, ScalarType::F32);
        for (std::vector<float>* values : {&sum_, &coverage_, &best_}) values->resize(grid_.count());
        if (!categorical_) part_.resize(grid_.count(), 1);
    }

    /// Flags of the slices of the grid that a frame adds to.
    std::vector<std::uint8_t> slicesTouchedBy(int frame) const {
        std::vector<std::uint8_t> slices(std::size_t(grid_.size.z), 0);
        parallelFor(slices.size(), [&](std::size_t k) {
            for (int j = 0; j < grid_.size.y && slices[k] == 0; ++j)
                for (int i = 0; i < grid_.size.x && slices[k] == 0; ++i)
                    if (isTouched(frame, pointAt({i, j, int(k)}))) slices[k] = 1;
        });
        return slices;
    }

    void add(int frame, const Field& samples, const std::vector<std::uint8_t>& slices) {
        const Lattice ownGrid = lattice_.grid(frame);
        parallelFor(slices.size(), [&](std::size_t k) {
            if (slices[k] == 0) return;
            std::size_t index = grid_.index({0, 0, int(k)});
            for (int j = 0; j < grid_.size.y; ++j)
                for (int i = 0; i < grid_.size.x; ++i, ++index) {
                    const glm::dvec4 point = pointAt({i, j, int(k)});
                    if (!isTouched(frame, point)) continue;
                    const double weight = frameWeight(lattice_, frame, latticeTime(point.w));
                    const glm::dvec3 place(point),
                        cells = categorical_ ? ownGrid.toCells(place) : ownGrid.between(place);
                    if (categorical_)
                        addLabel(index, samples, cells, weight);
                    else
                        addValue(index, samples, cells, weight);
                }
        });
    }

    HyperplaneSlice finish() {
        auto mask = std::make_shared<Mask>(grid_.count(), std::uint8_t(0));
        const auto to = out_.field.as<float>();
        for (std::size_t i = 0; i < to.size(); ++i) {
            if (coverage_[i] < float(kPresentCoverage)) continue;
            (*mask)[i] = 1;
            to[i] = sum_[i] / coverage_[i];
        }
        const auto present = std::count(mask->begin(), mask->end(), std::uint8_t(1));
        if (present == 0) throw Error("the hyperplane does not intersect the data");
        if (std::size_t(present) < mask->size()) out_.field.mask = std::move(mask);
        return std::move(out_);
    }

private:
    glm::dvec4 pointAt(glm::ivec3 at) const {
        const glm::dvec3 p = grid_.position(at);
        glm::dvec4 point(0);
        for (int i = 0; i < 3; ++i) point[out_.axes[std::size_t(i)]] = p[i];
        point[out_.solved] = -(glm::dot(plane_.normal, point) + plane_.e) / plane_.normal[out_.solved];
        return point;
    }

    /// Times of the lattice are those of its frames, which may be unevenly spaced.
    double latticeTime(double time) const {
        if (times_.empty()) return time;
        const double frame = frameAt(times_, time), whole = std::floor(frame);
        const double from = lattice_.time(int(whole));
        return from + (frame - whole) * (lattice_.time(int(whole) + 1) - from);
    }

    bool isTouched(int frame, const glm::dvec4& point) const {
        return point[out_.solved] >= space_.lo[out_.solved] - margin_ &&
               point[out_.solved] <= space_.hi[out_.solved] + margin_ &&
               frameWeight(lattice_, frame, latticeTime(point.w)) > 0;
    }

    /// For labels only the frame nearest in time is used.
    void addLabel(std::size_t index, const Field& samples, glm::dvec3 cells, double weight) {
        const Sample label = nearest(kCells, FieldSamples{samples}, cells);
        if (float(weight) <= best_[index]) return;
        best_[index] = float(weight);
        sum_[index] = float(label.value);
        coverage_[index] = label.present ? 1.0f : 0.0f;
    }

    void addValue(std::size_t index, const Field& samples, glm::dvec3 cells, double weight) {
        if (const std::uint8_t number = numberOf(samples, glm::ivec3(glm::round(cells)));
            float(weight) > best_[index]) {
            best_[index] = float(weight);
            if (number != 0 && number != part_[index]) sum_[index] = coverage_[index] = 0;
            if (number != 0) part_[index] = number;
        }
        const FieldSamples values{samples};
        const auto ownPart = [&](glm::ivec3 at) {
            const Sample sample = values(at);
            return Sample{sample.value, sample.present && numberOf(samples, at) == part_[index]};
        };
        // Samples of other parts are replaced by the value of the own part.
        const Blend own = linear(kCells, ownPart, cells);
        if (own.coverage <= 0) return;
        const double there = linear(kCells, values, cells).coverage;
        sum_[index] += float(weight * there * own.sum / own.coverage);
        coverage_[index] += float(weight * there);
    }

    static constexpr LevelGeometry kCells{LatticeKind::CC, 1, 0};

    Lattice4 lattice_;
    bool categorical_;
    Box4 box_, space_; ///< on the sheet, in space
    Hyperplane plane_;
    std::span<const double> times_;
    HyperplaneSlice out_;
    Lattice grid_;
    double margin_ = 0;
    std::vector<float> sum_, coverage_, best_;
    std::vector<std::uint8_t> part_; ///< in the frame nearest in time
};

} // namespace

HyperplaneSlice sliceBy(const Series& series, const Hyperplane& plane, std::span<const double> times,
                        const Progress& progress) {
    Slicing slicing(series, plane, times);
    for (int frame = 0; frame < series.lattice.size.w; ++frame) {
        progress.advance(double(frame) / series.lattice.size.w, "slice");
        const std::vector<std::uint8_t> slices = slicing.slicesTouchedBy(frame);
        // Skip frames that no sample needs.
        if (std::none_of(slices.begin(), slices.end(), [](std::uint8_t s) { return s != 0; })) continue;
        slicing.add(frame, *series.frame(frame), slices);
    }
    HyperplaneSlice out = slicing.finish();
    progress.advance(1, "slice");
    return out;
}

} // namespace tessera::volume
