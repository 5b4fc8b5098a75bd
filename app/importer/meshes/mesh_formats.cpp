// Mesh formats read by VTK, with their solution files.
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <hdf5.h>
#include <stdexcept>
#include <string>
#include <vtkCGNSReader.h>
#include <vtkDataArraySelection.h>
#include <vtkExodusIIReader.h>
#include <vtkNew.h>

namespace tessera::importer {

namespace {

/// The length of a node DimensionalUnits_t below the first base that has one: five words of 32 letters, mass and length
/// first. Files in HDF5 only, as all of CGNS 3 and later are by default.
std::string lengthUnitOfCgns(const std::string& path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return {};
    std::string unit;
    const auto read = [](hid_t root, const char* name, const H5O_info_t* info, void* to) -> herr_t {
        const std::string place = name;
        if (info->type != H5O_TYPE_DATASET || !place.ends_with("/ data")) return 0;
        const std::string group = place.substr(0, place.size() - 6);
        if (std::ranges::count(group, '/') != 1 || group.substr(group.find('/') + 1) != "DimensionalUnits") return 0;
        const hid_t dataset = H5Dopen2(root, name, H5P_DEFAULT);
        std::array<char, 160> words{};
        if (H5Dget_storage_size(dataset) == words.size() &&
            H5Dread(dataset, H5T_NATIVE_CHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, words.data()) >= 0) {
            std::string length(words.data() + 32, 32);
            length.erase(length.find_last_not_of(std::string(" \0", 2)) + 1);
            *static_cast<std::string*>(to) = volume::lengthUnitNamed(length);
        }
        H5Dclose(dataset);
        return 1; // found
    };
#if H5_VERSION_GE(1, 12, 0) // takes the fields to query as a further argument
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, read, &unit, H5O_INFO_BASIC);
#else
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, read, &unit);
#endif
    H5Fclose(file);
    return unit;
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
    source.lengthUnit = lengthUnitOfCgns(source.path);
}

void openExodus(Source& source) {
    checkNetCdf(source.path);
    vtkNew<vtkExodusIIReader> reader;
    if (reader->CanReadFile(source.path.c_str()) == 0)
        throw std::runtime_error("is truncated, damaged or not an Exodus file");
    reader->SetFileName(source.path.c_str());
    reader->UpdateInformation();
    reader->SetAllArrayStatus(vtkExodusIIReader::NODAL, 1);
    reader->SetAllArrayStatus(vtkExodusIIReader::ELEM_BLOCK, 1);
    reader->GenerateObjectIdCellArrayOff();
    reader->ApplyDisplacementsOff();
    source.reader = reader;
}

} // namespace tessera::importer
