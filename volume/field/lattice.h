#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>

/// Where samples lie in space.
///
/// CC is the usual grid. BCC is two CC grids ("sublattices"), the second moved by half a cell in x, y and z, stored as
/// slices: storage index (i, j, k) with even k belongs to the even sublattice, odd k to the moved one:
///
///     position = origin + spacing * (i + h, j + h, k / 2)   with h = 1/2 for odd k, else 0      (BCC)
///     position = origin + spacing * (i, j, k)                                                    (CC)
///
/// `spacing` is the cell edge of one sublattice, so a BCC slice is half a cell above the one below.
/// (Theussl, Moeller, Groeller: Optimal regular volume sampling, 2001; Röber 2002, section 4.1.)
namespace tessera::volume {

enum class LatticeKind : std::uint8_t { CC, BCC };
inline constexpr std::string_view kLatticeNames[] = {"cc", "bcc"};

/// Cell edge of a BCC sublattice, in cells of the CC grid it replaces, at 70.7 % of the samples.
inline constexpr double kBccSpacing = 1.4142135623730951;

struct Box {
    glm::dvec3 lo{0}, hi{1};
    glm::dvec3 size() const { return hi - lo; }
    glm::dvec3 center() const { return (lo + hi) * 0.5; }
    bool operator==(const Box&) const = default;
};

struct Lattice {
    LatticeKind kind = LatticeKind::CC;
    glm::ivec3 size{1};    ///< samples stored per axis; for BCC, z counts the slices of both sublattices
    glm::dvec3 spacing{1}; ///< cell edge of one sublattice, in the data set's length unit
    glm::dvec3 origin{0};  ///< position of sample (0, 0, 0)

    bool operator==(const Lattice&) const = default;

    std::size_t count() const {
        return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
    }
    /// Linear index of a storage index, x fastest.
    std::size_t index(glm::ivec3 at) const {
        return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(at.y)) *
                   static_cast<std::size_t>(size.x) +
               static_cast<std::size_t>(at.x);
    }
    /// Physical position of a storage index.
    glm::dvec3 position(glm::ivec3 at) const;
    /// Storage index of the sample nearest to a physical position, clamped to the lattice. Distances are measured in
    /// cells, not metres: where cells are long and thin the data vary at the scale of the cell. Of a tie the even one.
    glm::ivec3 nearest(glm::dvec3 position) const;
    /// Cells of the (even) sublattice: continuous index of a physical position; sample i lies at i.
    glm::dvec3 toCells(glm::dvec3 position) const { return (position - origin) / spacing; }
    glm::dvec3 fromCells(glm::dvec3 cells) const { return origin + cells * spacing; }
    /// Size in texels of one-sample-per-sublattice: CC its size, BCC (nx, ny, ceil(nz / 2)).
    glm::ivec3 texels() const;
    /// Samples of one sublattice (0 even, 1 odd); for CC sublattice 0 is everything.
    glm::ivec3 sublatticeSize(int sublattice) const;
};

/// The BCC lattice that takes the place of a CC grid at 70.7 % of its samples: sizes round(X / T), round(Y / T),
/// round(2 Z / T) with T = sqrt 2, at least 1 x 1 x 2, centred in the box the grid spans.
Lattice bccFor(const Lattice& cc);

} // namespace tessera::volume
