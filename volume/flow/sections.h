#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/space_axis.h"
#include "volume/flow/section_weight.h"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

/// Averages, extremes, integrals and fluxes over planes across an axis or any line, from the samples at full
/// resolution: each sample stands for its own cell (volume/bricks/sample_cells.h), where its value is constant.
namespace tessera::volume {

struct SectionQuery {
    std::vector<int> channels;               ///< indices of DatasetInfo::channels()
    std::array<int, 3> velocity{-1, -1, -1}; ///< channels of its components; -1: no flux and no mass flow
    int density = -1;                        ///< channel; -1: mass flow is volume flow
    SectionWeight weight = SectionWeight::Area;
    SpaceAxis axis = SpaceAxis::Z; ///< the planes are those that samples lie in
    /// Instead of an axis: a line from the first to the second point, with `planes` planes across it, each in the
    /// middle of a slab of equal thickness.
    std::optional<std::array<glm::dvec3, 2>> line;
    int planes = 100;
    int label = -1;           ///< channel of a label
    std::vector<int> regions; ///< of its values: one set of curves each; empty: one of all samples
    /// Degree of interest 0..1 that every sample counts with, given the values of `doiChannels` (NaN where absent) and
    /// its position. Called from several threads at once. Empty: everything has 1.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi;
    std::vector<int> doiChannels;
    int time = 0;
    std::vector<double> errors = {}; ///< bounds on the errors of samples, by position in `channels`; empty: 0
    std::array<double, 3> velocityError{0, 0, 0}; ///< and of the components of the velocity
};

/// One plane: sums over the samples of a region that have a value f there. a is the area of the sample's cell in the
/// plane, u the velocity along the axis or line (0 where there is none), d the degree of interest:
///
///     area      sum a d
///     integral  sum f a d                                      [unit * length^2]
///     mean      by area: sum f a d / sum a d
///               by volume: the same with the cell's volume in the slab around the plane in place of a
///               by mass flow: sum f |rho u| a d / sum |rho u| a d, rho = 1 where no density is given
///     flux      sum f u a d      what is carried through the plane, counted along the axis or line
///     flow      sum u a d        the volume flow of the samples that have f and a velocity
///
/// With the weight Volume, a is the cell's volume in the slab divided by its thickness: sums over planes of integral *
/// thickness are then the volume integral along any line. Along an axis both are the same. On BCC every plane across an
/// axis holds samples of one sublattice, whose cells fill it; along a line each counts half.
/// Where nothing is, area is 0 and the rest NaN but for samples, flux and flow.
struct SectionValues {
    double samples = 0, area = 0, mean = 0, least = 0, most = 0, integral = 0, flux = 0, flow = 0;
    double fluxError = 0, flowError = 0; ///< bounds on their errors, without a degree of interest
};

struct Sections {
    std::vector<double> place;     ///< of the planes: coordinate along the axis, or distance from the start of the line
    std::vector<double> thickness; ///< of the slabs around them; of one sublattice's planes half their distance
    std::vector<int> regions;      ///< as asked
    std::vector<std::vector<std::vector<SectionValues>>> values; ///< [region][channel][plane]
};

/// The result does not depend on the number of threads. Throws Error when a brick is damaged or a line has no length,
/// Cancelled.
Sections computeSections(const BrickSource& source, const SectionQuery& query, const Progress& progress = {});

/// Values of a label that occur at a time, rising.
std::vector<int> labelValues(const BrickSource& source, int label, int time, const Progress& progress = {});

} // namespace tessera::volume
