#pragma once

#include "app/importer/describe_source.h"
#include "app/importer/readers/vtk_messages.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <unistd.h>
#include <vector>

/// What tessera-import does with a file, in the process of a fuzz target.
namespace tessera::importer {

/// A file of this process that goes with it.
struct FuzzedFile {
    std::string path;
    explicit FuzzedFile(const std::string& suffix)
        : path((std::filesystem::temp_directory_path() / ("tessera_fuzz_" + std::to_string(getpid()) + suffix))
                   .string()) {}
    ~FuzzedFile() { std::remove(path.c_str()); }
    FuzzedFile(const FuzzedFile&) = delete;
    FuzzedFile& operator=(const FuzzedFile&) = delete;
};

/// Reads a file or folder, its header and up to three times of it. What is let through must have a value for each point
/// or cell of its grid.
inline void readPath(const std::string& path) {
    static std::once_flag once;
    std::call_once(once, catchMessages);
    try {
        Source source = openSource({path});
        describeImageHeader(source);
        constexpr std::size_t kTimes = 3;
        const std::size_t times = std::max<std::size_t>(1, std::min(kTimes, source.times.size()));
        for (std::size_t time = 0; time < times; ++time) {
            const std::vector<Block> blocks = readBlocks(source, static_cast<int>(time));
            const std::vector<BlockRef> described = describeBlocks(source, blocks);
            headerJson(described);
            for (std::size_t b = 0; b < blocks.size(); ++b)
                for (const ArrayRef& array : described[b].arrays) {
                    vtkDataSet* grid = blocks[b].data;
                    vtkDataArray* values = findArray(grid, array);
                    const vtkIdType wanted = array.ofCells ? grid->GetNumberOfCells() : grid->GetNumberOfPoints();
                    if (values == nullptr || values->GetNumberOfTuples() < wanted) std::abort();
                }
        }
    } catch (const std::exception&) {
    }
}

/// Reads bytes as a file with this suffix.
inline void readAs(const std::uint8_t* data, std::size_t size, const std::string& suffix) {
    const FuzzedFile file(suffix);
    std::ofstream(file.path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    readPath(file.path);
}

} // namespace tessera::importer
