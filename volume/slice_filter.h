#pragma once

#include "volume/reconstruct.h"
#include "volume/resample_taps.h"
#include "volume/stored_range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

/// Filtering of a CC field onto slices of another grid, axis by axis: inside of volume/resample_cc.cpp.
namespace tessera::volume {

/// Precision that sums over samples of a stored type need: a rounded 8 or 16 bit number comes out of float sums.
template <class T> using SumOf = std::conditional_t<(sizeof(T) < 4), float, double>;

/// One target slice of a CC source. `Value`: what the kernel weighs, the stored numbers or coefficients made from them.
template <class T, class Value> class SliceFilter {
public:
    using Sum = SumOf<T>;

    /// `values`: one per sample of the source. All arguments must outlive the filter.
    SliceFilter(const Field& source, std::span<const Value> values, const AxisTaps& taps, const StoredRange<T>& range)
        : source_(source), values_(values), taps_(taps), range_(range), stored_(source.as<T>()) {
        for (const Tap& x : taps.x)
            for (int k = 0; k < x.count; ++k) weightsX_.push_back(Sum(x.weight[std::size_t(k)]));
    }

    /// out, present: taps.x.size() * taps.y.size(), x fastest; present is null for a source without mask.
    void run(const Tap& z, T* out, std::uint8_t* present) {
        filterPlane(z, present != nullptr);
        row_.resize(std::size_t(source_.lattice.size.x));
        rowAbsent_.resize(row_.size());
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
    /// plane_ = the sum over slices; absent_ marks columns with an absent sample under a weight that is not 0.
    void filterPlane(const Tap& z, bool masked) {
        const auto nx = std::size_t(source_.lattice.size.x), ny = std::size_t(source_.lattice.size.y);
        plane_.assign(nx * ny, Sum(0));
        if (masked) absent_.assign(nx * ny, 0);
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
                std::uint8_t* absent = &absent_[j * nx];
                for (std::size_t i = 0; i < nx; ++i) {
                    to[i] += mask[i] != 0 ? w * Sum(from[i]) : Sum(0);
                    absent[i] = std::uint8_t(absent[i] | (mask[i] ^ 1));
                }
            }
    }

    void filterRow(const Tap& y, bool masked) {
        const std::size_t nx = row_.size();
        std::fill(row_.begin(), row_.end(), Sum(0));
        if (masked) std::fill(rowAbsent_.begin(), rowAbsent_.end(), std::uint8_t(0));
        for (int k = 0; k < y.count; ++k) {
            const Sum w = Sum(y.weight[std::size_t(k)]);
            if (w == 0) continue;
            const Sum* from = &plane_[std::size_t(y.first + k) * nx];
            for (std::size_t i = 0; i < nx; ++i) row_[i] += w * from[i];
            if (!masked) continue;
            const std::uint8_t* absent = &absent_[std::size_t(y.first + k) * nx];
            for (std::size_t i = 0; i < nx; ++i) rowAbsent_[i] |= absent[i];
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
            std::uint8_t absent = 0;
            for (int k = 0; k < x.count; ++k) {
                const Sum w = Sum(x.weight[std::size_t(k)]);
                if (w == 0) continue;
                sum += w * row_[std::size_t(x.first + k)];
                absent |= rowAbsent_[std::size_t(x.first + k)];
            }
            if (absent == 0) {
                present[i] = 1;
                out[i] = range_.store(double(sum));
            } else {
                present[i] = source_.present(source_.lattice.index({x.nearest, y.nearest, z.nearest})) ? 1 : 0;
                out[i] = present[i] != 0 ? range_.store(presentOnly(x, y, z)) : T{};
            }
        }
    }

    /// Trilinear over the present samples; the nearest one is present, so the weights do not vanish.
    double presentOnly(const Tap& x, const Tap& y, const Tap& z) const {
        Blend blend;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            const std::size_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
            const double w = (a ? x.fraction : 1 - x.fraction) * (b ? y.fraction : 1 - y.fraction) *
                             (c ? z.fraction : 1 - z.fraction);
            const std::size_t at = source_.lattice.index({x.cell[a], y.cell[b], z.cell[c]});
            blend.add(w, {double(stored_[at]), source_.present(at)});
        }
        return blend.sum / blend.coverage;
    }

    const Field& source_;
    std::span<const Value> values_;
    const AxisTaps& taps_;
    const StoredRange<T>& range_;
    std::span<const T> stored_;
    std::vector<Sum> weightsX_, plane_, row_;
    std::vector<std::uint8_t> absent_, rowAbsent_;
};

} // namespace tessera::volume
