// HDF5: VTKHDF and Fluent by their readers, NetCDF by libnetcdf, else the arrays of the file by their paths.
#include "app/importer/arrays/hdf_layouts.h"
#include "app/importer/readers/read_files.h"

#include <algorithm>
#include <stdexcept>

namespace tessera::importer {

void openHdf(Source& source) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const HdfArrays hdf(source.path);
    if (hdf.has("CGNSLibraryVersion")) throw std::runtime_error("is a CGNS file: give it the ending .cgns");
    if (hdf.has("meshes") && hdf.has("settings")) return openFluentHdf(source);
    if (hdf.has("VTKHDF")) return openVtkHdf(source);
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
