#pragma once

#include "codec/metadata.h"

namespace tessera::codec {

/// True if the next frames may be read while the last are coded. Throws Error when a stated limit of memory is below
/// what one time of a parameter and its coded bytes take.
bool mayReadAhead(const Metadata& metadata, const volume::DatasetInfo& source, const PackOptions& options);

} // namespace tessera::codec
