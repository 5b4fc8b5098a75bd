#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <optional>
#include <string>
#include <vector>

/// Writing data sets for other programs. Frames are loaded and written one component at a time.
namespace tessera::volume {

/// What to write; empty lists mean all.
struct ExportSelection {
    std::vector<int> parameters; ///< indices into DatasetInfo::parameters
    std::vector<int> times;      ///< indices into DatasetInfo::times, increasing
    std::optional<int> channel;  ///< .nrrd: index into DatasetInfo::channels(), to write that alone
    /// Write scaled integers as the values they represent: in their own type if it holds them, else in the smallest
    /// type that does, else as floats. For samples whose scaling is not that of the source.
    bool values = false;
};

/// Writes the CC data set `source` to `path`; its ending says how:
///
/// - .vti  VTK image data, point data, appended raw, one time; vectors as arrays of 3; field data TimeValue and units
///         ("O2 mol/m3; T K"). Several times: OUT_0000.vti ... and OUT.pvd. A .pvd path gives the same with any number,
///         of uneven axes as .vtr.
/// - .vtr  the same as a VTK rectilinear grid, whose coordinates are those of the axes bit for bit. Cell data if an
///         axis is of cells, between its planes, else point data. Of both, even axes get borders half a cell from the
///         samples, axes of points get them in the middle between samples and have the places in field data "points_x".
/// - .nrrd one parameter at one time, of a vector all components (a first axis of the kind "vector"), or one channel.
/// - .raw  (or .json) samples `[time][component][z][y][x]` as stored, and the sidecar beside them that `openFiles`
///         reads, with the planes of uneven axes; a parameter whose type differs from the first's has its own "dtype",
///         each component its own "scale" and "offset".
///
/// Axes of several units (DatasetInfo::axisUnits) have theirs in "space units" of .nrrd, "axis_units" of the sidecar
/// and of the field data of VTK files.
///
/// Without `selection.values`, integers whose scaling the format cannot say - in .vti, .vtr and .nrrd any, in .raw one
/// that changes in time - are written as physical floats (24 significant bits), and so are integer vectors whose
/// components lack different samples where only one array of flags could say so. Absent samples are NaN in floating
/// point; integers that have some get a companion array NAME.present (0 = absent). In .raw they keep their stored
/// numbers, bit for bit: where one number tells them from the present ones, the sidecar states it as missing_value,
/// else there is the companion array. Files appear complete or not at all; existing ones are replaced. Returns the
/// files written. Throws Error for another ending, a BCC lattice, uneven axes or a selection the format cannot hold,
/// MachineError when the disk refuses, Cancelled.
std::vector<std::string> exportDataset(const Dataset& source, const ExportSelection& selection, const std::string& path,
                                       const Progress& progress = {});

} // namespace tessera::volume
