#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace tessera::volume {

template <class T> struct NumberExtent { T least{}, most{}; };

/// Minimum and maximum of at least one number, computed in independent lanes.
template <class T> NumberExtent<T> extentOfNumbers(std::span<const T> numbers) {
    constexpr std::size_t kLanes = 64 / sizeof(T);
    std::array<T, kLanes> least, most;
    least.fill(numbers[0]);
    most.fill(numbers[0]);
    const std::size_t blocks = numbers.size() / kLanes;
    for (std::size_t block = 0; block < blocks; ++block) {
        const T* from = numbers.data() + block * kLanes;
        for (std::size_t i = 0; i < kLanes; ++i) {
            least[i] = from[i] < least[i] ? from[i] : least[i];
            most[i] = from[i] > most[i] ? from[i] : most[i];
        }
    }
    NumberExtent<T> all{numbers[0], numbers[0]};
    const auto include = [&all](T lo, T hi) {
        if (lo < all.least) all.least = lo;
        if (hi > all.most) all.most = hi;
    };
    for (std::size_t i = 0; i < kLanes; ++i) include(least[i], most[i]);
    for (std::size_t i = blocks * kLanes; i < numbers.size(); ++i) include(numbers[i], numbers[i]);
    return all;
}

} // namespace tessera::volume
