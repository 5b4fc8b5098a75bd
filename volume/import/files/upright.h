#pragma once

#include "volume/field/lattice.h"

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <span>
#include <string>
#include <vector>

/// Stored grids whose axes run in any direction of space, as grids whose axes are those of space.
namespace tessera::volume {

/// A grid as stored: sample (i, j, k) lies at origin + steps * (i, j, k); column a of `steps` is the step along stored
/// axis a, in x, y and z.
struct StoredGrid {
    glm::ivec3 size{1};
    glm::dvec3 origin{0};
    glm::dmat3 steps{1};
};

/// The grid with the axes of space: each axis of space gets the stored axis nearest to it, and axes that run backwards
/// are turned round. Exact where the stored axes are axes of space in any order and sense.
struct UprightGrid {
    Lattice lattice;                  ///< its sample (0, 0, 0) lies where the file says; spacings are lengths of steps
    std::array<int, 3> from{0, 1, 2}; ///< per axis of space: the stored axis
    std::array<bool, 3> turned{};     ///< per axis of space: it runs backwards in the file
    std::string note;                 ///< "" where exact; else how the file's axes really lie

    bool asStored() const { return from == std::array{0, 1, 2} && turned == std::array{false, false, false}; }
    /// Index of the stored sample that is sample (x, y, z) of the lattice.
    std::size_t stored(int x, int y, int z) const;
};

/// Steps of zero length count as 1, and steps that are no numbers, too, along their own axis. Axes within 1e-4 of an
/// axis of space lie on it.
UprightGrid upright(const StoredGrid& grid);

/// Whether one of the notes on a data set is that its axes are oblique in the file, and shown straight.
bool isStraightened(const std::vector<std::string>& notes);

/// Samples of `bytes` bytes each, x fastest, from the stored order to that of the lattice.
std::vector<std::byte> inUprightOrder(std::span<const std::byte> samples, std::size_t bytes, const UprightGrid& grid);

} // namespace tessera::volume
