#pragma once

#include "volume/base/progress.h"
#include "volume/four/tetra_mesh.h"

#include <string>
#include <string_view>

namespace tessera::volume {

inline constexpr std::string_view kTetraEnding = ".vtu";

/// Writes a surface in space and time as a VTK unstructured grid of tetrahedra, appended raw: points x, y, z, and their
/// time as an array of the points called `timeName`, all as 64-bit numbers. (A VTK file has no fourth coordinate: a
/// contour of that array is the surface at a time.) The file appears complete or not at all. Throws Error for another
/// ending, MachineError when the disk refuses, Cancelled.
void writeTetraMesh(const TetraMesh& mesh, const std::string& path, const std::string& timeName = "time",
                    const Progress& progress = {});

} // namespace tessera::volume
