#pragma once

#include "volume/field.h"

#include <span>
#include <vector>

/// Coefficients of interpolating B-splines. M. Unser, A. Aldroubi, M. Eden, B-spline signal processing, part II, 1993:
/// one causal and one anticausal first-order filter per pole.
namespace tessera::volume {

/// Replaces samples along a line by the coefficients of the interpolating B-spline of degree 3 or 5. Beyond the ends
/// samples and coefficients continue by point reflection (-i is twice the first minus i), which keeps linear functions.
void splinePrefilter(std::span<double> line, int degree);

/// Coefficients of a CC field's stored values, axis after axis. Every run of present samples along an axis is a signal
/// of its own, so no value crosses an absent sample. Absent ones give 0. `Real`: float or double.
template <class Real> std::vector<Real> splineCoefficients(const Field& field, int degree);

} // namespace tessera::volume
