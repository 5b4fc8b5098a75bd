// HDF5: VTKHDF and Fluent by their readers, NetCDF by libnetcdf, else the arrays of the file by their paths.
#include "app/importer/arrays/hdf_layouts.h"
#include "app/importer/arrays/open_arrays.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <stdexcept>

namespace tessera::importer {

void openHdf(Source& source) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    {
        const HdfId file(H5Fopen(source.path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
        const auto has = [&](const char* name) { return file && H5Lexists(file.id(), name, H5P_DEFAULT) > 0; };
        if (has("CGNSLibraryVersion")) throw std::runtime_error("is a CGNS file: give it the ending .cgns");
        if (has("meshes") && has("settings")) return openFluentHdf(source);
        if (has("VTKHDF")) return openVtkHdf(source);
    }
    const HdfArrays hdf(source.path);
    const bool netCdf = std::ranges::any_of(hdf.datasets(), [](const HdfDataset& dataset) {
        return dataset.attributes.contains("_Netcdf4Dimid") || dataset.attributes.contains("_Netcdf4Coordinates");
    });
    if (netCdf || !textOf(hdf.attributesOf(""), "_NCProperties").empty()) {
        openNetCdf(source);
        return;
    }
    ArrayFile file = isOpenPmd(hdf) ? readOpenPmd(hdf, source.notes) : readHdfArrays(hdf);
    std::string lost;
    for (const std::string& link : hdf.lostLinks()) lost += (lost.empty() ? "\"" : ", \"") + link + "\"";
    if (!lost.empty()) source.notes.push_back("left out, since the files that they link to are missing: " + lost);
    if (file.arrays.empty()) throw std::runtime_error("holds no array of numbers");
    openArrays(std::move(file), source);
}

} // namespace tessera::importer
