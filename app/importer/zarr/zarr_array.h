#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>
#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

/// One array of Zarr version 2: a folder with a file .zarray and one file for each chunk.
/// "Zarr storage specification version 2", zarr.readthedocs.io.
namespace tessera::importer {

struct ZarrArray {
    std::string folder;
    std::vector<std::size_t> shape, chunks; ///< by axis, slowest first
    char kind = 'f';                        ///< of the numbers: 'b' truth, 'i', 'u', 'f'
    std::size_t bytes = 4;                  ///< of one number
    bool bigEndian = false, columnsFirst = false;
    std::string compressor; ///< "" = none
    std::optional<double> fill;
    std::size_t shuffled = 0; ///< bytes of the elements of a shuffle filter; 0 = no filter
    char separator = '.';
    double stored = 0;     ///< bytes of the files of all chunks
    std::size_t files = 0; ///< their number

    int vtkType() const; ///< of what readZarr gives
    double statedBytes() const;
};

/// Text of a file of JSON below a folder, parsed; empty (an object) where there is none. Throws if it is no JSON.
nlohmann::json zarrJson(const std::string& folder, const std::string& file);

/// Reads .zarray. Throws with a reason where the array is not one of numbers, or not readable.
ZarrArray openZarrArray(const std::string& folder);

/// The numbers at [begin, begin + count) by axis, slowest first, one component.
vtkSmartPointer<vtkDataArray> readZarr(const ZarrArray& array, const std::vector<std::size_t>& begin,
                                       const std::vector<std::size_t>& count);

} // namespace tessera::importer
