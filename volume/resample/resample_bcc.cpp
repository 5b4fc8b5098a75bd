#include "volume/resample/resample_bcc.h"

#include "volume/field/for_slices.h"
#include "volume/field/stored_range.h"
#include "volume/reconstruct/continued.h"
#include "volume/resample/opposite_pairs.h"
#include "volume/resample/resample_taps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

namespace tessera::volume {

namespace {

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
                if (mask != nullptr) (*mask)[to] = (*source.mask)[from];
                samples[to] = source.present(from) ? stored[from] : T{};
            }
    });
}

/// Type for prefiltered values of a stored type.
template <class T> using Filtered = std::conditional_t<std::is_same_v<T, std::int32_t>, double, float>;

glm::ivec3 storageIndex(const Lattice& lattice, std::size_t index) {
    const std::size_t nx = std::size_t(lattice.size.x), ny = std::size_t(lattice.size.y);
    return {int(index % nx), int(index / nx % ny), int(index / (nx * ny))};
}

/// Whether an index is one of the lattice.
bool isInside(const Lattice& lattice, glm::ivec3 at) {
    const auto below = [](int i, int size) { return static_cast<unsigned>(i) < static_cast<unsigned>(size); };
    return below(at.x, lattice.size.x) && below(at.y, lattice.size.y) && below(at.z, lattice.size.z);
}

/// A BCC source's stored values, prefiltered (volume/reconstruct/reconstruct.h); 0 where absent. Beyond the border of a
/// part, its values are extrapolated.
template <class T> std::vector<Filtered<T>> prefilteredValues(const Field& source) {
    const Lattice& lattice = source.lattice;
    const auto stored = source.as<T>();
    const PartNumbers number{source.mask.get()};
    std::vector<Filtered<T>> values(source.count());
    parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
        std::size_t index = lattice.index({0, 0, int(k)});
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i, ++index) {
                const std::uint8_t own = number(index);
                if (own == 0) continue;
                const double centre = double(stored[index]);
                const auto ownValue = [&](glm::ivec3 there) -> std::optional<double> {
                    if (!isInside(lattice, there)) return std::nullopt;
                    const std::size_t at = lattice.index(there);
                    return number(at) == own ? std::optional(double(stored[at])) : std::nullopt;
                };
                const auto besideThis = [&](glm::ivec3 there) { return isBeside(lattice.kind, there, {i, j, int(k)}); };
                double differences = 0;
                forOppositePairs(lattice, {i, j, int(k)}, [&](std::size_t a, std::size_t b) {
                    for (const std::size_t at : {a, b})
                        differences += (number(at) == own
                                            ? double(stored[at])
                                            : continued(lattice.kind, storageIndex(lattice, at), ownValue, besideThis)
                                                  .value_or(centre)) -
                                       centre;
                });
                values[index] = Filtered<T>(centre - differences / 12);
            }
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
        const int own = source.size.z > 1 ? s : 0; // a single slice is used for both sublattices
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

/// The sample with a part's number that is nearest to a position, of those up to kLineReach samples from `nearest`, the
/// nearest of all on the sheet; empty if there is none.
std::optional<std::size_t> nearestOf(const Lattice& lattice, const PartNumbers& number, std::uint8_t own,
                                     std::size_t nearest, const glm::dvec3& position) {
    if (number(nearest) == own) return nearest;
    const glm::ivec3 centre = storageIndex(lattice, nearest);
    const glm::ivec3 reach(kLineReach, kLineReach, 2 * kLineReach);
    const glm::dvec3 wanted = lattice.axes.toSheet(position);
    const glm::ivec3 lo = glm::max(centre - reach, glm::ivec3(0)), hi = glm::min(centre + reach, lattice.size - 1);
    std::optional<std::size_t> best;
    double least = std::numeric_limits<double>::infinity();
    for (int z = lo.z; z <= hi.z; ++z)
        for (int y = lo.y; y <= hi.y; ++y)
            for (int x = lo.x; x <= hi.x; ++x) {
                const std::size_t at = lattice.index({x, y, z});
                if (number(at) != own) continue;
                const glm::dvec3 apart = (lattice.sheetPosition({x, y, z}) - wanted) / lattice.spacing;
                const double distance = glm::dot(apart, apart);
                if (distance < least) best = at, least = distance;
            }
    return best;
}

/// Means of the stored values of each part, where it has samples; in place of 0, of all samples.
template <class T> std::array<std::optional<double>, StoredExtent::kNumbers> meansOf(const Field& source) {
    std::array<double, StoredExtent::kNumbers> sum{}, count{};
    const auto stored = source.as<T>();
    const PartNumbers number{source.mask.get()};
    for (std::size_t i = 0; i < stored.size(); ++i) {
        const std::size_t n = number(i);
        if (n == 0 || n >= sum.size() || !std::isfinite(double(stored[i]))) continue;
        for (const std::size_t of : {std::size_t(0), n}) sum[of] += double(stored[i]), count[of] += 1;
    }
    std::array<std::optional<double>, StoredExtent::kNumbers> means;
    for (std::size_t n = 0; n < means.size(); ++n)
        if (count[n] > 0) means[n] = sum[n] / count[n];
    return means;
}

