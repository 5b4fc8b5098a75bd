#include "volume/resample.h"

#include "volume/parallel.h"
#include "volume/reconstruct.h"
#include "volume/slice_filter.h"
#include "volume/spline_prefilter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

// Target lattices are one or two axis-aligned grids, so a CC source is filtered axis by axis: z and y over whole rows,
// then x.

namespace tessera::volume {

namespace {

/// Runs `slice(k)` for every slice of the target in parallel, with progress between groups of them.
template <class Body> void forSlices(const Lattice& target, const Progress& progress, const Body& slice) {
    constexpr int kGroup = 32; // slices between two looks at the stop token
    for (int first = 0; first < target.size.z; first += kGroup) {
        progress.advance(double(first) / target.size.z, "resample");
        const int count = std::min(kGroup, target.size.z - first);
        parallelFor(std::size_t(count), [&](std::size_t i) { slice(first + int(i)); });
    }
    progress.advance(1, "resample");
}

template <class T, class Value>
void fromCc(const Field& source, std::span<const Value> values, Field& out, Mask* mask, const ResampleOptions& options,
            const Progress& progress) {
    const Lattice& target = out.lattice;
    const int sublattices = target.kind == LatticeKind::BCC ? 2 : 1;
    std::vector<AxisTaps> taps;
    for (int s = 0; s < sublattices; ++s) taps.push_back(tapsFor(source.lattice, target, s, options));
    const StoredRange<T> range(source);
    const std::size_t sliceSize = std::size_t(target.size.x) * std::size_t(target.size.y);
    T* const samples = out.as<T>().data();
    forSlices(target, progress, [&](int k) {
        const AxisTaps& own = taps[std::size_t(k % sublattices)];
        const std::size_t first = std::size_t(k) * sliceSize;
        SliceFilter<T, Value>(source, values, own, range)
            .run(own.z[std::size_t(k / sublattices)], samples + first,
                 mask != nullptr ? mask->data() + first : nullptr);
    });
}

template <class T>
void fromCc(const Field& source, Field& out, Mask* mask, const ResampleOptions& options, const Progress& progress) {
    const bool cubic = options.filter == ResampleFilter::BSpline3;
    if (cubic || options.filter == ResampleFilter::BSpline5) {
        const auto coefficients = splineCoefficients<SumOf<T>>(source, cubic ? 3 : 5);
        fromCc<T>(source, std::span<const SumOf<T>>(coefficients), out, mask, options, progress);
    } else {
        fromCc<T>(source, source.as<T>(), out, mask, options, progress);
    }
}

/// A gap of one absent CC sample can lie between two samples of a BCC sublattice, whose cells are sqrt 2 wide: both
/// sides of the gap would then be neighbours, and reconstruction would mix them. Where that happens along an axis, the
/// sample nearer to the gap becomes absent.
template <class T> void keepGaps(const Field& source, Field& out, Mask& mask, const Progress& progress) {
    const Lattice& target = out.lattice;
    const Mask before = mask;
    const glm::ivec3 steps[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 2}}; // to the next sample of the same sublattice
    std::array<std::vector<Tap>, 3> taps[2];
    for (int s = 0; s < 2; ++s) {
        AxisTaps all = tapsFor(source.lattice, target, s, {.filter = ResampleFilter::Nearest});
        taps[s] = {std::move(all.x), std::move(all.y), std::move(all.z)};
    }
    const auto removed = [&](glm::ivec3 at, int axis, int side) {
        const glm::ivec3 other = at + side * steps[axis];
        if (other[axis] < 0 || other[axis] >= target.size[axis] || before[target.index(other)] == 0) return false;
        const auto& [x, y, z] = taps[at.z & 1];
        const std::vector<Tap>& along = taps[at.z & 1][std::size_t(axis)];
        const Tap& own = along[std::size_t(axis == 2 ? at.z / 2 : at[axis])];
        const Tap& next = along[std::size_t(axis == 2 ? other.z / 2 : other[axis])];
        if (side * (next.nearest - own.nearest) < 2) return false;
        glm::ivec3 between(x[std::size_t(at.x)].nearest, y[std::size_t(at.y)].nearest,
                           z[std::size_t(at.z / 2)].nearest);
        between[axis] += side;
        if (source.present(source.lattice.index(between))) return false;
        const double mine = std::abs(own.cell[0] + own.fraction - between[axis]);
        const double theirs = std::abs(next.cell[0] + next.fraction - between[axis]);
        return mine < theirs || (mine == theirs && side > 0);
    };
    forSlices(target, progress, [&](int k) {
        std::size_t index = target.index({0, 0, k});
        for (int j = 0; j < target.size.y; ++j)
            for (int i = 0; i < target.size.x; ++i, ++index)
                for (int axis = 0; axis < 3 && mask[index] != 0; ++axis)
                    if (removed({i, j, k}, axis, -1) || removed({i, j, k}, axis, 1)) {
                        mask[index] = 0;
                        out.as<T>()[index] = T{};
                    }
    });
}

/// Nearest sample of a BCC source, copied.
template <class T> void fromNearest(const Field& source, Field& out, Mask* mask, const Progress& progress) {
    const Lattice& target = out.lattice;
    T* const samples = out.as<T>().data();
    const auto stored = source.as<T>();
    forSlices(target, progress, [&](int k) {
        for (int j = 0; j < target.size.y; ++j)
            for (int i = 0; i < target.size.x; ++i) {
                const std::size_t to = target.index({i, j, k});
                const std::size_t from = source.lattice.index(source.lattice.nearest(target.position({i, j, k})));
                if (mask != nullptr) (*mask)[to] = source.present(from) ? 1 : 0;
                samples[to] = source.present(from) ? stored[from] : T{};
            }
    });
}

/// Precision of prefiltered values of a stored type.
template <class T> using Filtered = std::conditional_t<std::is_same_v<T, std::int32_t>, double, float>;

/// A BCC source's stored values, prefiltered; 0 where absent.
template <class T> std::vector<Filtered<T>> prefilteredValues(const Field& source) {
    const Lattice& lattice = source.lattice;
    const auto stored = source.as<T>();
    const auto samples = [&](glm::ivec3 at) {
        const std::size_t index = lattice.index(clampToLattice(lattice.kind, lattice.size, at));
        return Sample{double(stored[index]), source.present(index)};
    };
    const Prefiltered filtered(samples, LevelGeometry{lattice.kind, 1, 0});
    std::vector<Filtered<T>> values(source.count());
    parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
        std::size_t index = lattice.index({0, 0, int(k)});
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i, ++index)
                if (source.present(index)) values[index] = Filtered<T>(filtered({i, j, int(k)}).value);
    });
    return values;
}

