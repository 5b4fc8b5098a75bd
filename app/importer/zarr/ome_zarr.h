#pragma once

#include "app/importer/readers/source.h"

#include <string>

namespace tessera::importer {

/// A folder whose attributes hold "multiscales": an image of OME-Zarr up to version 0.4 (ngff.openmicroscopy.org). Its
/// finest level is read: axes, units, places, times, channels by their names, and labels on the same grid.
void openOmeZarr(Source& source, const std::string& folder);

/// A folder of arrays without a geometry, or one array.
void openPlainZarr(Source& source, const std::string& folder);

} // namespace tessera::importer
