#pragma once

#include "volume/base/progress.h"
#include "volume/mesh/surface_mesh.h"

#include <string>
#include <string_view>

namespace tessera::volume {

inline constexpr std::string_view kMeshEndings[] = {".ply", ".stl", ".obj", ".vtp"};

/// Writes a mesh; the ending of `path` says how:
///
/// - .ply  binary, little-endian: positions, normals and the scalars as a property of that name, 32-bit float
/// - .stl  binary: triangles with their own normals; neither shared vertices nor scalars
/// - .obj  text: positions and normals
/// - .vtp  VTK poly data, appended raw: positions, normals and scalars
///
/// The file appears complete or not at all; an existing one is replaced. Throws Error for another ending or more
/// triangles than the format counts, MachineError when the disk refuses, Cancelled.
void writeMesh(const SurfaceMesh& mesh, const std::string& path, const std::string& scalarName = "value",
               const Progress& progress = {});

} // namespace tessera::volume