/// The two samples around a position along one axis of a BCC sublattice, as distances in memory.
struct PairTap {
    std::size_t lower, upper;
    double fraction;
};

/// Target positions of one axis in a BCC source: index pairs in both sublattices.
std::array<std::vector<PairTap>, 2> pairTaps(const Lattice& source, const Lattice& target, int targetSublattice,
                                             int axis) {
    const std::size_t steps[] = {1, std::size_t(source.size.x),
                                 std::size_t(source.size.x) * std::size_t(source.size.y)};
    const double last = (axis == 2 ? (source.size.z - 1) * 0.5 : source.size[axis] - 0.5);
    std::array<std::vector<PairTap>, 2> taps;
    for (int s = 0; s < 2; ++s) {
        const int own = source.size.z > 1 ? s : 0; // a single slice stands for both
        const int count = source.sublatticeSize(own)[axis];
        for (int i = 0; i < target.sublatticeSize(targetSublattice)[axis]; ++i) {
            const double cells =
                std::clamp(sourceCells(source, target, targetSublattice, axis, i), 0.0, last) - 0.5 * own;
            const double base = std::floor(cells);
            const auto offset = [&](double at) {
                const int inside = std::clamp(int(at), 0, count - 1);
                return steps[axis] * std::size_t(axis == 2 ? 2 * inside + own : inside);
            };
            taps[std::size_t(s)].push_back({offset(base), offset(base + 1), cells - base});
        }
    }
    return taps;
}

