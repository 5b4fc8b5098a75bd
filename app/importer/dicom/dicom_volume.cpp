#include "app/importer/dicom/dicom_volume.h"

#include "app/importer/dicom/dicom_pixels.h"
#include "app/importer/readers/check_file.h"
#include "volume/import/absent.h"
#include "volume/import/files/upright.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <set>
#include <span>
#include <stdexcept>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkUnsignedCharArray.h>

namespace tessera::importer {

namespace {

/// An array of the volume, and how stored numbers get into it.
struct DicomArray {
    std::string name, unit;
    std::size_t parameter = 0;
    std::size_t component = 0; ///< of a colour
    int type = VTK_FLOAT;
    bool scaled = false; ///< numbers are scaled when they are read, else by `form`
    bool asNaN = false;  ///< absent numbers are NaN, else `form.fill`
    StoredForm form;
};

struct OpenDicom {
    std::shared_ptr<const DicomVolume> volume;
    std::vector<DicomArray> arrays;
};

bool isAbsentPixel(const DicomImage& image, double stored) {
    if (!image.padding) return false;
    const double limit = image.paddingLimit.value_or(*image.padding);
    return stored >= std::min(*image.padding, limit) && stored <= std::max(*image.padding, limit);
}

/// The smallest type that holds all of a range of whole numbers; 0 for none of 16 bits.
int typeFor(double low, double high) {
    if (low >= 0 && high <= 255) return VTK_UNSIGNED_CHAR;
    if (low >= -32768 && high <= 32767) return VTK_SHORT;
    if (low >= 0 && high <= 65535) return VTK_UNSIGNED_SHORT;
    return 0;
}

int storedType(double low, double high, bool real, int bits) {
    if (real) return bits == 64 ? VTK_DOUBLE : VTK_FLOAT;
    if (const int type = typeFor(low, high)) return type;
    return low < 0 || high <= 2147483647.0 ? VTK_INT : VTK_UNSIGNED_INT;
}

/// The unit of scaled numbers: of CT unless another is stated; "" where it is none.
std::string unitOf(const DicomImage& image, const DicomFrame& frame, Source& source) {
    if (!image.doseUnit.empty()) return image.doseUnit == "GY" ? "Gy" : "";
    const std::string &activity = image.activityUnit, &type = frame.rescaleType;
    if (activity == "BQML") return "Bq/ml";
    if (activity == "GML") return "g/ml";
    if (image.modality == "CT") {
        if (frame.rescaled && (type.empty() || type == "HU" || type == "[hnsf'U]")) return "HU";
        if (!frame.rescaled) source.notes.emplace_back("CT without a rescale: its numbers are those stored, not HU");
    }
    if (!frame.rescaled || type.empty() || type == "US" || type == "1" || type == "{counts}") return {};
    if (type == "BQML" || type == "Bq/ml") return "Bq/ml";
    if (type.size() <= 16 && std::ranges::all_of(type, [](char c) { return c > ' ' && c < 127; })) return type;
    return {};
}

/// Whether what turns stored numbers into values is the same for all frames of an array.
struct Sameness {
    bool scaling = true, padding = true, slopes = true, whole = true, real = false, gaps = false;
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    int bits = 0;
    const DicomFrame* first = nullptr;
};

Sameness sameIn(const DicomVolume& volume, std::size_t parameter) {
    Sameness same;
    const DicomStack& stack = volume.stack;
    const std::size_t times = std::max<std::size_t>(1, stack.times.size());
    for (std::size_t t = 0; t < times; ++t)
        for (std::size_t k = 0; k < stack.slices; ++k) {
            const std::size_t f = stack.frameAt(t, parameter, k);
            if (f == kNoFrame) { // absent where another parameter is not
                for (std::size_t p = 0; p < stack.parameters.size(); ++p)
                    same.gaps = same.gaps || stack.frameAt(t, p, k) != kNoFrame;
                continue;
            }
            const DicomFrame& frame = volume.frames[f];
            const DicomImage& image = volume.images[frame.image];
            if (same.first == nullptr) same.first = &frame;
            const DicomImage& firstImage = volume.images[same.first->image];
            same.scaling = same.scaling && frame.slope == same.first->slope && frame.intercept == same.first->intercept;
            same.padding = same.padding && image.padding == firstImage.padding;
            same.whole =
                same.whole && frame.slope == std::floor(frame.slope) && frame.intercept == std::floor(frame.intercept);
            same.real = same.real || image.form.real;
            same.low = std::min(same.low, image.form.lowest());
            same.high = std::max(same.high, image.form.highest());
            same.bits = std::max(same.bits, image.form.bits);
        }
    return same;
}

/// The first file that the stack is made of.
const DicomImage& imageIn(const DicomVolume& volume) {
    const auto used = std::ranges::find_if(volume.stack.frames, [](std::size_t f) { return f != kNoFrame; });
    return volume.images[volume.frames[*used].image];
}

DicomArray arrayOf(const DicomVolume& volume, std::size_t parameter, const std::string& name, Source& source) {
    const Sameness same = sameIn(volume, parameter);
    DicomArray array;
    array.name = name;
    array.parameter = parameter;
    const DicomFrame& frame = *same.first;
    const DicomImage& image = volume.images[frame.image];
    array.unit = image.form.samples > 1 ? "" : unitOf(image, frame, source);
    const double a = frame.slope * same.low + frame.intercept, b = frame.slope * same.high + frame.intercept;
    const int whole = same.whole && same.scaling && !same.real ? typeFor(std::min(a, b), std::max(a, b)) : 0;
    if (!same.scaling || !same.padding || same.gaps || volume::isLabelName(name)) {
        array.scaled = array.asNaN = true;
        array.type = VTK_FLOAT;
        if (!same.scaling)
            source.notes.emplace_back("the rescale differs from slice to slice: each has its own applied");
        return array;
    }
    array.scaled = whole != 0;
    array.type = whole != 0 ? whole : storedType(same.low, same.high, same.real, same.bits);
    if (!array.scaled) {
        array.form.scale = frame.slope;
        array.form.offset = frame.intercept;
    }
    if (image.padding && image.form.samples == 1)
        array.form.fill = {array.scaled ? frame.intercept + frame.slope * *image.padding : *image.padding};
    return array;
}

template <class T>
void writeSlice(const DicomArray& array, const DicomImage& image, const DicomFrame& frame,
                const std::vector<double>& numbers, T* to) {
    const std::size_t samples = std::size_t(image.form.samples), count = image.form.pixels();
    const double slope = array.scaled ? frame.slope : 1, intercept = array.scaled ? frame.intercept : 0;
    const double absent = array.asNaN               ? std::numeric_limits<double>::quiet_NaN()
                          : array.form.fill.empty() ? 0
                                                    : array.form.fill.front();
    const bool pads = samples == 1 && image.padding.has_value();
    for (std::size_t i = 0; i < count; ++i) {
        const double stored = numbers[i * samples + array.component];
        to[i] = static_cast<T>(pads && isAbsentPixel(image, stored) ? absent : intercept + slope * stored);
    }
}

vtkSmartPointer<vtkDataArray> newArray(const DicomArray& array, vtkIdType count) {
    auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array.type));
    out->SetName(array.name.c_str());
    out->SetNumberOfTuples(count);
    return out;
}

