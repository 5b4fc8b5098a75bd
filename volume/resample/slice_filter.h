#pragma once

#include "volume/field/stored_range.h"
#include "volume/reconstruct/continued.h"
#include "volume/resample/resample_taps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

/// Filtering of a CC field onto slices of another grid, axis by axis: inside of volume/resample/resample_cc.cpp.
namespace tessera::volume {

/// Precision that sums over samples of a stored type need: a rounded 8 or 16 bit number comes out of float sums.
template <class T> using SumOf = std::conditional_t<(sizeof(T) < 4), float, double>;

/// The samples around a cell of a CC lattice that are of the part of one of its corners, and joined to that by steps
/// along the axes towards it: nothing counts beyond a gap. One bit for each sample, eight rows of eight to a slice.
class OwnWindow {
public:
    static constexpr int kReach = 3; ///< samples beyond the cell
    OwnWindow(const Lattice& lattice, const Mask& mask, glm::ivec3 cell, glm::ivec3 corner) : first_(cell - kReach) {
        const std::uint8_t part = mask[lattice.index(corner)];
        std::array<std::uint64_t, kEdge> own{};
        const glm::ivec3 lo = glm::max(-first_, glm::ivec3(0)), hi = glm::min(lattice.size - first_, glm::ivec3(kEdge));
        for (int z = lo.z; z < hi.z; ++z)
            for (int y = lo.y; y < hi.y; ++y) {
                const std::uint8_t* const row = &mask[lattice.index(first_ + glm::ivec3(lo.x, y, z))];
                own[std::size_t(z)] |= bitsOf(row, hi.x - lo.x, part) << (kEdge * y + lo.x);
            }
        join(corner - first_, own);
    }

    bool has(glm::ivec3 at) const {
        const glm::uvec3 in(at - first_);
        if (in.x >= unsigned(kEdge) || in.y >= unsigned(kEdge) || in.z >= unsigned(kEdge)) return false;
        return (joined_[in.z] >> (unsigned(kEdge) * in.y + in.x) & 1u) != 0;
    }

private:
    static constexpr int kEdge = 2 + 2 * kReach;
    static_assert(kEdge == 8);
    static constexpr std::uint64_t kOnes = 0x0101010101010101;

    /// Which of up to eight numbers are `part`, the first one in the lowest bit.
    static std::uint64_t bitsOf(const std::uint8_t* numbers, int count, std::uint8_t part) {
        if (std::endian::native == std::endian::little && count == kEdge) {
            constexpr std::uint64_t kLow = 0x7f * kOnes;
            std::uint64_t apart = 0; // bytes that are 0 where a number is the part
            std::memcpy(&apart, numbers, sizeof apart);
            apart ^= part * kOnes;
            const std::uint64_t zeros = ~(((apart & kLow) + kLow) | apart | kLow);
            return (zeros >> 7) * 0x0102040810204080 >> 56; // moves the bits of the bytes side by side
        }
        std::uint64_t bits = 0;
        for (int i = 0; i < count; ++i) bits |= std::uint64_t(numbers[i] == part ? 1u : 0u) << i;
        return bits;
    }

    /// Goes outwards from the corner: a sample is joined if one beside it and nearer to the corner along an axis is.
    void join(glm::ivec3 corner, const std::array<std::uint64_t, kEdge>& own) {
        const std::uint64_t right = kOnes * ((0xfeu << corner.x) & 0xffu), left = kOnes * ((1u << corner.x) - 1),
                            below = (std::uint64_t(1) << kEdge * corner.y) - 1,
                            above = corner.y == kEdge - 1 ? 0 : ~std::uint64_t(0) << kEdge * (corner.y + 1);
        const auto spread = [&](std::uint64_t from, std::uint64_t slice) {
            std::uint64_t joined = from & slice, before = 0;
            while (joined != before) {
                before = joined;
                joined |= ((before << 1 & right) | (before >> 1 & left) | (before << kEdge & above) |
                           (before >> kEdge & below)) &
                          slice;
            }
            return joined;
        };
        const auto z = std::size_t(corner.z);
        joined_[z] = spread(std::uint64_t(1) << (kEdge * corner.y + corner.x), own[z]);
        for (std::size_t k = z + 1; k < own.size(); ++k) joined_[k] = spread(joined_[k - 1], own[k]);
        for (std::size_t k = z; k-- > 0;) joined_[k] = spread(joined_[k + 1], own[k]);
    }

