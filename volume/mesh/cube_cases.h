#pragma once

#include <array>
#include <cstdint>
#include <vector>

/// The cases of marching cubes, made by following the surface's outline over the six faces of a cell.
///
/// Corner i lies at (i & 1, i >> 1 & 1, i >> 2). Edge 4 a + k runs along axis a from the corner whose other two
/// coordinates (rising axes) are the bits of k. Face 2 a + s lies across axis a at coordinate s.
namespace tessera::volume {

inline constexpr int kFirstCentre = 12; ///< numbers from here on are centres of outlines

struct CubeCase {
    /// Corners of triangles, counter-clockwise seen from the side of the corners that are not inside: edges 0..11, or
    /// kFirstCentre + c.
    std::vector<std::array<std::uint8_t, 3>> triangles;
    /// Outlines that no triangles without a diagonal on a face can fill: their centre is a vertex of its own, the mean
    /// of these edges' vertices.
    std::vector<std::vector<std::uint8_t>> centres;
};

/// First corner of an edge, and the axis it runs along.
constexpr int edgeCorner(int edge) {
    const int axis = edge / 4, k = edge % 4;
    return axis == 0 ? k << 1 : axis == 1 ? (k & 1) | (k & 2) << 1 : k;
}
/// Corners of a face, counter-clockwise seen from outside of the cell.
std::array<int, 4> faceCorners(int face);

/// Faces on which the inside corners lie across: the two corners are joined there, or the two others are.
std::uint8_t ambiguousFaces(int inside);

/// The case of a set of inside corners (bits) where the inside corners of the ambiguous faces in `joined` (bits) are
/// joined. Tables are made once.
const CubeCase& cubeCase(int inside, std::uint8_t joined);

} // namespace tessera::volume
