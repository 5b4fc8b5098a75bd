// Mesh formats read by VTK, with their solution files.
#include "app/importer/meshes/cgns_units.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vtkCGNSReader.h>
#include <vtkDataArraySelection.h>
#include <vtkExodusIIReader.h>
#include <vtkNew.h>
#include <vtk_netcdf.h>

namespace tessera::importer {

namespace {

/// VTK's reader takes all numbers for as long as the file states of them once, and looks for values at points where the
/// header says that they are: where that is wrong it shows memory that nobody wrote, without an error.
void checkExodusForm(const std::string& path) {
    int file = 0, stated = 0, byVariable = 0, variables = 0;
    if (nc_open(path.c_str(), NC_NOWRITE, &file) != NC_NOERR) return;
    const bool states = nc_get_att_int(file, NC_GLOBAL, "floating_point_word_size", &stated) == NC_NOERR;
    if (nc_get_att_int(file, NC_GLOBAL, "file_size", &byVariable) != NC_NOERR) byVariable = 0;
    std::string otherSize, otherPlace;
    for (int v = 0; nc_inq_nvars(file, &variables) == NC_NOERR && v < variables; ++v) {
        char text[NC_MAX_NAME + 1] = {};
        nc_type type = NC_NAT;
        if (nc_inq_varname(file, v, text) != NC_NOERR || nc_inq_vartype(file, v, &type) != NC_NOERR) continue;
        const std::string_view name = text;
        const int bytes = type == NC_FLOAT ? 4 : type == NC_DOUBLE ? 8 : stated;
        if (states && bytes != stated && name.starts_with("vals_")) otherSize = name;
        constexpr std::string_view kAtPoints = "vals_nod_var"; // one variable for each array, or one for all
        if (name.starts_with(kAtPoints) && (name.size() > kAtPoints.size()) != (byVariable != 0)) otherPlace = name;
    }
    nc_close(file);
    if (!otherPlace.empty())
        throw std::runtime_error("mixes the two forms of Exodus (" + otherPlace +
                                 "), as meshio writes it, which is not read: write it as VTK (.vtu)");
    if (!otherSize.empty())
        throw std::runtime_error("states numbers of " + std::to_string(stated) + " bytes, but those of " + otherSize +
                                 " have another size: write all numbers in 64 bits");
}

} // namespace

void openCgns(Source& source) {
    vtkNew<vtkCGNSReader> reader;
    if (reader->CanReadFile(source.path.c_str()) == 0)
        throw std::runtime_error("is truncated, damaged or not a CGNS file");
    reader->SetFileName(source.path.c_str());
    reader->UpdateInformation();
    reader->GetBaseSelection()->EnableAllArrays();
    reader->EnableAllPointArrays();
    reader->EnableAllCellArrays();
    source.reader = reader;
    CgnsUnits units = cgnsUnits(source.path);
    source.lengthUnit = std::move(units.length);
    source.units = std::move(units.arrays);
}

void openExodus(Source& source) {
    checkNetCdf(source.path);
    checkExodusForm(source.path);
    vtkNew<vtkExodusIIReader> reader;
    if (reader->CanReadFile(source.path.c_str()) == 0)
        throw std::runtime_error("is truncated, damaged or not an Exodus file");
    reader->SetFileName(source.path.c_str());
    reader->UpdateInformation();
    reader->SetAllArrayStatus(vtkExodusIIReader::NODAL, 1);
    reader->SetAllArrayStatus(vtkExodusIIReader::ELEM_BLOCK, 1);
    std::string left;
    for (int i = 0; i < reader->GetNumberOfGlobalResultArrays(); ++i)
        left += (left.empty() ? "" : ", ") + std::string(reader->GetGlobalResultArrayName(i));
    if (!left.empty()) source.notes.push_back("variables of the whole mesh are left out: " + left);
    reader->GenerateObjectIdCellArrayOff();
    reader->ApplyDisplacementsOff();
    source.reader = reader;
}

} // namespace tessera::importer
