#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <cstdint>
#include <vector>

/// Where the boundaries between materials lie, from the data alone: G. Kindlmann, J. Durkin: Semi-automatic generation
/// of transfer functions for direct volume rendering, 1998. Along the gradient through a boundary between two even
/// materials, blurred by a Gaussian of deviation s, the value is an error function of the place. Its first derivative
/// is greatest, and its second one 0, in the middle; so both, as functions of the value, tell how far from the middle a
/// value lies.
namespace tessera::volume {

/// What to count.
struct DerivativeQuery {
    int channel = 0, time = 0;
    int valueBins = 256, gradientBins = 128;
    Range range{0, 0};      ///< of the values; of no width: DatasetInfo::channelRange
    double gradientTop = 0; ///< largest magnitude counted, in value units per cell; 0: width of the range / 4
    bool operator==(const DerivativeQuery&) const = default;
};

/// The histogram volume of Kindlmann and Durkin, with the axis of second derivatives reduced to their sum. Samples on
/// the surface of the lattice and those with an absent neighbour are skipped. A neighbour in another part
/// (volume/field/parts.h) is replaced by extrapolation of the sample's own part. Element gradient * valueBins + value;
/// gradients above the top count in the last bin.
struct DerivativeHistogram {
    int valueBins = 0, gradientBins = 0;
    Range range;
    double gradientTop = 0;
    std::vector<std::uint64_t> count; ///< the joint histogram of value and gradient magnitude
    std::vector<double> second;       ///< sum of second derivatives
    std::vector<double> first;        ///< per value bin: sum of gradient magnitudes
    std::uint64_t samples = 0;
};

/// Computes the histogram on all cores; the result does not depend on the number of threads. Throws Error when a brick
/// is damaged, Cancelled.
DerivativeHistogram derivativeHistogram(const BrickSource& source, const DerivativeQuery& query,
                                        const Progress& progress = {});

/// The curves of the paper, one entry per value bin; NaN where no sample has the value.
struct BoundaryCurves {
    Range range;
    std::vector<double> first;    ///< g(v), mean gradient magnitude
    std::vector<double> second;   ///< h(v), mean second derivative
    std::vector<double> distance; ///< p(v) = -s^2 h(v) / max(g(v) - threshold, 0), cells from the middle of a boundary;
                                  ///< NaN where the gradient does not reach the threshold
    double thickness = 0;         ///< s = max g / (sqrt(e) max h), in cells: deviation of the blur
};

/// `threshold`: gradient magnitude below which there is no boundary, as a share of the greatest g(v).
BoundaryCurves boundaryCurves(const DerivativeHistogram& histogram, double threshold = 0.1);

} // namespace tessera::volume
