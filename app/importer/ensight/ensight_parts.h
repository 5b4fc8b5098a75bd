#pragma once

#include "app/importer/ensight/ensight_bytes.h"

#include <array>
#include <optional>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

/// The parts of an EnSight geometry, and the values of a variable on them.
namespace tessera::importer {

/// The cells of one type in a part.
struct EnSightCells {
    std::string type; ///< as the file says it: "hexa8", "g_tetra4"
    std::size_t count = 0;
    std::vector<std::int32_t> nodes;   ///< from 1
    std::vector<std::int32_t> pieces;  ///< nsided: corners of each; nfaced: faces of each
    std::vector<std::int32_t> corners; ///< nfaced: corners of each face
};

struct EnSightPart {
    enum class Kind { Cells, Curvilinear, Rectilinear, Uniform };
    int number = 0;
    std::string name;
    Kind kind = Kind::Cells;
    std::array<int, 3> size{0, 0, 0}; ///< points of a block
    std::size_t points = 0;
    std::vector<float> places; ///< all x, then y, then z; of a rectilinear block those of each axis; origin and steps
    std::vector<EnSightCells> cells;
    std::vector<std::int32_t> blanks, ghosts; ///< of a block: points that are none (0), cells that are ghosts (not 0)

    std::size_t cellCount() const;
};

/// Reads the parts of a geometry.
std::vector<EnSightPart> readEnSightParts(EnSightBytes& file);

/// Values of one part, one for each component after the other; NaN where the file states none.
struct EnSightValues {
    std::vector<float> values;
};

/// Values of a variable by part of the geometry; nothing for parts without it.
std::vector<std::optional<EnSightValues>> readEnSightValues(EnSightBytes& file, const std::vector<EnSightPart>& parts,
                                                            std::size_t components, bool ofCells);

/// The grid of a part without cells of a lower dimension than its highest, which `left` counts. Null: it has no cells.
struct EnSightGrid {
    vtkSmartPointer<vtkDataSet> data;
    std::vector<std::size_t> kept; ///< of each cell its place in the file; empty: all
    std::size_t left = 0;
};
EnSightGrid gridOfPart(const EnSightPart& part);

} // namespace tessera::importer
