#pragma once

#include "app/importer/dicom/dicom_stack.h"
#include "app/importer/readers/source.h"

#include <vtkImageData.h>

/// A stack of frames as an image of VTK.
namespace tessera::importer {

/// An opened series.
struct DicomVolume {
    std::vector<DicomImage> images;
    std::vector<DicomFrame> frames;
    DicomStack stack;
};

/// Fills a source whose volume is this one: units, scaling, absent numbers, times, `read`.
void openDicomVolume(const std::shared_ptr<const DicomVolume>& volume, Source& source);

/// A segmentation: labels where its segments do not overlap, else a parameter for each.
void openDicomSegments(const std::shared_ptr<const DicomVolume>& volume, const std::vector<std::size_t>& chosen,
                       Source& source);

/// An empty image with the geometry of a stack.
vtkSmartPointer<vtkImageData> imageOfDicom(const DicomStack& stack, const DicomForm& form);

/// The file of a frame; kept open by the caller for the next one.
class DicomFrames {
public:
    explicit DicomFrames(const DicomVolume& volume) : volume_(volume) {}
    std::vector<double> numbers(std::size_t frame);

private:
    const DicomVolume& volume_;
    std::size_t opened_ = kNoFrame;
    std::optional<DicomFile> file_;
};

} // namespace tessera::importer
