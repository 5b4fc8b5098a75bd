#pragma once

#include "app/importer/dicom/dicom_elements.h"
#include "app/importer/dicom/dicom_image.h"

#include <string>
#include <vector>

/// What a DICOM file says of each of its frames: place, scaling, and what tells frames at one place apart. The groups
/// of multi-frame files (PS3.3, C.7.6.16) count wherever they are, whatever the class of the file.
namespace tessera::importer {

/// Why a file holds no image that is read, "" if it does: the kind of its contents.
std::string notAnImage(const DicomFile& file);

/// Describes a file; its frames are appended, with `image` as their number.
DicomImage describeDicom(const DicomFile& file, const std::string& path, std::size_t image,
                         std::vector<DicomFrame>& frames);

} // namespace tessera::importer
