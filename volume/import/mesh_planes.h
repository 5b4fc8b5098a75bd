#pragma once

#include "volume/import/files/file_block.h"

#include <array>
#include <string>
#include <vector>

namespace tessera::volume {

/// Where the planes of a mesh come from.
struct PlanesOfMesh {
    std::array<AxisEvents, 3> events; ///< of all its blocks; of an axis where those of one are not known: empty
    Box box;
    std::array<std::vector<double>, 3> ends; ///< of the boxes of its blocks, rising: they stay planes
    glm::dvec3 mostSamples{1024};            ///< an axis
    double mostSamplesOfAll = 16e6;          ///< in all
};

/// Planes between which the samples of a mesh lie, along one axis.
struct AxisPlanes {
    std::vector<double> planes; ///< rising, from end to end of the box; empty: not known
    bool aligned = false;       ///< cells begin and end at these planes alone
    bool onePerCell = false;    ///< and each cell reaches from one to the next
};

/// Planes of a mesh from where its cells begin and end: graded blocks of hexahedra get exactly one interval per cell.
///
/// n(x), the cells up to x, is the integral of the mean of 1 / extent over the cells at x. Where at least half of the
/// cross-section ends or begins within 0.35 cells there is a plane. Between planes there is one interval where n grows
/// by at most 1.35, else 1.5 per cell at equal n. If these are too many, intervals between planes become fewer, then
/// the weakest planes are left out, but not the ends of regions; `notes` then says so. An axis for which that is not
/// enough has none.
std::array<AxisPlanes, 3> planesOfMesh(const PlanesOfMesh& mesh, std::vector<std::string>& notes);

/// Events of several meshes, in any order, as those of all together.
AxisEvents joinedEvents(AxisEvents events);

/// Events of a grid, whose cells lie between `borders` (rising); each counts for `others` cells beside it of the
/// cross-section `area`.
AxisEvents eventsOfGrid(const std::vector<double>& borders, double others, double area);

} // namespace tessera::volume
