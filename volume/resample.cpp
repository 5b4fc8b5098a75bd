#include "volume/resample.h"

#include "volume/for_slices.h"
#include "volume/reconstruct.h"
#include "volume/resample_cc.h"
#include "volume/resample_slices.h"
#include "volume/slice_filter.h"
#include "volume/spline_prefilter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

namespace tessera::volume {

namespace {

/// A CC source, all of it at once.
Field fromCc(const Field& source, const Lattice& target, const ResampleOptions& options, const Progress& progress) {
    const CcTaps taps(source.lattice, target, options);
    StoredExtent extent;
    extent.add(source);
    const auto run = [&](const void* coefficients) {
        return resampleCc(taps, {source, 0, coefficients}, extent, 0, target.size.z, progress);
    };
    const int degree = splineDegree(options.filter);
    if (degree == 0) return run(nullptr);
    return dispatch(source.type, [&]<class T>(T) {
        const auto coefficients = splineCoefficients<SumOf<T>>(source, degree);
        return run(coefficients.data());
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

void checkOrder(const ResampleOptions& options) {
    if (options.order < kLeastOrder || options.order > kMostOrder)
        throw Error("the order of a filter must be from " + std::to_string(kLeastOrder) + " to " +
                    std::to_string(kMostOrder));
}

Field sharpened(const Field& source, double amount, const StoredExtent& extent) {
    const Lattice& lattice = source.lattice;
    Field out = source;
    dispatch(source.type, [&]<class T>(T) {
        const auto stored = source.as<T>();
        const auto to = out.as<T>();
        const StoredRange<T> range(extent);
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

Field sharpened(const Field& source, double amount) {
    StoredExtent extent;
    extent.add(source);
    return sharpened(source, amount, extent);
}

Field resample(const Field& source, const Lattice& target, const ResampleOptions& options, const Progress& progress) {
    checkOrder(options);
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
    Field out;
    if (source.lattice.kind == LatticeKind::CC) {
        out = fromCc(source, target, options, progress);
    } else {
        out = makeField(target, source.type);
        out.offset = source.offset;
        out.scale = source.scale;
        std::shared_ptr<Mask> mask;
        if (source.mask) mask = std::make_shared<Mask>(target.count(), std::uint8_t(1));
        dispatch(source.type, [&]<class T>(T) {
            if (options.filter == ResampleFilter::Nearest)
                fromNearest<T>(source, out, mask.get(), progress);
            else
                fromBcc<T>(source, out, mask.get(), progress);
        });
        out.mask = std::move(mask);
    }
    if (out.mask && std::find(out.mask->begin(), out.mask->end(), std::uint8_t(0)) == out.mask->end()) out.mask.reset();
    return out;
}

Field toBcc(const Field& source, bool categorical, const ResampleOptions& options, const Progress& progress) {
    if (source.lattice.kind == LatticeKind::BCC) return source;
    return resample(source, bccFor(source.lattice), optionsFor(categorical, options), progress);
}

} // namespace tessera::volume