    glm::ivec3 first_;
    std::array<std::uint64_t, kEdge> joined_{};
};

/// Weights of Catmull-Rom for the samples around a cell, the one before it first; of the linear filter for its two.
inline std::array<double, 4> aroundCell(const Tap& tap) {
    const double f = tap.fraction;
    if (tap.count <= 2) return {0, 1 - f, f, 0};
    return {f * (-0.5 + f * (1 - 0.5 * f)), 1 + f * f * (-2.5 + 1.5 * f), f * (0.5 + f * (2 - 1.5 * f)),
            f * f * (-0.5 + 0.5 * f)};
}

/// Catmull-Rom, of the linear filter trilinear, over the samples of the nearest one's part; `beyond(index, own)` gives
/// the values in place of others, where own(index) returns those of the part. `taps`: along x, y and z.
template <class Values, class Beyond>
double ofOwnPart(const Lattice& lattice, const Mask& mask, const std::array<const Tap*, 3>& taps, const Values& values,
                 const Beyond& beyond) {
    const auto& [x, y, z] = taps;
    const glm::ivec3 cell(x->cell[0], y->cell[0], z->cell[0]);
    const OwnWindow window(lattice, mask, cell, {x->nearest, y->nearest, z->nearest});
    const auto own = [&](glm::ivec3 at) {
        return window.has(at) ? std::optional(double(values[lattice.index(at)])) : std::nullopt;
    };
    const std::array<std::array<double, 4>, 3> weights{aroundCell(*x), aroundCell(*y), aroundCell(*z)};
    double sum = 0;
    for (int n = 0; n < 64; ++n) {
        const int i = n & 3, j = n >> 2 & 3, k = n >> 4;
        const double w = weights[0][std::size_t(i)] * weights[1][std::size_t(j)] * weights[2][std::size_t(k)];
        if (w == 0) continue;
        const glm::ivec3 at = cell + glm::ivec3(i, j, k) - 1;
        const std::optional<double> value = own(at);
        sum += w * (value ? *value : beyond(at, own));
    }
    return sum;
}

/// One target slice of a CC source. `Value`: what the kernel weighs, the stored numbers or coefficients made from them.
template <class T, class Value> class SliceFilter {
public:
    using Sum = SumOf<T>;

    /// `values`: one per sample of the source; `inSpace`: taps are of places in space. All arguments must outlive the
    /// filter.
    SliceFilter(const Field& source, std::span<const Value> values, const AxisTaps& taps, const StoredRange<T>& range,
                bool inSpace)
        : source_(source), values_(values), taps_(taps), range_(range), inSpace_(inSpace), stored_(source.as<T>()) {
        for (const Tap& x : taps.x)
            for (int k = 0; k < x.count; ++k) weightsX_.push_back(Sum(x.weight[std::size_t(k)]));
    }

    /// out, present: taps.x.size() * taps.y.size(), x fastest; present is null for a source without mask.
    void run(const Tap& z, T* out, std::uint8_t* present) {
        filterPlane(z, present != nullptr);
        row_.resize(std::size_t(source_.lattice.size.x));
        rowMet_.resize(row_.size());
        const int count = taps_.x.front().count;
        for (const Tap& y : taps_.y) {
            filterRow(y, present != nullptr);
            if (present != nullptr)
                storeMasked(y, z, out, present);
            else if (count == 4)
                storeRow<4>(out, 4);
            else
                storeRow<0>(out, std::size_t(count));
            out += taps_.x.size();
            if (present != nullptr) present += taps_.x.size();
        }
    }

private:
    /// Where a kernel has been, a bit for each number that masks have there; 1 for absent samples.
    static std::uint8_t bitOf(std::uint8_t number) { return std::uint8_t(1u << (number & 7u)); }

    /// plane_ = the sum over slices; met_ has the bits of the samples of columns under weights that are not 0.
    void filterPlane(const Tap& z, bool masked) {
        const auto nx = std::size_t(source_.lattice.size.x), ny = std::size_t(source_.lattice.size.y);
        plane_.assign(nx * ny, Sum(0));
        if (masked) met_.assign(nx * ny, 0);
        for (std::size_t j = 0; j < ny; ++j) // row by row: the sums stay in the cache
            for (int k = 0; k < z.count; ++k) {
                const Sum w = Sum(z.weight[std::size_t(k)]);
                if (w == 0) continue;
                const std::size_t first = (std::size_t(z.first + k) * ny + j) * nx;
                const Value* from = &values_[first];
                Sum* to = &plane_[j * nx];
                if (!masked) {
                    for (std::size_t i = 0; i < nx; ++i) to[i] += w * Sum(from[i]);
                    continue;
                }
                const std::uint8_t* mask = &(*source_.mask)[first];
                std::uint8_t* met = &met_[j * nx];
                for (std::size_t i = 0; i < nx; ++i) {
                    to[i] += mask[i] != 0 ? w * Sum(from[i]) : Sum(0);
                    met[i] = std::uint8_t(met[i] | bitOf(mask[i]));
                }
            }
    }

    void filterRow(const Tap& y, bool masked) {
        const std::size_t nx = row_.size();
        std::fill(row_.begin(), row_.end(), Sum(0));
        if (masked) std::fill(rowMet_.begin(), rowMet_.end(), std::uint8_t(0));
        for (int k = 0; k < y.count; ++k) {
            const Sum w = Sum(y.weight[std::size_t(k)]);
            if (w == 0) continue;
            const Sum* from = &plane_[std::size_t(y.first + k) * nx];
            for (std::size_t i = 0; i < nx; ++i) row_[i] += w * from[i];
            if (!masked) continue;
            const std::uint8_t* met = &met_[std::size_t(y.first + k) * nx];
            for (std::size_t i = 0; i < nx; ++i) rowMet_[i] |= met[i];
        }
    }

    /// `Count`: known number of samples per tap, 0: `count`.
    template <std::size_t Count> void storeRow(T* out, std::size_t count) {
        if constexpr (Count > 0) count = Count;
        const Sum* weights = weightsX_.data();
        for (std::size_t i = 0; i < taps_.x.size(); ++i, weights += count) {
            const Sum* from = &row_[std::size_t(taps_.x[i].first)];
            Sum sum = 0;
            for (std::size_t k = 0; k < (Count > 0 ? Count : count); ++k) sum += weights[k] * from[k];
            out[i] = range_.store(double(sum));
        }
    }

    void storeMasked(const Tap& y, const Tap& z, T* out, std::uint8_t* present) {
        for (std::size_t i = 0; i < taps_.x.size(); ++i) {
            const Tap& x = taps_.x[i];
            Sum sum = 0;
            std::uint8_t met = 0;
            for (int k = 0; k < x.count; ++k) {
                const Sum w = Sum(x.weight[std::size_t(k)]);
                if (w == 0) continue;
                sum += w * row_[std::size_t(x.first + k)];
                met |= rowMet_[std::size_t(x.first + k)];
            }
            const glm::ivec3 nearest(x.nearest, y.nearest, z.nearest);
            present[i] = (*source_.mask)[source_.lattice.index(nearest)];
            if (present[i] == 0)
                out[i] = T{};
            else
                out[i] = range_.store(met == bitOf(present[i]) ? double(sum) : ownOnly(x, y, z, nearest), present[i]);
        }
    }

    double ownOnly(const Tap& x, const Tap& y, const Tap& z, glm::ivec3 nearest) const {
        const double here = double(stored_[source_.lattice.index(nearest)]);
        return ofOwnPart(source_.lattice, *source_.mask, {&x, &y, &z}, stored_, [&](glm::ivec3 at, const auto& own) {
            const auto any = [](glm::ivec3) { return true; };
            const std::optional<double> value =
                inSpace_ ? continuedInSpace(source_.lattice, at, own, any) : continued(LatticeKind::CC, at, own, any);
            return value.value_or(here);
        });
    }

    const Field& source_;
    std::span<const Value> values_;
    const AxisTaps& taps_;
    const StoredRange<T>& range_;
    bool inSpace_;
    std::span<const T> stored_;
    std::vector<Sum> weightsX_, plane_, row_;
    std::vector<std::uint8_t> met_, rowMet_;
};

} // namespace tessera::volume
