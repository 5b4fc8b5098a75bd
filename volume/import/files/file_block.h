#pragma once

#include "volume/field/dataset.h"
#include "volume/field/slices.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

/// The result of every reader: arrays on one grid or mesh, as named in the file. `assemble` turns them into a data set.
namespace tessera::volume {

/// One named array of a file, before renaming.
struct Array {
    std::string name, unit;
    int components = 1; ///< 1 or 3
    ScalarType type = ScalarType::F32;
    bool categorical = false;
    std::vector<Label> labels;
    bool operator==(const Array&) const = default;
};

/// Where cells of a mesh begin and end along an axis: sums over those that do at one place.
struct AxisEvent {
    double place = 0;
    double begun = 0, ended = 0;                   ///< cells
    double areaBegun = 0, areaEnded = 0;           ///< their cross-sections
    double perLengthBegun = 0, perLengthEnded = 0; ///< 1 / extent
    bool operator==(const AxisEvent&) const = default;

    /// Adds the sums of another; the place stays.
    void add(const AxisEvent& other) {
        begun += other.begun;
        ended += other.ended;
        areaBegun += other.areaBegun;
        areaEnded += other.areaEnded;
        perLengthBegun += other.perLengthBegun;
        perLengthEnded += other.perLengthEnded;
    }
};
using AxisEvents = std::vector<AxisEvent>; ///< places rise

/// One block of one file: a raw file, an image, a mesh, a region of a multi-block file.
struct FileBlock {
    std::string file;                 ///< as the user named it
    std::string format;               ///< "raw", "vti", "OpenFOAM", ...
    std::string name;                 ///< of the block, "" where the file is one block
    bool resamples = false;           ///< `read` can sample on any grid; a grid only on its own otherwise
    bool mesh = false;                ///< cells that are sampled; else samples lie on `lattice` as they are
    bool cellData = false;            ///< values belong to cells, so samples lie in the middle of cells, within `box`
    bool cellArrays = false;          ///< some array of a mesh is of cells, beside those of points or not
    Lattice lattice;                  ///< of a grid; of an uneven one with its axes
    Box box;                          ///< extent of a mesh, or of the cells of a grid
    double cells = 0;                 ///< of a mesh, or an uneven grid
    glm::dvec3 cellSize{0};           ///< harmonic mean of the extents of these cells, per axis
    double volume = 0;                ///< of all cells of a mesh; 0 where it is not known
    bool boxes = false;               ///< all cells of a mesh are boxes along the axes
    std::array<AxisEvents, 3> events; ///< of a mesh, per axis; empty where they are not known
    std::string lengthUnit, timeUnit, provenance; ///< "" = not stated
    std::string timeName;                         ///< "" = not stated
    std::vector<std::string> notes;               ///< for the user: how the samples came about, what was left out
    std::vector<Array> arrays;
    std::vector<double> times;        ///< empty: one frame whose time is not stated
    std::vector<Quantity> quantities; ///< one value for each time, or one for the only frame
    /// Slices of one component of one array at the block's own time index, sampled on `target` (equal to `lattice` for
    /// grids; samples outside a mesh are absent).
    std::function<Field(int array, int component, int time, const Lattice& target, SliceRange slices)> read;
    bool inParts = false; ///< `read` gives any slices, of the grid alone; else only all of them
    /// Ranges of an array's own values, at points or cells: one per component, then for a vector that of its magnitude;
    /// lo > hi where there is no value. Null, or empty, where they are not known. `between`: samples lie between the
    /// middles of cells, and reach the values that these give at their corners.
    std::function<std::vector<Range>(int array, int time, bool between)> ranges;
};

} // namespace tessera::volume
