#pragma once

#include "volume/resample/resample_taps.h"
#include "volume/sources/sampled_box.h"

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

/// For every index of `out`, x fastest, calls store(index, sum, met): the sum of the samples of `in` under the weights
/// of tapOf(axis, index along it), at most `Count`, whose samples lie in the box, and the bits of those whose weight is
/// not 0. Values of absent samples must be numbers.
template <int Count, class TapOf, class Store>
void filterBox(const SampledBox& in, const IndexBox& out, const TapOf& tapOf, const Store& store) {
    const glm::ivec3 size = in.box.size();
    const auto nx = std::size_t(size.x), ny = std::size_t(size.y);
    const bool mixed = !in.numbers.empty();
    std::vector<double> plane(nx * ny), row(nx + Count); // beyond the last sample weights are 0
    std::vector<std::uint8_t> planeMet(mixed ? nx * ny : 0), rowMet(mixed ? nx : 0);
    const PackedTaps<Count> alongX(tapOf, 0, out.begin.x, out.end.x, in.box.begin.x);
    const std::uint8_t only = bitOf(in.number);
    for (int z = out.begin.z; z < out.end.z; ++z) {
        const Tap& alongZ = tapOf(2, z);
        std::ranges::fill(plane, 0.0);
        std::ranges::fill(planeMet, std::uint8_t(0));
        for (std::size_t j = 0; j < ny; ++j) // row by row: the sums stay in the cache
            for (int k = 0; k < alongZ.count; ++k) {
                const double weight = alongZ.weight[std::size_t(k)];
                if (weight == 0) continue;
                const std::size_t first = (std::size_t(alongZ.first + k - in.box.begin.z) * ny + j) * nx;
                const float* from = &in.values[first];
                double* to = &plane[j * nx];
                for (std::size_t i = 0; i < nx; ++i) to[i] += weight * double(from[i]);
                for (std::size_t i = 0; mixed && i < nx; ++i) planeMet[j * nx + i] |= bitOf(in.numbers[first + i]);
            }
        for (int y = out.begin.y; y < out.end.y; ++y) {
            const Tap& alongY = tapOf(1, y);
            std::ranges::fill(row, 0.0);
            std::ranges::fill(rowMet, std::uint8_t(0));
            for (int k = 0; k < alongY.count; ++k) {
                const double weight = alongY.weight[std::size_t(k)];
                if (weight == 0) continue;
                const std::size_t first = std::size_t(alongY.first + k - in.box.begin.y) * nx;
                for (std::size_t i = 0; i < nx; ++i) row[i] += weight * plane[first + i];
                for (std::size_t i = 0; mixed && i < nx; ++i) rowMet[i] |= planeMet[first + i];
            }
            const double* weights = alongX.weights.data();
            for (int x = out.begin.x; x < out.end.x; ++x, weights += Count) {
                const auto first = std::size_t(alongX.first[std::size_t(x - out.begin.x)]);
                double sum = 0;
                for (std::size_t k = 0; k < Count; ++k) sum += weights[k] * row[first + k];
                std::uint8_t met = only;
                if (mixed) {
                    met = 0;
                    for (std::size_t k = 0; k < Count; ++k)
                        if (weights[k] != 0) met |= rowMet[first + k];
                }
                store(glm::ivec3(x, y, z), sum, met);
            }
        }
    }
}

} // namespace tessera::volume
