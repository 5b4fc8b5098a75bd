// Segmentations (PS3.3, A.51): each frame is one segment in one slice; what is in no frame is outside of it.
#include "app/importer/dicom/dicom_volume.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <stdexcept>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedShortArray.h>

namespace tessera::importer {

namespace {

struct DicomSegments {
    std::shared_ptr<const DicomVolume> volume;
    std::map<int, std::vector<std::pair<std::size_t, std::size_t>>> frames; ///< of each segment: frame, slice
    std::map<int, std::string> names;
    bool labels = true;
};

/// The label at each sample; false where two segments overlap.
bool fillLabels(const DicomSegments& open, std::vector<unsigned short>& labels) {
    DicomFrames reader(*open.volume);
    for (const auto& [segment, frames] : open.frames)
        for (const auto& [frame, slice] : frames) {
            const std::vector<double> numbers = reader.numbers(frame);
            for (std::size_t i = 0; i < numbers.size(); ++i) {
                if (numbers[i] == 0) continue;
                unsigned short& to = labels[slice * numbers.size() + i];
                if (to != 0 && to != segment) return false;
                to = static_cast<unsigned short>(segment);
            }
        }
    return true;
}

std::string plainName(std::string name, int segment) {
    std::erase(name, ';');
    return name.empty() ? "segment " + std::to_string(segment) : name;
}

vtkSmartPointer<vtkDataObject> readSegments(const DicomSegments& open) {
    const DicomVolume& volume = *open.volume;
    const DicomForm& form = volume.images[volume.frames[open.frames.begin()->second.front().first].image].form;
    vtkSmartPointer<vtkImageData> image = imageOfDicom(volume.stack, form);
    const auto count = std::size_t(image->GetNumberOfPoints());
    if (open.labels) {
        std::vector<unsigned short> labels(count);
        fillLabels(open, labels);
        vtkNew<vtkUnsignedShortArray> array;
        array->SetName("segment");
        array->SetNumberOfTuples(vtkIdType(count));
        std::ranges::copy(labels, array->GetPointer(0));
        image->GetPointData()->AddArray(array);
        std::string words;
        for (const auto& [segment, name] : open.names)
            words +=
                (words.empty() ? "" : "; ") + ("segment " + std::to_string(segment) + " ") + plainName(name, segment);
        vtkNew<vtkStringArray> field;
        field->SetName("labels");
        field->InsertNextValue(words);
        image->GetFieldData()->AddArray(field);
        return image;
    }
    DicomFrames reader(volume);
    for (const auto& [segment, frames] : open.frames) {
        vtkNew<vtkUnsignedCharArray> array;
        array->SetName(open.names.at(segment).c_str());
        array->SetNumberOfTuples(vtkIdType(count));
        array->FillValue(0);
        for (const auto& [frame, slice] : frames) {
            const std::vector<double> numbers = reader.numbers(frame);
            unsigned char* to = array->GetPointer(vtkIdType(slice * numbers.size()));
            for (std::size_t i = 0; i < numbers.size(); ++i) to[i] = static_cast<unsigned char>(numbers[i]);
        }
        image->GetPointData()->AddArray(array);
    }
    return image;
}

} // namespace

void openDicomSegments(const std::shared_ptr<const DicomVolume>& volume, const std::vector<std::size_t>& chosen,
                       Source& source) {
    const DicomStack& stack = volume->stack;
    const DicomImage& image = volume->images[volume->frames[chosen.front()].image];
    auto open = std::make_shared<DicomSegments>();
    open->volume = volume;
    for (const std::size_t f : chosen) {
        const DicomFrame& frame = volume->frames[f];
        const double length = glm::length(stack.sliceStep);
        const double along =
            frame.corner ? glm::dot(*frame.corner - stack.corner, stack.sliceStep) / (length * length) : 0;
        const auto slice = std::size_t(std::clamp(std::round(along), 0.0, double(stack.slices - 1)));
        open->frames[frame.segment].emplace_back(f, slice);
    }
    std::map<std::string, int> seen;
    for (const auto& [segment, frames] : open->frames) {
        if (segment < 0 || segment > 65535) throw std::runtime_error("numbers its segments beyond 65535");
        const auto named = image.segments.find(segment);
        std::string name = plainName(named == image.segments.end() ? "" : named->second, segment);
        if (const int before = seen[name]++; before > 0) name += " " + std::to_string(segment);
        open->names[segment] = name;
    }
    if (image.segmentation == "FRACTIONAL") {
        open->labels = false;
        for (const auto& [segment, name] : open->names) source.stored[name] = {1 / image.mostFraction, 0, {}};
        source.notes.emplace_back("a segmentation by fractions: each segment is a parameter from 0 to 1");
    } else {
        std::vector<unsigned short> labels(image.form.pixels() * stack.slices);
        open->labels = fillLabels(*open, labels);
        if (!open->labels) source.notes.emplace_back("segments overlap: each is a parameter, 1 inside and 0 outside");
    }
    if (stack.inMillimetres) source.lengthUnit = "mm";
    source.read = [open](std::size_t) -> vtkSmartPointer<vtkDataObject> { return readSegments(*open); };
}

} // namespace tessera::importer
