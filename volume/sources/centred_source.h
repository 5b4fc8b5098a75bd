#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// Whether a source can be shown on the body-centred lattice: a regular grid whose parameters have no more parts than
/// filters support.
bool canBeCentred(const BrickSource& source);

/// A source of regular grids as pictures show it: on the body-centred lattice, made of bricks as they are read, and
/// corrected once (volume/sources/centred_samples.h). Parts, absent samples, times, ranges and bounds are those of the
/// source; the samples of a brick may leave the range of the source's nearby by kCentredHeadroom of its width, which
/// the statistics of bricks allow for. Coarse levels are made from those of the source, means in the middle of theirs
/// (BrickGrid::phase 0.5). `budget`: bytes of bricks kept, those made and beside them a quarter as many of those read.
/// `former`: such a source of the same data with fewer or more parameters, whose bricks are taken over. Throws Error
/// where canBeCentred() is false.
std::shared_ptr<const BrickSource> makeCentredSource(std::shared_ptr<const BrickSource> source, std::size_t budget,
                                                     const BrickSource* former = nullptr);

/// The source that such a source shows; null for others.
std::shared_ptr<const BrickSource> centredFrom(const BrickSource& source);

} // namespace tessera::volume
