#include "app/importer/formats.h"

#include "app/importer/meshes/foam_units.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>
#include <vtkGenericDataObjectReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkOpenFOAMReader.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

template <class XmlReader> void openXml(Source& source) {
    checkXml(source.path);
    vtkNew<XmlReader> reader;
    reader->SetFileName(source.path.c_str());
    source.reader = reader;
}

/// Image files are recognised by content, so that a wrong one is refused with a reason.
template <class ImageReader, void (*check)(const std::string&)> void openImage(Source& source) {
    vtkNew<ImageReader> reader;
    if (reader->CanReadFile(source.path.c_str()) == 0) throw std::runtime_error("is damaged or has another format");
    check(source.path);
    reader->SetFileName(source.path.c_str());
    source.reader = reader;
}

void openFoam(Source& source) {
    vtkNew<vtkOpenFOAMReader> reader;
    const std::string& path = source.path;
    const std::string file = fs::is_directory(path) ? (fs::path(path) / "case.foam").string() : path;
    reader->SetFileName(file.c_str());
    reader->UpdateInformation();
    for (int i = 0; i < reader->GetNumberOfPatchArrays(); ++i) {
        const std::string name = reader->GetPatchArrayName(i);
        reader->SetPatchArrayStatus(name.c_str(), name.ends_with("internalMesh") ? 1 : 0);
    }
    reader->EnableAllCellArrays();
    reader->DisableAllLagrangianArrays();
    reader->CreateCellToPointOff(); // cell values are averaged here, for each block separately
    source.reader = reader;
    source.units = foamUnits(path);
    source.check = [](const Source& self, std::size_t time) {
        checkFoam(self.path, time < self.readerTimes.size() ? self.readerTimes[time] : 0);
    };
}

void openEnSight(Source& source) {
    checkLastLine(readWhole(source.path));
    vtkNew<vtkGenericEnSightReader> reader;
    reader->SetCaseFileName(source.path.c_str());
    reader->ReadAllVariablesOn();
    source.reader = reader;
    source.check = [](const Source& self, std::size_t time) { checkEnSight(self.path, time, self.readerTimes.size()); };
}

void openLegacy(Source& source) {
    vtkNew<vtkGenericDataObjectReader> reader;
    reader->SetFileName(source.path.c_str());
    reader->ReadAllScalarsOn();
    reader->ReadAllVectorsOn();
    reader->ReadAllFieldsOn();
    source.reader = reader;
}

constexpr Reader kReaders[] = {
#define TESSERA_FORMAT(name, suffixes, lengthUnit, slices, ...) Reader{name, __VA_ARGS__},
#define TESSERA_UNREAD(name, suffixes, advice)
#include "volume/import/files/format_rows.inc"
};

} // namespace

std::span<const Reader> readers() {
    return kReaders;
}

} // namespace tessera::importer
