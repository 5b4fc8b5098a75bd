// NRRD by VTK's reader, except for samples stored as text: VTK does not read those in the same file as the header, and
// leaves the memory uninitialised.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "app/importer/readers/vtk_messages.h"
#include "volume/import/files/nrrd.h"

#include <cctype>
#include <charconv>
#include <stdexcept>
#include <string_view>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkPointData.h>

namespace tessera::importer {

namespace {

/// Removes the next number from a text and returns it.
double takeNumber(std::string_view& text) {
    const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    std::size_t length = 0;
    while (length < text.size() && !blank(text[length])) ++length;
    const std::string_view whole = text.substr(0, length);
    text.remove_prefix(length);
    const std::string_view word = whole.starts_with('+') ? whole.substr(1) : whole;
    double value = 0;
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty()) throw std::runtime_error("holds fewer samples than it announces");
    if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size())
        throw std::runtime_error("has \"" + std::string(whole.substr(0, 40)) + "\" where a number belongs");
    return value;
}

} // namespace

void openNrrd(Source& source) {
    vtkNew<vtkNrrdReader> reader;
    if (reader->CanReadFile(source.path.c_str()) == 0) throw std::runtime_error("is damaged or has another format");
    checkNrrd(source.path);
    reader->SetFileName(source.path.c_str());
    constexpr std::size_t kHead = 1 << 20;
    const std::string head = readPart(source.path, 0, kHead);
    source.lengthUnit = volume::lengthUnitOfNrrd(head);
    if (!textOfNrrd(source.path)) {
        source.reader = reader;
        return;
    }
    reader->UpdateInformation();
    throwReported();
    vtkNew<vtkImageData> form;
    form->SetExtent(reader->GetDataExtent());
    form->SetSpacing(reader->GetDataSpacing());
    form->SetOrigin(reader->GetDataOrigin());
    std::string name = "value";
    int components = reader->GetNumberOfScalarComponents();
    // VTK takes a first axis of up to nine samples as components; the header states which axes are spatial.
    if (const auto scalar = volume::parseNrrd(head, {}, volume::NrrdEncoding::Text)) {
        const volume::Lattice& lattice = scalar->lattice;
        form->SetDimensions(lattice.size.x, lattice.size.y, lattice.size.z);
        form->SetSpacing(lattice.spacing.x, lattice.spacing.y, lattice.spacing.z);
        form->SetOrigin(lattice.origin.x, lattice.origin.y, lattice.origin.z);
        name = scalar->components[0].name;
        components = 1;
        source.units[name] = scalar->components[0].unit;
        source.times = scalar->times;
    }
    source.read = [path = source.path, form = vtkSmartPointer<vtkImageData>(form), type = reader->GetDataScalarType(),
                   name, components](std::size_t) {
        checkNrrd(path);
        const std::string all = textOfNrrd(path).value_or("");
        vtkNew<vtkImageData> image;
        image->CopyStructure(form);
        auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
        array->SetName(name.c_str());
        array->SetNumberOfComponents(components);
        array->SetNumberOfTuples(image->GetNumberOfPoints());
        std::string_view rest = all;
        for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
            for (int c = 0; c < components; ++c) array->SetComponent(i, c, takeNumber(rest));
        image->GetPointData()->SetScalars(array);
        return vtkSmartPointer<vtkDataObject>(image);
    };
}

} // namespace tessera::importer