void putSlice(const DicomArray& array, const DicomImage& image, const DicomFrame& frame,
              const std::vector<double>& numbers, std::size_t slice, vtkDataArray* to) {
    const std::size_t begin = slice * image.form.pixels();
    const auto put = [&]<class T>(T*) {
        writeSlice(array, image, frame, numbers, static_cast<T*>(to->GetVoidPointer(0)) + begin);
    };
    switch (array.type) {
    case VTK_UNSIGNED_CHAR:
        return put(static_cast<unsigned char*>(nullptr));
    case VTK_SHORT:
        return put(static_cast<short*>(nullptr));
    case VTK_UNSIGNED_SHORT:
        return put(static_cast<unsigned short*>(nullptr));
    case VTK_INT:
        return put(static_cast<int*>(nullptr));
    case VTK_UNSIGNED_INT:
        return put(static_cast<unsigned*>(nullptr));
    case VTK_DOUBLE:
        return put(static_cast<double*>(nullptr));
    default:
        return put(static_cast<float*>(nullptr));
    }
}

/// The same samples with the uneven places of the slices, where the axes are those of space; else the image.
vtkSmartPointer<vtkDataObject> atUnevenPlaces(vtkSmartPointer<vtkImageData> image, const DicomStack& stack) {
    volume::StoredGrid grid;
    int size[3];
    image->GetDimensions(size);
    grid.size = {size[0], size[1], size[2]};
    grid.origin = stack.corner;
    grid.steps = glm::dmat3(stack.columnStep, stack.rowStep, stack.sliceStep);
    const volume::UprightGrid turned = volume::upright(grid);
    if (!turned.note.empty()) return image;
    vtkNew<vtkRectilinearGrid> out;
    out->SetDimensions(turned.lattice.size.x, turned.lattice.size.y, turned.lattice.size.z);
    for (int axis = 0; axis < 3; ++axis) {
        vtkNew<vtkDoubleArray> places;
        const bool slices = turned.from[std::size_t(axis)] == 2, back = turned.turned[std::size_t(axis)];
        for (int i = 0; i < turned.lattice.size[axis]; ++i) {
            double place = turned.lattice.origin[axis] + turned.lattice.spacing[axis] * i;
            if (slices && back)
                place = stack.corner[axis] - (stack.uneven[stack.slices - 1 - std::size_t(i)] - stack.uneven[0]);
            if (slices && !back) place = stack.corner[axis] + stack.uneven[std::size_t(i)] - stack.uneven[0];
            places->InsertNextValue(place);
        }
        if (axis == 0) out->SetXCoordinates(places);
        if (axis == 1) out->SetYCoordinates(places);
        if (axis == 2) out->SetZCoordinates(places);
    }
    for (int i = 0; i < image->GetPointData()->GetNumberOfArrays(); ++i) {
        vtkDataArray* from = image->GetPointData()->GetArray(i);
        const auto bytes = std::size_t(from->GetDataTypeSize()), count = std::size_t(from->GetNumberOfTuples());
        const auto ordered = volume::inUprightOrder(
            {static_cast<const std::byte*>(from->GetVoidPointer(0)), bytes * count}, bytes, turned);
        auto to = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(from->GetDataType()));
        to->SetName(from->GetName());
        to->SetNumberOfTuples(from->GetNumberOfTuples());
        std::memcpy(to->GetVoidPointer(0), ordered.data(), ordered.size());
        out->GetPointData()->AddArray(to);
    }
    return vtkSmartPointer<vtkDataObject>(out);
}

