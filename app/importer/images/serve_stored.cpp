#include "app/importer/images/serve_stored.h"

#include "app/importer/images/sample_stream.h"
#include "app/importer/readers/check_file.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

using volume::StoredChannel;
using volume::StoredImage;
using volume::StoredType;

/// VTK's type for the samples of an image: integers too long for it are ints if they fit, else doubles.
int vtkTypeOfStored(StoredType type, bool fitsInt) {
    constexpr std::array kTypes = {VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT,
                                   VTK_INT,         VTK_INT,           VTK_INT,   VTK_FLOAT,          VTK_DOUBLE};
    return volume::isLongInteger(type) && !fitsInt ? VTK_DOUBLE : kTypes[std::size_t(type)];
}

template <class T>
void readArrays(const StoredImage& image, const volume::ReadBytes& read, std::size_t frame,
                const std::vector<vtkSmartPointer<vtkDataArray>>& arrays) {
    std::vector<volume::StoredTarget<T>> targets;
    for (std::size_t n = 0; n < arrays.size(); ++n)
        for (int c = 0; c < image.channels[n].components; ++c)
            targets.push_back({image.channels[n].first + std::size_t(c),
                               static_cast<T*>(arrays[n]->GetVoidPointer(0)) + c,
                               std::size_t(image.channels[n].components)});
    volume::readLayers<T>(image, read, {frame, 0, std::size_t(image.grid.size[2])}, targets);
}

void readArrays(const StoredImage& image, const volume::ReadBytes& read, std::size_t frame, int type,
                const std::vector<vtkSmartPointer<vtkDataArray>>& arrays) {
    switch (type) {
    case VTK_SIGNED_CHAR:
        return readArrays<signed char>(image, read, frame, arrays);
    case VTK_UNSIGNED_CHAR:
        return readArrays<std::uint8_t>(image, read, frame, arrays);
    case VTK_SHORT:
        return readArrays<std::int16_t>(image, read, frame, arrays);
    case VTK_UNSIGNED_SHORT:
        return readArrays<std::uint16_t>(image, read, frame, arrays);
    case VTK_INT:
        return readArrays<std::int32_t>(image, read, frame, arrays);
    case VTK_FLOAT:
        return readArrays<float>(image, read, frame, arrays);
    default:
        return readArrays<double>(image, read, frame, arrays);
    }
}

vtkSmartPointer<vtkDataObject> readFrame(const StoredImage& image, const volume::ReadBytes& read, int type,
                                         std::size_t frame) {
    vtkSmartPointer<vtkImageData> out = gridOf(image);
    vtkDataSetAttributes* to = out->GetPointData();
    if (image.cells) to = out->GetCellData();
    std::vector<vtkSmartPointer<vtkDataArray>> arrays;
    for (const StoredChannel& channel : image.channels) {
        arrays.push_back(vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type)));
        arrays.back()->SetName(channel.name.c_str());
        arrays.back()->SetNumberOfComponents(channel.components);
        arrays.back()->SetNumberOfTuples(vtkIdType(image.samples() / image.frames / image.offsets.size()));
        to->AddArray(arrays.back());
    }
    readArrays(image, read, frame, type, arrays);
    return out;
}

} // namespace

vtkSmartPointer<vtkImageData> gridOf(const StoredImage& image) {
    auto out = vtkSmartPointer<vtkImageData>::New();
    glm::dvec3 origin = image.grid.origin;
    const int more = image.cells ? 1 : 0;
    out->SetDimensions(image.grid.size[0] + more, image.grid.size[1] + more, image.grid.size[2] + more);
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(image.grid.steps[axis]);
        const bool usable = std::isfinite(length) && length > 0;
        if (image.cells && usable) origin -= image.grid.steps[axis] * 0.5;
        for (int row = 0; row < 3; ++row)
            out->GetDirectionMatrix()->SetElement(row, axis,
                                                  usable ? image.grid.steps[axis][row] / length : double(row == axis));
        double spacing[3];
        out->GetSpacing(spacing);
        spacing[axis] = usable ? length : 1;
        out->SetSpacing(spacing);
    }
    out->SetOrigin(origin.x, origin.y, origin.z);
    return out;
}

void serveStored(Source& source, StoredImage image) {
    image.files.outside = outsideOfFolders();
    const volume::ReadBytes read = samplesOf(image, source.path);
    const bool isLong = volume::isLongInteger(image.type);
    const bool fits = isLong && volume::fitsInt32(image, read);
    if (isLong && !fits) image.notes.emplace_back("whole numbers beyond 16777216 are rounded to seven digits");
    source.times = image.times;
    source.timeUnit = image.timeUnit;
    source.timeName = image.timeName;
    source.lengthUnit = image.lengthUnit;
    source.notes.insert(source.notes.end(), image.notes.begin(), image.notes.end());
    for (const StoredChannel& channel : image.channels) {
        source.units[channel.name] = image.unit;
        if (image.scale != 1 || image.offset != 0) source.stored[channel.name] = {image.scale, image.offset, {}};
    }
    source.read = [image = std::make_shared<const StoredImage>(std::move(image)), read,
                   type = vtkTypeOfStored(image.type, fits)](std::size_t frame) {
        return readFrame(*image, read, type, frame);
    };
}

} // namespace tessera::importer
