#pragma once

#include "volume/field/lattice.h"

#include <array>
#include <vector>

/// Lattices beside each other share the axes of one of them: slices, boxes, coarser levels. Files state the axes of
/// their own samples.
namespace tessera::volume {

/// The CC lattice as the grid of samples that axes of its own make, at the same places: a box keeps its planes; samples
/// that leave out others are points. Without uneven axes, and where the axes are of these samples already, itself.
Lattice withOwnAxes(const Lattice& cc);

/// The box in space of the grid that its axes make. If an axis is of cells, it reaches to the faces of cells, along
/// even axes half a cell beyond the samples; else from the first to the last sample.
Box gridBounds(const Lattice& cc);

/// Whether an axis is of cells, so that the box goes on beyond the outermost samples.
bool hasCells(const AxisMaps& axes);

/// Whether two axes have the same planes, up to a share of the shorter cell at each. Null is an even axis.
bool samePlanes(const AxisMap* a, const AxisMap* b, double share);

/// Places of the samples along each axis of a CC lattice.
std::array<std::vector<double>, 3> samplePlaces(const Lattice& cc);

/// The least and the greatest length of a cell along an axis; of points the distances between them. On an even axis
/// both are the spacing.
struct CellLengths {
    double least = 0, greatest = 0;
};
CellLengths cellLengthsAlong(const Lattice& lattice, int axis);

} // namespace tessera::volume
