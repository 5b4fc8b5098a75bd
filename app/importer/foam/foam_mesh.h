#pragma once

#include "app/importer/foam/foam_file.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Meshes of OpenFOAM: points, faces, and the cell on each side of a face.
namespace tessera::importer {

/// The files of a polyMesh at one time, of one processor.
struct FoamMeshFiles {
    FoamPlace points, faces, owner, neighbour, boundary, cellZones;
    bool operator==(const FoamMeshFiles&) const = default;
};

struct FoamMesh {
    std::vector<double> points;            ///< three for each
    std::vector<std::size_t> faceBegin{0}; ///< where the points of a face begin; one more at the end
    std::vector<std::int32_t> facePoints;  ///< those of the first face, of the second, ...
    std::vector<std::int32_t> owner;       ///< per face: the cell that its points turn round as seen from outside
    std::vector<std::int32_t> neighbour;   ///< per face: the cell on the other side, -1 at the boundary
    std::size_t cells = 0;
    std::vector<std::int32_t> zone; ///< per cell: 1 + its zone, 0 = none; empty without zones
    std::vector<std::string> zones; ///< their names

    std::size_t pointCount() const { return points.size() / 3; }
    std::size_t faceCount() const { return owner.size(); }
};

/// The mesh of one or more processors, joined where their boundaries meet. Cells and points follow each other in the
/// order of the processors; `pieces` gets the numbers of cells and points of each, before it was joined, and
/// `pointOf` the joined point of each of theirs (empty for a single piece). Throws std::runtime_error naming the file.
FoamMesh readFoamMesh(const std::vector<FoamMeshFiles>& pieces, std::vector<std::array<std::size_t, 2>>& sizes,
                      std::vector<std::int32_t>& pointOf);

/// The box of the points of a mesh: lowest x, y, z, highest x, y, z; lowest > highest without points.
std::array<double, 6> boxOfFoamPoints(const std::vector<FoamMeshFiles>& pieces);

} // namespace tessera::importer
