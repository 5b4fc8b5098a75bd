#pragma once

#include "volume/field/dataset.h"

#include <string>
#include <utility>
#include <vector>

/// Helpers of the archive benchmarks.
namespace tessera::app {

/// A temporary file, removed by the destructor.
struct BenchFile {
    std::string path;
    explicit BenchFile(const std::string& ending = ".tsr");
    ~BenchFile();
    BenchFile(const BenchFile&) = delete;
    BenchFile& operator=(const BenchFile&) = delete;
};

/// The data sets in $TESSERA_DATA/volumes by file name. If there are none, prints so to stderr and returns nothing.
std::vector<std::pair<std::string, volume::Dataset>> volumeFiles();

/// Those data sets with 8-bit or 16-bit samples.
std::vector<std::pair<std::string, volume::Dataset>> thesisVolumes();

} // namespace tessera::app
