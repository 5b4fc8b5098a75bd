#pragma once

#include "volume/import/files/file_block.h"
#include "volume/import/files/series.h"

#include <cstddef>
#include <vector>

/// Which of the files opened follow each other in time, and what they say of each time.
namespace tessera::volume {

/// A file of a series and the blocks a reader found in it.
struct OpenedFile {
    SeriesFile entry;
    std::vector<FileBlock> blocks;
};

/// A block of the files of a group, which need not all have it, nor all of its arrays.
struct GroupBlock {
    FileBlock form;      ///< of the first file that has the block, with the arrays of all
    std::vector<int> at; ///< per file: index of the block in it, -1 where it is not there
    std::vector<std::vector<int>>
        arrays; ///< per array of `form` and file: index of the array, -1 where it is not there
};

/// Files of one group, consecutive in time.
struct FileGroup {
    std::vector<const OpenedFile*> files;
    std::vector<GroupBlock> blocks; ///< of any file
    std::vector<std::string> notes;
    struct Frame {
        std::size_t file;
        int localTime;
    };
    std::vector<double> times; ///< strictly increasing; empty: one frame that is there at all times
    std::vector<Frame> frames; ///< one per time, or the only one
    bool timesAreNumbers = false;
};

/// Files whose entries are of one group follow each other in time, in the order of the files, which must outlive it.
/// But files that no list names, and that share no array, are parameters of one time: they form groups of their own.
/// Throws Error where two of one list have the same time.
std::vector<FileGroup> groupsInTime(const std::vector<OpenedFile>& files);

/// A type that holds an array's numbers in every file of its group.
ScalarType typeInAll(const FileGroup& group, std::size_t block, std::size_t array);

/// Times and quantities that the files of a group, and the list file that names them, state. The first statement is
/// used.
void addQuantities(DatasetInfo& info, const FileGroup& group);

} // namespace tessera::volume
