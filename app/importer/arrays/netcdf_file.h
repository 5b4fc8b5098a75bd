#pragma once

#include "app/importer/arrays/array_file.h"
#include "app/importer/arrays/conventions.h"

#include <memory>
#include <string>
#include <vector>

/// What libnetcdf says of a file: dimensions, variables and attributes of all groups.
namespace tessera::importer {

struct NetCdfDimension {
    int id = 0;
    std::string path; ///< "x", or "fields/x" in a group
    std::size_t length = 0;
    bool grows = false;
};

struct NetCdfVariable {
    int group = 0, id = 0;
    std::string path;
    int vtkType = VTK_VOID; ///< VTK_CHAR: text; VTK_VOID: no numbers
    std::string kind;       ///< "text", "compound"; "" of numbers
    Dims dims;
    std::vector<int> dimensions; ///< indices of NetCdfFile::dimensions
    Attributes attributes;
    std::vector<double> unwritten; ///< stored number of samples that were never written; empty = none
    std::string words;             ///< of an enumeration, "0 FALSE; 1 TRUE"
};

class NetCdfFile {
public:
    /// Throws if the file is none that libnetcdf reads.
    explicit NetCdfFile(const std::string& path);
    ~NetCdfFile();
    NetCdfFile(const NetCdfFile&) = delete;
    NetCdfFile& operator=(const NetCdfFile&) = delete;

    std::vector<NetCdfDimension> dimensions;
    std::vector<NetCdfVariable> variables;

    vtkSmartPointer<vtkDataArray> read(const NetCdfVariable& variable, const Slab& part) const;
    /// The lines of a variable of text with two dimensions; empty for others, and for very many.
    std::vector<std::string> lines(const NetCdfVariable& variable) const;

private:
    void addGroup(int group, const std::string& path, int depth);
    void addVariable(int group, int id, const std::string& path);
    int file_ = -1;
};

} // namespace tessera::importer
