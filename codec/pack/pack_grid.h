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

} // namespace tessera::codec
