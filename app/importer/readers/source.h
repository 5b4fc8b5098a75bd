#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>
#include <vtkAlgorithm.h>
#include <vtkDataObject.h>
#include <vtkSmartPointer.h>

/// The result of a reader: an opened file.
namespace tessera::importer {

/// An opened file, of which only the header has been read.
struct Source {
    std::string path, format;
    std::vector<std::string> files;       ///< slices of one volume, `path` first; else empty
    vtkSmartPointer<vtkAlgorithm> reader; ///< VTK's reader; null if `read` is set instead
    std::function<vtkSmartPointer<vtkDataObject>(std::size_t time)> read;
    /// Throws if the files of a time are shorter than their headers state; called before they are read.
    std::function<void(const Source& self, std::size_t time)> check;
    std::vector<double> times;                ///< empty: not stated
    std::vector<double> readerTimes;          ///< the same, as VTK's reader has them (float32 converted to double)
    std::map<std::string, std::string> units; ///< stated by the file, by array
    std::string lengthUnit, timeUnit;         ///< stated by the file
    std::string note;                         ///< for the user: how the samples were obtained
};

/// Names of time values in VTK files.
inline constexpr std::array<std::string_view, 3> kTimeNames = {"TimeValue", "TIME", "Time"};

/// Undoes float32 rounding of a time: 0.1 for the double of the float32 nearest to 0.1.
double meantTime(double time);

/// The unit of lengths in the header of an image (MetaImage, NIfTI) whose reader has read it; "" for other files and
/// where none is stated.
std::string lengthUnitInHeader(const Source& source);

/// Time stated in the field data (TimeValue), appended to `times`.
void findTime(vtkDataObject* data, std::vector<double>& times);

} // namespace tessera::importer
