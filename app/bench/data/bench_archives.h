#pragma once

#include "volume/field/dataset.h"

#include <string>
#include <utility>
#include <vector>

/// What the benchmarks of archives share.
namespace tessera::app {

/// A name for a file, which disappears with the object.
struct BenchFile {
    std::string path;
    explicit BenchFile(const std::string& ending = ".tsr");
    ~BenchFile();
    BenchFile(const BenchFile&) = delete;
    BenchFile& operator=(const BenchFile&) = delete;
};

/// The data sets of $TESSERA_DATA/volumes by the name of their files; empty, and said on stderr, where there are none.
std::vector<std::pair<std::string, volume::Dataset>> volumeFiles();

/// Of those the ones of 8 and 16 bits.
std::vector<std::pair<std::string, volume::Dataset>> thesisVolumes();

} // namespace tessera::app
