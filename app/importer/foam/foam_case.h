#pragma once

#include "app/importer/foam/foam_mesh.h"

#include <map>
#include <string>
#include <vector>

/// The folders of an OpenFOAM case: times, regions and processors.
namespace tessera::importer {

/// A folder with times and constants: the case itself, or that of a processor.
struct FoamPiece {
    std::string folder;
    int part = -1; ///< of files of all processors (processors4/), -1 = files are this piece's own
    bool operator==(const FoamPiece&) const = default;
};

struct FoamTime {
    double value = 0;
    std::string folder;      ///< its name: "0.1", "1e-05"
    bool processors = false; ///< it is read from the folders of the processors
};

struct FoamCase {
    std::string root;
    std::vector<FoamPiece> processors;
    std::vector<FoamTime> times;      ///< ascending; empty where there are only constants
    std::vector<std::string> regions; ///< with a mesh; "" is the one without a name
    std::vector<std::string> notes;
    bool particles = false;
    /// Times with files of a mesh, by piece's folder and region: value and name, ascending.
    std::map<std::pair<std::string, std::string>, std::vector<std::pair<double, std::string>>> meshTimes;

    /// What is joined at a time (an index of `times`).
    std::vector<FoamPiece> piecesAt(std::size_t time) const;
    /// The folder of a region's fields at a time; "constant" where there is no time.
    std::string fieldFolder(const FoamPiece& piece, const std::string& region, std::size_t time) const;
    /// The files of a region's mesh at a time.
    std::vector<FoamMeshFiles> meshAt(const std::string& region, std::size_t time) const;
    bool hasMeshAt(const std::string& region, std::size_t time) const;
    /// Whether the mesh of a region is the same at all times.
    bool isStill(const std::string& region) const;
};

/// Finds the parts of the case at `path`: its folder, a file in it (case.foam), or system/controlDict. Throws
/// std::runtime_error if it has no mesh.
FoamCase findFoamCase(const std::string& path);

/// Names of files in a folder, without .gz, in alphabetical order.
std::vector<std::string> foamFilesIn(const std::string& folder);

/// How times are counted: steady solvers count iterations, engines degrees.
struct FoamClock {
    std::string unit = "s", name;
};
FoamClock clockOfFoam(const FoamCase& foam);

} // namespace tessera::importer
