#pragma once

#include "volume/worth/worth_samples.h"

#include <array>
#include <vector>

/// Samples beside each other are alike: how many independent ones they are worth.
namespace tessera::volume {

/// Correlation of samples with those at rising distances, along each axis, and how far samples reach.
struct Correlogram {
    double samples = 0;                      ///< present
    std::array<std::vector<double>, 3> lags; ///< [axis][position in kLags]; ends where pairs do
    std::array<int, 3> extent{1, 1, 1};      ///< samples along each axis, of those present
};

/// Of the present samples of all, and of each region: [0] and [1 + position in regions].
std::vector<Correlogram> correlograms(const WorthSamples& samples, const std::vector<float>& values);

/// Along each axis, over how many samples one independent sample reaches, when a sum of products of both is looked at:
/// 1 + 2 sum over k of rx(k) ry(k) (P. Clifford, S. Richardson, D. Hemon, Assessing the significance of the correlation
/// between two spatial processes, 1989), up to where one of both vanishes; from 1 to the extent. For the mean of one,
/// `second` false: 1 + 2 sum over k of rx(k).
std::array<double, 3> correlationLengths(const Correlogram& x, const Correlogram& y, bool second = true);

/// Samples by the product of their lengths, at least 1.
double effectiveSamples(double samples, const std::array<double, 3>& lengths);

} // namespace tessera::volume
