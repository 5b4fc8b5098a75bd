#include "app/importer/formats.h"

#include "app/importer/meshes/foam_units.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>
#include <vtkGenericDataObjectReader.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNetCDFCFReader.h>
#include <vtkNew.h>
#include <vtkOpenFOAMReader.h>
#include <vtkStringArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLPStructuredGridReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLPartitionedDataSetCollectionReader.h>
#include <vtkXMLPartitionedDataSetReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtk_netcdf.h>

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

/// The unit that the axes "(time, z, y, x)" state, where those of space agree: of degrees and a height there is none.
std::string unitOfAxes(const std::string& path, std::string axes) {
    int file = 0;
    if (nc_open(path.c_str(), NC_NOWRITE, &file) != NC_NOERR) return {};
    for (char& c : axes)
        if (c == '(' || c == ')' || c == ',') c = ' ';
    std::istringstream names(axes);
    std::vector<std::string> units;
    for (std::string name; names >> name;) { // VTK knows the units of other variables alone
        int variable = 0;
        nc_type type = NC_NAT;
        std::size_t length = 0;
        std::string unit;
        if (nc_inq_varid(file, name.c_str(), &variable) == NC_NOERR &&
            nc_inq_att(file, variable, "units", &type, &length) == NC_NOERR && type == NC_CHAR && length < 1000) {
            unit.resize(length);
            if (nc_get_att_text(file, variable, "units", unit.data()) != NC_NOERR) unit.clear();
            unit.resize(std::min(unit.find('\0'), unit.size()));
        }
        const bool isTime = unit.find(" since ") != std::string::npos || volume::unitConversion(unit, "s");
        if (!isTime) units.push_back(unit);
    }
    nc_close(file);
    return volume::lengthUnitOfAxes(units);
}

/// Reads the variables of those dimensions that most share; others are on other grids.
void openNetCdf(Source& source) {
    checkNetCdf(source.path);
    vtkNew<vtkNetCDFCFReader> reader;
    reader->SetFileName(source.path.c_str());
    reader->SphericalCoordinatesOff();
    reader->ReplaceFillValueWithNanOn();
    reader->UpdateInformation();
    vtkStringArray* dimensions = reader->GetAllDimensions();
    std::string best;
    vtkIdType most = 0;
    for (vtkIdType d = 0; d < dimensions->GetNumberOfValues(); ++d) {
        const std::string name = dimensions->GetValue(d);
        const auto axes = std::count(name.begin(), name.end(), ',') + 1;
        vtkIdType count = axes >= 2 ? axes * 1000 : 0; // prefers three axes to two
        for (vtkIdType v = 0; v < reader->GetVariableDimensions()->GetNumberOfValues(); ++v)
            count += reader->GetVariableDimensions()->GetValue(v) == name ? 1 : 0;
        if (count > most) {
            most = count;
            best = name;
        }
    }
    if (!best.empty()) reader->SetDimensions(best.c_str());
    source.lengthUnit = unitOfAxes(source.path, best);
    source.reader = reader;
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
