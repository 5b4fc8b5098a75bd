#pragma once

#include "app/importer/dicom/dicom_elements.h"
#include "app/importer/dicom/dicom_form.h"

#include <string>
#include <vector>

/// The stored numbers of one frame, whatever their encoding.
namespace tessera::importer {

/// Throws unless the file has samples that are read here, and as many bytes of them as its header says.
DicomForm dicomForm(const DicomFile& file);

/// The stored numbers of a frame, top row first; colours as red, green and blue of each pixel.
std::vector<double> dicomNumbers(const DicomFile& file, const DicomForm& form, int frame);

} // namespace tessera::importer
