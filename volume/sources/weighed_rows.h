#pragma once

#include "volume/base/cpu.h"

#include <array>
#include <cstddef>

/// Loops over rows of samples by vectors: inside of volume/sources/centred_samples.cpp. Every instruction set gives the
/// same bits.
namespace tessera::volume {

/// Rows of numbers and their weights.
template <class Number> struct WeighedRows {
    static constexpr std::size_t kMost = 4;
    std::array<const Number*, kMost> rows{};
    std::array<double, kMost> weights{};
    std::size_t count = 0; ///< at most kMost

    void add(const Number* row, double weight) {
        rows[count] = row;
        weights[count++] = weight;
    }
};

/// to[i] = the sum of weight * row[i], i < n; 0 of no rows. `to` overlaps none of them.
void sumRows(const WeighedRows<float>& from, std::size_t n, double* to, Cpu cpu = bestCpu());
void sumRows(const WeighedRows<double>& from, std::size_t n, double* to, Cpu cpu = bestCpu());

/// to[i] = own[i] less a twelfth of the sum of differences of its neighbours other[i + step] to it.
void prefilterRow(const float* own, const float* other, const std::array<std::ptrdiff_t, 8>& steps, std::size_t n,
                  float* to, Cpu cpu = bestCpu());

/// Least and greatest of four rows at each place.
void extremesOfRows(const std::array<const float*, 4>& rows, std::size_t n, float* lo, float* hi, Cpu cpu = bestCpu());

/// Whether a value lies in lo .. hi widened by `headroom` of its width to either side.
TESSERA_INLINE bool isWithin(double value, float lo, float hi, double headroom) {
    const double least = double(lo), most = double(hi), beyond = headroom * (most - least);
    return (least - beyond <= value) & (value <= most + beyond); // without a branch
}

/// to[i] = from[i] + sums[i]. Returns how many of them, before they are rounded, are not within lo[i], hi[i].
std::size_t addWithin(const float* from, const double* sums, const float* lo, const float* hi, double headroom,
                      std::size_t n, float* to, Cpu cpu = bestCpu());

} // namespace tessera::volume
