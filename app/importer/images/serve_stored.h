#pragma once

#include "app/importer/readers/source.h"
#include "volume/import/files/stored_image.h"

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace tessera::importer {

/// Makes an image whose samples lie in files as its header says the contents of a source. Throws for files that are
/// missing or too short.
void serveStored(Source& source, volume::StoredImage image);

/// The grid of an image, without arrays. Samples of cells need one more point along each axis.
vtkSmartPointer<vtkImageData> gridOf(const volume::StoredImage& image);

} // namespace tessera::importer
