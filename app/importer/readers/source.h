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

/// What a reader gives: an opened file.
namespace tessera::importer {

/// An opened file: its header has been read, its samples not.
struct Source {
    std::string path, format;
    std::vector<std::string> files;       ///< slices of one volume, `path` first; else empty
    vtkSmartPointer<vtkAlgorithm> reader; ///< of VTK; null where `read` takes its place
    std::function<vtkSmartPointer<vtkDataObject>(std::size_t time)> read;
    /// Throws where the bytes of a time do not hold what their headers announce; called before they are read.
    std::function<void(const Source& self, std::size_t time)> check;
    std::vector<double> times;                ///< empty: not stated
    std::vector<double> readerTimes;          ///< the same as the reader has them (float32 made double)
    std::map<std::string, std::string> units; ///< stated by the file, by array
    std::string lengthUnit, timeUnit;         ///< stated by the file
    std::string note;                         ///< for the user: how the samples came about
};

/// Names that VTK's programs give to the time of a file.
inline constexpr std::array<std::string_view, 3> kTimeNames = {"TimeValue", "TIME", "Time"};

/// What was meant by a time: 0.1 for the double of the float32 nearest to 0.1.
double meantTime(double time);

/// Time stated in the field data (TimeValue), appended to `times`.
void findTime(vtkDataObject* data, std::vector<double>& times);

} // namespace tessera::importer
