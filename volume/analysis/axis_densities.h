#pragma once

#include "volume/base/describe.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// How many samples run from where on one axis to where on the next: what parallel coordinates of any number of samples
/// are drawn from (M. Novotny and H. Hauser, Outlier-preserving focus+context visualization in parallel coordinates,
/// 2006).
namespace tessera::volume {

/// An axis of bins of equal width, in the values or in their logarithm.
struct DensityAxis {
    int channel = 0;          ///< index of DatasetInfo::channels()
    Range range;              ///< of the bins; of a logarithmic axis above 0
    bool logarithmic = false; ///< values of 0 and below lie below the range
    bool operator==(const DensityAxis&) const = default;
};

/// Share of the axis below a value, 0..1 within the range; below 0 or above 1 outside of it. -infinity for what has no
/// logarithm.
double axisShare(const DensityAxis& axis, double value);
/// The value at a share of the axis.
double axisValue(const DensityAxis& axis, double share);

/// Which class of the selection a sample is in, and how much.
struct DensityInterest {
    int group = 0;     ///< below AxisDensitiesQuery::groups
    double degree = 0; ///< 0..1
};

struct AxisDensitiesQuery {
    std::vector<DensityAxis> axes; ///< in order: each has a gap to the next
    std::vector<int> further;      ///< more channels that `interest` is given
    int bins = 128;                ///< along every axis
    int time = 0, level = 0;
    int groups = 0;        ///< classes of the selection; 0: nothing is selected
    bool together = false; ///< of three axes: also every triple of bins
    /// Of a sample, given the physical values of the axes and `further` (NaN where absent) and its position. Called
    /// from several threads at once.
    std::function<DensityInterest(std::span<const float> values, glm::dvec3 position)> interest = {};
};

/// Where on an axis samples can lie: its bins, then three more places.
inline int absentPlace(int bins) {
    return bins;
}
inline int belowPlace(int bins) {
    return bins + 1;
}
inline int abovePlace(int bins) {
    return bins + 2;
}
inline std::size_t placesOf(int bins) {
    return std::size_t(bins) + 3;
}

/// Numbers by place, and those of each group as sums of degrees of interest.
struct PlaceCounts {
    std::vector<std::uint64_t> all;
    std::vector<std::vector<double>> selected; ///< by group
    /// Of all groups together.
    double selectedAt(std::size_t place) const;
};

struct AxisDensities {
    int bins = 0, level = 0;
    std::vector<PlaceCounts> axes; ///< placesOf(bins) each; absent: samples that have a value on another axis
    std::vector<PlaceCounts> gaps; ///< from axis i to the next: place on the left * placesOf(bins) + place on the right
    PlaceCounts cube;              ///< of all three axes: (bin * bins + bin) * bins + bin; empty unless asked for
};

/// Counts on all cores; the result does not depend on their number (degrees are summed in units of 2^-10). Samples that
/// lack every parameter take no part. Throws Error when a brick is damaged, Cancelled.
AxisDensities axisDensities(const BrickSource& source, const AxisDensitiesQuery& query, const Progress& progress = {});

} // namespace tessera::volume
