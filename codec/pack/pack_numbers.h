#pragma once

#include "codec/archive/archive_writer.h"
#include "codec/pack/memory_plan.h"
#include "codec/unpack/packed_before.h"
#include "volume/field/dataset.h"

#include <string>
#include <vector>

/// Numbers of regions that an archive with a bound keeps.
namespace tessera::codec {

/// Appends the numbers of a data set with known ranges to an archive and names them in its metadata: those that
/// `before` knows, else those of its samples if they are the original ones. Returns a message where they are left out,
/// else "". Throws Error, Cancelled.
std::string addNumbers(ArchiveWriter& writer, const volume::Dataset& source, const PackedBefore& before,
                       const Archive* grown, const MemoryPlan& memory, Metadata& metadata, const Progress& progress);

} // namespace tessera::codec
