#pragma once

#include "codec/container/pack_options.h"
#include "volume/field/dataset.h"

namespace tessera::codec {

/// Throws Error, with the reason, for a data set that cannot be packed with these options.
void requirePackable(const volume::DatasetInfo& source, const PackOptions& options);

} // namespace tessera::codec
