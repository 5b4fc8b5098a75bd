#include "volume/resample/resample_cc.h"

#include "volume/field/for_slices.h"
#include "volume/resample/slice_filter.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

namespace {

std::vector<AxisTaps> tapsOfSublattices(const Lattice& source, const Lattice& target, const ResampleOptions& options) {
    std::vector<AxisTaps> taps;
    for (int s = 0; s < (target.kind == LatticeKind::BCC ? 2 : 1); ++s)
        taps.push_back(tapsFor(source, target, s, options));
    return taps;
}

/// Target slices in progress: `field` holds those from number `first` of the whole.
struct TargetPart {
    Field& field;
    Mask* mask;
    int first;
};

template <class T, class Value>
void filterSlices(const CcTaps& taps, const CcPart& part, std::span<const Value> values, const StoredRange<T>& range,
                  const TargetPart& out, const Progress& progress) {
    const Lattice& target = out.field.lattice;
    const std::size_t sublattices = taps.kernel.size();
    const bool inSpace = !(taps.source.axes == taps.target.axes);
    const std::size_t sliceSize = std::size_t(target.size.x) * std::size_t(target.size.y);
    T* const samples = out.field.as<T>().data();
    forSlices(target, progress, [&](int k) {
        const std::size_t number = std::size_t(out.first + k);
        const AxisTaps& own = taps.kernel[number % sublattices];
        const std::size_t first = std::size_t(k) * sliceSize;
        SliceFilter<T, Value>(part.field, values, own, range, inSpace)
            .run(countedFrom(own.z[number / sublattices], part.first), samples + first,
                 out.mask != nullptr ? out.mask->data() + first : nullptr);
    });
}

/// A gap of one absent CC sample can lie between two samples of a BCC sublattice, whose cells are sqrt 2 wide: both
/// sides of the gap would then be neighbours, and reconstruction would mix them. Where that happens along an axis, the
/// sample nearer to the gap becomes absent.
template <class T>
void keepGaps(const CcTaps& taps, const CcPart& part, const TargetPart& out, const Progress& progress) {
    const Lattice& target = out.field.lattice;
    const Mask before = *out.mask;
    const glm::ivec3 steps[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, kGapSlices}}; // to the next of the same sublattice
    const auto tapAlong = [&](glm::ivec3 at, int axis) -> const Tap& {
        const AxisTaps& own = taps.kernel[std::size_t(at.z & 1)];
        const std::vector<Tap>& along = axis == 0 ? own.x : axis == 1 ? own.y : own.z;
        return along[std::size_t(axis == 2 ? (out.first + at.z) / 2 : at[axis])];
    };
    const auto removed = [&](glm::ivec3 at, int axis, int side) {
        const glm::ivec3 other = at + side * steps[axis];
        if (other[axis] < 0 || other[axis] >= target.size[axis] || before[target.index(other)] == 0) return false;
        const Tap &own = tapAlong(at, axis), &next = tapAlong(other, axis);
        if (side * (next.nearest - own.nearest) < 2) return false;
        glm::ivec3 between(tapAlong(at, 0).nearest, tapAlong(at, 1).nearest, tapAlong(at, 2).nearest);
        between[axis] += side;
        if (part.field.present(part.field.lattice.index(between - glm::ivec3(0, 0, part.first)))) return false;
        const double mine = std::abs(own.cell[0] + own.fraction - between[axis]);
        const double theirs = std::abs(next.cell[0] + next.fraction - between[axis]);
        return mine < theirs || (mine == theirs && side > 0);
    };
    Mask& mask = *out.mask;
    forSlices(target, progress, [&](int k) {
        std::size_t index = target.index({0, 0, k});
        for (int j = 0; j < target.size.y; ++j)
            for (int i = 0; i < target.size.x; ++i, ++index)
                for (int axis = 0; axis < 3 && mask[index] != 0; ++axis)
                    if (removed({i, j, k}, axis, -1) || removed({i, j, k}, axis, 1)) {
                        mask[index] = 0;
                        out.field.as<T>()[index] = T{};
                    }
    });
}

} // namespace

CcTaps::CcTaps(const Lattice& from, const Lattice& to, const ResampleOptions& options)
    : source(from), target(to), kernel(tapsOfSublattices(from, to, options)) {}

std::pair<int, int> CcTaps::slicesFor(int first, int count, bool masked) const {
    const int sublattices = int(kernel.size());
    int lo = source.size.z, hi = 0;
    for (int k = first; k < first + count; ++k) {
        const Tap& tap = kernel[std::size_t(k % sublattices)].z[std::size_t(k / sublattices)];
        const int reach = masked ? OwnWindow::kReach : 0; // slices needed to extrapolate a part beyond its border
        lo = std::min({lo, tap.first, tap.cell[0] - reach, tap.nearest});
        hi = std::max({hi, tap.first + tap.count, tap.cell[0] + 2 + reach, tap.nearest + 1});
    }
    return {std::max(lo, 0), std::min(hi, source.size.z)};
}

Field resampleCc(const CcTaps& taps, const CcPart& part, const StoredExtent& extent, int first, int count,
                 const Progress& progress) {
    const Field& source = part.field;
    Field out = makeField(slicesOf(taps.target, first, count), source.type);
    out.offset = source.offset;
    out.scale = source.scale;
    std::shared_ptr<Mask> mask;
    if (source.mask) mask = std::make_shared<Mask>(out.count(), std::uint8_t(1));
    const TargetPart to{out, mask.get(), first};
    dispatch(source.type, [&]<class T>(T) {
        const StoredRange<T> range(extent);
        if (part.coefficients)
            filterSlices<T>(taps, part, std::span(static_cast<const SumOf<T>*>(part.coefficients), source.count()),
                            range, to, progress);
        else
            filterSlices<T>(taps, part, source.as<T>(), range, to, progress);
        if (mask && taps.target.kind == LatticeKind::BCC) keepGaps<T>(taps, part, to, Progress{{}, progress.stop});
    });
    out.mask = std::move(mask);
    return out;
}

} // namespace tessera::volume
