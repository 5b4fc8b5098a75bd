#pragma once

#include "volume/field/axis_map.h"

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
/// `spacing` is the cell edge of one sublattice, so a BCC slice is half a cell above the one below. Where an axis has a
/// map, these are places on its sheet (`axis_map.h`), and the map leads from there to space.
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
    glm::dvec3 spacing{1}; ///< cell edge of one sublattice on the sheet, in the data set's length unit
    glm::dvec3 origin{0};  ///< place of sample (0, 0, 0) on the sheet
    AxisMaps axes = {};    ///< from the sheet to space

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
    /// Whether the sheet is space: one spacing per axis.
    bool isEven() const { return axes.isEven(); }

    /// Of space, for places and numbers. Position of a storage index.
    glm::dvec3 position(glm::ivec3 at) const { return axes.toSpace(sheetPosition(at)); }
    /// Storage index of the sample whose cell a place lies in, clamped to the lattice; of BCC the nearest one.
    /// Distances are measured in cells, not metres: where cells are long and thin the data vary at the scale of the
    /// cell. Of a tie the even one.
    glm::ivec3 nearest(glm::dvec3 place) const { return nearestToCells(toCells(place)); }
    /// Cells of the (even) sublattice: continuous index of a place; sample i lies at i, its cell reaches half to each
    /// side.
    glm::dvec3 toCells(glm::dvec3 place) const { return cellsOfSheet(axes.toSheet(place)); }
    glm::dvec3 fromCells(glm::dvec3 cells) const { return axes.toSpace(sheetOfCells(cells)); }
    /// Continuous index for values at a place: linear in space between samples. On BCC `toCells`.
    glm::dvec3 between(glm::dvec3 place) const;
    /// Edges in space of a cell around a place: half a cell of this lattice to each side of it on the sheet.
    glm::dvec3 lengthsAt(glm::dvec3 place) const;

    /// Of the sheet, for lattices beside each other and for pictures: affine.
    glm::dvec3 sheetPosition(glm::ivec3 at) const;
    glm::dvec3 sheetOfCells(glm::dvec3 cells) const { return origin + cells * spacing; }
    glm::dvec3 cellsOfSheet(glm::dvec3 sheet) const { return (sheet - origin) / spacing; }
    glm::ivec3 nearestToCells(glm::dvec3 cells) const;

    /// Size in texels of one-sample-per-sublattice: CC its size, BCC (nx, ny, ceil(nz / 2)).
    glm::ivec3 texels() const;
    /// Samples of one sublattice (0 even, 1 odd); for CC sublattice 0 is everything.
    glm::ivec3 sublatticeSize(int sublattice) const;
};

/// The grid of samples that axes make; `size`, `spacing` and `origin` of an axis without a map are kept.
Lattice withAxes(Lattice even, AxisMaps axes);

/// The BCC lattice that takes the place of a CC grid at 70.7 % of its samples: sizes round(X / T), round(Y / T),
/// round(2 Z / T) with T = sqrt 2, at least 1 x 1 x 2, centred in the box the grid spans.
Lattice bccFor(const Lattice& cc);

} // namespace tessera::volume
