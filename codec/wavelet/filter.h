#pragma once

#include "codec/wavelet/wavelet.h"

#include <array>

/// The lifting steps of the wavelets.
namespace tessera::codec {

/// target +- floor((centre * c + sum of weight[j] * (left_j +- right_j) + half) / 2^shift)
struct LiftStep {
    int centre = 0;
    int pairs = 0;
    std::array<int, 3> weight{};
    bool antisymmetric = false;
    int shift = 0;
    constexpr bool operator==(const LiftStep&) const = default;
};

struct LiftFilter {
    LiftStep predict; ///< odd samples from even ones
    LiftStep update;  ///< even samples from details
    bool updates = false;
};

constexpr bool isCubic(const LiftStep& step) {
    return step.pairs == 2 && step.weight[0] == 9 && step.weight[1] == -1;
}

/// Sample indices of each pair in a sum; incomplete pairs are replaced by the next pair inside.
struct Pairs {
    std::array<int, 3> left{}, right{};
    bool none = false;
};

/// Predict: pair j of odd sample i is even (i - j, i + 1 + j) of `sources` even ones. Update: details (i - 1 - j, i +
/// j) of the `sources` that were predicted from both sides.
constexpr Pairs pairsAt(int i, int count, int sources, bool update) {
    Pairs pairs;
    for (int j = 0; j < count; ++j) {
        const int l = update ? i - 1 - j : i - j, r = update ? i + j : i + 1 + j;
        const bool hasLeft = l >= 0 && l < sources, hasRight = r >= 0 && r < sources;
        const auto at = static_cast<std::size_t>(j);
        if (hasLeft && hasRight) {
            pairs.left[at] = l, pairs.right[at] = r;
        } else if (j == 0) {
            pairs.none = !hasLeft && !hasRight;
            pairs.left[0] = pairs.right[0] = hasLeft ? l : r;
        } else {
            for (int k = j; k < count; ++k) {
                pairs.left[std::size_t(k)] = pairs.left[std::size_t(j - 1)];
                pairs.right[std::size_t(k)] = pairs.right[std::size_t(j - 1)];
            }
            break;
        }
    }
    return pairs;
}

/// Number of details that an update may use: those predicted from both sides; all for the mean of two.
constexpr int usableDetails(int pairs, int evens, int odds) {
    return pairs == 0 || evens > odds ? odds : evens - 1;
}

/// Predictions with N = 4 are the interpolating ones of Deslauriers and Dubuc (9, -1)/16, as in Calderbank et al. 1998,
/// with updates that preserve N~ moments: 1/4; (9, -1)/32; (306, -59, 9)/1024. The factorisation of spline wavelets of
/// that order starts with an update and halves the coarse samples along each axis, which costs integers precision.
constexpr LiftFilter filterOf(Wavelet wavelet) {
    const LiftStep same{1, 0, {}, false, 0}, mean{0, 1, {1}, false, 1}, cubic{0, 2, {9, -1}, false, 4};
    switch (wavelet) {
    case Wavelet::N1:
        return {same, {}, false};
    case Wavelet::N2:
        return {mean, {}, false};
    case Wavelet::W11:
        return {same, {1, 0, {}, false, 1}, true};
    case Wavelet::W13:
        return {same, {8, 1, {-1}, true, 4}, true};
    case Wavelet::W15:
        return {same, {128, 2, {-22, 3}, true, 8}, true};
    case Wavelet::W22:
        return {mean, {0, 1, {1}, false, 2}, true};
    case Wavelet::W24:
        return {mean, {0, 2, {19, -3}, false, 6}, true};
    case Wavelet::W26:
        return {mean, {0, 3, {162, -39, 5}, false, 9}, true};
    case Wavelet::N4:
        return {cubic, {}, false};
    case Wavelet::W42:
        return {cubic, {0, 1, {1}, false, 2}, true};
    case Wavelet::W44:
        return {cubic, {0, 2, {9, -1}, false, 5}, true};
    case Wavelet::W46:
        break;
    }
    return {cubic, {0, 3, {306, -59, 9}, false, 10}, true};
}

/// Calls `visit.operator()<wavelet>()` for a runtime value.
template <class Visit> void withWavelet(Wavelet wavelet, Visit&& visit) {
    switch (wavelet) {
    case Wavelet::N1:
        return visit.template operator()<Wavelet::N1>();
    case Wavelet::N2:
        return visit.template operator()<Wavelet::N2>();
    case Wavelet::W11:
        return visit.template operator()<Wavelet::W11>();
    case Wavelet::W13:
        return visit.template operator()<Wavelet::W13>();
    case Wavelet::W15:
        return visit.template operator()<Wavelet::W15>();
    case Wavelet::W22:
        return visit.template operator()<Wavelet::W22>();
    case Wavelet::W24:
        return visit.template operator()<Wavelet::W24>();
    case Wavelet::W26:
        return visit.template operator()<Wavelet::W26>();
    case Wavelet::N4:
        return visit.template operator()<Wavelet::N4>();
    case Wavelet::W42:
        return visit.template operator()<Wavelet::W42>();
    case Wavelet::W44:
        return visit.template operator()<Wavelet::W44>();
    case Wavelet::W46:
        return visit.template operator()<Wavelet::W46>();
    }
}

} // namespace tessera::codec
