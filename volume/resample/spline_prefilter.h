#pragma once

#include "volume/field/field.h"
#include "volume/resample/resample_options.h"

#include <span>
#include <vector>

/// Coefficients of interpolating B-splines. M. Unser, A. Aldroubi, M. Eden, B-spline signal processing, part II, 1993:
/// one causal and one anticausal first-order filter per pole.
namespace tessera::volume {

/// Replaces samples along a line by the coefficients of the interpolating B-spline of degree 3 or 5. Beyond the ends
/// samples and coefficients continue by point reflection (-i is twice the first minus i), which keeps linear functions.
void splinePrefilter(std::span<double> line, int degree);

/// Degree of the spline of a filter; 0: it is none.
constexpr int splineDegree(ResampleFilter filter) {
    return filter == ResampleFilter::BSpline3 ? 3 : filter == ResampleFilter::BSpline5 ? 5 : 0;
}

/// The stored values of a field, 0 where absent.
template <class Real> std::vector<Real> splineValues(const Field& field);

/// Runs splinePrefilter over every line of a box along an axis, x fastest; `present`: the mask, empty: all are there.
/// Every run of samples of one part (volume/field/part_masks.h) is a signal of its own, so no value crosses an absent
/// sample.
template <class Real>
void splineFilterAxis(glm::ivec3 size, std::span<const std::uint8_t> present, std::vector<Real>& values, int axis,
                      int degree);

/// Coefficients of a CC field's stored values, axis after axis; of absent ones 0. `Real`: float or double.
template <class Real> std::vector<Real> splineCoefficients(const Field& field, int degree);

} // namespace tessera::volume
