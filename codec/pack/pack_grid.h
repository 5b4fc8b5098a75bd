#pragma once

#include "codec/archive/archive.h"
#include "codec/container/pack_options.h"

/// The bricks that samples are packed in.
namespace tessera::codec {

/// The bricks of samples on `lattice` that come from a data set: as the options say, or of an automatic size (as
/// PackOptions::brickSize says). Archives that grow (`grown`) keep theirs. Throws Error if the options ask for what
/// cannot be.
volume::BrickGrid gridFor(const volume::Lattice& lattice, const volume::DatasetInfo& source, const PackOptions& options,
                          const Archive* grown = nullptr);

/// Brick layers of the slabs that a team shares: one, but for so many that their open files would be too many. Those of
/// the samples of all components are open, and of the result of a step, twice while samples change.
int layersOfTeam(const volume::BrickGrid& grid, const volume::DatasetInfo& info);

} // namespace tessera::codec