/// The average of the trilinear interpolations of both sublattices of prefiltered samples. `given`: the parts of the
/// target's samples, or null.
template <class T>
void fromBcc(const Field& source, Field& out, Mask* mask, const Mask* given, const Progress& progress) {
    const Lattice &from = source.lattice, &target = out.lattice;
    const std::vector<Filtered<T>> values = prefilteredValues<T>(source);
    const int sublattices = target.kind == LatticeKind::BCC ? 2 : 1;
    std::array<std::vector<PairTap>, 2> taps[2][3]; // [target sublattice][axis][source sublattice]
    for (int s = 0; s < sublattices; ++s)
        for (int axis = 0; axis < 3; ++axis) taps[s][axis] = pairTaps(from, target, s, axis);
    StoredExtent extent;
    extent.add(source);
    const StoredRange<T> range(extent);
    const PartNumbers number{source.mask.get()};
    const auto means = given != nullptr ? meansOf<T>(source) : decltype(meansOf<T>(source)){};
    T* const stored = out.as<T>().data();
    forSlices(target, progress, [&](int k) {
        const auto& [tx, ty, tz] = taps[k % sublattices];
        struct Corner {
            double weight;
            std::size_t at;
        };
        std::array<Corner, 16> corners;
        std::size_t to = target.index({0, 0, k});
        for (int j = 0; j < target.size.y; ++j)
            for (int i = 0; i < target.size.x; ++i, ++to) {
                std::size_t nearest = 0;
                std::uint8_t own = given != nullptr ? (*given)[to] : std::uint8_t(1);
                if (own == 0) continue;
                bool onlyOwn = true;
                for (std::size_t s = 0; s < 2; ++s) {
                    const PairTap &x = tx[s][std::size_t(i)], &y = ty[s][std::size_t(j)],
                                  &z = tz[s][std::size_t(k / sublattices)];
                    for (std::size_t corner = 0; corner < 8; ++corner) {
                        Corner& one = corners[8 * s + corner];
                        one.weight = (corner & 1 ? x.fraction : 1 - x.fraction) *
                                     (corner & 2 ? y.fraction : 1 - y.fraction) *
                                     (corner & 4 ? z.fraction : 1 - z.fraction);
                        one.at = (corner & 1 ? x.upper : x.lower) + (corner & 2 ? y.upper : y.lower) +
                                 (corner & 4 ? z.upper : z.lower);
                        onlyOwn = onlyOwn && number(one.at) == own;
                    }
                }
                if (given != nullptr && !onlyOwn) {
                    const glm::dvec3 position = target.position({i, j, k});
                    const auto found = nearestOf(from, number, own, from.index(from.nearest(position)), position);
                    if (!found) {
                        const std::optional<double>& mean = own < means.size() && means[own] ? means[own] : means[0];
                        stored[to] = mean ? range.store(*mean, own) : T{};
                        continue;
                    }
                    nearest = *found;
                } else if (mask != nullptr) {
                    nearest = from.index(from.nearest(target.position({i, j, k})));
                    (*mask)[to] = own = number(nearest);
                    if (own == 0) continue;
                }
                const auto ownValue = [&](glm::ivec3 there) -> std::optional<double> {
                    if (!isInside(from, there)) return std::nullopt;
                    const std::size_t index = from.index(there);
                    return number(index) == own ? std::optional(double(values[index])) : std::nullopt;
                };
                const auto besideNearest = [&](glm::ivec3 there) {
                    return isBeside(from.kind, there, storageIndex(from, nearest));
                };
                double sum = 0;
                for (const auto& [w, at] : corners)
                    if (number(at) == own)
                        sum += w * double(values[at]);
                    else if (w != 0)
                        sum += w * continued(from.kind, storageIndex(from, at), ownValue, besideNearest)
                                       .value_or(double(values[nearest]));
                stored[to] = range.store(sum / 2, own); // the weights of a sublattice sum to 1
            }
    });
}

} // namespace

Field resampleBcc(const Field& source, const Lattice& target, ResampleFilter filter, const Progress& progress,
                  const Mask* own) {
    Field out = makeField(target, source.type);
    out.offset = source.offset;
    out.scale = source.scale;
    std::shared_ptr<Mask> mask;
    if (source.mask && own == nullptr) mask = std::make_shared<Mask>(target.count(), std::uint8_t(1));
    dispatch(source.type, [&]<class T>(T) {
        if (filter == ResampleFilter::Nearest)
            fromNearest<T>(source, out, mask.get(), progress);
        else
            fromBcc<T>(source, out, mask.get(), own, progress);
    });
    out.mask = std::move(mask);
    return out;
}

} // namespace tessera::volume
