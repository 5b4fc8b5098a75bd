#pragma once

#include "volume/import/files/nrrd_header.h"
#include "volume/import/files/stored_image.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

/// What the axes of a NRRD file run along, and where its samples lie.
namespace tessera::volume {

struct NrrdAxis {
    StoredAxis::Along along = StoredAxis::Along::Space;
    std::size_t size = 1;
    std::string kind, label, unit; ///< the kind in small letters
    double spacing = std::numeric_limits<double>::quiet_NaN();
    double thickness = spacing, min = spacing, max = spacing; ///< NaN: not stated
    std::optional<bool> cell;                                 ///< whether a sample is a cell, or else a node
    std::optional<std::vector<double>> direction;
};

/// The axes, fastest first, and what each of them runs along; a note for each guess. Throws Error.
std::vector<NrrdAxis> nrrdAxes(const NrrdHeader& header, std::vector<std::string>& notes);

/// Sets steps, origin, times and units of an image whose axes are set.
void placeNrrd(const NrrdHeader& header, const std::vector<NrrdAxis>& axes, StoredImage& image);

} // namespace tessera::volume
