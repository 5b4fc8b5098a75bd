#pragma once

#include "volume/worth/effective_samples.h"
#include "volume/worth/finding.h"

#include <span>

/// Which parameters depend on each other, and where.
namespace tessera::volume {

/// Distance correlation of pairs, bias-corrected and squared: about 0 where they are independent, 1 where one is a
/// linear function of the other (G. J. Szekely, M. L. Rizzo, The distance correlation t-test of independence in high
/// dimension, 2013). Takes memory and time of n^2; NaN below 4 pairs or where one is constant.
double distanceCorrelation(std::span<const double> x, std::span<const double> y);

/// One dependence at most for each pair of channels: of Pearson's r with as many samples as are independent, or of the
/// distance correlation of samples so far apart that they are (chi-square test), everywhere and in every region; where
/// r in a region and elsewhere differ, that.
Findings findDependences(const WorthSamples& samples, const Progress& progress = {});

} // namespace tessera::volume