vtkSmartPointer<vtkDataObject> readDicomTime(const OpenDicom& open, std::size_t time) {
    const DicomVolume& volume = *open.volume;
    const DicomStack& stack = volume.stack;
    const DicomForm& form = imageIn(volume).form;
    vtkSmartPointer<vtkImageData> image = imageOfDicom(stack, form);
    std::vector<vtkSmartPointer<vtkDataArray>> arrays;
    for (const DicomArray& array : open.arrays) arrays.push_back(newArray(array, image->GetNumberOfPoints()));
    std::vector<bool> present(stack.slices);
    DicomFrames reader(volume);
    for (std::size_t k = 0; k < stack.slices; ++k)
        for (std::size_t p = 0; p < stack.parameters.size(); ++p) {
            const std::size_t f = stack.frameAt(time, p, k);
            std::vector<double> numbers;
            if (f != kNoFrame) numbers = reader.numbers(f);
            for (std::size_t a = 0; a < open.arrays.size(); ++a) {
                if (open.arrays[a].parameter != p) continue;
                if (f != kNoFrame) {
                    const DicomFrame& frame = volume.frames[f];
                    putSlice(open.arrays[a], volume.images[frame.image], frame, numbers, k, arrays[a]);
                    present[k] = true;
                    continue;
                }
                const double nothing = open.arrays[a].asNaN ? std::numeric_limits<double>::quiet_NaN() : 0;
                const auto pixels = vtkIdType(form.pixels());
                for (vtkIdType i = 0; i < pixels; ++i) arrays[a]->SetComponent(vtkIdType(k) * pixels + i, 0, nothing);
            }
        }
    for (const auto& array : arrays) image->GetPointData()->AddArray(array);
    if (std::ranges::find(present, false) != present.end()) {
        vtkNew<vtkUnsignedCharArray> valid;
        valid->SetName("vtkValidPointMask");
        valid->SetNumberOfTuples(image->GetNumberOfPoints());
        for (std::size_t k = 0; k < stack.slices; ++k)
            std::fill_n(valid->GetPointer(vtkIdType(k * form.pixels())), form.pixels(),
                        static_cast<unsigned char>(present[k] ? 1 : 0));
        image->GetPointData()->AddArray(valid);
    }
    return stack.uneven.empty() ? vtkSmartPointer<vtkDataObject>(image) : atUnevenPlaces(image, stack);
}

} // namespace