/// The average of the trilinear interpolations of both sublattices of prefiltered samples.
template <class T> void fromBcc(const Field& source, Field& out, Mask* mask, const Progress& progress) {
    const Lattice &from = source.lattice, &target = out.lattice;
    const std::vector<Filtered<T>> values = prefilteredValues<T>(source);
    const int sublattices = target.kind == LatticeKind::BCC ? 2 : 1;
    std::array<std::vector<PairTap>, 2> taps[2][3]; // [target sublattice][axis][source sublattice]
    for (int s = 0; s < sublattices; ++s)
        for (int axis = 0; axis < 3; ++axis) taps[s][axis] = pairTaps(from, target, s, axis);
    const StoredRange<T> range(source);
    T* const stored = out.as<T>().data();
    forSlices(target, progress, [&](int k) {
        const auto& [tx, ty, tz] = taps[k % sublattices];
        std::size_t to = target.index({0, 0, k});
        for (int j = 0; j < target.size.y; ++j)
            for (int i = 0; i < target.size.x; ++i, ++to) {
                if (mask != nullptr) {
                    const glm::dvec3 position = target.position({i, j, k});
                    (*mask)[to] = source.present(from.index(from.nearest(position))) ? 1 : 0;
                    if ((*mask)[to] == 0) continue;
                }
                Blend blend;
                for (std::size_t s = 0; s < 2; ++s) {
                    const PairTap &x = tx[s][std::size_t(i)], &y = ty[s][std::size_t(j)],
                                  &z = tz[s][std::size_t(k / sublattices)];
                    for (std::size_t corner = 0; corner < 8; ++corner) {
                        const double w = (corner & 1 ? x.fraction : 1 - x.fraction) *
                                         (corner & 2 ? y.fraction : 1 - y.fraction) *
                                         (corner & 4 ? z.fraction : 1 - z.fraction);
                        const std::size_t at = (corner & 1 ? x.upper : x.lower) + (corner & 2 ? y.upper : y.lower) +
                                               (corner & 4 ? z.upper : z.lower);
                        blend.add(w, {double(values[at]), mask == nullptr || source.present(at)});
                    }
                }
                stored[to] = range.store(blend.sum / blend.coverage);
            }
    });
}

} // namespace

Field sharpened(const Field& source, double amount) {
    const Lattice& lattice = source.lattice;
    Field out = source;
    dispatch(source.type, [&]<class T>(T) {
        const auto stored = source.as<T>();
        const auto to = out.as<T>();
        const StoredRange<T> range(source);
        forSlices(lattice, {}, [&](int k) {
            std::size_t index = lattice.index({0, 0, k});
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i, ++index) {
                    if (!source.present(index)) continue;
                    double difference = 0, count = 0;
                    const auto add = [&](glm::ivec3 neighbour) {
                        const std::size_t at = lattice.index(clampToLattice(lattice.kind, lattice.size, neighbour));
                        if (!source.present(at)) return;
                        difference += double(stored[at]) - double(stored[index]);
                        count += 1;
                    };
                    if (lattice.kind == LatticeKind::BCC) {
                        const int lo = (k & 1) - 1;
                        for (const int z : {-1, 1})
                            for (const int y : {lo, lo + 1})
                                for (const int x : {lo, lo + 1}) add({i + x, j + y, k + z});
                    } else {
                        for (const int side : {-1, 1}) {
                            add({i + side, j, k});
                            add({i, j + side, k});
                            add({i, j, k + side});
                        }
                    }
                    if (count > 0) to[index] = range.store(double(stored[index]) - amount * difference / count);
                }
        });
    });
    return out;
}

Field resample(const Field& source, const Lattice& target, const ResampleOptions& options, const Progress& progress) {
    if (options.order < kLeastOrder || options.order > kMostOrder)
        throw Error("the order of a filter must be from " + std::to_string(kLeastOrder) + " to " +
                    std::to_string(kMostOrder));
    if (options.sharpen > 0) {
        ResampleOptions plain = options;
        plain.sharpen = 0;
        if (options.sharpenWhen == SharpenWhen::Before)
            return resample(sharpened(source, options.sharpen), target, plain, progress);
        return sharpened(resample(source, target, plain, progress), options.sharpen);
    }
    if (source.lattice == target) {
        progress.advance(1, "resample");
        return source;
    }
    Field out = makeField(target, source.type);
    out.offset = source.offset;
    out.scale = source.scale;
    std::shared_ptr<Mask> mask;
    if (source.mask) mask = std::make_shared<Mask>(target.count(), std::uint8_t(1));
    dispatch(source.type, [&]<class T>(T) {
        if (source.lattice.kind == LatticeKind::CC)
            fromCc<T>(source, out, mask.get(), options, progress);
        else if (options.filter == ResampleFilter::Nearest)
            fromNearest<T>(source, out, mask.get(), progress);
        else
            fromBcc<T>(source, out, mask.get(), progress);
        if (mask && source.lattice.kind == LatticeKind::CC && target.kind == LatticeKind::BCC)
            keepGaps<T>(source, out, *mask, Progress{{}, progress.stop});
    });
    if (mask && !std::all_of(mask->begin(), mask->end(), [](std::uint8_t p) { return p != 0; }))
        out.mask = std::move(mask);
    return out;
}

Field toBcc(const Field& source, bool categorical, const ResampleOptions& options, const Progress& progress) {
    if (source.lattice.kind == LatticeKind::BCC) return source;
    const ResampleOptions labels{.filter = ResampleFilter::Nearest};
    return resample(source, bccFor(source.lattice), categorical ? labels : options, progress);
}

} // namespace tessera::volume
