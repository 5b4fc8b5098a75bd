#pragma once

#include "volume/resample/resample_taps.h"
#include "volume/sources/sampled_box.h"
#include "volume/sources/weighed_rows.h"

#include <algorithm>

/// Separable filtering of boxes of samples: inside of volume/sources/centred_samples.cpp.
namespace tessera::volume {

/// Which numbers a kernel has met, a bit for each.
inline std::uint8_t bitOf(std::uint8_t number) {
    return std::uint8_t(1u << (number & 7u));
}

/// The weights of taps along a line in a box, one after another: `Count` each.
template <int Count> struct PackedTaps {
    std::vector<int> first; ///< in the box
    std::vector<double> weights;

    template <class TapOf> PackedTaps(const TapOf& tapOf, int axis, int begin, int end, int box) {
        for (int i = begin; i < end; ++i) {
            const Tap& tap = tapOf(axis, i);
            first.push_back(tap.first - box);
            for (int k = 0; k < Count; ++k) weights.push_back(k < tap.count ? tap.weight[std::size_t(k)] : 0);
        }
    }
};

/// For every row of `out`, calls store(y, z, sums, met): for each of its indices along x the sum of the samples of `in`
/// under the weights of tapOf(axis, index along it), at most `Count`, whose samples lie in the box, and the bits of
/// those whose weight is not 0; null where `in` has no numbers. Values of absent samples must be numbers.
template <int Count, class TapOf, class Store>
void filterBox(const SampledBox& in, const IndexBox& out, const TapOf& tapOf, const Store& store) {
    static_assert(Count <= int(WeighedRows<float>::kMost));
    const glm::ivec3 size = in.box.size();
    const auto nx = std::size_t(size.x), ny = std::size_t(size.y), width = std::size_t(out.size().x);
    const bool mixed = !in.numbers.empty();
    const Cpu cpu = bestCpu();
    std::vector<double> plane(nx * ny), row(nx + Count), sums(width); // beyond the last sample weights are 0
    std::vector<std::uint8_t> planeMet(mixed ? nx * ny : 0), rowMet(mixed ? nx : 0), met(mixed ? width : 0);
    const PackedTaps<Count> alongX(tapOf, 0, out.begin.x, out.end.x, in.box.begin.x);
    for (int z = out.begin.z; z < out.end.z; ++z) {
        const Tap& alongZ = tapOf(2, z);
        WeighedRows<float> slices;
        std::ranges::fill(planeMet, std::uint8_t(0));
        for (int k = 0; k < alongZ.count; ++k) {
            const double weight = alongZ.weight[std::size_t(k)];
            if (weight == 0) continue;
            const std::size_t first = std::size_t(alongZ.first + k - in.box.begin.z) * ny * nx;
            slices.add(&in.values[first], weight);
            for (std::size_t i = 0; i < planeMet.size(); ++i) planeMet[i] |= bitOf(in.numbers[first + i]);
        }
        sumRows(slices, nx * ny, plane.data(), cpu);
        for (int y = out.begin.y; y < out.end.y; ++y) {
            const Tap& alongY = tapOf(1, y);
            WeighedRows<double> rows;
            std::ranges::fill(rowMet, std::uint8_t(0));
            for (int k = 0; k < alongY.count; ++k) {
                const double weight = alongY.weight[std::size_t(k)];
                if (weight == 0) continue;
                const std::size_t first = std::size_t(alongY.first + k - in.box.begin.y) * nx;
                rows.add(&plane[first], weight);
                for (std::size_t i = 0; i < rowMet.size(); ++i) rowMet[i] |= planeMet[first + i];
            }
            sumRows(rows, nx, row.data(), cpu);
            const double* weights = alongX.weights.data();
            for (std::size_t x = 0; x < width; ++x, weights += Count) {
                const double* const from = &row[std::size_t(alongX.first[x])];
                double sum = weights[0] * from[0];
                for (std::size_t k = 1; k < Count; ++k) sum += weights[k] * from[k];
                sums[x] = sum;
            }
            if (mixed) {
                weights = alongX.weights.data();
                for (std::size_t x = 0; x < width; ++x, weights += Count) {
                    met[x] = 0;
                    for (std::size_t k = 0; k < Count; ++k)
                        if (weights[k] != 0) met[x] |= rowMet[std::size_t(alongX.first[x]) + k];
                }
            }
            store(y, z, sums.data(), mixed ? met.data() : nullptr);
        }
    }
}

} // namespace tessera::volume
