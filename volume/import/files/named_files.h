#pragma once

#include <string>
#include <vector>

namespace tessera::volume {

/// Every file that is read when `path` is opened, `path` itself left out: those that a .pvd, a .series, a pattern or a
/// folder stands for, the sidecar or the samples of a raw file, the files that a header (.nhdr, .mhd, .vtm, .pvtu,
/// .case and the like) names, and those that these name. Of an OpenFOAM case, named by its folder or by its .foam file,
/// all files in the folder. Existing regular files only, absolute paths in alphabetical order. Nothing is thrown: a
/// file that cannot be read names none.
std::vector<std::string> filesNamedBy(const std::string& path);

} // namespace tessera::volume
