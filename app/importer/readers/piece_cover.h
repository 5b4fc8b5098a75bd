#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Which samples of a grid in VTK's XML files lie in no piece. VTK's readers give what happens to lie in memory there.
namespace tessera::importer {

/// Indices of points, first and last of x, y and z.
using PointExtent = std::array<int, 6>;

struct GridPieces {
    PointExtent whole{};
    std::vector<PointExtent> parts;
    std::vector<std::string> sources; ///< the files of the parts, of a file that lists them; else empty
};

/// The pieces of a .vti, .vtr or .vts file, or of a list of such (.pvti and the like); nothing of other kinds. Throws
/// std::runtime_error for extents that are none.
std::optional<GridPieces> piecesOf(const std::string& path);

/// Per point of the whole grid, or per cell, 1 if a piece holds it; x fastest. Empty if all are held. Throws
/// std::runtime_error for a grid of more than 2^40 points.
std::vector<std::uint8_t> heldBy(const GridPieces& pieces, bool cells);

/// How many points, or cells, no piece holds.
std::size_t missingIn(const GridPieces& pieces, bool cells);

} // namespace tessera::importer
