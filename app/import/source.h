#pragma once

#include <string>
#include <vector>
#include <vtkAlgorithm.h>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

/// Opening a file with the VTK reader its ending asks for.
namespace tessera::importer {

/// An opened file: its header has been read, its samples not.
struct Source {
    std::string path, format;
    vtkSmartPointer<vtkAlgorithm> reader;
    std::vector<double> times;       ///< empty: not stated
    std::vector<double> readerTimes; ///< the same as the reader has them (float32 made double)
};

/// A leaf of a composite data set with the name of its block.
struct Block {
    std::string name;
    vtkSmartPointer<vtkDataSet> data;
};

/// Chooses a reader and reads the header. Throws std::runtime_error with one line of reason.
Source openSource(const std::string& path);

/// Reads everything at one time and gives the non-empty blocks of the highest dimension.
std::vector<Block> readBlocks(const Source& source, int time);

/// What was meant by a time: 0.1 for the double of the float32 nearest to 0.1.
double meantTime(double time);

/// Time stated in the field data (TimeValue), appended to `times`.
void findTime(vtkDataObject* data, std::vector<double>& times);

/// Throws what VTK's readers reported since the last call, if anything.
void throwReported();

/// Catches VTK's messages from now on: errors are kept for throwReported, all go to stderr.
void catchMessages();

} // namespace tessera::importer
