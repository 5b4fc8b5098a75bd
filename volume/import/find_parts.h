#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/import/parts_rules.h"

#include <string>
#include <vector>

/// Parts of parameters, found from the samples on either side of region borders.
namespace tessera::volume {

/// Samples of two regions at this distance along an axis, with only absent ones between, are never used together by a
/// filter.
inline constexpr int kPartsApart = 5;

/// The parts of a parameter by a label, from up to three times (first, middle and last). Between two regions whose
/// samples are closer than kPartsApart along an axis the parameter jumps if, on a quarter of the border or more, the
/// values extrapolated from both sides to the middle differ by more than three times the usual difference inside, and
/// by more than a five-hundredth of the range (a tenth if one side is a layer of one sample everywhere, where curvature
/// and jump cannot be distinguished). Regions separated by a jump are in different parts; all others share one,
/// including those too far apart to meet.
Parts foundParts(const Dataset& dataset, int parameter, int label, const Progress& progress = {});

/// Applies foundParts to every parameter (or those in `only`, if not empty) with the first label, except those named in
/// `stated`. Returns a description, one line each.
std::vector<std::string> findParts(Dataset& dataset, const std::vector<PartsRule>& stated,
                                   const std::vector<std::string>& only = {}, const Progress& progress = {});

} // namespace tessera::volume