std::vector<double> DicomFrames::numbers(std::size_t frame) {
    const DicomFrame& one = volume_.frames[frame];
    const DicomImage& image = volume_.images[one.image];
    try {
        if (opened_ != one.image) {
            file_.emplace(image.path);
            opened_ = one.image;
            if (dicomForm(*file_) != image.form) throw std::runtime_error("has changed since it was opened");
        }
        return dicomNumbers(*file_, image.form, one.index);
    } catch (const std::runtime_error& error) {
        opened_ = kNoFrame;
        if (volume_.images.size() == 1) throw;
        throw std::runtime_error("its slice " + std::filesystem::path(image.path).filename().string() + " " +
                                 error.what());
    }
}

vtkSmartPointer<vtkImageData> imageOfDicom(const DicomStack& stack, const DicomForm& form) {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(form.columns, form.rows, int(stack.slices));
    image->SetOrigin(stack.corner.x, stack.corner.y, stack.corner.z);
    const glm::dvec3 steps[3] = {stack.columnStep, stack.rowStep, stack.sliceStep};
    image->SetSpacing(glm::length(steps[0]), glm::length(steps[1]), glm::length(steps[2]));
    for (int axis = 0; axis < 3; ++axis)
        for (int row = 0; row < 3; ++row)
            image->GetDirectionMatrix()->SetElement(row, axis, steps[axis][row] / glm::length(steps[axis]));
    return image;
}

void openDicomVolume(const std::shared_ptr<const DicomVolume>& volume, Source& source) {
    const DicomStack& stack = volume->stack;
    auto open = std::make_shared<OpenDicom>();
    open->volume = volume;
    static constexpr const char* kColours[] = {"red", "green", "blue"};
    double bytes = 0, stored = 0;
    for (std::size_t p = 0; p < stack.parameters.size(); ++p) {
        std::string name = stack.parameters[p];
        const DicomImage& image = imageIn(*volume);
        if (name.empty()) name = image.doseUnit.empty() ? "value" : "dose";
        DicomArray array = arrayOf(*volume, p, name, source);
        for (std::size_t c = 0; c < std::size_t(image.form.samples); ++c) {
            array.component = c;
            if (image.form.samples > 1)
                array.name = (stack.parameters.size() > 1 ? name + " " : std::string()) + kColours[c % 3];
            open->arrays.push_back(array);
            bytes += 8.0 * double(image.form.pixels()) * double(stack.slices);
        }
    }
    for (const DicomImage& image : volume->images) stored += double(bytesIn(image.path));
    refuseHollow(bytes, stored);
    for (const DicomArray& array : open->arrays) {
        if (!array.unit.empty()) source.units[array.name] = array.unit;
        if (array.form != StoredForm{}) source.stored[array.name] = array.form;
    }
    std::set<std::string> told; // parameters may have the same to say
    std::erase_if(source.notes, [&](const std::string& note) { return !told.insert(note).second; });
    if (stack.inMillimetres) source.lengthUnit = "mm";
    source.times = stack.times;
    source.timeUnit = stack.timeUnit;
    source.timeName = stack.timeName;
    source.read = [open](std::size_t time) { return readDicomTime(*open, time); };
}

} // namespace tessera::importer
