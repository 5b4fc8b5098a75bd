#pragma once

#include "volume/worth/finding.h"
#include "volume/worth/worth_samples.h"

/// Places unlike the rest, one or a few for each parameter.
namespace tessera::volume {

/// Of each parameter the connected sets of samples
/// - whose values lie beyond all others' tail, on either side (Outliers), and
/// - whose difference from a neighbour is unlike the differences between the same two planes of samples elsewhere
/// (Jump):
///   layers of a cell, across which everything jumps, are not odd.
/// Both within regions, where there are some. Tails are judged by expectedBeyond.
Findings findOddPlaces(const WorthSamples& samples, const Progress& progress = {});

} // namespace tessera::volume
