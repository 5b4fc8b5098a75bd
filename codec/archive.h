#pragma once

#include "volume/brick_source.h"
#include "volume/error.h"

#include <memory>
#include <string>

namespace tessera::codec {

/// Opens a .tsr archive (memory mapped) as a source of bricks. Reads header and index only. Throws Error with file,
/// byte offset and reason when it is not an archive, of a newer version, truncated or damaged.
std::shared_ptr<const volume::BrickSource> openArchive(const std::string& path);

} // namespace tessera::codec
