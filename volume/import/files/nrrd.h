#pragma once

#include "volume/import/files/stored_image.h"

#include <string_view>

namespace tessera::volume {

/// The header of a NRRD file, at most.
inline constexpr std::size_t kMostNrrdHeader = 1 << 20;

/// The image that the header at the beginning of a .nrrd or .nhdr file (`head`, up to 1 MiB) describes: any encoding,
/// number of axes, and order of them. The keys "unit" and "time" that exportDataset writes count, and those of a series
/// of volumes by 3D Slicer ("axis 3 index values"). Throws Error for a broken header.
StoredImage parseNrrd(std::string_view head);

} // namespace tessera::volume
