#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>
#include <vtkAlgorithm.h>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

/// Opening a file with the reader its ending asks for (app/importer/formats.h).
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

/// A leaf of a composite data set with the name of its block.
struct Block {
    std::string name;
    vtkSmartPointer<vtkDataSet> data;
};

/// Chooses a reader and reads the header of a file, or of several that are slices of one volume. Throws
/// std::runtime_error with one line of reason.
Source openSource(const std::vector<std::string>& files);

/// Reads everything at one time and gives the non-empty blocks of the highest dimension.
std::vector<Block> readBlocks(const Source& source, int time);

/// Names that VTK's programs give to the time of a file.
inline constexpr std::array<std::string_view, 3> kTimeNames = {"TimeValue", "TIME", "Time"};

/// What was meant by a time: 0.1 for the double of the float32 nearest to 0.1.
double meantTime(double time);

/// Time stated in the field data (TimeValue), appended to `times`.
void findTime(vtkDataObject* data, std::vector<double>& times);

/// Throws what VTK's readers reported since the last call, if anything.
void throwReported();

/// Catches VTK's messages from now on: errors are kept for throwReported, all go to stderr.
void catchMessages();

} // namespace tessera::importer
