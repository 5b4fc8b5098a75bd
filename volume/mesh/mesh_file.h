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
/// Positions of a mesh with an origin are 64-bit numbers (.ply, .vtp) or have 17 digits (.obj). STL has 32 bits alone:
/// there they stay less the origin (meshShift), which its header says, too.
///
/// The file appears complete or not at all; an existing one is replaced. Throws Error for another ending or more
/// triangles than the format counts, MachineError when the disk refuses, Cancelled.
void writeMesh(const SurfaceMesh& mesh, const std::string& path, const std::string& scalarName = "value",
               const Progress& progress = {});

/// What a file of a mesh says of where the mesh lies, for the user: "32-bit coordinates, less (500000, 5000000, 0)";
/// "" where they are as in the data.
std::string meshShift(const SurfaceMesh& mesh, const std::string& path);

} // namespace tessera::volume
