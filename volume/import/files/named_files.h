#pragma once

#include <string>
#include <vector>

namespace tessera::volume {

/// All files that are read when `path` is opened, except `path` itself: those listed by a .pvd, a .series, a pattern or
/// a folder, the sidecar or the samples of a raw file, the files named by a header (.nhdr, .mhd, .vtm, .pvtu, .case and
/// the like), and those that these name. For an OpenFOAM case, named by its folder or by its .foam file, all files in
/// the folders of system, constants, processors and times. Existing regular files only, absolute paths in alphabetical
/// order. Does not throw: a file that cannot be read names none.
std::vector<std::string> filesNamedBy(const std::string& path);

} // namespace tessera::volume
