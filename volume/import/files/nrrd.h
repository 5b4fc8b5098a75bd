#pragma once

#include "volume/import/files/raw.h"

#include <optional>
#include <string>
#include <string_view>

namespace tessera::volume {

enum class NrrdEncoding { Raw, Text };

/// Layout of a scalar .nrrd or .nhdr file of up to three axes with this encoding, from the beginning of the file
/// (`head`, up to 1 MiB); empty for other encodings and vectors, which VTK reads. The keys "unit" and "time" that
/// exportDataset writes are supported. Throws Error for a broken header.
std::optional<RawForm> parseNrrd(std::string_view head, const std::string& file,
                                 NrrdEncoding wanted = NrrdEncoding::Raw);

/// The unit of lengths that such a header states for its axes, of any encoding; "" where it states none, or they
/// differ. Throws Error for a broken header.
std::string lengthUnitOfNrrd(std::string_view head);

} // namespace tessera::volume
